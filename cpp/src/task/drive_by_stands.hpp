#pragma once

#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/task/drive_by.hpp"

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
/// looking along the way. `checker` may be null.
std::vector<Stand> find_stands(const JointGroup& group, CollisionChecker* checker, const DriveByTask& task,
                               const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                               const DriveByOptions& options, unsigned stream, const Monitor& monitor);

/// Chains of one stand per task, quickest first, at most `count`; each differs from the ones before it.
std::vector<std::vector<Stand>> choose_stands(const JointGroup& group, const std::vector<std::vector<Stand>>& stands,
                                              const Eigen::VectorXd& start, const Eigen::VectorXd& goal, int count);

}  // namespace mmgrasp::detail
