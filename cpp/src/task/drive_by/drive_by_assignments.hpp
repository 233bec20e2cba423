#pragma once

#include <functional>
#include <vector>

#include "task/drive_by/drive_by_goals.hpp"
#include "task/drive_by/drive_by_steps.hpp"

namespace mmgrasp::detail {

/// One candidate per task, and chains of stands for them, quickest first.
struct DriveByChoice {
  std::vector<std::vector<Stand>> chains;
  double bound = 0;  ///< No motion with these candidates is shorter [s].
  double about = 0;  ///< What the first chain may take [s].
};

/// Every candidate of every task that stands were found for is in one of the choices, beside the candidates of the
/// other tasks that go with it best. Least bound first, then what looks quickest. When options.choices is 1 or no task
/// has two candidates there is a single choice, of chains through any candidates. `collisions` tells how many waypoints
/// of a chain's first guess collide: such chains come later.
std::vector<DriveByChoice> drive_by_assignments(const JointGroup& group, const std::vector<DriveByStep>& steps,
                                                const std::vector<std::vector<Stand>>& stands,
                                                const Eigen::VectorXd& start, const DriveByGoal& goal,
                                                const DriveByOptions& options,
                                                const std::function<int(const std::vector<Stand>&)>& collisions);

/// Seconds that any motion takes that starts and ends at rest and brings the tool to `T_world_tip` on the way, up to
/// `slack` [m] beside it: joints and base as fast as their limits let them, the arm stretched out towards the tool.
double least_duration(const JointGroup& group, const Eigen::VectorXd& start, const DriveByGoal& goal,
                      const Pose& T_world_tip, double slack);

}  // namespace mmgrasp::detail
