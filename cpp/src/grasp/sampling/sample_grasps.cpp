#include <algorithm>
#include <cmath>
#include <map>

#include "grasp/sampling/contact_pairs.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/grasp/grasp.hpp"

namespace mmgrasp {
namespace {

using detail::ContactPair;
using detail::ContactPairs;

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

/// Judges grasps of one object. Every factor lies in [0.5, 1], so their product orders grasps without ruling any out.
class Judge {
 public:
  Judge(const ContactPairs& pairs, const Gripper& gripper) : pairs_(pairs), gripper_(gripper) {
    for (const Eigen::Vector3d& corner : pairs.corners)
      radius_ = std::max(radius_, (corner - pairs.centre_of_mass).norm());
  }

  double operator()(const ContactPair& pair, const Eigen::Vector3d& approach, const Eigen::Vector3d& tcp) const {
    return half_plus(pair.alignment) * half_plus(centring(pair)) * half_plus(support(pair, approach)) *
           half_plus(insertion(approach, tcp)) * half_plus(gap(pair.width));
  }

 private:
  static double half_plus(double share) { return 0.5 + 0.5 * std::clamp(share, 0.0, 1.0); }

  /// 1 when the line of contact passes through the centre of mass (no moment from gravity), 0 at the object's radius.
  double centring(const ContactPair& pair) const {
    const Eigen::Vector3d arm = pair.middle - pairs_.centre_of_mass;
    return radius_ > 0 ? 1 - (arm - arm.dot(pair.axis) * pair.axis).norm() / radius_ : 1;
  }

  double support(const ContactPair& pair, const Eigen::Vector3d& approach) const {
    return pair.face ? detail::pad_overlap(*pair.face, approach, gripper_.finger_depth, gripper_.finger_width) : 1;
  }

  /// 1 when nothing of the object stands further back than the pad does; falls with what must fit in front of the palm.
  double insertion(const Eigen::Vector3d& approach, const Eigen::Vector3d& tcp) const {
    double behind = 0;
    for (const Eigen::Vector3d& corner : pairs_.corners) behind = std::max(behind, approach.dot(tcp - corner));
    const double excess = std::max(0.0, behind - gripper_.finger_depth / 2);
    return 1 / (1 + excess / gripper_.finger_depth);
  }

  /// Share of the wanted clearance that the opening leaves.
  double gap(double width) const {
    return gripper_.clearance > 0 ? (gripper_.max_opening - width) / 2 / gripper_.clearance : 1;
  }

  const ContactPairs& pairs_;
  const Gripper& gripper_;
  double radius_ = 0;
};

void add_grasps(const ContactPair& pair, const Gripper& gripper, const GraspSamplerOptions& options, const Judge& judge,
                std::vector<Candidate>& candidates) {
  const Eigen::Vector3d side = pair.axis.cross(pair.first_approach);
  for (int i = 0; i < options.approaches; ++i) {
    const double angle = detail::kTwoPi * i / options.approaches;
    const Eigen::Vector3d approach = (std::cos(angle) * pair.first_approach + std::sin(angle) * side).normalized();
    // The pads are alike, the arm is not: the hand turned by half a turn about the approach is a grasp of its own.
    for (const double flip : {1.0, -1.0}) {
      const Eigen::Vector3d closing = flip * pair.axis;
      Candidate candidate;
      candidate.grasp.T_object_tcp.linear() = align_axes(gripper.approach, gripper.closing, approach, closing);
      candidate.grasp.T_object_tcp.translation() = pair.middle - options.standoff * approach;
      candidate.grasp.width = pair.width;
      candidate.grasp.quality = judge(pair, approach, candidate.grasp.T_object_tcp.translation());
      candidate.bin = 27 * direction_bin(approach) + direction_bin(closing);
      candidates.push_back(candidate);
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
  require(approaches > 0, "approaches", approaches, "must be positive");
  require(positions > 0, "positions", positions, "must be positive");
  require(mesh_samples > 0, "mesh_samples", mesh_samples, "must be positive");
  require(max_grasps > 0, "max_grasps", max_grasps, "must be positive");
  require(std::isfinite(friction) && friction > 0, "friction", friction, "must be positive and finite");
  require(std::isfinite(standoff), "standoff", standoff, "must be finite [m]");
}

std::vector<Grasp> sample_grasps(const std::vector<LinkShape>& object, const Gripper& gripper,
                                 const GraspSamplerOptions& options, int* too_wide) {
  gripper.check();
  options.check();
  check_object(object);

  std::optional<ContactPairs> pairs;
  if (object.size() == 1) pairs = detail::primitive_pairs(object.front(), gripper, options);
  if (!pairs) pairs = detail::surface_pairs(object, options);

  int wide = 0;
  std::vector<Candidate> candidates;
  const Judge judge(*pairs, gripper);
  for (const ContactPair& pair : pairs->pairs) {
    if (pair.width > gripper.max_opening)
      ++wide;
    else
      add_grasps(pair, gripper, options, judge, candidates);
  }
  if (too_wide) *too_wide = wide;
  return keep_spread(candidates, options.max_grasps);
}

}  // namespace mmgrasp
