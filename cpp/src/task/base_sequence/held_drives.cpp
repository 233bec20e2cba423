#include "task/base_sequence/held_drives.hpp"

#include <algorithm>

#include "task/base_sequence/base_routes.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp::detail {
namespace {

std::vector<double> numbers(const Eigen::Vector3d& pose) {
  return {pose.x(), pose.y(), pose.z()};
}

/// What is held is padded as the links are.
World with_held_padded(World world, double padding) {
  Padding grown = world.padding();
  grown.attached = std::max(grown.attached, padding);
  world.set_padding(std::move(grown));
  return world;
}

}  // namespace

HeldDrives::HeldDrives(const PartSupplyProblem& problem, const Monitor& monitor) : problem_(problem) {
  quiet_.stop = monitor.stop;
}

bool HeldDrives::plan(const Eigen::Vector3d& base_pose, PartRef part, int grasp,
                      const std::vector<PartRef>& remaining) {
  const Part& held = part_of(problem_, part);
  const Grasp& by = held.grasps[grasp];
  const JointGroup arm = arm_with_opening(problem_.arm, problem_.gripper, by.opening);
  const World world =
      world_holding(world_with_parts(problem_, remaining), problem_.gripper, held.name, by.T_object_hand.inverse());
  const CheckerOptions options = drive_padding();
  CollisionChecker padded(arm, with_held_padded(world, options.padding), options), bare(arm, world);
  BasePath path = plan_drive(problem_, padded, bare, base_pose, problem_.goal, quiet_);
  const bool solved = path.outcome == Outcome::solved;
  const std::lock_guard<std::mutex> lock(mutex_);
  known_[{numbers(base_pose), part}] = std::move(path);
  return solved;
}

BasePath HeldDrives::found(const Eigen::Vector3d& base_pose, PartRef part) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto known = known_.find({numbers(base_pose), part});
  return known == known_.end() ? BasePath{} : known->second;
}

}  // namespace mmgrasp::detail
