#include "mmgrasp/grasp/sample_grasps.hpp"

#include <algorithm>
#include <cmath>

#include "grasp/sampling/contact_pairs.hpp"
#include "grasp/sampling/spread.hpp"
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

void add_grasps(int index, const ContactPair& pair, const Hand& hand, const GraspSamplerOptions& options,
                const Judge& judge, std::vector<SampledGrasp>& candidates) {
  const Eigen::Vector3d side = pair.axis.cross(pair.first_approach);
  for (int i = 0; i < options.approaches; ++i) {
    const double angle = detail::kTwoPi * i / options.approaches;
    const Eigen::Vector3d approach = (std::cos(angle) * pair.first_approach + std::sin(angle) * side).normalized();
    // The pads are alike, the arm is not: the hand turned by half a turn about the approach is a grasp of its own.
    for (const double flip : {1.0, -1.0}) {
      const Eigen::Vector3d closing = flip * pair.axis;
      SampledGrasp candidate;
      Grasp& grasp = candidate.grasp;
      grasp.T_object_hand.linear() = detail::align_axes(hand.approach, hand.closing, approach, closing);
      grasp.T_object_hand.translation() = pair.middle - options.standoff * approach;
      grasp.opening = pair.width;
      grasp.set_quality(judge(pair, approach, grasp.T_object_hand.translation()));
      grasp.provenance = ContactPairProvenance{index, i, flip < 0};
      candidate.bin = 27 * detail::direction_bin(approach) + detail::direction_bin(closing);
      candidates.push_back(std::move(candidate));
    }
  }
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
}

SampledGrasps sample_grasps(const std::vector<LinkShape>& object, const Hand& hand,
                            const GraspSamplerOptions& options) {
  hand.check_fingers();
  options.check();
  detail::check_object(object);

  std::optional<ContactPairs> pairs;
  if (object.size() == 1) pairs = detail::primitive_pairs(object.front(), hand, options);
  if (!pairs) pairs = detail::surface_pairs(object, options);

  SampledGrasps sampled;
  std::vector<SampledGrasp> candidates;
  const Judge judge(*pairs, hand);
  for (std::size_t i = 0; i < pairs->pairs.size(); ++i) {
    const ContactPair& pair = pairs->pairs[i];
    if (pair.width > hand.max_opening)
      ++sampled.too_wide;
    else
      add_grasps(static_cast<int>(i), pair, hand, options, judge, candidates);
  }
  sampled.grasps = detail::keep_spread(candidates, options.max_grasps);
  return sampled;
}

}  // namespace mmgrasp
