#pragma once

#include "mmgrasp/robot/ik.hpp"

namespace mmgrasp::detail {

/// The part of `xi` that moves the joints but not the tip: (I - J^+ J) xi (P3 3.5), J^+ the pseudo-inverse that is
/// weighted with `weights` (empty: 1 each). Joints in `fixed` do not move. J: 6 x n.
Eigen::VectorXd null_space_part(const Matrix6Xd& J, const Eigen::VectorXd& xi, const std::vector<double>& weights,
                                const std::vector<bool>& fixed);

/// Lowers the sum of the options' objectives from the solution q (in place) along the solutions of the same pose (P3
/// 3.3-3.5, 5.7): steps along the projected negative gradient, each pulled back onto the pose and kept only when the
/// sum falls, limits hold and `valid` agrees. Returns the sum at the end; adds to `iterations`.
double slide_along_solutions(const JointGroup& group, const Pose& T_world_tip, const IkOptions& options,
                             const ConfigurationFilter& valid, IkWorkspace& workspace, Eigen::VectorXd& q,
                             int& iterations);

/// Sum of the objectives' costs.
double total_cost(const IkObjectives& objectives, const Eigen::VectorXd& q);

}  // namespace mmgrasp::detail
