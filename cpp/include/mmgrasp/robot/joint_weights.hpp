#pragma once

#include <Eigen/Core>
#include <initializer_list>
#include <map>
#include <string>
#include <utility>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp {

/// What a motion of each joint costs: the length of a path is the sum of sqrt(sum_i (w_i dq_i)^2) over its edges. A
/// metre of a base is no radian of a wrist:
///
///     MotionOptions options;
///     options.joint_weights = {{"x", 10}, {"y", 10}};  // joints that are not named count once
struct MMGRASP_EXPORT JointWeights {
  Eigen::VectorXd values;                 ///< One per joint of the group, finite and > 0; empty: 1 each.
  std::map<std::string, double> by_name;  ///< Or some of them by the joint's name, in place of `values`.

  JointWeights() = default;  ///< 1 each.
  JointWeights(Eigen::VectorXd all) : values(std::move(all)) {}
  JointWeights(std::initializer_list<std::pair<const std::string, double>> some) : by_name(some) {}
  bool empty() const { return values.size() == 0 && by_name.empty(); }
  /// One weight per joint of the group; empty when all are 1. Throws InvalidInput: a joint that the group does not
  /// have, another number of weights, one that is not finite and > 0 (the joint is named).
  Eigen::VectorXd of(const JointGroup& group) const;
};

}  // namespace mmgrasp
