// bound_deviation(): how far a solid reaches beyond a mesh, proven by splitting cubes.
#include <algorithm>
#include <cmath>
#include <queue>

#include "geometry/hierarchy/triangle_tree.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/geometry/simplify_mesh.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

constexpr int kMaxCells = 1'000'000;  // checked before a bound counts as not reached
constexpr int kPolishCells = 50'000;  // once the limit is kept: spent on a tighter figure
constexpr double kTightEnough = 1.1;  // a bound this close to the truth is good enough

/// A cube that may hold points of the solid. No point in it lies farther from the mesh than `bound`.
struct Cell {
  Vector3d centre;
  double half;  // half its edge
  double bound;
  bool operator<(const Cell& other) const { return bound < other.bound; }
};

/// Splits cubes around the solid, the one with the largest bound first, until what is left to gain does not matter.
class DeviationSearch {
 public:
  DeviationSearch(const TriangleMesh& solid, const TriangleMesh& mesh) : solid_(solid), mesh_(mesh) {
    Eigen::AlignedBox3d box;
    for (const Vector3d& v : solid.vertices) box.extend(v);
    push(box.center(), 0.5 * box.sizes().maxCoeff());
  }

  double run(double limit) {
    detail::InterruptionPoll poll(64);
    while (!cells_.empty()) {
      poll();
      const double bound = std::max(cells_.top().bound, farthest_);
      if (farthest_ > limit) return detail::kInfinity;
      const bool kept = bound <= limit;
      if (kept && (bound <= kTightEnough * farthest_ || looked_at_ > kPolishCells)) return bound;
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
    const bool in_solid = solid_.contains(centre);
    if (!in_solid && solid_.distance(centre) > reach) return;  // holds no point of the solid
    const double surface = mesh_.distance(centre);
    const bool in_mesh = mesh_.contains(centre);
    if (in_solid && !in_mesh) farthest_ = std::max(farthest_, surface);
    // Deep inside a solid mesh a whole cell belongs to it; else distances change by at most the way from the centre.
    const double bound = in_mesh ? std::max(0.0, reach - surface) : surface + reach;
    if (bound > 0) cells_.push({centre, half, bound});
  }

  detail::TriangleTree solid_, mesh_;
  std::priority_queue<Cell> cells_;
  double farthest_ = 0;  // of a point that surely belongs to the solid
  int looked_at_ = 0;
};

}  // namespace

double bound_deviation(const TriangleMesh& solid, const TriangleMesh& mesh, double limit) {
  require(solid.closed, "solid", "open", "must be a closed mesh");
  require_positive(limit, "limit");
  return DeviationSearch(solid, mesh).run(limit);
}

}  // namespace mmgrasp
