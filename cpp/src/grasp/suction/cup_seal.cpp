#include "grasp/suction/cup_seal.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kRimPoints = 48;
constexpr double kRings[] = {0.35, 0.7};  // Shares of the radius at which the inside is looked at, beside the middle.
constexpr int kRingPoints = 12;

void add_ring(const SuctionCup& cup, double radius, int points, const Eigen::Vector3d& u, const Eigen::Vector3d& v,
              std::vector<Eigen::Vector3d>& ring) {
  for (int i = 0; i < points; ++i) {
    const double angle = kTwoPi * i / points;
    ring.push_back(cup.position + radius * (std::cos(angle) * u + std::sin(angle) * v));
  }
}

}  // namespace

CupSeal::CupSeal(const TriangleMesh& mesh, const Suction& suction, const Eigen::Vector3d& approach)
    : caster_(mesh), approach_(approach), behind_(0) {
  const Eigen::Vector3d u = approach.unitOrthogonal(), v = approach.cross(u);
  for (const SuctionCup& cup : suction.cups) {
    Cup points{cup.radius, {}, {cup.position}};
    add_ring(cup, cup.radius, kRimPoints, u, v, points.rim);
    for (const double share : kRings) add_ring(cup, share * cup.radius, kRingPoints, u, v, points.inside);
    behind_ = std::max(behind_, cup.radius);
    cups_.push_back(std::move(points));
  }
}

CupSeal::Contact CupSeal::at(const Pose& T_object_hand) const {
  Contact contact;
  contact.nearest = kInfinity;
  const Eigen::Vector3d direction = T_object_hand.linear() * approach_;
  const auto hit_from = [&](const Eigen::Vector3d& point) {
    return caster_.closest_hit({T_object_hand * point - behind_ * direction, direction});
  };
  for (const Cup& cup : cups_) {
    for (const Eigen::Vector3d& point : cup.rim) {
      const RayHit hit = hit_from(point);
      const double distance = hit ? hit.distance - behind_ : kInfinity;
      contact.nearest = std::min(contact.nearest, distance);
      contact.farthest = std::max(contact.farthest, distance);
      if (hit) contact.rim.push_back(hit.point);
    }
    for (const Eigen::Vector3d& point : cup.inside) {
      const RayHit hit = hit_from(point);
      const double distance = hit ? hit.distance - behind_ : kInfinity;
      contact.nearest = std::min(contact.nearest, distance);
      contact.covered = contact.covered && distance <= cup.radius;
    }
  }
  return contact;
}

}  // namespace mmgrasp::detail
