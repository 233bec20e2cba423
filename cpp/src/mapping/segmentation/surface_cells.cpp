#include "mapping/segmentation/surface_cells.hpp"

#include <cmath>
#include <unordered_map>

#include "mmgrasp/core/detail/cell_key.hpp"
#include "mmgrasp/core/detail/interruption.hpp"

namespace mmgrasp::detail {

using Eigen::Vector3d;

SurfaceCells surface_cells(const std::vector<Vector3d>& points, double leaf) {
  SurfaceCells cells;
  cells.leaf = leaf;
  std::unordered_map<CellKey, int, CellKeyHash> cell_at;
  std::vector<CellKey> keys;
  std::vector<int> count;
  InterruptionPoll poll;
  for (const Vector3d& p : points) {
    poll();
    CellKey key;
    for (int k = 0; k < 3; ++k) key[k] = static_cast<std::int64_t>(std::floor(p[k] / leaf));
    const auto [entry, is_new] = cell_at.emplace(key, cells.size());
    if (is_new) {
      keys.push_back(key);
      count.push_back(0);
      cells.position.push_back(Vector3d::Zero());
    }
    cells.cell_of.push_back(entry->second);
    cells.position[entry->second] += p;
    ++count[entry->second];
  }
  cells.first_neighbour.push_back(0);
  for (int c = 0; c < cells.size(); ++c) {
    poll();
    cells.position[c] /= count[c];
    for (int k = 0; k < 27; ++k) {
      const auto found = cell_at.find({keys[c][0] + k / 9 - 1, keys[c][1] + k / 3 % 3 - 1, keys[c][2] + k % 3 - 1});
      if (found != cell_at.end() && found->second != c) cells.neighbours.push_back(found->second);
    }
    cells.first_neighbour.push_back(static_cast<int>(cells.neighbours.size()));
  }
  return cells;
}

void average_normals(const std::vector<Vector3d>& normals, SurfaceCells& cells) {
  cells.normal.assign(cells.size(), Vector3d::Zero());
  for (std::size_t i = 0; i < normals.size(); ++i) cells.normal[cells.cell_of[i]] += normals[i];
  for (Vector3d& normal : cells.normal) {
    if (normal.norm() > 1e-9) normal.normalize();
  }
}

}  // namespace mmgrasp::detail
