#include "mmgrasp/grasp/sample_grasps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "grasp/sampling/approach_direction.hpp"
#include "grasp/sampling/contact_pairs.hpp"
#include "grasp/sampling/far_face.hpp"
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
using detail::RankedCandidate;

constexpr double kMostCandidates = 1e6;
constexpr double kSamePlace = 1e-9;  // What differs by less is the same [m].
constexpr double kUnitTolerance = 1e-3;
constexpr double kLeastOverlap = 1e-6;  // Share of a pad that lies on a face.

/// Judges grasps of one object. Every part has weight 0.5, so their product orders grasps without ruling any out.
class Judge {
 public:
  Judge(const ContactPairs& pairs, const Hand& hand) : pairs_(pairs), hand_(hand) {
    for (const Eigen::Vector3d& corner : pairs.corners)
      radius_ = std::max(radius_, (corner - pairs.centre_of_mass).norm());
  }

  /// The tool frame stays `standoff` before the contacts.
  std::vector<QualityFactor> operator()(const ContactPair& pair, const Eigen::Vector3d& approach,
                                        double standoff) const {
    return {half("alignment", pair.alignment), half("centring", centring(pair)),
            half("support", support(pair, approach, standoff)),
            half("insertion", insertion(approach, pair.middle - standoff * approach)),
            half("clearance", clearance(pair.width))};
  }

 private:
  static QualityFactor half(const char* name, double share) { return {name, std::clamp(share, 0.0, 1.0), 0.5}; }

  /// 1 when the line of contact passes through the centre of mass (no moment from gravity), 0 at the object's radius.
  double centring(const ContactPair& pair) const {
    const Eigen::Vector3d arm = pair.middle - pairs_.centre_of_mass;
    return radius_ > 0 ? 1 - (arm - arm.dot(pair.axis) * pair.axis).norm() / radius_ : 1;
  }

