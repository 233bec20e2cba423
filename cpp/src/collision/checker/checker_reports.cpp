#include <set>

#include "collision/checker/checker_impl.hpp"

namespace mmgrasp {

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
    const detail::PairPlan& plan = *impl_->plan;
    for (const auto& [shapes, count] :
         {std::pair(&plan.fixed, plan.fixed_in_scene), {&plan.moving, plan.moving_in_scene}}) {
      for (int k = 0; k < count; ++k) {
        const int s = (*shapes)[k];
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

}  // namespace mmgrasp
