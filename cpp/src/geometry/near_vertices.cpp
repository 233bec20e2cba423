#include "geometry/near_vertices.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>
#include <unordered_map>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kBits = 22;       // The rounding is so many binary digits below the largest coordinate's power of two.
constexpr int kCellBits = 52;   // Numbers of cells have no more.
constexpr double kEdge = 1e-3;  // Share of the shortest edge.

/// The least power of two above a length, as its exponent.
int level_of(double length) {
  int exponent = 0;
  std::frexp(length, &exponent);
  return exponent;
}

/// A cube of space among those for vertices whose roundings have one level; its sides are at least as long.
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

/// Vertices that no other is the same as, by cells.
class KeptVertices {
 public:
  KeptVertices(const std::vector<Eigen::Vector3d>& vertices, const std::vector<double>& roundings)
      : vertices_(vertices), roundings_(roundings) {}

  void add(int vertex) {
    const int level = level_of(roundings_[vertex]);
    if (!has_cells(vertex, level)) return;
    levels_.insert(level);
    cells_[cell_at(vertices_[vertex], level)].push_back(vertex);
  }

  /// The nearest that is the same, or -1.
  int nearest(int vertex) const {
    int found = -1;
    double least = kInfinity;
    const Eigen::Vector3d& at = vertices_[vertex];
    for (const int level : levels_) {
      if (!has_cells(vertex, level)) continue;
      const double radius = std::min(roundings_[vertex], std::ldexp(1.0, level));
      const Cell low = cell_at(at.array() - radius, level), high = cell_at(at.array() + radius, level);
      Cell cell = low;
      for (cell.at[0] = low.at[0]; cell.at[0] <= high.at[0]; ++cell.at[0])
        for (cell.at[1] = low.at[1]; cell.at[1] <= high.at[1]; ++cell.at[1])
          for (cell.at[2] = low.at[2]; cell.at[2] <= high.at[2]; ++cell.at[2]) look_into(cell, vertex, least, found);
    }
    return found;
  }

 private:
  /// Whether cells of a level have numbers where a vertex is; none is the same as one so far off that they have not.
  bool has_cells(int vertex, int level) const {
    return vertices_[vertex].cwiseAbs().maxCoeff() < std::ldexp(1.0, level + kCellBits);
  }

  static Cell cell_at(const Eigen::Vector3d& place, int level) {
    Cell cell{level, {}};
    for (int k = 0; k < 3; ++k) cell.at[k] = static_cast<std::int64_t>(std::floor(std::ldexp(place[k], -level)));
    return cell;
  }

  void look_into(const Cell& cell, int vertex, double& least, int& found) const {
    const auto held = cells_.find(cell);
    if (held == cells_.end()) return;
    for (const int other : held->second) {
      const double distance = (vertices_[other] - vertices_[vertex]).cwiseAbs().maxCoeff();
      if (distance > std::min(roundings_[other], roundings_[vertex])) continue;
      if (distance > least || (distance == least && other > found)) continue;
      least = distance;
      found = other;
    }
  }

  const std::vector<Eigen::Vector3d>& vertices_;
  const std::vector<double>& roundings_;
  std::set<int> levels_;
  std::unordered_map<Cell, std::vector<int>, CellHash> cells_;
};

}  // namespace

std::vector<double> roundings(const std::vector<Eigen::Vector3d>& vertices,
                              const std::vector<std::array<int, 3>>& triangles) {
  std::vector<double> largest(vertices.size(), 0), shortest(vertices.size(), kInfinity);
  for (const auto& t : triangles) {
    double coordinate = 0;
    for (const int v : t) coordinate = std::max(coordinate, vertices[v].cwiseAbs().maxCoeff());
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      largest[a] = std::max(largest[a], coordinate);
      const double edge = (vertices[a] - vertices[b]).norm();
      for (const int end : {a, b}) shortest[end] = std::min(shortest[end], edge);
    }
  }
  for (std::size_t i = 0; i < vertices.size(); ++i)
    largest[i] = std::min(std::ldexp(1.0, level_of(largest[i]) - kBits), kEdge * shortest[i]);
  return largest;
}

std::vector<int> near_vertices(const std::vector<Eigen::Vector3d>& vertices, const std::vector<double>& roundings,
                               const std::vector<int>& candidates) {
  std::vector<int> same(vertices.size());
  std::iota(same.begin(), same.end(), 0);
  KeptVertices kept(vertices, roundings);
  InterruptionPoll poll(256);
  for (const int candidate : candidates) {
    poll();
    const int near = kept.nearest(candidate);
    if (near >= 0)
      same[candidate] = near;
    else
      kept.add(candidate);
  }
  return same;
}

}  // namespace mmgrasp::detail
