// Ask how near the arm is to what, follow the gradient away from it, and carry a part past an obstacle.
// Usage: 06_distance_and_attach <folder of the shipped assets>
#include <iostream>

#include "mmgrasp/collision/collision_ik.hpp"
#include "mmgrasp/collision/edge.hpp"

int main(int, char** argv) {
  using namespace mmgrasp;
  const std::string folder = std::string(argv[1]) + "/robots/fetchlike/fetchlike";
  const Robot robot = Robot::load(folder + ".urdf", folder + ".srdf");
  const JointGroup arm = robot.group("arm_with_torso", "gripper_tcp");
  const auto at = [](double x, double y, double z) { return pose_from_xyz_rpy({x, y, z}, Eigen::Vector3d::Zero()); };

  World world;
  world.add("table", Box{{0.6, 1.2, 0.04}}, at(0.9, 0, 0.6));
  world.add("part", Box{{0.04, 0.04, 0.2}}, at(0.7, 0.2, 0.75));
  CollisionChecker checker(arm, world);
  const Eigen::VectorXd seed = 0.5 * (arm.sample_lower() + arm.sample_upper());
  const Eigen::VectorXd q = solve_collision_free_ik(checker, at(0.6, 0.2, 0.9), seed).q;

  const DistanceResult nearest = checker.distance_and_gradient(q);
  std::cout << nearest.a << " - " << nearest.b << ": " << nearest.value << " m\n";
  for (const DistanceResult& pair : checker.distances(q, 0.1))
    std::cout << "  " << pair.a << " - " << pair.b << ": " << pair.value << " m\n";
  const Eigen::VectorXd step = q + 0.05 * nearest.gradient / nearest.gradient.lpNorm<Eigen::Infinity>();
  std::cout << "a step along the gradient: " << checker.distance(step).value << " m\n";

  // The gripper takes the part: it moves with the link, and its fingers may touch it. A checker sees the world as it
  // was when it was made, so the change needs a new one.
  world.attach("part", "gripper_link", at(0.15, 0, 0));
  CollisionChecker carrying(arm, world);
  CollisionChecker alone(arm, World());
  const Eigen::VectorXd lower = solve_collision_free_ik(alone, at(0.7, 0.2, 0.68), q).q;
  EdgeOptions options;
  options.continuous = true;
  const EdgeResult edge = check_edge(carrying, q, lower, options);
  std::cout << "down to the table: " << (edge.free ? "free" : "refused");
  if (edge.contact) std::cout << ", " << edge.contact->a << " touches " << edge.contact->b;
  std::cout << "\n";
}
