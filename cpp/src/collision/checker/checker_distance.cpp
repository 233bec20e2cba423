// Distances of a placed robot: spheres bound every pair from below, boxes those that remain, and the exact gaps are
// computed nearest bound first until no bound lies below the best gap. Nothing is carried over from one query to the
// next that could change a digit of an answer.

#include <algorithm>
#include <map>

#include "collision/checker/checker_impl.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp {

using detail::Candidate;
using detail::NearestPair;
using detail::SolidClearance;

namespace {

bool by_bound(const Candidate& a, const Candidate& b) {
  return a.bound < b.bound;
}

}  // namespace

template <class Visit>
void CollisionChecker::Impl::each_pair(bool still, const Visit& visit) const {
  if (snapshot->options.check_self) {
    for (const detail::ShapePair& pair : still ? plan->constant : plan->varying) {
      visit(Candidate{(balls[pair.a] - balls[pair.b]).norm() - pair.reach, pair.a, pair.b, false});
    }
  }
  if (!snapshot->options.check_scene) return;
  const int count = static_cast<int>(snapshot->scene.size());
  const std::vector<int>& shapes = still ? plan->fixed : plan->moving;
  for (int k = 0; k < (still ? plan->fixed_in_scene : plan->moving_in_scene); ++k) {
    const int s = shapes[k];
    const double radius = snapshot->shapes[s].solid->ball_radius;
    for (int i = 0; i < count; ++i) {
      const detail::SceneShape& other = snapshot->scene[i];
      visit(Candidate{(balls[s] - other.ball).norm() - radius - other.solid->ball_radius, s, i, true});
    }
  }
}

SolidClearance CollisionChecker::Impl::gap_of(const Candidate& pair, double bound, bool still) {
  const detail::Solid& a = *snapshot->shapes[pair.shape].solid;
  if (pair.with_scene) {
    const detail::SceneShape& other = snapshot->scene[pair.other];
    return solids_distance(a, pose(pair.shape), *other.solid, other.T_world, bound);
  }
  const detail::Solid& b = *snapshot->shapes[pair.other].solid;
  if (still) return solids_distance(a, plan->placed[pair.shape].in_frame, b, plan->placed[pair.other].in_frame, bound);
  return solids_distance(a, pose(pair.shape), b, pose(pair.other), bound);
}

double CollisionChecker::Impl::box_bound(const Candidate& pair, bool still) {
  const detail::Solid& a = *snapshot->shapes[pair.shape].solid;
  if (pair.with_scene) {
    const detail::SceneShape& other = snapshot->scene[pair.other];
    return std::max(pair.bound, boxes_gap(a, pose(pair.shape), *other.solid, other.T_world));
  }
  const detail::Solid& b = *snapshot->shapes[pair.other].solid;
  const detail::Rigid& T_a = still ? plan->placed[pair.shape].in_frame : pose(pair.shape);
  const detail::Rigid& T_b = still ? plan->placed[pair.other].in_frame : pose(pair.other);
  return std::max(pair.bound, boxes_gap(a, T_a, b, T_b));
}

void CollisionChecker::Impl::to_world(NearestPair& nearest) const {
  SolidClearance& gap = nearest.gap;
  if (nearest.pair.with_scene || gap.distance == detail::kInfinity) return;
  const int frame = plan->placed[nearest.pair.shape].frame;
  const detail::Rigid T = detail::MovingFrames::get(frames.data() + 16 * frame);
  gap.on_a = T * gap.on_a;
  gap.on_b = T * gap.on_b;
  gap.normal = T.R * gap.normal;
}

NearestPair CollisionChecker::Impl::nearest() {
  NearestPair best;
  const auto look_at = [&](const Candidate& pair, bool still) {
    const SolidClearance gap = gap_of(pair, best.gap.distance, still);
    if (gap.distance < best.gap.distance) best = {pair, gap};
  };
  const auto search = [&](bool still) {
    candidates.clear();
    each_pair(still, [&](const Candidate& pair) {
      if (pair.bound < best.gap.distance) candidates.push_back(pair);
    });
    if (candidates.empty()) return;
    // A first gap turns most others away by their boxes.
    look_at(*std::min_element(candidates.begin(), candidates.end(), by_bound), still);
    std::size_t kept = 0;
    for (Candidate pair : candidates) {
      if (pair.bound >= best.gap.distance) continue;
      pair.bound = box_bound(pair, still);
      if (pair.bound < best.gap.distance) candidates[kept++] = pair;
    }
    candidates.resize(kept);
    std::sort(candidates.begin(), candidates.end(), by_bound);
    for (const Candidate& pair : candidates) {
      if (pair.bound >= best.gap.distance) break;
      look_at(pair, still);
    }
  };
  if (nearest_still) {
    best = *nearest_still;
  } else {
    search(true);
    nearest_still = best;
  }
  to_world(best);
  search(false);
  return best;
}

