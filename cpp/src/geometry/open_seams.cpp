#include "geometry/open_seams.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/near_vertices.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/geometry/detail/mesh_topology.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kThin = 10;  // So many roundings thick, in the mean, is no solid.

/// Vertices of edges that belong to one triangle only, in rising order.
std::vector<int> border_vertices(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<std::pair<int, int>> edges;
  edges.reserve(3 * triangles.size());
  for (const auto& t : triangles)
    for (int k = 0; k < 3; ++k) edges.push_back(std::minmax({t[k], t[(k + 1) % 3]}));
  InterruptionPoll poll;
  std::sort(edges.begin(), edges.end(), [&](const auto& a, const auto& b) {
    poll();
    return a < b;
  });
  std::vector<int> found;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool alone = (i == 0 || edges[i - 1] != edges[i]) && (i + 1 == edges.size() || edges[i + 1] != edges[i]);
    if (alone) found.insert(found.end(), {edges[i].first, edges[i].second});
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace

std::vector<int> joined_at_seams(const std::vector<Eigen::Vector3d>& vertices,
                                 const std::vector<std::array<int, 3>>& triangles) {
  const std::vector<int> border = border_vertices(triangles);
  std::vector<int> same = near_vertices(vertices, roundings(vertices, triangles), border);
  const bool joins = std::any_of(border.begin(), border.end(), [&](int vertex) { return same[vertex] != vertex; });
  return joins ? same : std::vector<int>{};
}

std::vector<bool> thin_shells(const std::vector<Eigen::Vector3d>& vertices,
                              const std::vector<std::array<int, 3>>& triangles) {
  const Shells shells = find_shells(triangles);
  const std::vector<double> rounding = roundings(vertices, triangles);
  std::vector<double> volume(shells.count, 0), thinnest(shells.count, 0);
  std::vector<int> first(shells.count, -1);  // volumes are measured from a shell's own vertex
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const int shell = shells.shell_of_triangle[i];
    if (first[shell] < 0) first[shell] = triangles[i][0];
    const Eigen::Vector3d &a = vertices[triangles[i][0]], &b = vertices[triangles[i][1]],
                          &c = vertices[triangles[i][2]], &origin = vertices[first[shell]];
    volume[shell] += (a - origin).dot((b - origin).cross(c - origin)) / 6;
    // Each of a sheet's sides has half of the area.
    const double area = (b - a).cross(c - a).norm() / 2;
    const auto& [i0, i1, i2] = triangles[i];
    thinnest[shell] += area / 2 * kThin * std::max({rounding[i0], rounding[i1], rounding[i2]});
  }
  std::vector<bool> thin(shells.count);
  for (int shell = 0; shell < shells.count; ++shell) thin[shell] = std::abs(volume[shell]) <= thinnest[shell];
  return thin;
}

}  // namespace mmgrasp::detail
