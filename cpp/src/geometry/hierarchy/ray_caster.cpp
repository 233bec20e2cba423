#include "mmgrasp/geometry/ray_caster.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/hierarchy/triangle_tree.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/geometry/detail/mesh_topology.hpp"

namespace mmgrasp {
namespace {

using detail::PreparedRay;
using detail::TriangleTree;
using Eigen::Vector3d;

constexpr std::size_t kBlock = 1024;  // rays of a work item
constexpr int kBatch = 32;            // rays given to the kernels at once: few enough to stay near

bool prepare(const TriangleTree& tree, const Ray& ray, PreparedRay& out) {
  // A number that is not finite is not 0 even times 0.
  if ((0.0 * (ray.origin + ray.direction)).sum() != 0 || ray.direction.isZero(0))
    throw InvalidInput("ray: origin and direction must be finite, and the direction not zero");
  return tree.prepare(ray.origin, ray.direction, ray.nearest, ray.farthest, out);
}

RayHit make_hit(const TriangleTree& tree, const Ray& ray, double t, int packet, int lane) {
  const Vector3d a = tree.corner(packet, lane, 0);
  const Vector3d normal = (tree.corner(packet, lane, 1) - a).cross(tree.corner(packet, lane, 2) - a);
  RayHit hit;
  hit.triangle = tree.packet(packet).triangle[lane];
  hit.distance = t;
  hit.point = ray.origin + t * ray.direction;
  hit.normal = normal * (1 / normal.norm());
  hit.front = hit.normal.dot(ray.direction) < 0;
  return hit;
}

// As meet_triangles() of the kernels, but of neighbours just one is crossed on their shared edge: an edge through the
// ray counts by the direction in which it runs, which the neighbour sees the other way round.
bool crosses(const TriangleTree& tree, const PreparedRay& ray, int packet, int lane, double& t, bool& front) {
  Eigen::Vector2d shadow[3];
  double z[3], side[3];
  for (int c = 0; c < 3; ++c) {
    const auto& corner = tree.packet(packet).corner[c];
    z[c] = corner[ray.axis[2]][lane] - ray.origin[ray.axis[2]];
    shadow[c] = {corner[ray.axis[0]][lane] - ray.origin[ray.axis[0]] - ray.shear[0] * z[c],
                 corner[ray.axis[1]][lane] - ray.origin[ray.axis[1]] - ray.shear[1] * z[c]};
  }
  int positive = 0;
  for (int c = 0; c < 3; ++c) {
    const Eigen::Vector2d &from = shadow[c], &to = shadow[(c + 1) % 3];
    side[c] = detail::edge_side(from, to);
    if (side[c] != 0)
      positive += side[c] > 0;
    else
      positive += from.x() != to.x() ? from.x() < to.x() : from.y() < to.y();
  }
  const double total = side[1] + side[2] + side[0];  // in the kernels' order: the same rounding
  if ((positive != 0 && positive != 3) || total == 0) return false;
  front = total < 0;
  t = (side[1] * z[0] + side[2] * z[1] + side[0] * z[2]) / total * ray.shear[2];
  return t >= ray.nearest && t <= ray.farthest;
}

// Calls tell(index, record) for each ray; no record when it meets nothing.
template <class Kernel, class Tell>
void cast_all(const TriangleTree& tree, const std::vector<Ray>& rays, int threads, const Kernel& kernel,
              const Tell& tell) {
  parallel_for((rays.size() + kBlock - 1) / kBlock, threads, [&](std::size_t block, int) {
    PreparedRay prepared[kBatch];
    detail::RayRecord records[kBatch];
    std::size_t index[kBatch];
    int count = 0;
    const auto cast = [&] {
      kernel(tree.view(), prepared, count, records);
      for (int i = 0; i < count; ++i) {
        tell(index[i], records[i].packet >= 0 ? records + i : nullptr);
      }
      count = 0;
    };
    const std::size_t end = std::min(rays.size(), (block + 1) * kBlock);
    for (std::size_t i = block * kBlock; i < end; ++i) {
      if (!prepare(tree, rays[i], prepared[count])) {
        tell(i, nullptr);
        continue;
      }
      index[count++] = i;
      if (count == kBatch) cast();
    }
    if (count > 0) cast();
  });
}

}  // namespace

RayCaster::RayCaster(const TriangleMesh& mesh) : tree_(std::make_shared<TriangleTree>(mesh)) {}

RayHit RayCaster::closest_hit(const Ray& ray) const {
  PreparedRay prepared;
  if (!prepare(*tree_, ray, prepared)) return {};
  detail::RayRecord best{ray.farthest};
  detail::ray_kernels().closest(tree_->view(), prepared, best);
  return best.triangle >= 0 ? make_hit(*tree_, ray, best.t, best.packet, best.lane) : RayHit();
}

bool RayCaster::any_hit(const Ray& ray) const {
  PreparedRay prepared;
  return prepare(*tree_, ray, prepared) && detail::ray_kernels().any(tree_->view(), prepared);
}

std::vector<RayHit> RayCaster::all_hits(const Ray& ray) const {
  std::vector<RayHit> hits;
  PreparedRay prepared;
  if (!prepare(*tree_, ray, prepared)) return hits;
  tree_->visit_leaves(prepared, [&](int packet) {
    for (int lane = 0; lane < detail::kPacketWidth; ++lane) {
      double t = 0;
      bool front = false;
      if (tree_->packet(packet).triangle[lane] < 0 || !crosses(*tree_, prepared, packet, lane, t, front)) continue;
      hits.push_back(make_hit(*tree_, ray, t, packet, lane));
      hits.back().front = front;
    }
  });
  std::sort(hits.begin(), hits.end(), [](const RayHit& a, const RayHit& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
  });
  return hits;
}

bool RayCaster::contains(const Vector3d& point) const {
  return tree_->contains(point);
}

std::vector<RayHit> RayCaster::closest_hits(const std::vector<Ray>& rays, int threads) const {
  std::vector<RayHit> hits;
  closest_hits(rays, hits, threads);
  return hits;
}

void RayCaster::closest_hits(const std::vector<Ray>& rays, std::vector<RayHit>& hits, int threads) const {
  hits.resize(rays.size());
  cast_all(*tree_, rays, threads, detail::ray_kernels().closest_many, [&](std::size_t i, const detail::RayRecord* met) {
    hits[i] = met ? make_hit(*tree_, rays[i], met->t, met->packet, met->lane) : RayHit();
  });
}

std::vector<char> RayCaster::any_hits(const std::vector<Ray>& rays, int threads) const {
  std::vector<char> hits(rays.size());
  cast_all(*tree_, rays, threads, detail::ray_kernels().any_many,
           [&](std::size_t i, const detail::RayRecord* met) { hits[i] = met != nullptr; });
  return hits;
}

}  // namespace mmgrasp
