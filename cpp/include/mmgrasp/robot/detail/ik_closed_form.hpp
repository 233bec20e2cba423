#pragma once

#include <Eigen/Core>
#include <array>

#include "mmgrasp/core/detail/rigid.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::detail {

/// The turn about the axis h through the point p.
Rigid turn_about(const Eigen::Vector3d& h, const Eigen::Vector3d& p, double angle);

/// A chain of revolute joints as the product of exponentials E_1 ... E_n = G, with axes as they lie when all joint
/// values are zero, seen from the root: G = T_root_tip T_root_tip(0)^-1.
struct Screws {
  static constexpr int kMaxJoints = 7;
  int size = 0;
  std::array<Eigen::Vector3d, kMaxJoints> h, p;
  Rigid tip;  ///< T_world_tip at zero.
};

/// True when each column moves one revolute or prismatic joint (no mimic, planar or floating joints on the way to the
/// tip).
bool one_joint_a_column(const JointGroup& group);

/// Empty (size 0) unless the group has no base and six or seven revolute joints, each with its own column.
Screws screws_of(const JointGroup& group);

/// Configurations of every branch; in a singularity that leaves a joint free, of one of its values.
struct Branches {
  static constexpr int kMaxBranches = 16;
  std::array<std::array<double, Screws::kMaxJoints>, kMaxBranches> value;
  int count = 0;
  bool free = false;  ///< A joint could take any value.
};

/// Which closed form fits a chain of six revolute joints.
///  spherical: axes 4, 5, 6 meet in one point (Pieper), and among the first three two neighbours meet or are parallel;
///  parallel:  axes 2, 3, 4 are parallel, 5 and 6 meet;
///  either also seen from the tip (`reversed`).
struct ClosedForm {
  enum class Family { none, spherical, parallel };
  Family family = Family::none;
  bool reversed = false;
};
ClosedForm closed_form_of(const Screws& six);
void solve_closed_form(const ClosedForm& form, const Screws& six, const Rigid& G, Branches& branches);

/// Seven joints: the joint which, once locked, leaves six that have a closed form, whatever its value; -1 for none.
int redundant_joint(const Screws& seven);
/// The six others with joint `locked` at `angle`; G changes with it.
Screws lock_joint(const Screws& seven, int locked, double angle, Rigid& G);

}  // namespace mmgrasp::detail
