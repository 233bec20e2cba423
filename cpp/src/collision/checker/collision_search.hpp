#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "collision/checker/edge_motion.hpp"
#include "collision/checker/pair_tests.hpp"

namespace mmgrasp::detail {

/// Finds something that collides in a placed configuration, and remembers what did last: it tends to collide again.
class CollisionSearch {
 public:
  explicit CollisionSearch(const PairPlan& plan) : pair_masks_(plan.blocks.size()) {}

  bool self_collides(Placement& placement);
  bool scene_collides(Placement& placement);
  /// Neither of the two, by the options; what collided last is tested first.
  bool is_free(Placement& placement);
  /// True when covers prove that a moving shape hits the scene: quick. False proves nothing.
  bool surely_hits_scene(Placement& placement);
  /// The first contact in the order of the plan, self before scene.
  std::optional<Contact> first_contact(Placement& placement);

  /// False when plan().moving[body] hits a bounded shape of the scene. Lowers `share` to how much of the way to the
  /// checks `reach` pieces of the edge away it surely stays free for.
  bool body_is_free(Placement& placement, int body, EdgeMotion& motion, double reach, double& share);
  void remember_pair(int varying) { last_pair_ = varying; }

  /// Forgets what depends on where the root stands.
  void forget_root() { fixed_scene_.reset(); }
  /// Forgets whether the pairs collide that no configuration changes.
  void forget_constant_pairs() { constant_self_.reset(); }

 private:
  struct Near {
    int shape, other;  ///< `other`: a shape of the scene.
  };

  /// Fills `near_` with the bounded scene shapes whose boxes meet the spheres first .. last of the plan.
  void gather_near(const Placement& placement, int first, int last);
  /// The first of `count` shapes of the plan that hits the scene is remembered; false when none does.
  bool find_scene_hit(Placement& placement, const std::vector<int>& shapes, int count, int first_sphere);
  /// The same by covers alone; pairs that they leave open are left in `unsure_`.
  bool covers_hit_scene(Placement& placement, const std::vector<int>& shapes, int count, int first_sphere);
  /// The pairs in `unsure_`, and the unbounded shapes of the scene.
  bool unsure_shapes_hit_scene(Placement& placement, const std::vector<int>& shapes, int count);
  bool last_hits_scene(Placement& placement);
  bool found_in_scene(int shape, int other) {
    last_shape_ = shape;
    last_scene_ = other;
    return true;
  }
  bool fixed_hits_scene(Placement& placement);
  bool moving_hits_scene(Placement& placement);

  /// What the covers can tell; pairs that they cannot are left in `unsure_pairs_`.
  bool self_collides_for_certain(Placement& placement);
  bool unsure_pairs_collide(Placement& placement);

  std::vector<Near> near_, unsure_;
  std::vector<int> unsure_pairs_;
  std::vector<std::uint8_t> masks_, pair_masks_;
  std::optional<bool> constant_self_;  ///< Whether pairs collide whose relative pose no configuration changes.
  std::optional<bool> fixed_scene_;    ///< Whether links that no configuration moves hit the scene.
  int last_pair_ = -1;                 ///< The varying pair that collided last.
  int last_shape_ = -1, last_scene_ = -1;
};

}  // namespace mmgrasp::detail
