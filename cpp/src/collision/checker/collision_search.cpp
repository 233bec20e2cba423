// The hot query: bounding spheres against boxes eight by eight, and the pairs they leave.

#include "collision/checker/collision_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/narrow/stages.hpp"

namespace mmgrasp::detail {

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
    kernels().spheres_meet_boxes(packs.data(), count, spheres.from(first), last - first, masks_.data(), nullptr);
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
      kernels().spheres_meet_boxes(packs.data() + pack, 1, sphere, 1, &mask, nullptr);
      add(s, pack, mask);
      return false;
    });
  }
}

bool CollisionSearch::body_is_free(Placement& placement, int body, const Closing& closing, bool& proven) {
  const double motion = closing.most;
  const ScenePacks& packs = placement.snapshot().packs;
  const SphereRows sphere = placement.spheres().from(body);
  const int s = placement.plan().moving[body];
  // A body that moves far is only tested where it is: what its sphere, grown by the motion, meets would hardly ever
  // turn out to stay clear.
  const bool far = motion > kMaxProvenMotion;
  float grown_radius = runs(kSphereStage) ? static_cast<float>(*sphere.radius + (far ? 0 : motion)) : 1e9f;
  const SphereRows grown{sphere.x, sphere.y, sphere.z, &grown_radius};
  const auto hits_any = [&](int pack, unsigned mask) {
    for (; mask != 0; mask &= mask - 1) {
      const int other = packs.item(pack, __builtin_ctz(mask));
      if (far) {
        if (!detail::scene_collides(placement, s, other)) continue;
      } else {
        const CoverAnswer answer = scene_within(placement, s, other, closing);
        if (answer == kApart) continue;
        proven = false;
        if (answer == kMaybe) continue;
      }
      last_shape_ = s;
      last_scene_ = other;
      return true;
    }
    return false;
  };
  const auto stays_far = [&](float nearest) {
    return runs(kSphereStage) && std::sqrt(nearest) - *sphere.radius > motion;
  };
  if (packs.flat()) {
    std::uint8_t flat_masks[ScenePacks::kFlat];
    float nearest = std::numeric_limits<float>::infinity();
    kernels().spheres_meet_boxes(packs.data(), packs.count(), grown, 1, flat_masks, &nearest);
    if (stays_far(nearest)) return true;
    if (far) proven = false;
    for (int k = 0; k < packs.count(); ++k) {
      if (hits_any(k, flat_masks[k])) return false;
    }
    return true;
  }
  const float reach[4] = {*sphere.x, *sphere.y, *sphere.z, static_cast<float>(*sphere.radius + motion)};
  return !packs.packs_near(reach, [&](int pack) {
    std::uint8_t mask = 0;
    float nearest = 0;
    kernels().spheres_meet_boxes(packs.data() + pack, 1, grown, 1, &mask, &nearest);
    if (stays_far(nearest)) return false;
    if (far) proven = false;
    return hits_any(pack, mask);
  });
}

bool CollisionSearch::find_scene_hit(Placement& placement, const std::vector<int>& shapes, int count,
                                     int first_sphere) {
  const Snapshot& snapshot = placement.snapshot();
  const auto found = [&](int s, int other) {
    last_shape_ = s;
    last_scene_ = other;
    return true;
  };
  gather_near(placement, first_sphere, first_sphere + count);
  unsure_.clear();
  for (const Near& pair : near_) {
    const int s = shapes[pair.shape - first_sphere];
    const CoverAnswer answer = scene_by_covers(placement, s, pair.other);
    if (answer == kOverlap) return found(s, pair.other);
    if (answer == kMaybe) unsure_.push_back({s, pair.other});
  }
  for (const Near& pair : unsure_) {
    if (scene_collides_exactly(placement, pair.shape, pair.other)) return found(pair.shape, pair.other);
  }
  for (int i = snapshot.packed; i < static_cast<int>(snapshot.scene.size()); ++i) {
    for (int k = 0; k < count; ++k) {
      const int s = shapes[k];
      if (detail::scene_collides(placement, s, i)) return found(s, i);
    }
  }
  return false;
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
      const int i = plan.pair_of[block * kLanes + static_cast<std::size_t>(__builtin_ctz(mask))];
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
  for (const int pair : unsure_pairs_) {
    if (!pair_collides_exactly(placement, placement.plan().varying[pair])) continue;
    last_pair_ = pair;
    return true;
  }
  return false;
}

bool CollisionSearch::scene_collides(Placement& placement) {
  if (!fixed_scene_) fixed_scene_ = fixed_hits_scene(placement);
  return *fixed_scene_ || moving_hits_scene(placement);
}

bool CollisionSearch::is_free(Placement& placement) {
  const CheckerOptions& options = placement.snapshot().options;
  if (runs(kLastCollisionStage) && options.check_scene && last_shape_ >= 0 &&
      detail::scene_collides(placement, last_shape_, last_scene_))
    return false;
  // What costs most, meshes that come close, is left for last.
  if (options.check_self && self_collides_for_certain(placement)) return false;
  if (options.check_scene && scene_collides(placement)) return false;
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
