// Plan an arm motion around a post and give it a clock.
// Usage: 02_motion <folder of the shipped assets>
#include <iostream>

#include "mmgrasp/collision/collision_ik.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "mmgrasp/plan/time_parameterization.hpp"

int main(int, char** argv) {
  using namespace mmgrasp;
  const std::string folder = std::string(argv[1]) + "/robots/fetchlike/fetchlike";
  const Robot robot = Robot::load(folder + ".urdf", folder + ".srdf");
  const JointGroup arm = robot.group("arm_with_torso", "gripper_tcp");

  World world;
  world.add("post", Box{{0.08, 0.08, 1.6}}, pose_from_xyz_rpy({0.75, 0, 0.8}, Eigen::Vector3d::Zero()));
  CollisionChecker checker(arm, world);
  const auto configuration = [&](double y) {
    const Pose T_world_tip = pose_from_xyz_rpy({0.6, y, 0.9}, Eigen::Vector3d::Zero());
    const Eigen::VectorXd seed = 0.5 * (arm.sample_lower() + arm.sample_upper());
    return solve_collision_free_ik(checker, T_world_tip, seed).q;
  };

  const MotionResult result = plan_motion(checker, configuration(0.4), {configuration(-0.4)});
  std::cout << to_string(result.outcome) << ", cost " << result.cost << "\n";
  if (!result.path) return 1;
  const JointTrajectory trajectory = time_parameterize_free(checker, *result.path);
  std::cout << trajectory.positions.size() << " samples, " << trajectory.duration() << " s\n";
}
