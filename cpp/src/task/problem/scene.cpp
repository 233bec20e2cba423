#include "task/problem/scene.hpp"

namespace mmgrasp {

std::vector<std::pair<int, int>> all_parts(const PartSupplyProblem& problem) {
  std::vector<std::pair<int, int>> parts;
  for (int tray = 0; tray < static_cast<int>(problem.trays.size()); ++tray) {
    const int count = static_cast<int>(problem.trays[tray].parts.size());
    for (int part = 0; part < count; ++part) parts.emplace_back(tray, part);
  }
  return parts;
}

World world_with_parts(const PartSupplyProblem& problem, const std::vector<std::pair<int, int>>& parts) {
  World world = problem.scene;
  for (const auto& [tray, index] : parts) {
    const Part& part = part_of(problem, tray, index);
    WorldObject object;
    object.shapes = part.shapes;
    object.T_world_object = part.T_world_part;
    world.add(part.name, std::move(object));
  }
  return world;
}

JointGroup arm_with_opening(const PartSupplyProblem& problem, double opening) {
  Eigen::VectorXd values = problem.arm.reference();
  for (const auto& [name, value] : problem.gripper.joint_values(opening)) {
    const Joint& joint = problem.robot.joints()[problem.robot.joint_index(name)];
    values[joint.value_index] = value;
  }
  return problem.arm.with_reference(values);
}

}  // namespace mmgrasp
