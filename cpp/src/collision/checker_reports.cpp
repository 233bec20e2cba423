#include <algorithm>
#include <set>

#include "collision/checker_impl.hpp"

namespace mmgrasp {

namespace {

// A pair with a bound from below on its gap: bounding spheres cannot be farther in than that.
struct Candidate {
  double bound;
  int shape;
  int other;  // shape, or scene shape
  bool with_scene;
};

std::vector<Candidate> candidates(const detail::Snapshot& snapshot, const detail::PairPlan& plan,
                                  const std::vector<Eigen::Vector3d>& balls);

}  // namespace

std::vector<Contact> CollisionChecker::contacts(const Eigen::VectorXd& q) {
  impl_->group.check_configuration(q, "q");
  ++impl_->queries;
  impl_->place(q);
  const detail::Snapshot& snapshot = *impl_->snapshot;
  std::set<std::tuple<bool, int, int>> found;  // one entry per pair of bodies, self contacts first
  if (snapshot.options.check_self) {
    for (const auto* pairs : {&impl_->plan->constant, &impl_->plan->varying}) {
      for (const detail::ShapePair& pair : *pairs) {
        const int a = snapshot.shapes[pair.a].body, b = snapshot.shapes[pair.b].body;
        if (found.count({false, a, b}) == 0 && impl_->pair_collides(pair)) found.insert({false, a, b});
      }
    }
  }
  if (snapshot.options.check_scene) {
    for (const auto* shapes : {&impl_->plan->fixed, &impl_->plan->moving}) {
      for (const int s : *shapes) {
        for (int i = 0; i < static_cast<int>(snapshot.scene.size()); ++i) {
          if (impl_->hits_scene(s, i)) found.insert({true, snapshot.shapes[s].body, snapshot.scene[i].object});
        }
      }
    }
  }
  std::vector<Contact> out;
  for (const auto& [with_scene, a, b] : found) {
    out.push_back(
        {snapshot.bodies[a].name, with_scene ? snapshot.object_names[b] : snapshot.bodies[b].name, with_scene});
  }
  return out;
}

DistanceResult CollisionChecker::distance(const Eigen::VectorXd& q) {
  impl_->group.check_configuration(q, "q");
  ++impl_->queries;
  impl_->place(q);
  const detail::Snapshot& snapshot = *impl_->snapshot;
  std::vector<Candidate> pairs = candidates(snapshot, *impl_->plan, impl_->balls);
  std::sort(pairs.begin(), pairs.end(), [](const Candidate& a, const Candidate& b) { return a.bound < b.bound; });
  DistanceResult best;
  for (const Candidate& pair : pairs) {
    if (pair.bound >= best.value) break;
    const detail::BodyShape& a = snapshot.shapes[pair.shape];
    const detail::Solid& b = pair.with_scene ? *snapshot.scene[pair.other].solid : *snapshot.shapes[pair.other].solid;
    const detail::Rigid& T_b = pair.with_scene ? snapshot.scene[pair.other].T_world : impl_->pose(pair.other);
    const detail::SolidGap gap = detail::solids_distance(*a.solid, impl_->pose(pair.shape), b, T_b, best.value);
    if (gap.distance >= best.value) continue;
    best.value = gap.distance;
    best.point_a = gap.on_a;
    best.point_b = gap.on_b;
    best.a = snapshot.bodies[a.body].name;
    best.b = pair.with_scene ? snapshot.object_names[snapshot.scene[pair.other].object]
                             : snapshot.bodies[snapshot.shapes[pair.other].body].name;
  }
  return best;
}

namespace {

std::vector<Candidate> candidates(const detail::Snapshot& snapshot, const detail::PairPlan& plan,
                                  const std::vector<Eigen::Vector3d>& balls) {
  std::vector<Candidate> out;
  if (snapshot.options.check_self) {
    for (const auto* pairs : {&plan.constant, &plan.varying}) {
      for (const detail::ShapePair& pair : *pairs) {
        out.push_back({(balls[pair.a] - balls[pair.b]).norm() - pair.reach, pair.a, pair.b, false});
      }
    }
  }
  if (snapshot.options.check_scene) {
    for (const auto* shapes : {&plan.fixed, &plan.moving}) {
      for (const int s : *shapes) {
        for (int i = 0; i < static_cast<int>(snapshot.scene.size()); ++i) {
          const double reach = snapshot.shapes[s].solid->ball_radius + snapshot.scene[i].solid->ball_radius;
          out.push_back({(balls[s] - snapshot.scene[i].ball).norm() - reach, s, i, true});
        }
      }
    }
  }
  return out;
}

}  // namespace

}  // namespace mmgrasp
