#include "collision/broad/sphere_cover.hpp"

#include <algorithm>
#include <cmath>

#include "collision/broad/cover_shapes.hpp"

namespace mmgrasp::detail {

void SphereCover::add(const Eigen::Vector3d& centre, double outer, double inner) {
  for (int k = 0; k < 3; ++k) {
    data_[k].push_back(static_cast<float>(centre[k]));
    extent_ = std::max(extent_, std::abs(data_[k].back()));
  }
  const double rounding = 1e-6 * (centre.cwiseAbs().maxCoeff() + outer);
  data_[3].push_back(static_cast<float>(outer * kCoverGrowth + rounding));
  data_[4].push_back(inner > 2 * rounding ? static_cast<float>(inner / kCoverGrowth - rounding) : -1.0f);
  extent_ = std::max(extent_, data_[3].back());
  filled_ = static_cast<int>(data_[0].size());
}

void SphereCover::add_far() {
  for (int k = 0; k < 3; ++k) data_[k].push_back(1e18f);
  data_[3].push_back(0);
  data_[4].push_back(-1);
}

void SphereCover::pad() {
  while (data_[0].size() % kLanes != 0) add_far();
}

CoverView SphereCover::view() const {
  return {data_[0].data(), data_[1].data(), data_[2].data(),
          data_[3].data(), data_[4].data(), static_cast<int>(data_[0].size()),
          filled_};
}

BoundingVolumes::BoundingVolumes(const Solid& solid, const Shape& shape) {
  CoverLevels levels(1);
  if (const auto* s = std::get_if<MeshShape>(&shape)) {
    mesh_ = s->mesh;
    if (!s->mesh->triangles.empty()) cover_mesh(*s->mesh, solid, levels);
  } else {
    if (!std::holds_alternative<Voxels>(shape)) shape_ = shape;
    cover_primitive(shape, levels);
  }
  cover_ = std::move(levels.front());
  cover_.pad();
}

const CoverLevels& BoundingVolumes::levels(const Solid& solid) const {
  std::call_once(levels_once_, [&] {
    levels_.resize(kLevels);
    if (cover_.empty()) return;
    if (const auto mesh = mesh_.lock()) {
      cover_mesh(*mesh, solid, levels_);
    } else {
      cover_primitive(shape_, levels_);
    }
    levels_.front().pad();
  });
  return levels_;
}

const DistanceGrid* BoundingVolumes::grid(const Solid& solid) const {
  std::call_once(grid_once_, [&] {
    const auto mesh = mesh_.lock();
    if (mesh && !cover_.empty()) grid_ = std::make_unique<const DistanceGrid>(*mesh, solid);
  });
  return grid_.get();
}

}  // namespace mmgrasp::detail
