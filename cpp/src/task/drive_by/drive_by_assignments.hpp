#pragma once

#include <functional>
#include <vector>

#include "task/drive_by/drive_by_goals.hpp"
#include "task/drive_by/drive_by_steps.hpp"

namespace mmgrasp::detail {

/// One candidate per task, and configuration sequences for them, quickest first.
struct GraspAssignment {
  std::vector<ConfigurationSequence> sequences;
  double bound = 0;               ///< No motion with these candidates is shorter [s].
  double estimated_duration = 0;  ///< What the first sequence may take [s].
};

/// Every candidate of every task that goal configurations were found for is in one of the assignments, beside the
/// candidates of the other tasks that go with it best. Least bound first, then the shortest estimated duration. When
/// options.grasp_assignments is 1 or no task has two candidates there is a single assignment, of sequences through any
/// candidates. `collisions` counts the waypoints of a sequence's first guess that collide: such sequences come later.
std::vector<GraspAssignment> drive_by_assignments(const JointGroup& group, const std::vector<DriveByStep>& steps,
                                                  const std::vector<GoalConfigurations>& goals,
                                                  const Eigen::VectorXd& start, const DriveByGoal& goal,
                                                  const DriveByOptions& options,
                                                  const std::function<int(const ConfigurationSequence&)>& collisions);

/// Seconds that any motion takes that starts and ends at rest and brings the tool to `T_world_tip` on the way, up to
/// `slack` [m] beside it: joints and base as fast as their limits let them, the arm stretched out towards the tool.
double least_duration(const JointGroup& group, const Eigen::VectorXd& start, const DriveByGoal& goal,
                      const Pose& T_world_tip, double slack);

}  // namespace mmgrasp::detail
