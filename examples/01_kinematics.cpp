// Load a robot, compute where its tool is, and find a configuration for a pose.
// Usage: 01_kinematics <folder of the shipped assets>
#include <iostream>

#include "mmgrasp/collision/collision_ik.hpp"
#include "mmgrasp/robot/joint_group.hpp"

int main(int, char** argv) {
  using namespace mmgrasp;
  const std::string folder = std::string(argv[1]) + "/robots/fetchlike/fetchlike";
  const Robot robot = Robot::load(folder + ".urdf", folder + ".srdf");
  const JointGroup arm = robot.group("arm_with_torso", "gripper_tcp");

  CollisionChecker checker(arm, World{});  // an empty world: no self-collision either
  const Pose T_world_tip = pose_from_xyz_rpy({0.7, 0.2, 0.9}, Eigen::Vector3d::Zero());
  const Eigen::VectorXd seed = 0.5 * (arm.sample_lower() + arm.sample_upper());
  const IkResult found = solve_collision_free_ik(checker, T_world_tip, seed);
  std::cout << to_string(found.outcome) << "\n";
  if (found.outcome != Outcome::solved) return 1;
  std::cout << "tool at " << arm.fk(found.q).translation().transpose() << "\n";
}