DistanceResult CollisionChecker::Impl::described(const NearestPair& nearest) const {
  DistanceResult out;
  const auto& [pair, gap] = nearest;
  if (gap.distance == detail::kInfinity) return out;
  out.value = gap.distance;
  out.point_a = gap.on_a;
  out.point_b = gap.on_b;
  out.with_scene = pair.with_scene;
  out.a = snapshot->bodies[snapshot->shapes[pair.shape].body].name;
  out.b = pair.with_scene ? snapshot->object_names[snapshot->scene[pair.other].object]
                          : snapshot->bodies[snapshot->shapes[pair.other].body].name;
  return out;
}

Eigen::VectorXd CollisionChecker::Impl::gradient(const NearestPair& nearest, const Eigen::VectorXd& q) {
  Eigen::VectorXd row = Eigen::VectorXd::Zero(group.size());
  const auto& [pair, gap] = nearest;
  if (gap.distance == detail::kInfinity) return row;
  point_jacobian.resize(6, group.size());
  const auto add = [&](int link, const Eigen::Vector3d& point, double sign) {
    group.point_jacobian(links, q, link, point, point_jacobian);
    row.noalias() += sign * point_jacobian.topRows<3>().transpose() * gap.normal;
  };
  add(snapshot->shapes[pair.shape].link, gap.on_a, 1);
  if (!pair.with_scene) add(snapshot->shapes[pair.other].link, gap.on_b, -1);
  return row;
}

DistanceResult CollisionChecker::distance(const Eigen::VectorXd& q) {
  impl_->group.check_configuration(q, "q");
  ++impl_->queries;
  impl_->place(q);
  return impl_->described(impl_->nearest());
}

DistanceResult CollisionChecker::distance_and_gradient(const Eigen::VectorXd& q) {
  impl_->group.check_configuration(q, "q");
  ++impl_->queries;
  impl_->place(q);
  const NearestPair nearest = impl_->nearest();
  DistanceResult out = impl_->described(nearest);
  out.gradient = impl_->gradient(nearest, q);
  return out;
}

std::vector<DistanceResult> CollisionChecker::distances(const Eigen::VectorXd& q, double within) {
  impl_->group.check_configuration(q, "q");
  require(std::isfinite(within) && within > 0, "within", within, "must be finite and > 0 [m]");
  ++impl_->queries;
  impl_->place(q);
  std::vector<Candidate> pairs;
  for (const bool still : {true, false}) {
    impl_->each_pair(still, [&](const Candidate& pair) {
      if (pair.bound < within) pairs.push_back(pair);
    });
  }
  const detail::Snapshot& snapshot = *impl_->snapshot;
  std::map<std::tuple<bool, int, int>, NearestPair> by_bodies;
  for (Candidate& pair : pairs) {
    pair.bound = impl_->box_bound(pair);
  }
  std::sort(pairs.begin(), pairs.end(), by_bound);
  for (const Candidate& pair : pairs) {
    if (pair.bound >= within) break;
    const int other = pair.with_scene ? snapshot.scene[pair.other].object : snapshot.shapes[pair.other].body;
    const std::tuple<bool, int, int> key{pair.with_scene, snapshot.shapes[pair.shape].body, other};
    const auto known = by_bodies.find(key);
    const double bound = known == by_bodies.end() ? within : known->second.gap.distance;
    const SolidClearance gap = impl_->gap_of(pair, bound);
    if (gap.distance < bound) by_bodies[key] = {pair, gap};
  }
  std::vector<DistanceResult> out;
  for (const auto& [key, nearest] : by_bodies) {
    out.push_back(impl_->described(nearest));
    out.back().gradient = impl_->gradient(nearest, q);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const DistanceResult& a, const DistanceResult& b) { return a.value < b.value; });
  return out;
}

}  // namespace mmgrasp
