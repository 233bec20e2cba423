#pragma once

#include "mmgrasp/reach/capability_map.hpp"

namespace mmgrasp {

namespace detail {

constexpr int kCapabilityFormat = 1;

/// T_centre_tip of the tool poses around a voxel's centre.
Poses sphere_poses(const CapabilityOptions& options);

/// Key of robot, joints, tip and where the other joints are held.
std::string capability_arm_key(const JointGroup& arm);

}  // namespace detail

struct CapabilityMap::Data {
  CapabilityOptions options;
  std::string arm_key;
  int joints = 0;
  std::array<int, 3> shape{0, 0, 0};
  Poses tool_poses;                   ///< Around a voxel's centre.
  std::vector<std::uint8_t> classes;  ///< Rejection of each pose of each voxel.
  std::vector<float> configurations;  ///< Configurations of the reached poses, in order.

  // Derived by complete().
  std::vector<float> index;
  std::vector<std::int64_t> first;  ///< Reached poses before each voxel, and all.
  Rejections rejections;

  std::int64_t voxel_count() const { return static_cast<std::int64_t>(shape[0]) * shape[1] * shape[2]; }
  std::size_t poses() const { return tool_poses.size(); }
  Eigen::Vector3d centre(std::int64_t voxel) const;
  Pose pose(std::size_t at) const;  ///< T_root_tip of an entry of `classes`.
  /// Shape and tool poses from the options.
  void lay_out();
  void complete();
};

}  // namespace mmgrasp
