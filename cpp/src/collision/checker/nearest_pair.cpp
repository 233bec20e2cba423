#include "collision/checker/nearest_pair.hpp"

#include <algorithm>
#include <map>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

bool by_bound(const CandidatePair& a, const CandidatePair& b) {
  return a.bound < b.bound;
}

// Calls visit(candidate) for every pair, bounded by spheres: those no configuration changes, or the others.
template <class Visit>
void each_pair(const Placement& placement, bool constant, const Visit& visit) {
  const Snapshot& snapshot = placement.snapshot();
  const PairPlan& plan = placement.plan();
  if (snapshot.options.check_self) {
    for (const ShapePair& pair : constant ? plan.constant : plan.varying) {
      const double between = (placement.shape_centre(pair.a) - placement.shape_centre(pair.b)).norm();
      visit(CandidatePair{between - pair.reach, pair.a, pair.b, false});
    }
  }
  if (!snapshot.options.check_scene) return;
  const int count = static_cast<int>(snapshot.scene.size());
  const std::vector<int>& shapes = constant ? plan.fixed : plan.moving;
  for (int k = 0; k < (constant ? plan.fixed_in_scene : plan.moving_in_scene); ++k) {
    const int s = shapes[k];
    const double radius = snapshot.shapes[s].solid->sphere_radius;
    for (int i = 0; i < count; ++i) {
      if (snapshot.allowed(s, i)) continue;
      const SceneShape& other = snapshot.scene[i];
      const double between = (placement.shape_centre(s) - other.sphere_centre).norm();
      visit(CandidatePair{between - radius - other.bare->sphere_radius, s, i, true});
    }
  }
}

// The two solids of a pair with their poses. `constant`: two of the robot's own shapes stand in the frame they share,
// so that the answer is the same digit for digit wherever they are.
struct PlacedPair {
  PlacedPair(Placement& placement, const CandidatePair& pair, bool constant)
      : a(*placement.snapshot().shapes[pair.shape].solid),
        b(pair.with_scene ? *placement.snapshot().scene[pair.other].bare
                          : *placement.snapshot().shapes[pair.other].solid),
        T_a(constant && !pair.with_scene ? placement.plan().placed[pair.shape].in_frame : placement.pose(pair.shape)),
        T_b(pair.with_scene ? placement.snapshot().scene[pair.other].T_world
            : constant      ? placement.plan().placed[pair.other].in_frame
                            : placement.pose(pair.other)) {}

  SolidClearance clearance(double bound) const { return solids_distance(a, T_a, b, T_b, bound); }
  double box_bound(double sphere_bound) const { return std::max(sphere_bound, boxes_clearance(a, T_a, b, T_b)); }

  const Solid &a, &b;
  const Rigid &T_a, &T_b;
};

// The clearance of a constant pair, where the last place_links() puts it into the world.
void to_world(const Placement& placement, NearestPair& nearest) {
  SolidClearance& clearance = nearest.clearance;
  if (nearest.pair.with_scene || clearance.distance == kInfinity) return;
  const Rigid T = placement.frame(placement.plan().placed[nearest.pair.shape].frame);
  clearance.on_a = T * clearance.on_a;
  clearance.on_b = T * clearance.on_b;
  clearance.normal = T.R * clearance.normal;
}

}  // namespace

void NearestPairSearch::search(Placement& placement, bool constant, NearestPair& best) {
  const auto measure = [&](const CandidatePair& pair) {
    const SolidClearance clearance = PlacedPair(placement, pair, constant).clearance(best.clearance.distance);
    if (clearance.distance < best.clearance.distance) best = {pair, clearance};
  };
  candidates_.clear();
  each_pair(placement, constant, [&](const CandidatePair& pair) {
    if (pair.bound < best.clearance.distance) candidates_.push_back(pair);
  });
  if (candidates_.empty()) return;
  // A first clearance rules most others out by their boxes.
  measure(*std::min_element(candidates_.begin(), candidates_.end(), by_bound));
  std::size_t kept = 0;
  for (CandidatePair pair : candidates_) {
    if (pair.bound >= best.clearance.distance) continue;
    pair.bound = PlacedPair(placement, pair, constant).box_bound(pair.bound);
    if (pair.bound < best.clearance.distance) candidates_[kept++] = pair;
  }
  candidates_.resize(kept);
  std::sort(candidates_.begin(), candidates_.end(), by_bound);
  for (const CandidatePair& pair : candidates_) {
    if (pair.bound >= best.clearance.distance) break;
    measure(pair);
  }
}

