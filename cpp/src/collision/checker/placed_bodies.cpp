#include "mmgrasp/collision/detail/placed_bodies.hpp"

#include <algorithm>
#include <string>

#include "collision/broad/solid_cache.hpp"
#include "collision/narrow/narrow.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

struct PlacedSolid {
  std::shared_ptr<const Solid> solid;
  Rigid T_world;
  Eigen::Vector3d centre;  ///< Centre of the bounding sphere, world frame.
};

/// Two shapes, with a number their distance is not below.
struct Candidate {
  double bound;
  const PlacedSolid *a, *b;
};

}  // namespace

struct PlacedBodies::Impl {
  std::vector<PlacedSolid> solids;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< A sphere around all of them, world frame.
  double radius = 0;
};

PlacedBodies::PlacedBodies(const std::vector<LinkShape>& shapes, const Poses& T_world_body)
    : impl_(std::make_unique<Impl>()) {
  if (shapes.size() != T_world_body.size()) {
    throw InvalidInput("T_world_body: has " + std::to_string(T_world_body.size()) + " poses, there are " +
                       std::to_string(shapes.size()) + " shapes");
  }
  Eigen::AlignedBox3d centres;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    auto solid = shared_solid(shapes[i].shape, 0);
    if (solid->never_collides()) continue;
    const Rigid T_world = Rigid(T_world_body[i]) * Rigid(shapes[i].T_link_shape);
    const Eigen::Vector3d centre = T_world * solid->sphere_centre;
    centres.extend(centre);
    impl_->solids.push_back({std::move(solid), T_world, centre});
  }
  if (impl_->solids.empty()) return;
  impl_->centre = centres.center();
  for (const PlacedSolid& s : impl_->solids)
    impl_->radius = std::max(impl_->radius, (s.centre - impl_->centre).norm() + s.solid->sphere_radius);
}

PlacedBodies::PlacedBodies(PlacedBodies&&) noexcept = default;
PlacedBodies::~PlacedBodies() = default;

double PlacedBodies::distance(const PlacedBodies& other, double within) const {
  const Impl &a = *impl_, &b = *other.impl_;
  if ((a.centre - b.centre).norm() - a.radius - b.radius >= within) return kInfinity;
  std::vector<Candidate> candidates;
  for (const PlacedSolid& s : a.solids) {
    if ((s.centre - b.centre).norm() - s.solid->sphere_radius - b.radius >= within) continue;
    for (const PlacedSolid& o : b.solids) {
      const double bound = (s.centre - o.centre).norm() - s.solid->sphere_radius - o.solid->sphere_radius;
      if (bound < within) candidates.push_back({bound, &s, &o});
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const auto& x, const auto& y) { return x.bound < y.bound; });
  double best = within;
  for (const Candidate& c : candidates) {
    if (c.bound >= best) break;
    if (boxes_clearance(*c.a->solid, c.a->T_world, *c.b->solid, c.b->T_world) >= best) continue;
    best = std::min(best, solids_distance(*c.a->solid, c.a->T_world, *c.b->solid, c.b->T_world, best).distance);
  }
  return best < within ? best : kInfinity;
}

}  // namespace mmgrasp::detail
