#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "geometry/triangle_tree.hpp"
#include "mmgrasp/geometry/simplify_mesh.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

constexpr int kMaxCells = 200'000;    // looked at before a bound counts as not reached
constexpr int kPolishCells = 20'000;  // once the limit is kept: spent on a tighter figure
constexpr double kClose = 1.1;        // a bound this close to the truth is good enough

/// A cube that may hold points of the convex body. No point in it lies farther from the mesh than `bound`.
struct Cell {
  Vector3d centre;
  double half;  // half its edge
  double bound;
  bool operator<(const Cell& other) const { return bound < other.bound; }
};

class DeviationSearch {
 public:
  DeviationSearch(const TriangleMesh& convex, const TriangleMesh& mesh) : mesh_(mesh), tree_(mesh) {
    for (const auto& t : convex.triangles) {
      const Vector3d &a = convex.vertices[t[0]], &b = convex.vertices[t[1]], &c = convex.vertices[t[2]];
      const Vector3d n = (b - a).cross(c - a);
      if (!(n.norm() > 0)) continue;
      normals_.push_back(n.normalized());
      offsets_.push_back(normals_.back().dot(a));
    }
    Eigen::AlignedBox3d box;
    for (const Vector3d& v : convex.vertices) box.extend(v);
    const double half = 0.5 * box.sizes().maxCoeff();
    push(box.center(), half);
  }

  double run(double limit) {
    while (!cells_.empty()) {
      const double bound = std::max(cells_.top().bound, farthest_);
      if (farthest_ > limit) return std::numeric_limits<double>::infinity();
      const bool kept = bound <= limit;
      if (kept && (bound <= kClose * farthest_ || looked_at_ > kPolishCells)) return bound;
      if (looked_at_ > kMaxCells) return bound;
      const Cell cell = cells_.top();
      cells_.pop();
      const double half = 0.5 * cell.half;
      for (int child = 0; child < 8; ++child)
        push(cell.centre + half * Vector3d(child & 1 ? 1 : -1, child & 2 ? 1 : -1, child & 4 ? 1 : -1), half);
    }
    return farthest_;
  }

 private:
  void push(const Vector3d& centre, double half) {
    ++looked_at_;
    const double reach = std::sqrt(3.0) * half;
    const double outside = above_faces(centre);
    if (outside > reach) return;  // holds no point of the convex body
    const double surface = tree_.distance(centre);
    const bool inside = tree_.contains(centre);
    const double distance = inside ? 0 : surface;
    if (outside <= 0) farthest_ = std::max(farthest_, distance);
    // Deep inside a solid a whole cell belongs to it; else distances change by at most the way from the centre.
    const double bound = inside ? std::max(0.0, reach - surface) : surface + reach;
    if (bound > 0) cells_.push({centre, half, bound});
  }

  /// Height over the face whose plane is farthest below the point; <= 0 inside. A lower bound of the distance.
  double above_faces(const Vector3d& p) const {
    double height = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < normals_.size(); ++i) height = std::max(height, normals_[i].dot(p) - offsets_[i]);
    return height;
  }

  const TriangleMesh& mesh_;
  detail::TriangleTree tree_;
  std::vector<Vector3d> normals_;
  std::vector<double> offsets_;
  std::priority_queue<Cell> cells_;
  double farthest_ = 0;  // of a point that surely belongs to the convex body
  int looked_at_ = 0;
};

}  // namespace

double bound_deviation(const TriangleMesh& convex, const TriangleMesh& mesh, double limit) {
  return DeviationSearch(convex, mesh).run(limit);
}

}  // namespace mmgrasp
