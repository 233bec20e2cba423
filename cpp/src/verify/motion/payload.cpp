// Weighs parts: against what the hand may carry, and against what its suction cups hold while the arm moves.
#include "verify/motion/payload.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "verify/motion/hermite.hpp"

namespace mmgrasp::verify::detail {
namespace {

constexpr double kPi = mmgrasp::detail::kPi;
constexpr int kDirections = 720;
constexpr double kPlaces[] = {0.05, 0.35, 0.65, 0.95};  // Shares of a segment where the part's acceleration is taken.
constexpr double kStep = 0.04;                          // A share of a segment, for differences.
const Eigen::Vector3d kGravity(0, 0, -9.80665);         // [m/s^2]

struct Weight {
  double size = 0;  ///< Volume [m^3], or area of an open surface [m^2].
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
};

Weight weight_of(const TriangleMesh& mesh) {
  Weight weight;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]],
                          &c = mesh.vertices[triangle[2]];
    const double size = mesh.closed ? a.dot(b.cross(c)) / 6 : (b - a).cross(c - a).norm() / 2;
    weight.size += size;
    sum += size * (a + b + c) / (mesh.closed ? 4 : 3);
  }
  if (std::abs(weight.size) > 1e-15) weight.middle = sum / weight.size;
  return weight;
}

Weight weight_of(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) return {box->size.prod()};
  if (const auto* ball = std::get_if<Sphere>(&shape)) return {4.0 / 3 * kPi * std::pow(ball->radius, 3)};
  if (const auto* rod = std::get_if<Cylinder>(&shape)) return {kPi * rod->radius * rod->radius * rod->length};
  if (const auto* pill = std::get_if<Capsule>(&shape))
    return {kPi * pill->radius * pill->radius * (pill->length + 4.0 / 3 * pill->radius)};
  if (const auto* mesh = std::get_if<MeshShape>(&shape)) return weight_of(*mesh->mesh);
  Weight weight;
  if (const auto* voxels = std::get_if<Voxels>(&shape)) {
    for (const Eigen::Vector3d& centre : *voxels->centres) weight.middle += centre;
    if (!voxels->centres->empty()) weight.middle /= static_cast<double>(voxels->centres->size());
    weight.size = std::pow(voxels->resolution, 3) * static_cast<double>(voxels->centres->size());
  }
  return weight;
}

/// The cups as one ring: their force, where it acts, and how far from there the part can tilt about.
struct Cups {
  double force = 0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double support = 0;
};

Cups cups_of(const PlanToCheck& plan) {
  Cups cups;
  for (const CheckedCup& cup : plan.suction.cups) {
    cups.force += plan.suction.vacuum * kPi * cup.radius * cup.radius;
    cups.middle += cup.position / static_cast<double>(plan.suction.cups.size());
  }
  const Eigen::Vector3d u = plan.approach.unitOrthogonal(), v = plan.approach.cross(u);
  cups.support = mmgrasp::detail::kInfinity;
  for (int i = 0; i < kDirections; ++i) {
    const Eigen::Vector3d way = std::cos(2 * kPi * i / kDirections) * u + std::sin(2 * kPi * i / kDirections) * v;
    double reach = -mmgrasp::detail::kInfinity;
    for (const CheckedCup& cup : plan.suction.cups)
      reach = std::max(reach, way.dot(cup.position - cups.middle) + cup.radius);
    cups.support = std::min(cups.support, reach);
  }
  return cups;
}

/// How many times the force that holding takes, with the part pulled at by `pull` [N] at `arm` from the cups' middle,
/// goes into the cups' force. With the approach n: what presses the rims on, F - pull.n, must bear the sideways force
/// with the torsion by friction, and the tilting moment about the nearest edge of the rims.
double reserve(const PlanToCheck& plan, const Cups& cups, const Eigen::Vector3d& arm, const Eigen::Vector3d& pull) {
  const double along = pull.dot(plan.approach);
  const Eigen::Vector3d moment = arm.cross(pull);
  const double torsion = moment.dot(plan.approach);
  const double sideways = std::hypot((pull - along * plan.approach).norm(), torsion / cups.support);
  const double tilt = (moment - torsion * plan.approach).norm() / cups.support;
  const double needed = along + std::max(sideways / plan.suction.friction, tilt);
  return needed > 0 ? cups.force / needed : mmgrasp::detail::kInfinity;
}

}  // namespace

Eigen::Vector3d centre_of_mass(const std::vector<LinkShape>& shapes) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double total = 0;
  for (const LinkShape& shape : shapes) {
    const Weight weight = weight_of(shape.shape);
    total += weight.size;
    sum += weight.size * (shape.T_link_shape * weight.middle);
  }
  return total > 0 ? Eigen::Vector3d(sum / total) : sum;
}

void check_cups_hold(const Context& context, Judge& judge, const CheckedMotion& motion, double mass,
                     const Eigen::Vector3d& centre, const std::string& where, Faults& faults) {
  const PlanToCheck& plan = context.plan;
  const Cups cups = cups_of(plan);
  for (std::size_t i = 0; i + 1 < motion.times.size(); ++i) {
    const HermiteSegment segment(motion, i);
    const double step = kStep * segment.duration();
    const auto centre_at = [&](double s) { return judge.tip(segment.at(s)) * centre; };
    for (const double s : kPlaces) {
      const Eigen::Vector3d acceleration =
          (centre_at(s - kStep) - 2 * centre_at(s) + centre_at(s + kStep)) / (step * step);
      const Eigen::Matrix3d R_world_tip = judge.tip(segment.at(s)).linear();
      const Eigen::Vector3d pull = mass * (R_world_tip.transpose() * (kGravity - acceleration));
      const double times = reserve(plan, cups, centre - cups.middle, pull);
      if (times >= plan.suction.safety) continue;
      faults.push_back({"payload", where + ", t = " + text(motion.times[i] + s * segment.duration()) + " s",
                        "the cups hold " + text(times) + " times what pulls at the part, of " + text(mass) +
                            " kg: must be " + text(plan.suction.safety) + " times"});
      return;
    }
  }
}

void check_payload(const PlanToCheck& plan, Faults& faults) {
  for (const CheckedPart& part : plan.parts) {
    if (!part.target || part.mass <= plan.payload) continue;
    faults.push_back({"payload", "part '" + part.body.name + "'",
                      "weighs " + text(part.mass) + " kg, the hand may carry " + text(plan.payload) + " kg"});
  }
}

}  // namespace mmgrasp::verify::detail
