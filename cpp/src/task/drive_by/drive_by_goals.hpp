#pragma once

#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "task/drive_by/drive_by_steps.hpp"

namespace mmgrasp::detail {

/// A configuration of base and arm in which the tool is where a task wants it.
struct StepConfiguration {
  Eigen::VectorXd q;
  int candidate = 0;  ///< Index into the task's candidates.
};
using GoalConfigurations = std::vector<StepConfiguration>;     ///< Alternatives for one step.
using ConfigurationSequence = std::vector<StepConfiguration>;  ///< One for each step.

/// Time between two configurations by the limits alone [s]: driving and turning, or the slowest joint.
double travel_time(const JointGroup& group, const Eigen::VectorXd& from, const Eigen::VectorXd& to);

/// `to` with values that wrap moved by full turns next to `from`.
Eigen::VectorXd unwound(const JointGroup& group, const Eigen::VectorXd& from, Eigen::VectorXd to);

/// Configurations for a task on the way from `before` to `after`, best first; the base is sought beside the tool,
/// looking along the way. Each candidate is tried as if it were the only one. `checker` may be null.
GoalConfigurations find_goal_configurations(const JointGroup& group, CollisionChecker* checker, const DriveByTask& task,
                                            const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                                            const DriveByOptions& options, unsigned stream, const Monitor& monitor);

/// Configurations for a step to which a straight way leads: beside each one of the step before the nearest with the
/// same candidate, where there is one.
GoalConfigurations follow_goal_configurations(const JointGroup& group, CollisionChecker* checker,
                                              const DriveByStep& step, const GoalConfigurations& before,
                                              const Monitor& monitor);

/// Sequences of one configuration per step, quickest first, at most `count`; each differs from the ones before it. A
/// straight way joins configurations of one candidate. Empty when there is no such sequence.
std::vector<ConfigurationSequence> choose_sequences(const JointGroup& group, const std::vector<DriveByStep>& steps,
                                                    const std::vector<GoalConfigurations>& goals,
                                                    const Eigen::VectorXd& start, const Eigen::VectorXd& goal,
                                                    int count);

}  // namespace mmgrasp::detail
