// The hot query: bounding spheres against boxes eight by eight, and the pairs they leave.

#include "collision/checker/collision_search.hpp"

#include <algorithm>
#include <cmath>

#include "collision/narrow/stages.hpp"

namespace mmgrasp::detail {

namespace {

/// Whether the pair's clearance table proves it apart.
bool table_parts(const Placement& placement, const ShapePair& pair) {
  const std::vector<double>& q = placement.configuration();
  return runs(kTableStage) && pair.clearances &&
         pair.clearances->at_least(q[pair.columns[0]], q[pair.columns[1]], 0) > 0;
}

}  // namespace

void CollisionSearch::gather_near(const Placement& placement, int first, int last) {
  const ScenePacks& packs = placement.snapshot().packs;
  const SphereRows spheres = placement.spheres();
  near_.clear();
  if constexpr (!runs(kSphereStage)) {
    for (int s = first; s < last; ++s) {
      for (int i = 0; i < placement.snapshot().packed; ++i) near_.push_back({s, i});
    }
    return;
  }
  const auto add = [&](int sphere, int pack, unsigned mask) {
    for (; mask != 0; mask &= mask - 1) near_.push_back({sphere, packs.item(pack, __builtin_ctz(mask))});
  };
  if (packs.flat()) {
    const int count = packs.count();
    masks_.resize(count * (last - first));
    kernels().spheres_meet_boxes(packs.data(), count, spheres.from(first), last - first, masks_.data());
    for (int s = first; s < last; ++s) {
      for (int k = 0; k < count; ++k) add(s, k, masks_[(s - first) * count + k]);
    }
    return;
  }
  for (int s = first; s < last; ++s) {
    const SphereRows sphere = spheres.from(s);
    const float at[4] = {*sphere.x, *sphere.y, *sphere.z, *sphere.radius};
    packs.packs_near(at, [&](int pack) {
      std::uint8_t mask = 0;
      kernels().spheres_meet_boxes(packs.data() + pack, 1, sphere, 1, &mask);
      add(s, pack, mask);
      return false;
    });
  }
}

bool CollisionSearch::body_is_free(Placement& placement, int body, EdgeMotion& motion, double reach, double& share) {
  const ScenePacks& packs = placement.snapshot().packs;
  const SphereRows sphere = placement.spheres().from(body);
  const double radius = *sphere.radius;
  float squared[ScenePacks::kFlat * kLanes];
  double clearance = -radius;
  if (packs.flat()) {
    const float nearest =
        kernels().boxes_from_point(packs.data(), packs.count(), *sphere.x, *sphere.y, *sphere.z, squared);
    clearance = std::sqrt(nearest) - radius;
    if (runs(kSphereStage) && clearance > motion.of_body_anywhere(body, reach)) return true;
  }
  const Closing closing = motion.of_body(body, reach);
  if (runs(kSphereStage) && clearance > closing.most) return true;
  // A body that moves far is only tested for shapes that its sphere meets: others would hardly ever turn out to stay
  // clear of all of its way.
  const bool far = closing.most > kMaxProvenMotion;
  if (runs(kSphereStage) && far && clearance > 0) {
    share = std::min(share, closing.share(clearance));
    return true;
  }
  const auto grown = static_cast<float>(runs(kSphereStage) ? radius + closing.most : 1e9);
  const auto touched = static_cast<float>(runs(kSphereStage) ? radius * radius : 1e18);
  const auto hits_near = [&](int pack, const float* distances) {
    float apart = grown * grown;  // the nearest that the sphere does not meet, where such shapes are left at that
    for (int lane = 0; lane < kLanes; ++lane) {
      if (distances[lane] > grown * grown) continue;
      double by_sphere = 0;
      if (distances[lane] > touched) {
        if (far) {
          apart = std::min(apart, distances[lane]);
          continue;
        }
        by_sphere = closing.share(std::sqrt(distances[lane]) - radius);
        if (by_sphere >= share) continue;
      }
      const int shape = placement.plan().moving[body], other = packs.item(pack, lane);
      const Within within = scene_within(placement, shape, other, closing);
      if (within.touch) return found_in_scene(shape, other);
      share = std::min(share, std::max(by_sphere, within.share));
    }
    if (apart < grown * grown) share = std::min(share, closing.share(std::sqrt(apart) - radius));
    return false;
  };
  if (packs.flat()) {
    for (int k = 0; k < packs.count(); ++k) {
      if (hits_near(k, squared + k * kLanes)) return false;
    }
    return true;
  }
  const float around[4] = {*sphere.x, *sphere.y, *sphere.z, static_cast<float>(radius + closing.most)};
  return !packs.packs_near(around, [&](int pack) {
    const float nearest = kernels().boxes_from_point(packs.data() + pack, 1, around[0], around[1], around[2], squared);
    if (runs(kSphereStage) && std::sqrt(nearest) - radius > closing.most) return false;
    return hits_near(pack, squared);
  });
}

bool CollisionSearch::covers_hit_scene(Placement& placement, const std::vector<int>& shapes, int count,
                                       int first_sphere) {
  gather_near(placement, first_sphere, first_sphere + count);
  unsure_.clear();
  for (const Near& pair : near_) {
    const int s = shapes[pair.shape - first_sphere];
    const CoverAnswer answer = scene_by_covers(placement, s, pair.other);
    if (answer == kOverlap) return found_in_scene(s, pair.other);
    if (answer == kMaybe) unsure_.push_back({s, pair.other});
  }
  return false;
}

bool CollisionSearch::unsure_shapes_hit_scene(Placement& placement, const std::vector<int>& shapes, int count) {
  const Snapshot& snapshot = placement.snapshot();
  if (runs(kLastCollisionStage)) {
    const auto last = std::find_if(unsure_.begin(), unsure_.end(), [&](const Near& pair) {
      return pair.shape == last_shape_ && pair.other == last_scene_;
    });
    if (last != unsure_.end()) std::iter_swap(unsure_.begin(), last);
  }
  for (const Near& pair : unsure_) {
    if (scene_collides_exactly(placement, pair.shape, pair.other)) return found_in_scene(pair.shape, pair.other);
  }
  for (int i = snapshot.packed; i < static_cast<int>(snapshot.scene.size()); ++i) {
    for (int k = 0; k < count; ++k) {
      if (detail::scene_collides(placement, shapes[k], i)) return found_in_scene(shapes[k], i);
    }
  }
  return false;
}

bool CollisionSearch::find_scene_hit(Placement& placement, const std::vector<int>& shapes, int count,
                                     int first_sphere) {
  return covers_hit_scene(placement, shapes, count, first_sphere) || unsure_shapes_hit_scene(placement, shapes, count);
}

bool CollisionSearch::fixed_hits_scene(Placement& placement) {
  const PairPlan& plan = placement.plan();
  return find_scene_hit(placement, plan.fixed, plan.fixed_in_scene, static_cast<int>(plan.moving.size()));
}

bool CollisionSearch::moving_hits_scene(Placement& placement) {
  const PairPlan& plan = placement.plan();
  return find_scene_hit(placement, plan.moving, plan.moving_in_scene, 0);
}

bool CollisionSearch::self_collides(Placement& placement) {
  return self_collides_for_certain(placement) || unsure_pairs_collide(placement);
}

bool CollisionSearch::self_collides_for_certain(Placement& placement) {
  const PairPlan& plan = placement.plan();
  unsure_pairs_.clear();
  if (!constant_self_) {
    constant_self_ = false;
    for (const ShapePair& pair : plan.constant) {
      if (pair_collides(placement, pair)) constant_self_ = true;
    }
  }
  if (*constant_self_) return true;
  kernels().sphere_pairs_meet(plan.blocks.data(), static_cast<int>(plan.blocks.size()), placement.spheres(),
                              pair_masks_.data());
  for (std::size_t block = 0; block < plan.blocks.size(); ++block) {
    const unsigned lanes = runs(kSphereStage) ? pair_masks_[block] : plan.blocks[block].lanes;
    for (unsigned mask = lanes; mask != 0; mask &= mask - 1) {
      const int i = plan.pair_of[block * kLanes + __builtin_ctz(mask)];
      if (table_parts(placement, plan.varying[i])) continue;
      const CoverAnswer answer = pair_by_covers(placement, plan.varying[i]);
      if (answer == kApart) continue;
      if (answer == kMaybe) {
        unsure_pairs_.push_back(i);
        continue;
      }
      last_pair_ = i;
      return true;
    }
  }
  return false;
}

bool CollisionSearch::unsure_pairs_collide(Placement& placement) {
  if (runs(kLastCollisionStage)) {
    const auto last = std::find(unsure_pairs_.begin(), unsure_pairs_.end(), last_pair_);
    if (last != unsure_pairs_.end()) std::iter_swap(unsure_pairs_.begin(), last);
  }
  for (const int i : unsure_pairs_) {
    const ShapePair& pair = placement.plan().varying[i];
    if (!pair_collides_exactly(placement, pair)) continue;
    last_pair_ = i;
    return true;
  }
  return false;
}

bool CollisionSearch::scene_collides(Placement& placement) {
  if (!fixed_scene_) fixed_scene_ = fixed_hits_scene(placement);
  return *fixed_scene_ || moving_hits_scene(placement);
}

bool CollisionSearch::last_hits_scene(Placement& placement) {
  return runs(kLastCollisionStage) && placement.snapshot().options.check_scene && last_shape_ >= 0 &&
         scene_by_covers(placement, last_shape_, last_scene_) == kOverlap;
}

bool CollisionSearch::surely_hits_scene(Placement& placement) {
  if (!placement.snapshot().options.check_scene) return false;
  const PairPlan& plan = placement.plan();
  return last_hits_scene(placement) || covers_hit_scene(placement, plan.moving, plan.moving_in_scene, 0);
}

bool CollisionSearch::is_free(Placement& placement) {
  const CheckerOptions& options = placement.snapshot().options;
  const PairPlan& plan = placement.plan();
  if (options.check_scene) {
    if (!fixed_scene_) fixed_scene_ = fixed_hits_scene(placement);
    if (*fixed_scene_) return false;
  }
  // What costs most is left for last: meshes that come close.
  if (surely_hits_scene(placement)) return false;
  if (options.check_self && self_collides_for_certain(placement)) return false;
  if (options.check_scene && unsure_shapes_hit_scene(placement, plan.moving, plan.moving_in_scene)) return false;
  return !(options.check_self && unsure_pairs_collide(placement));
}

std::optional<Contact> CollisionSearch::first_contact(Placement& placement) {
  const Snapshot& snapshot = placement.snapshot();
  const auto body = [&](int s) { return snapshot.bodies[snapshot.shapes[s].body].name; };
  if (snapshot.options.check_self) {
    for (const auto* pairs : {&placement.plan().constant, &placement.plan().varying}) {
      for (const ShapePair& pair : *pairs) {
        if (pair_collides(placement, pair)) return Contact{body(pair.a), body(pair.b), false};
      }
    }
  }
  if (!snapshot.options.check_scene) return std::nullopt;
  if (!fixed_hits_scene(placement) && !moving_hits_scene(placement)) return std::nullopt;
  return Contact{body(last_shape_), snapshot.object_names[snapshot.scene[last_scene_].object], true,
                 only_padding_meets(placement, last_shape_, last_scene_)};
}

}  // namespace mmgrasp::detail
