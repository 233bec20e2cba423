// Where can a base stand so that it reaches two places, and how does it get there? Uses the installed library alone.
// Usage: plan_in_a_room <folder of the shipped assets>
#include <iostream>

#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/task/base_route.hpp"
#include "mmgrasp/task/base_sequence.hpp"

int main(int, char** argv) {
  using namespace mmgrasp;
  const std::string folder = std::string(argv[1]) + "/robots/fetchlike/fetchlike";
  RobotOptions options;
  options.base = BaseKind::diff_drive;
  const Robot robot = Robot::load(folder + ".urdf", folder + ".srdf", options);
  const JointGroup arm = robot.group("arm_with_torso", "gripper_tcp");

  World world;
  world.add("wall", Box{{0.1, 3.0, 1.0}}, pose_from_xyz_rpy({1.5, 0, 0.5}, Eigen::Vector3d::Zero()));
  CollisionChecker checker(arm, world);
  Eigen::VectorXd home(arm.size());
  home << 0.05, 1.2, -1.2, -0.2, -1.3, 0.0, -1.6, 0.0;  // tucked
  BaseRouteOptions route_options;
  route_options.base = robot.base();
  const BasePath route = plan_base_route(checker, home, {0, 0, 0}, {3, 0, 0}, route_options);
  std::cout << "route " << to_string(route.outcome) << ", " << route.length << " m\n";

  BaseGrid grid;
  grid.nx = grid.ny = 20;
  grid.headings = {0.0};
  const CellMask cells(grid.size(), 1);
  const InscribedCircle disc = inscribed_circle(grid, cells, 0);
  std::cout << "largest disc " << disc.radius << " m\n";
  return route.outcome == Outcome::solved && disc.radius > 0.49 ? 0 : 1;
}
