// What the parts of an operation weigh, what the hole does to them, and what a grasp does about it (P1 5.3.5).
#include "mmgrasp/gripper_design/operation_load.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/grasp/detail/motion_looks.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

constexpr double kGravity = 9.81;  // [m/s^2]

/// Volume of a closed mesh, and that times its centre.
void add_volume(const TriangleMesh& mesh, double& volume, Vector3d& moment) {
  for (const auto& t : mesh.triangles) {
    const Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double part = a.dot(b.cross(c)) / 6;
    volume += part;
    moment += part * (a + b + c) / 4;
  }
}

}  // namespace

void HoldingRequirement::check() const {
  grip.check();
  require_positive(density, "density", "kg/m3");
  require_not_negative(least_safety, "least_safety");
}

OperationLoad operation_load(const AssemblyOperation& operation, const HoldingRequirement& requirement) {
  operation.check();
  requirement.check();
  OperationLoad load;
  load.grip = requirement.grip;
  for (const PlacedMesh& part : operation.active) {
    if (!part.mesh->closed)
      throw InvalidInput("part '" + part.name + "': must be a closed mesh for its weight to be known");
    double volume = 0;
    Vector3d moment = Vector3d::Zero();
    add_volume(*part.mesh, volume, moment);
    load.mass += requirement.density * volume;
    load.centre += requirement.density * (part.pose.linear() * moment + volume * part.pose.translation());
  }
  load.centre /= load.mass;
  for (const Pose& pose : operation.motion)
    load.weights.push_back(pose.linear().transpose() * Vector3d(0, 0, -load.mass * kGravity));
  if (operation.insertion_force > 0) {
    const Vector3d middle = detail::middle_of(operation.active);
    const Vector3d way = detail::MotionPiece(operation.motion.end()[-2], operation.motion.back(), middle).way();
    load.resistance = operation.motion.back().linear().transpose() * (-operation.insertion_force * way.normalized());
  }
  load.hole = operation.hole.value_or(load.centre);
  return load;
}

HeldLoad held_load(const AssemblyGrasp& grasp, const OperationLoad& load) {
  if (load.weights.empty()) throw InvalidInput("weights is empty: an operation has at least one pose");
  HeldLoad out;
  out.safety = detail::kInfinity;
  for (std::size_t i = 0; i < load.weights.size(); ++i) {
    const bool at_end = i + 1 == load.weights.size();
    const GraspHolding held = grasp_holding(
        grasp, load.grip, {load.weights[i], load.centre, at_end ? load.resistance : Vector3d::Zero(), load.hole});
    out.safety = std::min(out.safety, held.safety);
    out.insertion_moment = held.insertion_moment;
    out.pad_torque = held.pad_torque;
    out.contact_area = held.contact.area();
  }
  return out;
}

}  // namespace mmgrasp
