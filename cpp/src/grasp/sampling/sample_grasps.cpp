#include "mmgrasp/grasp/sample_grasps.hpp"

#include <algorithm>
#include <cmath>

#include "grasp/sampling/contact_pairs.hpp"
#include "grasp/sampling/pad_seat.hpp"
#include "grasp/sampling/spread.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/grasp/detail/joined_surface.hpp"

namespace mmgrasp {
namespace {

using detail::ContactPair;
using detail::ContactPairs;
using detail::SampledGrasp;

constexpr double kMostCandidates = 1e6;

/// Judges grasps of one object. Every part has weight 0.5, so their product orders grasps without ruling any out.
class Judge {
 public:
  Judge(const ContactPairs& pairs, const Hand& hand) : pairs_(pairs), hand_(hand) {
    for (const Eigen::Vector3d& corner : pairs.corners)
      radius_ = std::max(radius_, (corner - pairs.centre_of_mass).norm());
  }

  /// `tool` is the origin of the tool frame in the object's frame.
  std::vector<QualityFactor> operator()(const ContactPair& pair, const Eigen::Vector3d& approach,
                                        const Eigen::Vector3d& tool) const {
    return {half("alignment", pair.alignment), half("centring", centring(pair)),
            half("support", support(pair, approach)), half("insertion", insertion(approach, tool)),
            half("clearance", clearance(pair.width))};
  }

 private:
  static QualityFactor half(const char* name, double share) { return {name, std::clamp(share, 0.0, 1.0), 0.5}; }

  /// 1 when the line of contact passes through the centre of mass (no moment from gravity), 0 at the object's radius.
  double centring(const ContactPair& pair) const {
    const Eigen::Vector3d arm = pair.middle - pairs_.centre_of_mass;
    return radius_ > 0 ? 1 - (arm - arm.dot(pair.axis) * pair.axis).norm() / radius_ : 1;
  }

  double support(const ContactPair& pair, const Eigen::Vector3d& approach) const {
    return pair.face ? detail::pad_overlap(*pair.face, approach, hand_.finger_depth, hand_.finger_width) : 1;
  }

  /// 1 when nothing of the object stands further back than the pad does; falls with what must fit in front of the palm.
  double insertion(const Eigen::Vector3d& approach, const Eigen::Vector3d& tool) const {
    double behind = 0;
    for (const Eigen::Vector3d& corner : pairs_.corners) behind = std::max(behind, approach.dot(tool - corner));
    const double excess = std::max(0.0, behind - hand_.finger_depth / 2);
    return 1 / (1 + excess / hand_.finger_depth);
  }

  /// Share of the wanted clearance that the opening leaves.
  double clearance(double width) const {
    return hand_.clearance > 0 ? (hand_.max_opening - width) / 2 / hand_.clearance : 1;
  }

  const ContactPairs& pairs_;
  const Hand& hand_;
  double radius_ = 0;
};

/// Turns contact pairs into grasps: each approached from all around, the hand either way.
class Candidates {
 public:
  Candidates(const ContactPairs& pairs, const Hand& hand, const GraspSamplerOptions& options)
      : hand_(hand), options_(options), judge_(pairs, hand) {
    if (pairs.surface) seats_.emplace(*pairs.surface, hand, options);
    for (std::size_t i = 0; i < pairs.pairs.size(); ++i) add(static_cast<int>(i), pairs.pairs[i]);
  }

  const std::vector<SampledGrasp>& all() const { return candidates_; }
  int too_wide() const { return too_wide_; }

 private:
  void add(int index, const ContactPair& pair) {
    detail::throw_if_interrupted();
    bool wide = pair.width > hand_.max_opening, held = false;
    if (!wide) {
      const std::vector<int> near = seats_ ? seats_->near(pair) : std::vector<int>();
      const Eigen::Vector3d side = pair.axis.cross(pair.first_approach);
      for (int i = 0; i < options_.approaches; ++i) {
        const double angle = detail::kTwoPi * i / options_.approaches;
        const Eigen::Vector3d approach = (std::cos(angle) * pair.first_approach + std::sin(angle) * side).normalized();
        const std::optional<ContactPair> seated = seat(pair, approach, near);
        if (!seated) continue;
        const bool fits = seated->width <= hand_.max_opening;
        (fits ? held : wide) = true;
        if (fits) add_both_hands({index, i, false}, *seated, approach);
      }
    }
    if (wide && !held) ++too_wide_;
  }

  /// The pair where the pads meet the part, if they do not on its contacts alone.
  std::optional<ContactPair> seat(const ContactPair& pair, const Eigen::Vector3d& approach,
                                  const std::vector<int>& near) const {
    if (!seats_) return pair;
    const std::optional<detail::PadSeat> seat = seats_->seat(pair, approach, near);
    if (!seat) return {};
    ContactPair seated = pair;
    seated.middle = seat->middle;
    seated.width = seat->width;
    seated.alignment = seat->alignment;
    return seated;
  }

  /// The pads are alike, the arm is not: the hand turned by half a turn about the approach is a grasp of its own.
  void add_both_hands(ContactPairProvenance provenance, const ContactPair& pair, const Eigen::Vector3d& approach) {
    for (const bool flipped : {false, true}) {
      const Eigen::Vector3d closing = flipped ? -pair.axis : pair.axis;
      SampledGrasp candidate;
      Grasp& grasp = candidate.grasp;
      grasp.T_object_hand.linear() = detail::align_axes(hand_.approach, hand_.closing, approach, closing);
      grasp.T_object_hand.translation() = pair.middle - options_.standoff * approach;
      grasp.opening = pair.width;
      grasp.set_quality(judge_(pair, approach, grasp.T_object_hand.translation()));
      provenance.flipped = flipped;
      grasp.provenance = provenance;
      candidate.bin = 27 * detail::direction_bin(approach) + detail::direction_bin(closing);
      candidates_.push_back(std::move(candidate));
    }
  }

  const Hand& hand_;
  const GraspSamplerOptions& options_;
  Judge judge_;
  std::optional<detail::PadSeats> seats_;
  std::vector<SampledGrasp> candidates_;
  int too_wide_ = 0;
};

}  // namespace

void GraspSamplerOptions::check() const {
  require(approaches > 0 && approaches <= 360, "approaches", approaches, "must be in [1, 360] directions");
  require(positions > 0 && positions <= 100, "positions", positions, "must be in [1, 100] places");
  require(mesh_samples > 0 && mesh_samples <= 100000, "mesh_samples", mesh_samples, "must be in [1, 100000] points");
  const double candidates = static_cast<double>(approaches) * std::max(mesh_samples, positions * positions);
  require(candidates <= kMostCandidates, "approaches", approaches,
          "must be fewer: approaches times mesh_samples, or times positions squared, must be at most 1e6 candidates");
  require_count(max_grasps, "max_grasps", 1, 1'000'000);
  require_positive(friction, "friction");
  require_number(standoff, "standoff", "m");
}

SampledGrasps sample_grasps(const std::vector<LinkShape>& object, const Hand& hand,
                            const GraspSamplerOptions& options) {
  hand.check_fingers();
  options.check();
  detail::check_object(object);

  std::optional<ContactPairs> pairs;
  if (object.size() == 1) pairs = detail::primitive_pairs(object.front(), hand, options);
  if (!pairs) pairs = detail::surface_pairs(object, hand.max_opening, options);

  const Candidates candidates(*pairs, hand, options);
  return {detail::keep_spread(candidates.all(), options.max_grasps), candidates.too_wide()};
}

}  // namespace mmgrasp
