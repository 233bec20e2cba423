#include "mmgrasp/geometry/distance_field.hpp"

#include "geometry/hierarchy/triangle_tree.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

}  // namespace

DistanceField::~DistanceField() = default;

double DistanceField::distance(const Vector3d& point) const {
  return distances(Eigen::Matrix3Xd(point))[0];
}

Eigen::VectorXd DistanceField::distances(const Eigen::Matrix3Xd& points) const {
  require_positions(points, "point");
  Eigen::VectorXd out(points.cols());
  evaluate(points, out, nullptr);
  return out;
}

Eigen::VectorXd DistanceField::distances(const Eigen::Matrix3Xd& points, Eigen::Matrix3Xd& gradients) const {
  require_positions(points, "point");
  Eigen::VectorXd out(points.cols());
  gradients.resize(3, points.cols());
  evaluate(points, out, &gradients);
  return out;
}

MeshDistanceField::MeshDistanceField(const TriangleMesh& mesh) {
  require(mesh.closed && !mesh.triangles.empty(), "mesh", mesh.source.empty() ? "open" : "'" + mesh.source + "'",
          "must be closed: an open surface has no inside");
  tree_ = std::make_shared<detail::TriangleTree>(mesh);
}

DistanceFieldProperties MeshDistanceField::properties() const {
  const Vector3d everywhere = Vector3d::Constant(detail::kInfinity);
  return {Eigen::AlignedBox3d(Vector3d(-everywhere), everywhere)};
}

void MeshDistanceField::evaluate(const Eigen::Matrix3Xd& points, Eigen::VectorXd& distances,
                                 Eigen::Matrix3Xd* gradients) const {
  // Nearer than this the way to the surface is rounding; its normal is not.
  const double on_surface = 1e-12 * tree_->bounds().diagonal().norm();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Vector3d p = points.col(i);
    const detail::NearestTriangle nearest = tree_->nearest(p);
    const double sign = tree_->bounds().contains(p) && tree_->contains(p) ? -1 : 1;
    distances[i] = sign * nearest.distance;
    if (!gradients) continue;
    const Vector3d a = tree_->corner(nearest.packet, nearest.lane, 0),
                   b = tree_->corner(nearest.packet, nearest.lane, 1),
                   c = tree_->corner(nearest.packet, nearest.lane, 2);
    const Vector3d way = sign * (p - detail::closest_on_triangle(p, a, b, c));
    gradients->col(i) = nearest.distance > on_surface ? way.normalized() : (b - a).cross(c - a).normalized();
  }
}

}  // namespace mmgrasp
