#include "task/problem/scene.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace mmgrasp::detail {
namespace {

constexpr double kJustTouching = 1e-6;  // [m] A part that slides along a wall without a gap is no pick.

}  // namespace

std::vector<TrayId> all_trays(const PartSupplyProblem& problem) {
  std::vector<TrayId> trays;
  for (int tray = 0; tray < static_cast<int>(problem.trays.size()); ++tray) trays.emplace_back(tray);
  return trays;
}

std::vector<PartRef> all_parts(const PartSupplyProblem& problem) {
  std::vector<PartRef> parts;
  for (TrayId tray : all_trays(problem)) {
    const int count = static_cast<int>(tray_of(problem, tray).parts.size());
    for (int part = 0; part < count; ++part) parts.push_back({tray, part});
  }
  return parts;
}

std::vector<PartRef> target_parts(const PartSupplyProblem& problem, TrayId tray) {
  std::vector<PartRef> targets;
  const std::vector<Part>& parts = tray_of(problem, tray).parts;
  for (int part = 0; part < static_cast<int>(parts.size()); ++part) {
    if (parts[part].target) targets.push_back({tray, part});
  }
  return targets;
}

int ik_seeds_of_a_grasp(const PartSupplyProblem& problem) {
  std::vector<int> grasps;
  for (const Tray& tray : problem.trays) {
    for (const Part& part : tray.parts) {
      if (part.target) grasps.push_back(static_cast<int>(part.grasps.size()));
    }
  }
  return mmgrasp::ik_seeds_of_a_grasp(problem.options.grid.ik_seeds, grasps);
}

World world_with_parts(const PartSupplyProblem& problem, const std::vector<PartRef>& parts) {
  World world = problem.world;
  // A checker refuses pairs that name a part which is not there.
  for (const PartRef& ref : all_parts(problem)) {
    if (std::find(parts.begin(), parts.end(), ref) == parts.end()) world.forget(part_of(problem, ref).name);
  }
  for (const PartRef& ref : parts) {
    const Part& part = part_of(problem, ref);
    WorldObject object;
    object.shapes = part.shapes;
    object.T_world_object = part.T_world_part;
    world.add(part.name, std::move(object));
  }
  return world;
}

World world_holding(World world, const Hand& gripper, const std::string& object, const Pose& T_hand_object) {
  const std::vector<std::string>& fingers = gripper.finger_links;
  world.attach(object, gripper.tool_link, T_hand_object, std::set<std::string>(fingers.begin(), fingers.end()));
  Padding padding = world.padding();
  padding.attached = std::max(padding.attached, kJustTouching);
  world.set_padding(std::move(padding));
  return world;
}

JointGroup arm_with_opening(const JointGroup& arm, const Hand& gripper, double opening) {
  Eigen::VectorXd values = arm.reference();
  for (const auto& [name, value] : gripper.joint_values(opening)) {
    const Joint& joint = arm.robot().joints()[arm.robot().joint_index(name)];
    values[joint.value_index] = value;
  }
  return arm.with_reference(values);
}

}  // namespace mmgrasp::detail
