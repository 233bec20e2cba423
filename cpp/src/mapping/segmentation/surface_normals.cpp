// fit_normals of surface_cells.hpp.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mapping/segmentation/surface_cells.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
/// Radius of the round window that a plane is fitted to [cells].
constexpr double kWindow = 3;
/// Fewer points say nothing about a plane's direction.
constexpr double kFewestPoints = 5;
/// Points whose second extent is smaller than this share of the first lie on a line.
constexpr double kLine = 0.05;
/// A cell lies on a neighbour's plane when it is no farther from it than this [cells].
constexpr double kOnPlane = 0.5;

/// Sums over points, about a point near them so that squares stay small.
struct Moments {
  double count = 0;
  Vector3d sum = Vector3d::Zero();
  Matrix3d squares = Matrix3d::Zero();

  /// Adds the moments of points that were counted from `shift` farther on.
  void add(const Moments& other, const Vector3d& shift) {
    count += other.count;
    sum += other.sum + other.count * shift;
    const Matrix3d mixed = other.sum * shift.transpose();
    squares += other.squares + mixed + mixed.transpose() + other.count * shift * shift.transpose();
  }
};

struct LocalPlane {
  Vector3d mean = Vector3d::Zero(), normal = Vector3d::Zero();
  double residual = detail::kInfinity;  ///< Root mean square distance [m].
};

/// Fits a plane around every cell; a cell takes the best plane of those around that hold it, so that edges stay sharp.
class NormalFitter {
 public:
  NormalFitter(const std::vector<Vector3d>& points, const Vector3d& eye, SurfaceCells& cells)
      : cells_(cells), eye_(eye), own_(cells.size()), visited_(cells.size(), -1) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3d off = points[i] - cells.position[cells.cell_of[i]];
      own_[cells.cell_of[i]].add({1, off, off * off.transpose()}, Vector3d::Zero());
    }
  }

  void fit() {
    std::vector<LocalPlane> planes;
    for (int c = 0; c < cells_.size(); ++c) planes.push_back(plane_around(c));
    cells_.normal.clear();
    for (int c = 0; c < cells_.size(); ++c) {
      const LocalPlane* best = &planes[c];
      for (int k = cells_.first_neighbour[c]; k < cells_.first_neighbour[c + 1]; ++k) {
        const LocalPlane& plane = planes[cells_.neighbours[k]];
        const double height = plane.normal.dot(cells_.position[c] - plane.mean);
        if (plane.residual < best->residual && std::abs(height) <= kOnPlane * cells_.leaf) best = &plane;
      }
      cells_.normal.push_back(best->normal);
    }
  }

 private:
  /// Plane through the cells in the window that hang together with the one in the middle.
  LocalPlane plane_around(int middle) {
    poll_();
    const Vector3d origin = cells_.position[middle];
    Moments window;
    stack_.assign(1, middle);
    visited_[middle] = middle;
    while (!stack_.empty()) {
      const int c = stack_.back();
      stack_.pop_back();
      window.add(own_[c], cells_.position[c] - origin);
      for (int k = cells_.first_neighbour[c]; k < cells_.first_neighbour[c + 1]; ++k) {
        const int next = cells_.neighbours[k];
        if (visited_[next] == middle) continue;
        visited_[next] = middle;
        if ((cells_.position[next] - origin).norm() <= kWindow * cells_.leaf) stack_.push_back(next);
      }
    }
    return plane_of(window, origin);
  }

  LocalPlane plane_of(const Moments& window, const Vector3d& origin) const {
    LocalPlane out;
    if (window.count < kFewestPoints) return out;
    const Vector3d mean = window.sum / window.count;
    Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
    solver.computeDirect(window.squares / window.count - mean * mean.transpose());
    const Vector3d extents = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
    if (!(extents[1] > kLine * extents[2])) return out;
    out.mean = origin + mean;
    out.normal = solver.eigenvectors().col(0);
    if (out.normal.dot(eye_ - out.mean) < 0) out.normal = -out.normal;
    out.residual = extents[0];
    return out;
  }

  SurfaceCells& cells_;
  Vector3d eye_;
  std::vector<Moments> own_;
  std::vector<int> visited_;  ///< The last window that a cell was examined for.
  std::vector<int> stack_;
  InterruptionPoll poll_{64};
};

}  // namespace

void fit_normals(const std::vector<Vector3d>& points, const Vector3d& eye, SurfaceCells& cells) {
  NormalFitter(points, eye, cells).fit();
}

}  // namespace mmgrasp::detail
