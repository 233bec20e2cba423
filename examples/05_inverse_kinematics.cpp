// Inverse kinematics: one solution, every branch, what the redundancy is used for.
// Usage: 05_inverse_kinematics <folder of the shipped assets>
#include <iostream>

#include "mmgrasp/robot/ik.hpp"
#include "mmgrasp/robot/ik_branches.hpp"
#include "mmgrasp/robot/ik_objective.hpp"

int main(int, char** argv) {
  using namespace mmgrasp;
  const std::string folder = std::string(argv[1]) + "/robots/fetchlike/fetchlike";
  const Robot robot = Robot::load(folder + ".urdf", folder + ".srdf");
  const JointGroup arm = robot.group("arm_with_torso", "gripper_tcp");
  const Pose T_world_tip = pose_from_xyz_rpy({0.7, 0.2, 0.9}, {0, 0, 0});
  const Eigen::VectorXd seed = 0.5 * (arm.sample_lower() + arm.sample_upper());

  IkOptions options;
  const IkResult plain = solve_ik(arm, T_world_tip, seed, options);
  options.objectives = {make_joint_limit_objective(arm, 0.3)};
  const IkResult better = solve_ik(arm, T_world_tip, seed, options);
  if (plain.outcome != Outcome::solved || better.outcome != Outcome::solved) return 1;
  Eigen::VectorXd gradient;
  std::cout << "joint limit cost " << options.objectives[0]->evaluate(plain.q, gradient) << " -> " << better.objective
            << "\n";

  const IkBranches branches = solve_ik_branches(arm, T_world_tip);
  std::cout << branches.solutions.size() << " different solutions\n";
  return branches.solutions.empty();
}
