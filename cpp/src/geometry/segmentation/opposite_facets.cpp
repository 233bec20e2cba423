#include "mmgrasp/geometry/opposite_facets.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "geometry/segmentation/shadow_grid.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/lengths.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/geometry/detail/clip_polygon.hpp"
#include "mmgrasp/geometry/detail/mesh_topology.hpp"

namespace mmgrasp {
namespace {

constexpr double kThinnest = 1e-4;  // Thinner material is not held [m].
constexpr double kRounding = 1e-9;  // [m]
/// Directions in a half turn in which the length of an overlap is measured: the longest is missed by 0.02 %.
constexpr int kDirections = 90;

/// Axes of a plane: x, y, and its normal as z.
Eigen::Matrix3d plane_axes(const Eigen::Vector3d& normal) {
  Eigen::Matrix3d axes;
  axes.col(2) = normal;
  const Eigen::Vector3d least = std::abs(normal.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  axes.col(0) = least.cross(normal).normalized();
  axes.col(1) = normal.cross(axes.col(0));
  return axes;
}

using Polygon = std::vector<Eigen::Vector3d>;

/// Triangles of a facet in the plane's axes, turned counter-clockwise; those without a shadow are left out.
std::vector<Polygon> shadow(const TriangleMesh& mesh, const Facet& facet, const Eigen::Matrix3d& axes) {
  std::vector<Polygon> out;
  for (const int f : facet.faces) {
    Polygon t;
    for (const int v : mesh.triangles[f]) t.push_back(axes.transpose() * mesh.vertices[v]);
    const double area = detail::edge_side((t[1] - t[0]).head<2>(), (t[2] - t[0]).head<2>());
    if (area < 0) std::swap(t[1], t[2]);
    if (area != 0) out.push_back(std::move(t));
  }
  return out;
}

bool apart(const Polygon& a, const Polygon& b) {
  for (int axis = 0; axis < 2; ++axis) {
    const auto [a0, a1] = std::minmax({a[0][axis], a[1][axis], a[2][axis]});
    const auto [b0, b1] = std::minmax({b[0][axis], b[1][axis], b[2][axis]});
    if (a1 <= b0 || b1 <= a0) return true;
  }
  return false;
}

/// Where the shadows of two facets lie on each other, in convex pieces.
std::vector<Polygon> overlap_of(const std::vector<Polygon>& first, const std::vector<Polygon>& second) {
  std::vector<Polygon> out;
  const detail::ShadowGrid grid(second);
  detail::InterruptionPoll poll(256);
  for (const Polygon& a : first) {
    for (const int near : grid.near(a)) {
      poll();
      const Polygon& b = second[near];
      if (apart(a, b)) continue;
      Polygon piece = a;
      for (std::size_t i = 0; i < b.size() && !piece.empty(); ++i) {
        const Eigen::Vector2d edge = (b[(i + 1) % b.size()] - b[i]).head<2>(), out_of(edge.y(), -edge.x());
        piece = detail::clip_polygon(piece, {out_of, out_of.dot(b[i].head<2>())});
      }
      if (piece.size() >= 3) out.push_back(std::move(piece));
    }
  }
  return out;
}

/// Area and its centre.
std::pair<double, Eigen::Vector2d> area_and_centre(const std::vector<Polygon>& pieces) {
  double area = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Polygon& p : pieces) {
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
      const double part = detail::edge_side((p[i] - p[0]).head<2>(), (p[i + 1] - p[0]).head<2>()) / 2;
      area += part;
      sum += part / 3 * (p[0] + p[i] + p[i + 1]).head<2>();
    }
  }
  return {area, area > 0 ? Eigen::Vector2d(sum / area) : Eigen::Vector2d::Zero()};
}

/// The longest that a pad may overlap: the extent in the direction where it is largest.
double longest_extent(const std::vector<Polygon>& pieces) {
  double longest = 0;
  for (int k = 0; k < kDirections; ++k) {
    const double turn = detail::kPi * k / kDirections;
    const Eigen::Vector2d along(std::cos(turn), std::sin(turn));
    double low = detail::kInfinity, high = -detail::kInfinity;
    for (const Polygon& piece : pieces) {
      for (const Eigen::Vector3d& p : piece) {
        low = std::min(low, along.dot(p.head<2>()));
        high = std::max(high, along.dot(p.head<2>()));
      }
    }
    longest = std::max(longest, high - low);
  }
  return longest;
}

/// Height of a facet's plane over a point of the axes' plane: where a facet is tilted, or its centre lies far off, its
/// centre's height is another one.
double height_at(const Facet& facet, const Eigen::Matrix3d& axes, const Eigen::Vector2d& place) {
  const Eigen::Vector3d centre = axes.transpose() * facet.centre, normal = axes.transpose() * facet.normal;
  return centre.z() - normal.head<2>().dot(place - centre.head<2>()) / normal.z();
}

}  // namespace

void OppositeFacetsOptions::check() const {
  require(facet_angle > 0 && facet_angle <= 0.5, "facet_angle", facet_angle, "must be in (0, 0.5] [rad]");
  require(parallel_angle > 0 && parallel_angle <= 0.5, "parallel_angle", parallel_angle, "must be in (0, 0.5] [rad]");
  require_positive(min_contact, "min_contact", "m");
  require_positive(max_width, "max_width", "m");
}

void visit_opposite_facets(const TriangleMesh& mesh, const std::vector<int>& faces,
                           const OppositeFacetsOptions& options,
                           const std::function<void(const OppositeFacets&)>& visit) {
  options.check();
  std::vector<Facet> facets = planar_facets(mesh, faces, options.facet_angle);
  const double least_area = (1 - kRounding) * options.min_contact * options.min_contact;
  while (!facets.empty() && facets.back().area < least_area) facets.pop_back();
  detail::InterruptionPoll poll;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    for (std::size_t k = i + 1; k < facets.size(); ++k) {
      poll();
      const Facet &a = facets[i], &b = facets[k];
      if (a.normal.dot(b.normal) > -std::cos(options.parallel_angle)) continue;
      OppositeFacets pair{a, b};
      pair.axes = plane_axes((a.normal - b.normal).normalized());
      const double between = pair.axes.col(2).dot(a.centre - b.centre);
      if (between <= kThinnest || !detail::at_most(between, options.max_width)) continue;
      pair.overlap = overlap_of(shadow(mesh, a, pair.axes), shadow(mesh, b, pair.axes));
      std::tie(pair.area, pair.middle) = area_and_centre(pair.overlap);
      // Faces beside each other whose rough edges overlap by a hair are no pair.
      if (pair.area < least_area || longest_extent(pair.overlap) < options.min_contact - kRounding) continue;
      const double above = height_at(a, pair.axes, pair.middle), below = height_at(b, pair.axes, pair.middle);
      pair.width = above - below;
      pair.height = (above + below) / 2;
      if (pair.width > kThinnest) visit(pair);
    }
  }
}

}  // namespace mmgrasp
