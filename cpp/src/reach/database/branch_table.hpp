#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/robot/detail/ik_closed_form.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::detail {

/// The closed form of an arm for one set of values of the joints that a tool pose leaves free ("locked" here).
struct LockedArm {
  Screws six;  ///< Screws of the other six, at these values and all else zero.
  ClosedForm form;
  Rigid tip_inverse;   ///< T_world_tip^-1 there: a target times this is what the six turns multiply to.
  Eigen::VectorXd at;  ///< The configuration: locked values, zeros.
};

/// Closed forms of an arm of six joints and up to two more, over values of the latter that fill their range evenly:
/// every prefix of the list does. Immutable, shared between threads.
class BranchTable {
 public:
  /// `samples` values, 0: enough for their number. An arm of six has one entry. The arm's root stands where it stands
  /// now.
  BranchTable(const JointGroup& arm, int samples);

  bool known() const { return !arms_.empty(); }  ///< False: no closed form fits.
  int size() const { return static_cast<int>(arms_.size()); }
  int free_joints() const { return static_cast<int>(locked_.size()); }
  const LockedArm& operator[](int sample) const { return arms_[sample]; }
  /// Samples below `count`, nearest to `sample` first (itself included).
  const std::vector<int>& order(int sample) const { return orders_[sample]; }
  /// The arm with its locked joints where they are in q.
  LockedArm lock(const Eigen::VectorXd& q) const;

  /// Calls use(q, outside) for every branch that puts the tip at `target` until it says true, and returns whether it
  /// did. q is scratch: the branch, clamped to limits (joints that may turn more than once: nearest to their middle);
  /// `outside` says by how much in sum [rad], 0 for branches within limits. Exact for ideal geometry.
  template <class Use>
  bool each_branch(const LockedArm& arm, const Rigid& target, Eigen::VectorXd& q, const Use& use) const {
    Branches branches;
    solve_closed_form(arm.form, arm.six, target * arm.tip_inverse, branches);
    for (int b = 0; b < branches.count; ++b) {
      const double outside = fill(branches.value[b], arm, q);
      if (use(q, outside)) return true;
    }
    return false;
  }

 private:
  double fill(const std::array<double, Screws::kMaxJoints>& values, const LockedArm& arm, Eigen::VectorXd& q) const;

  JointGroup arm_;
  std::vector<int> locked_, turning_;  ///< Columns.
  Eigen::VectorXd lower_, upper_, middle_;
  std::vector<LockedArm> arms_;
  std::vector<std::vector<int>> orders_;
};

}  // namespace mmgrasp::detail
