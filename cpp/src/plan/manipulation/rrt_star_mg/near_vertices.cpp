#include "plan/manipulation/rrt_star_mg/near_vertices.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "mmgrasp/core/detail/ball_volume.hpp"

namespace mmgrasp::detail {

using Near = GraspTrees::Near;

NearVertices::NearVertices(const GraspTrees& trees, InformedUnion& informed, const RrtStarMgOptions& options,
                           const RrtStarMgTuning& tuning)
    : trees_(trees), informed_(informed), options_(options), tuning_(tuning) {}

void NearVertices::in_tree(int tree, const double* q, int nearest, std::vector<Near>& out) const {
  const int vertices = trees_.tree_size(tree);
  trees_.near_in_tree(tree, q, radius(vertices), out);
  keep_nearest(vertices, informed_.volume(GraspTrees::grasp_of(tree)), out);
  include(nearest, q, out);
}

void NearVertices::on_side(int side, const double* q, int nearest, std::vector<Near>& out) const {
  const int vertices = trees_.side_size(side);
  trees_.near_on_side(side, q, radius(vertices), out);
  keep_nearest(vertices, informed_.volume(), out);
  include(nearest, q, out);
}

double NearVertices::radius(int vertices) const {
  if (!(options_.gamma > 0)) return options_.range;
  const double n = std::max(2, vertices);
  return std::min(options_.gamma * std::pow(std::log(n) / n, 1.0 / (trees_.ends().dimension() + 1)), options_.range);
}

// RRT*'s radius for vertices that are uniform in a set of this volume (Karaman and Frazzoli; of the informed set as in
// Informed RRT* and BIT*) holds a constant times log n of them. With n^(1/(d+1)) times as many it is in the end larger
// than any constant times (log n / n)^(1/(d+1)), which Solovey and others ask for. Ellipsoids of good paths are thin,
// and a sphere wider than they are holds fewer: as many of the nearest are kept, too.
void NearVertices::keep_nearest(int vertices, double volume, std::vector<Near>& near) const {
  if (options_.gamma > 0) return;
  if (!options_.informed) volume = informed_.box_volume();
  const int dimension = trees_.ends().dimension();
  const double n = std::max(2, vertices), d = dimension;
  const double joined = 0.5 * (d + 1) * std::log(n) * std::pow(n, 1 / (d + 1));
  const auto count = static_cast<std::ptrdiff_t>(std::ceil(joined)) + tuning_.min_near_vertices;
  if (static_cast<std::ptrdiff_t>(near.size()) <= count) return;
  const auto nearer = [](const Near& a, const Near& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.vertex < b.vertex;
  };
  std::nth_element(near.begin(), near.begin() + count, near.end(), nearer);
  const double radius = std::pow(volume / unit_ball_volume(dimension) * joined / n, 1 / d);
  near.erase(
      std::partition(near.begin() + count, near.end(), [&](const Near& entry) { return entry.distance < radius; }),
      near.end());
}

void NearVertices::include(int nearest, const double* q, std::vector<Near>& near) const {
  for (const Near& entry : near)
    if (entry.vertex == nearest) return;
  near.push_back(
      {nearest, std::sqrt(trees_.ends().metric().squared_distance(trees_.at(nearest), q, trees_.ends().dimension()))});
}

}  // namespace mmgrasp::detail
