#include "mmgrasp/collision/floor.hpp"

#include <algorithm>
#include <vector>

namespace mmgrasp {
namespace {

/// Whether the joints of the group, not the base's, move each link. Joints stand behind those that carry them.
std::vector<bool> moved_links(const JointGroup& group) {
  const std::vector<Joint>& joints = group.robot().joints();
  const auto in_group = [&](int joint) {
    return std::find(group.joints().begin(), group.joints().end(), joint) != group.joints().end();
  };
  std::vector<bool> moved(group.robot().links().size(), false);
  for (int j = 0; j < static_cast<int>(joints.size()); ++j) {
    const Joint& joint = joints[j];
    moved[joint.child_link] =
        moved[joint.parent_link] || in_group(j) || (joint.mimic_joint >= 0 && in_group(joint.mimic_joint));
  }
  return moved;
}

}  // namespace

void add_floor(World& world, const JointGroup& group, double height) {
  world.add(kFloor, Plane{Eigen::Vector3d::UnitZ(), height}, Pose::Identity());
  const std::vector<bool> moved = moved_links(group);
  for (std::size_t link = 0; link < moved.size(); ++link) {
    if (!moved[link]) world.allow(group.robot().links()[link].name, kFloor);
  }
}

}  // namespace mmgrasp