NearestPair NearestPairSearch::nearest(Placement& placement) {
  if (!nearest_constant_) {
    NearestPair constant;
    search(placement, true, constant);
    nearest_constant_ = constant;
  }
  NearestPair best = *nearest_constant_;
  to_world(placement, best);
  search(placement, false, best);
  return best;
}

std::vector<NearestPair> NearestPairSearch::all_within(Placement& placement, double within) {
  const Snapshot& snapshot = placement.snapshot();
  candidates_.clear();
  for (const bool constant : {true, false}) {
    each_pair(placement, constant, [&](const CandidatePair& pair) {
      if (pair.bound < within) candidates_.push_back(pair);
    });
  }
  for (CandidatePair& pair : candidates_) pair.bound = PlacedPair(placement, pair, false).box_bound(pair.bound);
  std::sort(candidates_.begin(), candidates_.end(), by_bound);
  std::map<std::tuple<bool, int, int>, NearestPair> by_bodies;
  for (const CandidatePair& pair : candidates_) {
    if (pair.bound >= within) break;
    const int other = pair.with_scene ? snapshot.scene[pair.other].object : snapshot.shapes[pair.other].body;
    const std::tuple<bool, int, int> key{pair.with_scene, snapshot.shapes[pair.shape].body, other};
    const auto known = by_bodies.find(key);
    const double bound = known == by_bodies.end() ? within : known->second.clearance.distance;
    const SolidClearance clearance = PlacedPair(placement, pair, false).clearance(bound);
    if (clearance.distance < bound) by_bodies[key] = {pair, clearance};
  }
  std::vector<NearestPair> out;
  for (const auto& [key, nearest] : by_bodies) out.push_back(nearest);
  return out;
}

Eigen::VectorXd NearestPairSearch::gradient(const Placement& placement, const NearestPair& nearest,
                                            const Eigen::VectorXd& q) {
  const JointGroup& group = placement.group();
  Eigen::VectorXd row = Eigen::VectorXd::Zero(group.size());
  const auto& [pair, clearance] = nearest;
  if (clearance.distance == kInfinity) return row;
  point_jacobian_.resize(6, group.size());
  const auto add = [&](int shape, const Eigen::Vector3d& point, double sign) {
    const int link = placement.snapshot().shapes[shape].link;
    group.point_jacobian(placement.links(), q, link, point, point_jacobian_);
    row.noalias() += sign * point_jacobian_.topRows<3>().transpose() * nearest.clearance.normal;
  };
  add(pair.shape, clearance.on_a, 1);
  if (!pair.with_scene) add(pair.other, clearance.on_b, -1);
  return row;
}

DistanceResult describe(const Snapshot& snapshot, const NearestPair& nearest) {
  DistanceResult out;
  const auto& [pair, clearance] = nearest;
  if (clearance.distance == kInfinity) return out;
  out.value = clearance.distance;
  out.point_a = clearance.on_a;
  out.point_b = clearance.on_b;
  out.with_scene = pair.with_scene;
  out.a = snapshot.bodies[snapshot.shapes[pair.shape].body].name;
  out.b = pair.with_scene ? snapshot.object_names[snapshot.scene[pair.other].object]
                          : snapshot.bodies[snapshot.shapes[pair.other].body].name;
  return out;
}

}  // namespace mmgrasp::detail