  double support(const ContactPair& pair, const Eigen::Vector3d& approach, double standoff) const {
    return pair.face ? detail::pad_overlap(*pair.face, approach, standoff, hand_.finger_depth, hand_.finger_width) : 1;
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

/// How far the tool frame stays before the contacts along the approach.
struct Standoff {
  double distance;  // [m]
  bool tips_flush;  // The tips of the pads are flush with the object's far face then.
};

/// Turns contact pairs into grasps: each approached from all around, the hand either way.
class Candidates {
 public:
  Candidates(const ContactPairs& pairs, const std::vector<LinkShape>& object, const Hand& hand,
             const GraspSamplerOptions& options)
      : hand_(hand), options_(options), pairs_(pairs.pairs), judge_(pairs, hand), far_face_(object) {
    if (pairs.surface) seats_.emplace(*pairs.surface, pairs.hull.get(), hand, options);
    for (std::size_t i = 0; i < pairs_.size(); ++i) add(static_cast<int>(i), pairs_[i]);
  }

  std::vector<Grasp> best(int most) const {
    std::vector<Grasp> grasps;
    for (const std::size_t i : detail::keep_spread(ranked_, most)) grasps.push_back(made(candidates_[i]));
    return grasps;
  }

  int too_wide() const { return too_wide_; }

 private:
  void add(int index, const ContactPair& pair) {
    detail::throw_if_interrupted();
    bool wide = pair.width > hand_.max_opening, held = false;
    if (!wide) {
      const double farthest = std::max(std::abs(options_.standoff), hand_.finger_depth / 2);
      const detail::NearPads near = seats_ ? seats_->near(pair, farthest) : detail::NearPads{};
      const std::vector<Eigen::Vector3d> approaches = approaches_to(pair);
      for (std::size_t i = 0; i < approaches.size(); ++i) {
        const Eigen::Vector3d& approach = approaches[i];
        for (const Standoff& standoff : standoffs(pair, approach)) {
          const std::optional<ContactPair> seated = seat(pair, approach, standoff.distance, near);
          if (!seated) continue;
          const bool fits = seated->width <= hand_.max_opening;
          (fits ? held : wide) = true;
          if (fits)
            add_both_hands({index, static_cast<int>(i), false, standoff.tips_flush}, *seated, approach,
                           standoff.distance);
        }
      }
    }
    if (wide && !held) ++too_wide_;
  }

  /// From all around, or the one that is wanted where the pair lies across it.
  std::vector<Eigen::Vector3d> approaches_to(const ContactPair& pair) const {
    std::vector<Eigen::Vector3d> found;
    if (options_.approach_direction) {
      const auto along = detail::straight_across(pair.axis, options_.approach_direction->normalized());
      if (along) found.push_back(*along);
      return found;
    }
    const Eigen::Vector3d side = pair.axis.cross(pair.first_approach);
    for (int i = 0; i < options_.approaches; ++i) {
      const double angle = detail::kTwoPi * i / options_.approaches;
      found.push_back((std::cos(angle) * pair.first_approach + std::sin(angle) * side).normalized());
    }
    return found;
  }

  /// Where the hand stops along an approach: as the options say and, where the tips of the pads would reach beyond the
  /// object's far face there (it may lie on something), also flush with it, which goes first among equally good ones.
  std::vector<Standoff> standoffs(const ContactPair& pair, const Eigen::Vector3d& approach) {
    const double flush = approach.dot(pair.middle) + hand_.finger_depth / 2 - far_face_(approach);
    std::vector<Standoff> found;
    if (flush > options_.standoff + kSamePlace && is_new(pair, approach, flush)) found.push_back({flush, true});
    found.push_back({options_.standoff, false});
    return found;
  }

  /// Pairs that lie one behind the other along the approach come to the same place when the tips are flush.
  bool is_new(const ContactPair& pair, const Eigen::Vector3d& approach, double standoff) {
    std::array<long long, 9> rounded;
    Eigen::Matrix<double, 9, 1> numbers;
    numbers << pair.middle - standoff * approach, approach, pair.axis;
    for (int i = 0; i < 9; ++i) rounded[i] = std::llround(numbers[i] / kSamePlace);
    return flush_.insert(rounded).second;
  }

  /// Whether pads meet a primitive at the pair's contacts, or at the faces that these lie on.
  bool are_on_face(const ContactPair& pair, const Eigen::Vector3d& approach, double standoff) const {
    if (!pair.face) return std::abs(standoff) <= hand_.finger_depth / 2 + kSamePlace;
    return detail::pad_overlap(*pair.face, approach, standoff, hand_.finger_depth, hand_.finger_width) > kLeastOverlap;
  }

  /// The pair where the pads meet the part, if they do not on its contacts alone.
  std::optional<ContactPair> seat(const ContactPair& pair, const Eigen::Vector3d& approach, double standoff,
                                  const detail::NearPads& near) const {
    if (!seats_) return are_on_face(pair, approach, standoff) ? std::optional(pair) : std::nullopt;
    const std::optional<detail::PadSeat> seat = seats_->seat(pair, approach, standoff, near);
    if (!seat) return {};
    ContactPair seated = pair;
    seated.middle = seat->middle;
    seated.width = seat->width;
    seated.alignment = seat->alignment;
    return seated;
  }

  /// Enough to make a grasp of: there are up to millions.
  struct Candidate {
    ContactPairProvenance provenance;
    Eigen::Vector3d approach;
    double standoff;         // [m]
    Eigen::Vector3d middle;  // Where the pads meet the part.
    double width, alignment;
  };

  /// The pads are alike, the arm is not: the hand turned by half a turn about the approach is a grasp of its own.
  void add_both_hands(ContactPairProvenance provenance, const ContactPair& pair, const Eigen::Vector3d& approach,
                      double standoff) {
    Grasp judged;
    judged.set_quality(judge_(pair, approach, standoff));
    for (const bool flipped : {false, true}) {
      provenance.flipped = flipped;
      candidates_.push_back({provenance, approach, standoff, pair.middle, pair.width, pair.alignment});
      const Eigen::Vector3d closing = flipped ? -pair.axis : pair.axis;
      ranked_.push_back({judged.quality, 27 * detail::direction_bin(approach) + detail::direction_bin(closing)});
    }
  }

  Grasp made(const Candidate& candidate) const {
    detail::throw_if_interrupted();
    ContactPair pair = pairs_[candidate.provenance.pair];
    pair.middle = candidate.middle;
    pair.width = candidate.width;
    pair.alignment = candidate.alignment;
    const Eigen::Vector3d closing = candidate.provenance.flipped ? -pair.axis : pair.axis;
    Grasp grasp;
    grasp.T_object_hand.linear() = detail::align_axes(hand_.approach, hand_.closing, candidate.approach, closing);
    grasp.T_object_hand.translation() = pair.middle - candidate.standoff * candidate.approach;
    grasp.opening = pair.width;
    grasp.set_quality(judge_(pair, candidate.approach, candidate.standoff));
    grasp.provenance = candidate.provenance;
    return grasp;
  }

  const Hand& hand_;
  const GraspSamplerOptions& options_;
  const std::vector<ContactPair>& pairs_;
  Judge judge_;
  detail::FarFace far_face_;
  std::optional<detail::PadSeats> seats_;
  std::set<std::array<long long, 9>> flush_;  // Places and axes of hands whose tips are flush.
  std::vector<Candidate> candidates_;
  std::vector<RankedCandidate> ranked_;
  int too_wide_ = 0;
};

int count_flush(const std::vector<Grasp>& grasps) {
  return static_cast<int>(std::count_if(grasps.begin(), grasps.end(), [](const Grasp& grasp) {
    return std::get<ContactPairProvenance>(grasp.provenance).tips_flush;
  }));
}

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
  if (approach_direction) {
    require_numbers(*approach_direction, "approach_direction");
    require(std::abs(approach_direction->norm() - 1) <= kUnitTolerance, "approach_direction norm",
            approach_direction->norm(), "must be 1 within 1e-3");
  }
}

SampledGrasps sample_grasps(const std::vector<LinkShape>& object, const Hand& hand,
                            const GraspSamplerOptions& options) {
  hand.check_fingers();
  options.check();
  detail::check_object(object);

  std::optional<ContactPairs> pairs;
  if (object.size() == 1) pairs = detail::primitive_pairs(object.front(), hand, options);
  if (!pairs) pairs = detail::surface_pairs(object, hand.max_opening, options);

  const Candidates candidates(*pairs, object, hand, options);
  SampledGrasps sampled{candidates.best(options.max_grasps), candidates.too_wide()};
  sampled.tips_flush = count_flush(sampled.grasps);
  return sampled;
}

}  // namespace mmgrasp
