#include "geometry/near_vertices.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>

#include "mmgrasp/core/detail/interruption.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kBits = 22;  // The rounding is so many binary digits below the largest coordinate's power of two.
constexpr int kCellLarger =
    2;  // Cells are larger by so many: a ball of the rounding meets two of them along each axis.
constexpr int kZeroLevel = -100;  // The level of coordinates that are all (nearly) zero.

/// The least power of two above a vertex's largest coordinate, as its exponent.
int level_of(const Eigen::Vector3d& vertex) {
  int exponent = kZeroLevel;
  const double largest = vertex.cwiseAbs().maxCoeff();
  if (largest > 0) std::frexp(largest, &exponent);
  return std::max(exponent, kZeroLevel);
}

/// A cube of space among those for vertices of one level.
struct Cell {
  int level;
  std::array<std::int64_t, 3> at;

  bool operator==(const Cell& other) const { return level == other.level && at == other.at; }
};

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = static_cast<std::uint64_t>(cell.level) * 0x9e3779b97f4a7c15ull;
    for (const std::int64_t k : cell.at) {
      hash = (hash ^ static_cast<std::uint64_t>(k)) * 0xff51afd7ed558ccdull;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

double cell_size(int level) {
  return std::ldexp(1.0, level - kBits + kCellLarger);
}

/// Vertices that no other is the same as, by cells.
class KeptVertices {
 public:
  explicit KeptVertices(const std::vector<Eigen::Vector3d>& vertices) : vertices_(vertices) {}

  void add(int vertex) { cells_[cell_at(vertices_[vertex], level_of(vertices_[vertex]))].push_back(vertex); }

  /// The nearest within the rounding of a vertex, or -1.
  int nearest(const Eigen::Vector3d& vertex) const {
    const double radius = rounding_of(vertex);
    int found = -1;
    double least = radius;
    const int own = level_of(vertex);
    for (const int level : {own - 1, own, own + 1}) {  // one of nearly the same size may be beyond a power of two
      const Cell low = cell_at(vertex.array() - radius, level), high = cell_at(vertex.array() + radius, level);
      Cell cell = low;
      for (cell.at[0] = low.at[0]; cell.at[0] <= high.at[0]; ++cell.at[0])
        for (cell.at[1] = low.at[1]; cell.at[1] <= high.at[1]; ++cell.at[1])
          for (cell.at[2] = low.at[2]; cell.at[2] <= high.at[2]; ++cell.at[2]) look_into(cell, vertex, least, found);
    }
    return found;
  }

 private:
  static Cell cell_at(const Eigen::Vector3d& place, int level) {
    Cell cell{level, {}};
    for (int k = 0; k < 3; ++k) cell.at[k] = static_cast<std::int64_t>(std::floor(place[k] / cell_size(level)));
    return cell;
  }

  void look_into(const Cell& cell, const Eigen::Vector3d& vertex, double& least, int& found) const {
    const auto held = cells_.find(cell);
    if (held == cells_.end()) return;
    for (const int other : held->second) {
      const double distance = (vertices_[other] - vertex).cwiseAbs().maxCoeff();
      if (distance > least || (distance == least && found >= 0)) continue;
      least = distance;
      found = other;
    }
  }

  const std::vector<Eigen::Vector3d>& vertices_;
  std::unordered_map<Cell, std::vector<int>, CellHash> cells_;
};

}  // namespace

double rounding_of(const Eigen::Vector3d& vertex) {
  return std::ldexp(1.0, level_of(vertex) - kBits);
}

std::vector<int> near_vertices(const std::vector<Eigen::Vector3d>& vertices, const std::vector<int>& candidates) {
  std::vector<int> same(vertices.size());
  std::iota(same.begin(), same.end(), 0);
  KeptVertices kept(vertices);
  InterruptionPoll poll(256);
  for (const int candidate : candidates) {
    poll();
    const int near = kept.nearest(vertices[candidate]);
    if (near >= 0)
      same[candidate] = near;
    else
      kept.add(candidate);
  }
  return same;
}

}  // namespace mmgrasp::detail
