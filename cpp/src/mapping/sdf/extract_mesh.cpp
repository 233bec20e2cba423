#include "mapping/sdf/extract_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "mapping/sdf/marching_cubes.hpp"
#include "mapping/sdf/sdf_sampler.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;
constexpr int kSide = kBlockSide + 1;  // with the first voxels of the next blocks

/// Marching cubes block by block; vertices on common edges are made once.
class Extraction {
 public:
  explicit Extraction(const SdfGrid& grid) : grid_(grid), sampler_(grid), mesh_(std::make_shared<TriangleMesh>()) {}

  SdfMesh run(const Eigen::AlignedBox3d* within, const Monitor& monitor) {
    std::vector<int> order(grid_.keys.size());
    std::iota(order.begin(), order.end(), 0);
    if (within) {
      const double side = kBlockSide * grid_.options.voxel;
      const auto outside = [&](int block) {
        const BlockKey& key = grid_.keys[block];
        const Vector3d low = side * Vector3d(key.x, key.y, key.z);
        return !within->intersects(Eigen::AlignedBox3d(low, low + Vector3d::Constant(side)));
      };
      order.erase(std::remove_if(order.begin(), order.end(), outside), order.end());
    }
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return grid_.keys[a].packed() < grid_.keys[b].packed(); });
    for (const int block : order) {
      if (monitor.stopped()) return {std::make_shared<TriangleMesh>(), {}};
      int first[3] = {0, 0, 0}, last[3] = {kBlockSide - 1, kBlockSide - 1, kBlockSide - 1};
      if (within) {
        const int corner[3] = {8 * grid_.keys[block].x, 8 * grid_.keys[block].y, 8 * grid_.keys[block].z};
        for (int k = 0; k < 3; ++k) {
          const double low = within->min()[k] / grid_.options.voxel - corner[k],
                       high = within->max()[k] / grid_.options.voxel - corner[k];
          first[k] = static_cast<int>(std::floor(std::clamp(low, 0.0, 8.0)));
          last[k] = static_cast<int>(std::floor(std::clamp(high, -1.0, 7.0)));
        }
      }
      if (first[0] > last[0] || first[1] > last[1] || first[2] > last[2]) continue;
      read(block);
      for (int z = first[2]; z <= last[2]; ++z) {
        for (int y = first[1]; y <= last[1]; ++y) {
          for (int x = first[0]; x <= last[0]; ++x) add_cell(block, x, y, z);
        }
      }
    }
    mesh_->closed = !within && closed();
    return {mesh_, std::move(sigma_)};
  }

 private:
  static int local(int x, int y, int z) { return (z * kSide + y) * kSide + x; }

  void read(int block) {
    const BlockKey& key = grid_.keys[block];
    for (int z = 0; z < kSide; ++z) {
      for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
          const bool inside = x < kBlockSide && y < kBlockSide && z < kBlockSide;
          nodes_[local(x, y, z)] = inside ? sampler_.node(block, (z << 6) + (y << 3) + x)
                                          : sampler_.node_at(8 * key.x + x, 8 * key.y + y, 8 * key.z + z);
        }
      }
    }
  }

  void add_cell(int block, int x, int y, int z) {
    int pattern = 0;
    for (int k = 0; k < 8; ++k) {
      const Node& node = nodes_[local(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2))];
      if (node.seen == Seen::nothing) return;
      pattern |= (node.mean < 0) << k;
    }
    for (const auto& edges : marching_cubes_triangles()[pattern]) {
      std::array<int, 3> corners;
      for (int k = 0; k < 3; ++k) corners[k] = vertex(block, x, y, z, edges[k]);
      mesh_->triangles.push_back(corners);
    }
  }

  int vertex(int block, int x, int y, int z, int edge) {
    const int axis = edge / 4, corner = kCellEdges[edge][0];
    x += corner & 1;
    y += corner >> 1 & 1;
    z += corner >> 2;
    const BlockKey& key = grid_.keys[block];
    const int place[3] = {8 * key.x + x, 8 * key.y + y, 8 * key.z + z};
    // The edge is named by the voxel it leaves, which is known and so has a block.
    const bool inside = x < kBlockSide && y < kBlockSide && z < kBlockSide;
    const int owner = inside ? block : grid_.find({place[0] >> 3, place[1] >> 3, place[2] >> 3});
    const int voxel_of_owner = ((z & 7) << 6) + ((y & 7) << 3) + (x & 7);
    const std::uint64_t name = (static_cast<std::uint64_t>(owner) * kBlockVoxels + voxel_of_owner) * 3 + axis;
    const int next = static_cast<int>(mesh_->vertices.size());
    const int at = vertices_.insert(name, next);
    if (at != next) return at;
    const Node& a = nodes_[local(x, y, z)];
    const Node& b = nodes_[local(x + (axis == 0), y + (axis == 1), z + (axis == 2))];
    const auto voxel = static_cast<float>(grid_.options.voxel);
    // As in the sampler: of a voxel that was only looked through its neighbour bounds the distance.
    const float fa = a.seen == Seen::free ? std::min(a.mean, b.mean + voxel) : a.mean,
                fb = b.seen == Seen::free ? std::min(b.mean, a.mean + voxel) : b.mean;
    const double t = fa == fb ? 0.5 : std::clamp<double>(fa / (fa - fb), 0, 1);
    Vector3d point(place[0], place[1], place[2]);
    point[axis] += t;
    mesh_->vertices.push_back(grid_.options.voxel * point);
    const Node& first = a.seen == Seen::free ? b : a;
    const Node& second = b.seen == Seen::free ? a : b;
    const double kept = 1 - 2 * t * (1 - t) * (1 - grid_.correlation[block][axis]);
    sigma_.push_back(std::sqrt(((1 - t) * first.variance + t * second.variance) * kept + (1 - t) * first.systematic +
                               t * second.systematic));
    return at;
  }

  /// Every edge once in each direction.
  bool closed() const {
    std::vector<std::pair<int, int>> edges;
    for (const auto& t : mesh_->triangles) {
      for (int k = 0; k < 3; ++k) edges.emplace_back(t[k], t[(k + 1) % 3]);
    }
    std::sort(edges.begin(), edges.end());
    return !edges.empty() && std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
      return std::binary_search(edges.begin(), edges.end(), std::make_pair(edge.second, edge.first));
    });
  }

  const SdfGrid& grid_;
  SdfSampler sampler_;
  std::shared_ptr<TriangleMesh> mesh_;
  std::vector<double> sigma_;
  std::array<Node, kSide * kSide * kSide> nodes_;
  KeyTable vertices_;
};

}  // namespace

SdfMesh extract_mesh(const SdfGrid& grid, const Eigen::AlignedBox3d* within, const Monitor& monitor) {
  return Extraction(grid).run(within, monitor);
}

}  // namespace mmgrasp::detail
