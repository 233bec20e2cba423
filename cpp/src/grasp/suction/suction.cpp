#include "mmgrasp/grasp/suction.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "grasp/suction/cup_seal.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/grasp/detail/joined_surface.hpp"

namespace mmgrasp {
namespace {

constexpr double kGravity = 9.80665;  // [m/s^2]
constexpr double kRounding = 1e-9;    // What a ray's length is off by [m].
constexpr int kDirections = 360;
constexpr std::size_t kMostCups = 100;

/// Radius of the largest disc about the cups' middle within the hull of the rims: the hull reaches, in every direction
/// u, as far as its farthest rim does.
double support_radius(const Suction& suction, const Eigen::Vector3d& approach) {
  const Eigen::Vector3d middle = suction.middle(), u = approach.unitOrthogonal(), v = approach.cross(u);
  double least = detail::kInfinity;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = detail::kTwoPi * i / kDirections;
    const Eigen::Vector3d direction = std::cos(angle) * u + std::sin(angle) * v;
    double reach = -detail::kInfinity;
    for (const SuctionCup& cup : suction.cups)
      reach = std::max(reach, direction.dot(cup.position - middle) + cup.radius);
    least = std::min(least, reach);
  }
  return least;
}

}  // namespace

void Suction::check() const {
  require(!cups.empty() && cups.size() <= kMostCups, "suction.cups", static_cast<double>(cups.size()),
          "must be from 1 to 100 cups");
  for (const SuctionCup& cup : cups) {
    require_within(cup.radius, 1e-3, 1, "suction.cups radius", "m");
    require(cup.position.allFinite() && cup.position.norm() <= 10, "suction.cups position", cup.position.norm(),
            "must be within 10 m of the tool frame");
  }
  require_within(max_gap, 2 * kSuctionStandoff, 0.1, "suction.max_gap", "m");
  require_within(vacuum, 1, 1.1e5, "suction.vacuum", "Pa");
  require_within(friction, 0.01, 10, "suction.friction", "");
  require_within(safety, 1, 100, "suction.safety", "");
}

double Suction::force() const {
  double area = 0;
  for (const SuctionCup& cup : cups) area += detail::kPi * cup.radius * cup.radius;
  return vacuum * area;
}

Eigen::Vector3d Suction::middle() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const SuctionCup& cup : cups) sum += cup.position;
  return sum / static_cast<double>(cups.size());
}

double seal_gap(const std::vector<LinkShape>& object, const Pose& T_object_hand, const Eigen::Vector3d& approach,
                const Suction& suction) {
  suction.check();
  detail::check_object(object);
  checked_pose(T_object_hand.matrix(), "T_object_hand");
  require(std::abs(approach.norm() - 1) <= 1e-6, "approach norm", approach.norm(), "must be 1 within 1e-6");
  const detail::CupSeal seal(detail::joined_surface(object, detail::kSealSegments).mesh, suction, approach);
  const detail::CupSeal::Contact contact = seal.at(T_object_hand);
  if (contact.nearest < -kRounding) return contact.nearest;
  return contact.covered ? contact.farthest : detail::kInfinity;
}

double suction_share(const Suction& suction, const Eigen::Vector3d& approach, double mass,
                     const Eigen::Vector3d& centre_of_mass, const Eigen::Vector3d& pull) {
  const double rho = support_radius(suction, approach), along = pull.dot(approach);
  const Eigen::Vector3d moment = (centre_of_mass - suction.middle()).cross(pull);
  const double torsion = moment.dot(approach);
  const double tilt = (moment - torsion * approach).norm();
  const double friction = std::hypot((pull - along * approach).norm(), torsion / rho) / suction.friction;
  return std::max(0.0, mass * (along + std::max(friction, tilt / rho)) * suction.safety / suction.force());
}

double suction_share_any_way(const Suction& suction, const Eigen::Vector3d& approach, double mass,
                             const Eigen::Vector3d& centre_of_mass) {
  const double rho = support_radius(suction, approach);
  const Eigen::Vector3d arm = centre_of_mass - suction.middle();
  const double along = arm.dot(approach), across = (arm - along * approach).norm();
  const double slip = std::sqrt(1 + (1 + across * across / (rho * rho)) / (suction.friction * suction.friction));
  const double tilt = std::hypot(1 + across / rho, along / rho);
  return mass * kGravity * std::max(slip, tilt) * suction.safety / suction.force();
}

}  // namespace mmgrasp
