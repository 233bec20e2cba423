#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::detail {

/// What a database knows of its arm: enough to work out tool poses without the robot, and to notice another one.
/// T_root_tip = root * product over rows of [Trans(p) Rx(turn) Rz(m q + o) Trans(0, 0, s q + t)] * tip.
class StoredArm {
 public:
  /// One row of chain.npy: p (3), cosine and sine of the turn about x, m, o, s, t, column of q, 1 for a slide.
  static constexpr int kRow = 11;
  static constexpr int kLevels = 65536;  ///< Values a stored joint can have.

  StoredArm() = default;
  /// The group must stand at the origin. Throws InvalidInput for floating joints on the way to the tip.
  explicit StoredArm(const JointGroup& arm);

  std::string robot, robot_hash, group, tip;
  std::vector<std::string> joints;
  std::vector<std::string> other_joints;  ///< The robot's whole value vector by name, the arm's own left out.
  std::vector<double> other_values;
  std::vector<double> lower, step;  ///< q = lower + step * stored; step is rounded so that no q lies above the limit.
  std::vector<double> chain;        ///< kRow numbers each.
  std::vector<double> root, tip_pose;  ///< 3 x 4, row by row.

  int size() const { return static_cast<int>(joints.size()); }
  /// False when the numbers make no sense (they came from a file).
  bool sound() const;
  /// Builds the tables that tool_poses() works from. To be called once the members above are set.
  void complete();

  double value(int joint, std::uint16_t stored) const { return lower[joint] + step[joint] * stored; }
  /// Values of stored configurations, one column each.
  void decode(const std::uint16_t* stored, std::size_t count, double* q) const;
  /// T_root_tip of `count` stored configurations.
  void tool_poses(const std::uint16_t* stored, std::size_t count, Pose* poses) const;

  /// What of this arm is not as it was when the database was built; empty when nothing.
  std::string difference(const StoredArm& now) const;

 private:
  void tool_poses_of(const double* q, std::size_t count, Pose* poses) const;

  struct Tables;
  std::shared_ptr<const Tables> tables_;
};

}  // namespace mmgrasp::detail
