#include "geometry/segmentation/surface_creases.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/parallel.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
constexpr std::size_t kBatch = 64;
/// Edges that bend inwards by less make no crease, however many there are within the reach [rad].
constexpr double kSlight = 0.02;
/// Faces closer to each other than this share of the reach see the same creases.
constexpr double kSameShare = 0.125;

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

/// Gathers the faces around one, over edges, as far as their centres lie within the reach.
struct Walk {
  explicit Walk(const FaceGraph& graph) : seen(graph.faces.size(), -1) {}
  std::vector<int> seen, faces;

  void around(const FaceGraph& graph, int face, double reach) {
    faces.assign(1, face);
    seen[face] = face;
    for (std::size_t k = 0; k < faces.size(); ++k) {
      const int f = faces[k];
      for (int i = graph.first_border[f]; i < graph.first_border[f + 1]; ++i) {
        const int other = graph.other(graph.border_of[i], f);
        if (seen[other] == face || (graph.centres[other] - graph.centres[face]).squaredNorm() > reach * reach) continue;
        seen[other] = face;
        faces.push_back(other);
      }
    }
  }
};

/// Covariance of normal and place over the area around the face. Two half discs of radius r that meet at an angle have
/// sin(angle) 2 r / (3 pi) across the crease, negative where it bends inwards; faces without area, whose normals are
/// chance, do not count.
double bend_around(const FaceGraph& graph, int face, double reach, Walk& walk) {
  walk.around(graph, face, reach);
  double area = 0;
  Vector3d place = Vector3d::Zero(), normal = Vector3d::Zero();
  Matrix3d product = Matrix3d::Zero();
  for (const int f : walk.faces) {
    const Vector3d x = graph.centres[f] - graph.centres[face], n = graph.areas[f] * graph.normals[f];
    area += graph.areas[f];
    place += graph.areas[f] * x;
    normal += n;
    product += n * x.transpose();
  }
  if (!(area > 0)) return 0;
  const Matrix3d covariance = product / area - normal * place.transpose() / (area * area);
  const Matrix3d tensor = (covariance + covariance.transpose()) / 2;
  const double least = Eigen::SelfAdjointEigenSolver<Matrix3d>(tensor, Eigen::EigenvaluesOnly).eigenvalues()[0];
  return std::asin(std::clamp(-least * 3 * kPi / (2 * reach), 0.0, 1.0));
}

}  // namespace

std::vector<double> inward_bends(const FaceGraph& graph, double reach, int threads) {
  std::vector<double> out(graph.size(), 0);
  const NearCreases creases(graph, reach);
  // Neighbours much closer than the reach see the same creases: one of them is asked for all.
  std::vector<int> asked_for(graph.size(), -1), asked;
  Walk close(graph);
  for (int f = 0; f < graph.size(); ++f) {
    if (asked_for[f] >= 0 || !creases.near(graph.centres[f])) continue;
    close.around(graph, f, kSameShare * reach);
    for (const int other : close.faces) {
      if (asked_for[other] < 0) asked_for[other] = f;
    }
    asked.push_back(f);
  }
  std::vector<Walk> walks(resolve_threads(threads), Walk(graph));
  parallel_for((asked.size() + kBatch - 1) / kBatch, threads, [&](std::size_t batch, int worker) {
    const std::size_t end = std::min(asked.size(), (batch + 1) * kBatch);
    for (std::size_t k = batch * kBatch; k < end; ++k)
      out[asked[k]] = bend_around(graph, asked[k], reach, walks[worker]);
  });
  for (int f = 0; f < graph.size(); ++f) {
    if (asked_for[f] >= 0) out[f] = out[asked_for[f]];
  }
  return out;
}

}  // namespace mmgrasp::detail
