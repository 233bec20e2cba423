// A whole round from structs: two trays on a table, planned, judged by the independent checker, and written as
// plan.json, which `mmgrasp verify` and `mmgrasp view` take. Uses the installed library alone.
// Usage: plan_a_round <folder of the shipped assets> [plan.json]
#include <iostream>

#include "mmgrasp/collision/floor.hpp"
#include "mmgrasp/grasp/sample_grasps.hpp"
#include "mmgrasp/reach/reach_database.hpp"
#include "mmgrasp/task/part_supply.hpp"
#include "mmgrasp/task/plan_file.hpp"
#include "mmgrasp/task/plan_to_check.hpp"
#include "mmgrasp/verify/plan_check.hpp"

using namespace mmgrasp;

namespace {

Pose at(double x, double y, double z) {
  return pose_from_xyz_rpy({x, y, z}, Eigen::Vector3d::Zero());
}

Hand two_fingers() {
  Hand hand;
  hand.tool_link = "gripper_tcp";
  hand.max_opening = 0.10;
  hand.finger_depth = 0.04;
  hand.finger_width = 0.022;
  for (const std::string side : {"left", "right"}) {
    hand.joints.push_back({side + "_gripper_finger_joint", 0.0, 0.05});
    hand.finger_links.push_back(side + "_gripper_finger_link");
  }
  return hand;
}

/// A tray of four brackets whose floor has its middle at (x, y, z); the walls stand in the room.
Tray tray_of_brackets(const std::string& name, const Pose& T_world_tray, const Hand& hand, World& room) {
  Tray tray;
  tray.name = name;
  tray.T_world_tray = T_world_tray;
  const std::vector<LinkShape> body = {{Box{{0.03, 0.05, 0.07}}}};
  const std::vector<Grasp> grasps = sample_grasps(body, hand).grasps;
  for (int i = 0; i < 4; ++i) {
    Part part;
    part.name = name + "/bracket " + std::to_string(i);
    part.shapes = body;
    part.T_world_part = T_world_tray * at(-0.06 + 0.12 * (i / 2), -0.08 + 0.16 * (i % 2), 0.0351);
    part.grasps = grasps;
    tray.parts.push_back(part);
  }
  for (const double side : {-1.0, 1.0}) {
    const std::string end = side < 0 ? " near" : " far";
    room.add(name + end, Box{{0.01, 0.40, 0.05}}, T_world_tray * at(side * 0.155, 0, 0.025));
  }
  return tray;
}

}  // namespace

int main(int count, char** arguments) {
  const std::string folder = std::string(arguments[1]) + "/robots/fetchlike/fetchlike";
  RobotOptions options;
  options.base = BaseKind::diff_drive;
  const Robot robot = Robot::load(folder + ".urdf", folder + ".srdf", options);
  const JointGroup arm = robot.group("arm_with_torso", "gripper_tcp");
  const Hand hand = two_fingers();

  World room;
  add_floor(room, arm);
  room.add("table", Box{{0.40, 1.40, 0.03}}, at(2.78, 0, 0.685));
  room.add("wall", Box{{0.10, 4.0, 1.2}}, at(3.05, 0, 0.6));
  std::vector<Tray> trays;
  for (const double y : {-0.30, 0.30}) {
    trays.push_back(tray_of_brackets(y < 0 ? "A" : "B", at(2.78, y, 0.7001), hand, room));
  }
  Eigen::VectorXd home(arm.size());
  home << 0.05, 1.2, -1.2, -0.2, -1.3, 0.0, -1.6, 0.0;  // tucked

  PartSupplyProblem problem{robot, arm, hand, room, trays, home};
  problem.place_region.T_base_bin = at(-0.06, -0.27, 0.60);
  problem.place_region.size = {0.22, 0.20};
  problem.options.positioning_uncertainty = 0.05;
  ReachOptions postures;
  postures.samples = 500000;
  const ReachDatabase database = ReachDatabase::build(arm, postures);
  const PartSupplyPlan plan = plan_part_supply(problem, database);
  std::cout << "round " << to_string(plan.outcome) << ": " << plan.stops.size() << " stop(s), at least "
            << plan.lower_bound << ", " << plan.picks.size() << " picks\n";
  for (const Obstruction& what : plan.obstructions) std::cout << "- " << what.message << "\n";
  if (plan.outcome != Outcome::solved) return 1;

  const verify::PlanCheckResult verdict = verify::check_plan(plan_to_check(problem, plan));
  std::cout << verdict.configurations_checked << " configurations checked by KDL and FCL: " << verdict.faults.size()
            << " faults, " << verdict.minimal_stops << " stop(s) are enough\n";
  for (const verify::Fault& fault : verdict.faults) std::cout << "- " << fault.where << ": " << fault.message << "\n";
  write_plan(problem, database, plan, count > 2 ? arguments[2] : "plan.json", {"two trays", "plan_a_round.cpp"});
  return verdict.faults.empty() ? 0 : 1;
}
