#include "geometry/segmentation/surface_creases.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "mmgrasp/core/parallel.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
constexpr std::size_t kBatch = 256;
/// Edges that bend inwards by less make no crease, however many there are within the reach [rad].
constexpr double kSlight = 0.02;

/// Whether a place is near an edge that bends inwards: a grid of cells as wide as the reach (and half an edge).
class NearCreases {
 public:
  NearCreases(const FaceGraph& graph, double reach) : cell_(reach) {
    for (const FaceBorder& b : graph.borders) cell_ = b.bend < -kSlight ? std::max(cell_, reach + b.length / 2) : cell_;
    for (const FaceBorder& b : graph.borders) {
      if (b.bend >= -kSlight) continue;
      const auto at = cell_of(0.5 * (graph.vertices[b.vertices[0]] + graph.vertices[b.vertices[1]]));
      for (int k = 0; k < 27; ++k) cells_.insert({at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1});
    }
  }
  bool near(const Vector3d& x) const { return cells_.count(cell_of(x)) > 0; }

 private:
  std::array<long, 3> cell_of(const Vector3d& x) const {
    return {std::lround(x.x() / cell_), std::lround(x.y() / cell_), std::lround(x.z() / cell_)};
  }
  double cell_;
  std::set<std::array<long, 3>> cells_;
};

/// Visits the faces around one, over edges, as far as their centres lie within the reach.
struct Walk {
  explicit Walk(const FaceGraph& graph) : seen(graph.faces.size(), -1), edges_seen(graph.borders.size(), -1) {}
  std::vector<int> seen, edges_seen, queue;
};

double bend_around(const FaceGraph& graph, int face, double reach, Walk& walk) {
  Matrix3d tensor = Matrix3d::Zero();
  walk.queue.assign(1, face);
  walk.seen[face] = face;
  for (std::size_t k = 0; k < walk.queue.size(); ++k) {
    const int f = walk.queue[k];
    for (int i = graph.first_border[f]; i < graph.first_border[f + 1]; ++i) {
      const FaceBorder& border = graph.borders[graph.border_of[i]];
      const int other = graph.other(graph.border_of[i], f);
      const bool inside = (graph.centres[other] - graph.centres[face]).norm() <= reach;
      if (walk.edges_seen[graph.border_of[i]] != face) {
        walk.edges_seen[graph.border_of[i]] = face;
        // The part of the edge within the sphere.
        const Vector3d &a = graph.vertices[border.vertices[0]], &b = graph.vertices[border.vertices[1]];
        const Vector3d along = (b - a) / std::max(border.length, 1e-300);
        const double foot = (graph.centres[face] - a).dot(along);
        const double off = (graph.centres[face] - a - foot * along).squaredNorm();
        const double half = std::sqrt(std::max(0.0, reach * reach - off));
        const double length = std::min(border.length, foot + half) - std::max(0.0, foot - half);
        if (length > 0) tensor += (border.bend * length / (2 * reach)) * along * along.transpose();
      }
      if (!inside || walk.seen[other] == face) continue;
      walk.seen[other] = face;
      walk.queue.push_back(other);
    }
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(tensor, Eigen::EigenvaluesOnly);
  return -solver.eigenvalues()[0];
}

}  // namespace

std::vector<double> inward_bends(const FaceGraph& graph, double reach, int threads) {
  std::vector<double> out(graph.size(), 0);
  const std::size_t batches = (out.size() + kBatch - 1) / kBatch;
  const NearCreases creases(graph, reach);
  std::vector<Walk> walks(resolve_threads(threads), Walk(graph));
  parallel_for(batches, threads, [&](std::size_t batch, int worker) {
    const std::size_t end = std::min(out.size(), (batch + 1) * kBatch);
    for (std::size_t f = batch * kBatch; f < end; ++f) {
      if (!creases.near(graph.centres[f])) continue;
      out[f] = bend_around(graph, static_cast<int>(f), reach, walks[worker]);
    }
  });
  return out;
}

}  // namespace mmgrasp::detail
