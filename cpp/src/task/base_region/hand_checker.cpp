#include "task/base_region/hand_checker.hpp"

#include <set>

#include "mmgrasp/collision/detail/named_bodies.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp::detail {
namespace {

/// Links that stand still in the tool's frame while the arm moves: those behind the last arm joint.
std::set<std::string> hand_links(const JointGroup& arm) {
  const Robot& robot = arm.robot();
  std::set<std::string> names;
  std::vector<int> open = {robot.joints()[arm.joints().back()].child_link};
  while (!open.empty()) {
    const Link& link = robot.links()[open.back()];
    open.pop_back();
    names.insert(link.name);
    for (int joint : link.child_joints) open.push_back(robot.joints()[joint].child_link);
  }
  return names;
}

}  // namespace

CollisionChecker hand_checker(const PartSupplyProblem& problem, double opening, const World& world) {
  const JointGroup arm = arm_with_opening(problem.arm, problem.gripper, opening);
  const std::vector<Pose> T_root_link = arm.robot().link_poses(arm.full_values(problem.home));
  const Pose T_hand_root = T_root_link[arm.tip_link()].inverse();
  WorldObject hand;
  const std::set<std::string> links = hand_links(arm);
  for (std::size_t i = 0; i < arm.robot().links().size(); ++i) {
    const Link& link = arm.robot().links()[i];
    if (links.count(link.name) == 0) continue;
    for (LinkShape shape : link.collisions) {
      shape.T_link_shape = T_hand_root * T_root_link[i] * shape.T_link_shape;
      hand.shapes.push_back(shape);
    }
  }
  // A body without shapes that can be put anywhere holds the hand.
  static const Robot carrier = Robot::from_strings(
      "<robot name='carrier'><link name='root'/><link name='tool'/><joint name='turn' type='revolute'><parent "
      "link='root'/><child link='tool'/><axis xyz='0 0 1'/><limit lower='-1' upper='1' velocity='1' effort='1'/>"
      "</joint></robot>");
  World scene = objects_never_touched(arm.robot(), world, links);
  if (!hand.shapes.empty()) {
    std::string name = "hand";
    while (scene.has(name)) name += "'";
    scene.add(name, std::move(hand));
    scene.attach(name, "tool", Pose::Identity());
  }
  CheckerOptions scene_only;
  scene_only.check_self = false;
  return CollisionChecker(carrier.chain("root", "tool"), scene, scene_only);
}

}  // namespace mmgrasp::detail
