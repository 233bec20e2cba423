#pragma once

#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "task/drive_by/drive_by_steps.hpp"

namespace mmgrasp::detail {

/// A configuration in which the tool is where a task wants it.
struct Stand {
  Eigen::VectorXd q;
  int candidate = 0;
};

/// Seconds between two configurations, as far as limits tell: driving and turning, or the slowest joint.
double travel_time(const JointGroup& group, const Eigen::VectorXd& from, const Eigen::VectorXd& to);

/// `to` with values that wrap moved by full turns next to `from`.
Eigen::VectorXd unwound(const JointGroup& group, const Eigen::VectorXd& from, Eigen::VectorXd to);

/// Configurations for a task on the way from `before` to `after`, best first; the base is sought beside the tool,
/// looking along the way. Each candidate is tried as if it were the only one. `checker` may be null.
std::vector<Stand> find_stands(const JointGroup& group, CollisionChecker* checker, const DriveByTask& task,
                               const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                               const DriveByOptions& options, unsigned stream, const Monitor& monitor);

/// For a step to which a straight way leads: beside each stand of the step before the nearest one with the same
/// candidate, where there is one.
std::vector<Stand> follow_stands(const JointGroup& group, CollisionChecker* checker, const DriveByStep& step,
                                 const std::vector<Stand>& before, const Monitor& monitor);

/// Chains of one stand per step, quickest first, at most `count`; each differs from the ones before it. A straight way
/// joins stands of one candidate. Empty when there is no such chain.
std::vector<std::vector<Stand>> choose_stands(const JointGroup& group, const std::vector<DriveByStep>& steps,
                                              const std::vector<std::vector<Stand>>& stands,
                                              const Eigen::VectorXd& start, const Eigen::VectorXd& goal, int count);

}  // namespace mmgrasp::detail
