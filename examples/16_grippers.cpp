// Two parts, one operation: which gripper puts a ring on a peg, and its files. Usage: 16_grippers <any> [folder]
#include <cmath>
#include <iostream>

#include "mmgrasp/gripper_design/plan_grippers.hpp"

using namespace mmgrasp;

/// A closed profile of (radius, z) [m], turned about z.
std::shared_ptr<const TriangleMesh> turned(const std::vector<std::pair<double, double>>& profile) {
  const int sides = 64, rows = static_cast<int>(profile.size());
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i < sides; ++i) {
    const double turn = 2 * M_PI * i / sides;
    for (const auto& [r, z] : profile) vertices.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
    const int next = rows * ((i + 1) % sides);
    for (int k = 0; k < rows; ++k) {
      const int up = (k + 1) % rows;
      triangles.push_back({rows * i + k, next + k, rows * i + up});
      triangles.push_back({rows * i + up, next + k, next + up});
    }
  }
  return make_mesh(vertices, triangles);
}

int main(int count, char** argv) {
  const auto at = [](double z) { return pose_from_xyz_rpy({0, 0, z}, Eigen::Vector3d::Zero()); };
  AssemblyOperation put_on;  // from 45 mm above, against 15 N
  put_on.name = "put the ring on";
  put_on.active = {{"ring", turned({{0.005, 0}, {0.01, 0}, {0.01, 0.012}, {0.005, 0.012}}), at(0.008)}};
  put_on.passive = {
      {"peg", turned({{0, 0}, {0.012, 0}, {0.012, 0.008}, {0.0049, 0.008}, {0.0049, 0.04}, {0, 0.04}}), at(0)}};
  put_on.motion = {at(0.045), at(0)};
  put_on.insertion_force = 15;

  PlanGrippersOptions options;
  options.holding = HoldingRequirement{};
  const PlanGrippersResult plan =
      plan_grippers({put_on}, {{"air chuck", 3, 0.016}, {"parallel drive", 2, 0.03}}, {}, options);
  for (const std::string& reason : plan.missing) std::cout << reason << "\n";
  for (const std::string& change : plan.help) std::cout << "would help: " << change << "\n";
  if (plan.outcome != Outcome::solved) return 1;
  const int taken = plan.set->requirement_of_part[0];
  std::cout << put_on.name << ": " << plan.requirements[taken].name() << ", " << 1000 * plan.requirements[taken].opening
            << " mm wide, held " << 1000 * plan.grasps[taken].contact_length << " mm deep, holds "
            << plan.holdings[taken].safety << " times its load\n";
  for (const Gripper& gripper : plan.set->grippers) {
    std::cout << gripper.name << ": " << gripper.fingers << " fingers of " << 1000 * gripper.finger_length << " mm, "
              << 1000 * gripper.min_opening << " to " << 1000 * gripper.max_opening << " mm\n";
    if (count > 2)
      gripper.to_urdf(std::string(argv[2]) + "/" + gripper.name);  // gripper.urdf, gripper.srdf, finger.stl
  }
}
