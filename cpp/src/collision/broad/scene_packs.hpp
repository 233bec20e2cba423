#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "collision/kernels/kernels.hpp"
#include "collision/narrow/box_tree.hpp"
#include "collision/narrow/convex.hpp"

namespace mmgrasp::detail {

/// The oriented boxes around the bounded shapes of a scene, eight by eight. Immutable.
class ScenePacks {
 public:
  struct Item {
    Rigid T_world_box;
    Eigen::Vector3d half;
  };

  ScenePacks() = default;
  explicit ScenePacks(const std::vector<Item>& items);

  bool empty() const { return packs_.empty(); }
  int count() const { return static_cast<int>(packs_.size()); }
  const BoxPack* data() const { return packs_.data(); }
  /// Few enough to sweep over all of them.
  bool flat() const { return count() <= kFlat; }
  /// Number of the item in a lane of a pack.
  int item(int pack, int lane) const { return items_[pack * kLanes + lane]; }
  /// Calls visit(pack) for packs whose bounds meet the sphere (x, y, z, radius) until it returns true; true then.
  template <class Visit>
  bool packs_near(const float* sphere, const Visit& visit) const {
    return tree_.any_in(Eigen::Vector3d(sphere[0], sphere[1], sphere[2]), Eigen::Vector3d::Constant(sphere[3]), visit);
  }

  static constexpr int kFlat = 6;

 private:
  std::vector<BoxPack> packs_;
  std::vector<int> items_;
  BoxTree tree_;  ///< Hierarchy over the packs.
};

}  // namespace mmgrasp::detail
