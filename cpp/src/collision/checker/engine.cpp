#include "collision/checker/engine.hpp"

#include <algorithm>
#include <map>

#include "collision/checker/pair_tests.hpp"
#include "mmgrasp/collision/detail/edge_steps.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {

CheckerEngine::CheckerEngine(std::shared_ptr<const Snapshot> snapshot, std::shared_ptr<const PairPlan> plan,
                             const JointGroup& group)
    : placement_(std::move(snapshot), std::move(plan), group), search_(placement_.plan()) {}

CheckerEngine::CheckerEngine(const std::shared_ptr<const Snapshot>& snapshot, const JointGroup& group)
    : CheckerEngine(snapshot, std::make_shared<PairPlan>(*snapshot, group), group) {}

void CheckerEngine::set_root(const Pose& T_world_root) {
  placement_.set_root(T_world_root);
  search_.forget_root();
  nearest_.forget();
}

void CheckerEngine::attached_moved() {
  const PairPlan& plan = placement_.plan();
  const auto is_fixed = [&](int sphere) { return sphere >= static_cast<int>(plan.moving.size()); };
  const int first = placement_.snapshot().first_attached;
  if (std::any_of(plan.sphere_of.begin() + first, plan.sphere_of.end(), is_fixed)) {
    placement_.forget();
    search_.forget_root();
  }
  // What does not depend on the configuration may depend on the pose in the hand.
  search_.forget_constant_pairs();
  nearest_.forget();
}

Rejection CheckerEngine::rejection(const Eigen::VectorXd& q) {
  ++queries_;
  if (!group().within_limits(q, kLimitSlack)) return Rejection::limits;
  placement_.place(q.data());
  if (options().check_self && search_.self_collides(placement_)) return Rejection::self_collision;
  if (options().check_scene && search_.scene_collides(placement_)) return Rejection::scene;
  return Rejection::none;
}

bool CheckerEngine::is_free(const Eigen::VectorXd& q) {
  ++queries_;
  if (!group().within_limits(q, kLimitSlack)) return false;
  placement_.place(q.data());
  return search_.is_free(placement_);
}

std::optional<Contact> CheckerEngine::first_contact(const Eigen::VectorXd& q) {
  ++queries_;
  placement_.place(q.data());
  return search_.first_contact(placement_);
}

std::vector<Contact> CheckerEngine::contacts(const Eigen::VectorXd& q) {
  ++queries_;
  placement_.place(q.data());
  const Snapshot& snapshot = placement_.snapshot();
  const PairPlan& plan = placement_.plan();
  std::map<std::tuple<bool, int, int>, bool> found;  // whether only padding meets, by pair of bodies; self first
  if (options().check_self) {
    for (const auto* pairs : {&plan.constant, &plan.varying}) {
      for (const ShapePair& pair : *pairs) {
        const int a = snapshot.shapes[pair.a].body, b = snapshot.shapes[pair.b].body;
        if (found.count({false, a, b}) == 0 && pair_collides(placement_, pair)) found[{false, a, b}] = false;
      }
    }
  }
  if (options().check_scene) {
    for (const auto& [shapes, count] :
         {std::pair(&plan.fixed, plan.fixed_in_scene), {&plan.moving, plan.moving_in_scene}}) {
      for (int k = 0; k < count; ++k) {
        const int s = (*shapes)[k];
        for (int i = 0; i < static_cast<int>(snapshot.scene.size()); ++i) {
          if (!scene_collides(placement_, s, i)) continue;
          const bool padding = only_padding_meets(placement_, s, i);
          bool& all = found.try_emplace({true, snapshot.shapes[s].body, snapshot.scene[i].object}, true).first->second;
          all = all && padding;
        }
      }
    }
  }
  std::vector<Contact> out;
  for (const auto& [pair, padding] : found) {
    const auto& [with_scene, a, b] = pair;
    out.push_back({snapshot.bodies[a].name, with_scene ? snapshot.object_names[b] : snapshot.bodies[b].name, with_scene,
                   padding});
  }
  return out;
}

DistanceResult CheckerEngine::distance(const Eigen::VectorXd& q, bool with_gradient) {
  ++queries_;
  placement_.place_links(q);
  const NearestPair nearest = nearest_.nearest(placement_);
  DistanceResult out = describe(placement_.snapshot(), nearest);
  if (with_gradient) out.gradient = nearest_.gradient(placement_, nearest, q);
  return out;
}

std::vector<DistanceResult> CheckerEngine::distances(const Eigen::VectorXd& q, double within) {
  ++queries_;
  placement_.place_links(q);
  std::vector<DistanceResult> out;
  for (const NearestPair& nearest : nearest_.all_within(placement_, within)) {
    out.push_back(describe(placement_.snapshot(), nearest));
    out.back().gradient = nearest_.gradient(placement_, nearest, q);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const DistanceResult& a, const DistanceResult& b) { return a.value < b.value; });
  return out;
}

bool CheckerEngine::edge_stays_free(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, double step,
                                    bool end_is_free) {
  if (!end_is_free && !is_free(q1)) return false;
  const double pieces = edge_pieces((q1 - q0).cwiseAbs().maxCoeff(), step);
  require(pieces < kMaxPieces, "step", step, "must not cut the edge into more than 1e9 pieces");
  const bool free = walk_.all_free(placement_, search_, q0, q1, static_cast<long>(pieces));
  queries_ += walk_.checks();
  return free;
}

}  // namespace mmgrasp::detail
