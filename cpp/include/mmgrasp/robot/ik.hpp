#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp {

class IkObjective;  // robot/ik_objective.hpp
/// What a redundant arm prefers among the configurations of a pose; costs are summed.
using IkObjectives = std::vector<std::shared_ptr<const IkObjective>>;

/// Tolerances and budget of inverse kinematics, and what a redundant arm uses its freedom for.
struct MMGRASP_EXPORT IkOptions {
  double position_tolerance = 1e-5;  ///< [m], > 0
  double rotation_tolerance = 1e-4;  ///< [rad], > 0
  int max_iterations = 60;           ///< Per descent; > 0
  int restarts = 30;                 ///< Random restarts after the seed; >= 0
  double time_limit = 1.0;           ///< Wall-clock cap [s]; > 0
  unsigned seed = 1;                 ///< Same seed, same answer.
  /// Cost of moving each joint, > 0, one per joint of the group; empty: all the same (weighted least squares).
  std::vector<double> joint_weights;
  /// What the redundancy is used for: costs that are lowered in the null space (P3 3.3-3.5, 5.7). Empty: nothing.
  IkObjectives objectives;
  int objective_iterations = 50;  ///< Steps along the solutions once one is found, each kept on the pose; >= 0
  void check() const;
};

/// A configuration whose tip stands at the pose, or how near the search came and why others were rejected.
struct MMGRASP_EXPORT IkResult {
  /// infeasible only when the pose is farther away than all links stretched; not_found, also when every branch of a
  /// closed form was refused.
  Outcome outcome = Outcome::not_found;
  Eigen::VectorXd q;          ///< Set if and only if solved; inside limits, verified by forward kinematics.
  double position_error = 0;  ///< [m] of q, or of the best descent.
  double rotation_error = 0;  ///< [rad]
  Rejections rejections;      ///< Descents that ended: unreachable, limits, or what `valid` said.
  double objective = 0;       ///< Sum of the objectives' costs at q; 0 without objectives.
  int iterations = 0;
};

/// Says why a configuration is rejected, or Rejection::none. Kept as a callback so that `robot` knows no collisions.
using ConfigurationFilter = std::function<Rejection(const Eigen::VectorXd& q)>;

/// Scratch of one descent, reusable: no allocation after the first use. One per thread.
struct MMGRASP_EXPORT IkWorkspace {
  Matrix6Xd J;
  Eigen::VectorXd step, trial;
};

/// One damped least squares descent from q (in place), kept inside limits. Returns true when both tolerances hold.
/// The hot loop of base regions: about 10 FK + Jacobian evaluations.
MMGRASP_EXPORT bool refine_ik(const JointGroup& group, const Pose& T_world_tip, Eigen::VectorXd& q,
                              const IkOptions& options, IkWorkspace& workspace);

/// Closed-form branches and descents, from `seed` first, until one passes limits and `valid` (docs/methods/ik.md).
MMGRASP_EXPORT IkResult solve_ik(const JointGroup& group, const Pose& T_world_tip, const Eigen::VectorXd& seed,
                                 const IkOptions& options = {}, const ConfigurationFilter& valid = {},
                                 const Monitor& monitor = {});

/// Up to `count` distinct solutions, farthest-apart first. For chains of six joints whose wrist allows it (and for
/// seven with one joint sampled) every branch is computed in closed form, polished and confirmed, so the set is
/// complete; otherwise random restarts search for solutions that differ by more than 0.1 rad. Solutions are arm
/// postures: where limits leave a joint more than one turn, each comes in the turns nearest to the middle of the limits
/// alone, and with `all_turns` in every whole turn of its joints within limits, one posture after the other; `count`
/// counts postures. Stopped by the monitor, it returns what it has found.
MMGRASP_EXPORT std::vector<Eigen::VectorXd> solve_ik_all(const JointGroup& group, const Pose& T_world_tip, int count,
                                                         const IkOptions& options = {},
                                                         const ConfigurationFilter& valid = {}, bool all_turns = false,
                                                         const Monitor& monitor = {});

}  // namespace mmgrasp
