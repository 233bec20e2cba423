// Holds suction cups against their parts: needles of a cup's give must meet the surface all around its rim.
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "verify/context.hpp"

namespace mmgrasp::verify::detail {
namespace {

constexpr double kNeedle = 2e-5;  // Width of a needle [m].
constexpr double kRounding = 1e-6;
constexpr int kRimNeedles = 64;
constexpr double kInside[] = {0.25, 0.5, 0.75};  // Shares of the radius at which the inside is looked at.
constexpr int kInsideNeedles = 16;

/// Seen from the tool frame, z along the approach.
class CupsOnPart {
 public:
  CupsOnPart(const Eigen::Vector3d& approach, const PlacedBody& part, const Pose& T_object_hand) : part_(part) {
    const Eigen::Vector3d u = approach.unitOrthogonal();
    R_hand_cups_ << u, approach.cross(u), approach;
    T_object_hand_ = T_object_hand;
  }

  std::string broken(const CheckedSuction& suction) const {
    for (std::size_t i = 0; i < suction.cups.size(); ++i) {
      const CheckedCup& cup = suction.cups[i];
      const std::string name = "cup " + std::to_string(i);
      if (reaches_through(cup)) return name + ": the part reaches through its rim's plane";
      if (!ring_meets(cup, cup.radius, kRimNeedles, suction.max_gap))
        return name + ": the part is not within " + text(suction.max_gap) + " m before all of its rim, of radius " +
               text(cup.radius) + " m";
      bool covered = ring_meets(cup, 0, 1, cup.radius);
      for (const double share : kInside)
        covered = covered && ring_meets(cup, share * cup.radius, kInsideNeedles, cup.radius);
      if (!covered) return name + ": a hole lies within its rim";
    }
    return "";
  }

 private:
  bool meets(const Shape& kind, const Eigen::Vector3d& hand_point, double along) const {
    mmgrasp::detail::throw_if_interrupted();
    LinkShape shape;
    shape.shape = kind;
    const Solid probe = make_solids({shape}).front();
    Pose T = T_object_hand_;
    T.translate(hand_point);
    T.rotate(R_hand_cups_);
    T.translate(Eigen::Vector3d(0, 0, along));
    const Bounds bounds = bounds_at(probe, T);
    for (std::size_t i = 0; i < part_.solids.size(); ++i) {
      if (bounds.intersects(part_.bounds[i]) && touches(probe, T, part_.solids[i], part_.T_world_shape[i])) return true;
    }
    return false;
  }

  /// Whether anything of the part is within the cup, up to its radius behind the rim.
  bool reaches_through(const CheckedCup& cup) const {
    return meets(Cylinder{cup.radius, cup.radius}, cup.position, -0.5 * cup.radius - kRounding);
  }

  bool ring_meets(const CheckedCup& cup, double radius, int needles, double length) const {
    const Box needle{Eigen::Vector3d(kNeedle, kNeedle, length)};
    for (int i = 0; i < needles; ++i) {
      const double angle = 2 * mmgrasp::detail::kPi * i / needles;
      const Eigen::Vector3d out = R_hand_cups_ * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
      if (!meets(needle, cup.position + radius * out, 0.5 * length)) return false;
    }
    return true;
  }

  const PlacedBody& part_;
  Pose T_object_hand_;
  Eigen::Matrix3d R_hand_cups_;
};

}  // namespace

void check_seals(const PlanToCheck& plan, Faults& faults) {
  for (const CheckedPart& part : plan.parts) {
    if (!part.target) continue;
    const PlacedBody body = place_body(part.body.name, part.body.shapes, Pose::Identity());
    std::size_t broken = 0;
    std::string first;
    for (const CheckedGrasp& grasp : part.grasps) {
      const std::string wrong = CupsOnPart(plan.approach, body, grasp.T_object_hand).broken(plan.suction);
      if (wrong.empty()) continue;
      if (++broken == 1) first = wrong;
    }
    if (broken == 0) continue;
    faults.push_back(
        {"no-seal", "part '" + part.body.name + "'",
         std::to_string(broken) + " of its " + std::to_string(part.grasps.size()) + " grasps do not seal; " + first});
  }
}

}  // namespace mmgrasp::verify::detail

namespace mmgrasp::verify {

std::string broken_seal(const CheckedSuction& suction, const Eigen::Vector3d& approach,
                        const std::vector<LinkShape>& part, const CheckedGrasp& grasp) {
  const detail::PlacedBody body = detail::place_body("part", part, Pose::Identity());
  return detail::CupsOnPart(approach, body, grasp.T_object_hand).broken(suction);
}

}  // namespace mmgrasp::verify
