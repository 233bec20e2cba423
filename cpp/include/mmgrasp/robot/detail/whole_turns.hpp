#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::detail {

/// Turns of one configuration that planners look at: enough for six joints of three turns; limits that allow far more
/// would only fill the memory.
inline constexpr std::size_t kMaxWholeTurns = 1024;

/// The configurations of a group in which the robot stands the same: equal up to whole turns of its revolute joints. A
/// joint whose limits are wider than a turn has several such values, which planners must tell apart: the way from one
/// to the other is a turn long. Angles without limits (JointGroup::wraps()) are the same configuration in every turn,
/// and count once. A joint that others mimic in a fraction of its turns does not turn.
class MMGRASP_EXPORT WholeTurns {
 public:
  explicit WholeTurns(const JointGroup& group);

  /// Some joint's limits are at least a turn wide.
  bool any() const { return any_; }
  /// The turns of value i that lie within limits, ascending; the value itself where nothing turns. A value beyond a
  /// limit by rounding lies on it.
  std::vector<double> of(int i, double value) const;
  /// All turns of q within limits, the nearest to `near` first; at most `count`. Angles without limits take the turn
  /// nearest to `near`. Made one after the other, so the first few of many cost little.
  std::vector<Eigen::VectorXd> of(const Eigen::VectorXd& q, const Eigen::VectorXd& near,
                                  std::size_t count = kMaxWholeTurns) const;

 private:
  Eigen::VectorXd lower_, upper_;
  std::vector<bool> wraps_;
  std::vector<char> turns_;  ///< Per value: the robot stands the same a turn on, and limits are finite.
  bool any_ = false;
};

/// All turns of each configuration, those nearest to the middle of the limits first.
MMGRASP_EXPORT std::vector<Eigen::VectorXd> all_whole_turns(const JointGroup& group,
                                                            const std::vector<Eigen::VectorXd>& configurations);

}  // namespace mmgrasp::detail
