#include "mmgrasp/grasp/sample_grasps.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "grasp/sampling/contact_pairs.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

using detail::ContactPair;
using detail::ContactPairs;

constexpr double kMostCandidates = 1e6;

struct Candidate {
  Grasp grasp;
  int bin = 0;  ///< Coarse direction of approach and closing axis.
};

/// Rotation with R * from_a = to_a and R * from_b = to_b for two orthonormal pairs.
Eigen::Matrix3d align_axes(const Eigen::Vector3d& from_a, const Eigen::Vector3d& from_b, const Eigen::Vector3d& to_a,
                           const Eigen::Vector3d& to_b) {
  Eigen::Matrix3d from, to;
  from << from_a, from_b, from_a.cross(from_b);
  to << to_a, to_b, to_a.cross(to_b);
  return to * from.transpose();
}

/// One of the 26 directions to a cube's face middles, edges and corners, nearest to a unit vector.
int direction_bin(const Eigen::Vector3d& direction) {
  const double threshold = std::sin(detail::kPi / 8);  // half way between a face middle and an edge middle
  int bin = 0;
  for (int i = 0; i < 3; ++i) bin = 3 * bin + (direction[i] > threshold ? 2 : direction[i] < -threshold ? 0 : 1);
  return bin;
}

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
                const Judge& judge, std::vector<Candidate>& candidates) {
  const Eigen::Vector3d side = pair.axis.cross(pair.first_approach);
  for (int i = 0; i < options.approaches; ++i) {
    const double angle = detail::kTwoPi * i / options.approaches;
    const Eigen::Vector3d approach = (std::cos(angle) * pair.first_approach + std::sin(angle) * side).normalized();
    // The pads are alike, the arm is not: the hand turned by half a turn about the approach is a grasp of its own.
    for (const double flip : {1.0, -1.0}) {
      const Eigen::Vector3d closing = flip * pair.axis;
      Candidate candidate;
      Grasp& grasp = candidate.grasp;
      grasp.T_object_hand.linear() = align_axes(hand.approach, hand.closing, approach, closing);
      grasp.T_object_hand.translation() = pair.middle - options.standoff * approach;
      grasp.opening = pair.width;
      grasp.set_quality(judge(pair, approach, grasp.T_object_hand.translation()));
      grasp.provenance = ContactPairProvenance{index, i, flip < 0};
      candidate.bin = 27 * direction_bin(approach) + direction_bin(closing);
      candidates.push_back(std::move(candidate));
    }
  }
}

/// The best of every direction first, then the second best of every direction, and so on.
std::vector<Grasp> keep_spread(const std::vector<Candidate>& candidates, int max_grasps) {
  std::vector<std::size_t> order(candidates.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return candidates[a].grasp.quality > candidates[b].grasp.quality;
  });
  std::map<int, int> seen;
  std::vector<int> rank(candidates.size());  // place of a candidate among those of its direction
  for (const std::size_t i : order) rank[i] = seen[candidates[i].bin]++;

  std::vector<std::size_t> kept = order;
  std::stable_sort(kept.begin(), kept.end(), [&](std::size_t a, std::size_t b) { return rank[a] < rank[b]; });
  kept.resize(std::min<std::size_t>(kept.size(), max_grasps));
  std::sort(kept.begin(), kept.end(), [&](std::size_t a, std::size_t b) {
    const double qa = candidates[a].grasp.quality, qb = candidates[b].grasp.quality;
    return qa != qb ? qa > qb : a < b;
  });
  std::vector<Grasp> grasps;
  for (const std::size_t i : kept) grasps.push_back(candidates[i].grasp);
  return grasps;
}

void check_object(const std::vector<LinkShape>& object) {
  require(!object.empty(), "object", "no shapes", "an object to grasp needs at least one shape");
  for (std::size_t i = 0; i < object.size(); ++i) {
    const std::string field = "object.shapes[" + std::to_string(i) + "]";
    require(!std::holds_alternative<Plane>(object[i].shape), field, "plane", "a plane cannot be grasped");
    check_shape(object[i].shape, field);
    checked_pose(object[i].T_link_shape.matrix(), field + ".pose");
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
  require(max_grasps > 0, "max_grasps", max_grasps, "must be positive");
  require_positive(friction, "friction");
  require_number(standoff, "standoff", "m");
}

SampledGrasps sample_grasps(const std::vector<LinkShape>& object, const Hand& hand,
                            const GraspSamplerOptions& options) {
  hand.check();
  options.check();
  check_object(object);

  std::optional<ContactPairs> pairs;
  if (object.size() == 1) pairs = detail::primitive_pairs(object.front(), hand, options);
  if (!pairs) pairs = detail::surface_pairs(object, options);

  SampledGrasps sampled;
  std::vector<Candidate> candidates;
  const Judge judge(*pairs, hand);
  for (std::size_t i = 0; i < pairs->pairs.size(); ++i) {
    const ContactPair& pair = pairs->pairs[i];
    if (pair.width > hand.max_opening)
      ++sampled.too_wide;
    else
      add_grasps(static_cast<int>(i), pair, hand, options, judge, candidates);
  }
  sampled.grasps = keep_spread(candidates, options.max_grasps);
  return sampled;
}

}  // namespace mmgrasp
