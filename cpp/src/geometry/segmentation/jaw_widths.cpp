#include "geometry/segmentation/jaw_widths.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/geometry/opposite_facets.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

constexpr double kSameWidth = 1e-5;  // Widths of smooth faces that differ by less are one [m].
constexpr double kRough = 4;         // Those of rough faces may differ by so many of their standard deviations.

/// Standard deviation of a facet's corners from its plane [m].
double roughness(const TriangleMesh& mesh, const Facet& facet) {
  double sum = 0;
  for (const int f : facet.faces) {
    for (const int v : mesh.triangles[f]) {
      const double off = facet.normal.dot(mesh.vertices[v] - facet.centre);
      sum += off * off / 3;
    }
  }
  return std::sqrt(sum / static_cast<double>(facet.faces.size()));
}

/// The area that a box' shadow along an axis has [m^2].
double shadow_of(const FittedPrimitive& box, const Vector3d& axis) {
  const Vector3d along = (box.T_mesh_primitive.linear().transpose() * axis).cwiseAbs();
  const Vector3d& s = box.size;
  return along.x() * s.y() * s.z() + along.y() * s.z() * s.x() + along.z() * s.x() * s.y();
}

}  // namespace

std::vector<GraspWidth> jaw_widths(const TriangleMesh& mesh, const std::vector<int>& faces, const FittedPrimitive& box,
                                   double min_contact, JawReach& reach) {
  OppositeFacetsOptions options;
  options.min_contact = min_contact;
  std::vector<GraspWidth> out;
  std::vector<double> areas;
  visit_opposite_facets(mesh, faces, options, [&](const OppositeFacets& pair) {
    if (!reach.reaches(pair)) return;
    const Vector3d axis = pair.axes.col(2);
    const double near = kSameWidth + kRough * (roughness(mesh, pair.first) + roughness(mesh, pair.second));
    std::size_t k = 0;
    while (k < out.size() && (std::abs(axis.dot(out[k].axis)) < std::cos(options.parallel_angle) ||
                              std::abs(pair.width - out[k].width) > near))
      ++k;
    if (k == out.size()) {
      out.push_back({pair.width, axis, 0});
      areas.push_back(0);
    }
    areas[k] += pair.area;
    out[k].width += pair.area / areas[k] * (pair.width - out[k].width);
  });
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double shadow = shadow_of(box, out[k].axis);
    out[k].covered = shadow > 0 ? std::min(1.0, areas[k] / shadow) : 0;
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const GraspWidth& a, const GraspWidth& b) { return a.covered > b.covered; });
  return out;
}

}  // namespace mmgrasp::detail
