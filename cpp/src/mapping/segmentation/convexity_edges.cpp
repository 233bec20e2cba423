#include "mapping/segmentation/convexity_edges.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

/// Where two patches touch.
struct Border {
  int pairs = 0;  ///< Neighbouring cells, one of each patch.
  Vector3d first_normal = Vector3d::Zero(), second_normal = Vector3d::Zero();  ///< Sums over the pairs.
};

}  // namespace

std::vector<SignedEdge> convexity_edges(const SurfaceCells& cells, const SurfacePatches& patches, double concavity) {
  std::map<std::pair<int, int>, Border> borders;
  for (int c = 0; c < cells.size(); ++c) {
    for (int k = cells.first_neighbour[c]; k < cells.first_neighbour[c + 1]; ++k) {
      const int other = cells.neighbours[k];
      const int first = patches.patch_of[c], second = patches.patch_of[other];
      if (first >= second) continue;  // inside a patch, or met from the other side
      Border& border = borders[{first, second}];
      ++border.pairs;
      border.first_normal += cells.normal[c];
      border.second_normal += cells.normal[other];
    }
  }
  std::vector<SignedEdge> edges;
  for (const auto& [pair, border] : borders) {
    const Vector3d first = border.first_normal.normalized(), second = border.second_normal.normalized();
    if (first.isZero() || second.isZero()) continue;
    const double angle = std::acos(std::clamp(first.dot(second), -1.0, 1.0));
    // Seen from the other's centre each normal leans away where the surface bulges, towards it in a crease.
    const bool crease = (first - second).dot(patches.centre[pair.first] - patches.centre[pair.second]) < 0;
    const double score = crease ? std::max(-1.0, 1 - angle / concavity) : 1.0;
    edges.push_back({pair.first, pair.second, score * border.pairs});
  }
  return edges;
}

}  // namespace mmgrasp::detail
