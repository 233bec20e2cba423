#include "collision/broad/scene_packs.hpp"

namespace mmgrasp::detail {

namespace {

Eigen::AlignedBox3d bounds(const ScenePacks::Item& item) {
  const Eigen::Vector3d half = item.T_world_box.R.cwiseAbs() * item.half;
  return {Eigen::Vector3d(item.T_world_box.t - half), Eigen::Vector3d(item.T_world_box.t + half)};
}

void put(BoxPack& pack, int lane, const Rigid& T, const Eigen::Vector3d& half) {
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) pack.axes[3 * k + i][lane] = static_cast<float>(T.R(i, k));
    pack.centre[k][lane] = static_cast<float>(T.t[k]);
    // Spheres grow by what single precision rounds of their own coordinates; this is the box's share.
    const double rounding = 2e-6 * (T.t.lpNorm<1>() + half.lpNorm<1>());
    pack.half[k][lane] = static_cast<float>(half[k] + rounding);
  }
  pack.radius[lane] = static_cast<float>(half.norm() + 4e-6 * (T.t.lpNorm<1>() + half.lpNorm<1>()));
}

}  // namespace

ScenePacks::ScenePacks(const std::vector<Item>& items) {
  if (items.empty()) return;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Item& item : items) boxes.push_back(bounds(item));
  const BoxTree order(boxes, kLanes);
  std::vector<Eigen::AlignedBox3d> pack_bounds;
  for (const BoxTree::Node& node : order.nodes()) {
    if (node.count == 0) continue;
    BoxPack pack{};
    Eigen::AlignedBox3d all;
    for (int lane = 0; lane < kLanes; ++lane) {
      const bool filled = lane < node.count;
      const int item = filled ? order.items()[node.first + lane] : -1;
      items_.push_back(item);
      if (!filled) {
        put(pack, lane, {Eigen::Matrix3d::Identity(), Eigen::Vector3d::Constant(1e18)}, Eigen::Vector3d::Zero());
        continue;
      }
      put(pack, lane, items[item].T_world_box, items[item].half);
      all.extend(boxes[item]);
    }
    packs_.push_back(pack);
    pack_bounds.push_back(all);
  }
  tree_ = BoxTree(pack_bounds, 1);
}

}  // namespace mmgrasp::detail
