#include "geometry/segmentation/refine_models.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
constexpr int kSteps = 10;

}  // namespace

double RoundFit::distance(const Vector3d& x, Vector3d& normal) const {
  const Vector3d d = x - point;
  if (kind == Kind::sphere) {
    normal = d.norm() > 0 ? Vector3d(d.normalized()) : axis;
    return d.norm() - radius;
  }
  const double along = d.dot(axis);
  const Vector3d radial = d - along * axis;
  const Vector3d outward = radial.norm() > 0 ? Vector3d(radial.normalized()) : axis.unitOrthogonal();
  if (kind == Kind::cylinder) {
    normal = outward;
    return radial.norm() - radius;
  }
  // A cone's surface runs from the apex against the axis.
  normal = std::cos(half_angle) * outward + std::sin(half_angle) * axis;
  return d.dot(normal);
}

bool refine_cylinder(const std::vector<Vector3d>& points, const std::vector<double>& weights, RoundFit& cylinder) {
  for (int step = 0; step < kSteps; ++step) {
    const Vector3d u = cylinder.axis.unitOrthogonal(), v = cylinder.axis.cross(u);
    // Unknowns: tilt towards u and v, shift along u and v, and the radius.
    Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
    Eigen::Matrix<double, 5, 1> right = Eigen::Matrix<double, 5, 1>::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3d d = points[i] - cylinder.point;
      const double height = d.dot(cylinder.axis);
      const Vector3d radial = d - height * cylinder.axis;
      const double distance = radial.norm();
      if (distance <= 0) continue;
      const double a = radial.dot(u) / distance, b = radial.dot(v) / distance;
      Eigen::Matrix<double, 5, 1> row;
      row << -height * a, -height * b, -a, -b, -1;
      normal += weights[i] * row * row.transpose();
      right -= weights[i] * (distance - cylinder.radius) * row;
    }
    const Eigen::Matrix<double, 5, 1> change = normal.ldlt().solve(right);
    if (!change.allFinite()) return false;
    cylinder.point += change[2] * u + change[3] * v;
    cylinder.axis = (cylinder.axis + change[0] * u + change[1] * v).normalized();
    cylinder.radius += change[4];
  }
  return cylinder.radius > 0 && cylinder.point.allFinite();
}

std::optional<RoundFit> cylinder_through(const std::vector<Vector3d>& points, const std::vector<Vector3d>& normals) {
  if (points.size() < 6) return std::nullopt;
  Matrix3d scatter = Matrix3d::Zero();
  for (const Vector3d& n : normals) scatter += n * n.transpose();
  RoundFit out;
  out.axis = Eigen::SelfAdjointEigenSolver<Matrix3d>(scatter).eigenvectors().col(0);
  const Vector3d u = out.axis.unitOrthogonal(), v = out.axis.cross(u);
  // A circle through the points seen along the axis: x^2 + y^2 = 2 a x + 2 b y + c.
  Matrix3d normal = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  double middle = 0;
  for (const Vector3d& p : points) {
    const double x = p.dot(u), y = p.dot(v);
    const Vector3d row(2 * x, 2 * y, 1);
    normal += row * row.transpose();
    right += (x * x + y * y) * row;
    middle += p.dot(out.axis) / static_cast<double>(points.size());
  }
  const Vector3d circle = normal.ldlt().solve(right);
  const double square = circle[2] + circle[0] * circle[0] + circle[1] * circle[1];
  if (!circle.allFinite() || square <= 0) return std::nullopt;
  out.point = circle[0] * u + circle[1] * v + middle * out.axis;
  out.radius = std::sqrt(square);
  if (!refine_cylinder(points, std::vector<double>(points.size(), 1), out)) return std::nullopt;
  return out;
}

std::optional<RoundFit> cone_through(const std::vector<Vector3d>& points, const std::vector<Vector3d>& normals) {
  if (points.size() < 6) return std::nullopt;
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& n : normals) mean += n / static_cast<double>(normals.size());
  // The normals of a cone end on a circle, whose plane lies across the axis.
  Matrix3d scatter = Matrix3d::Zero(), apex = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    scatter += (normals[i] - mean) * (normals[i] - mean).transpose();
    apex += normals[i] * normals[i].transpose();
    right += normals[i] * normals[i].dot(points[i]);
  }
  RoundFit out;
  out.kind = RoundFit::Kind::cone;
  out.axis = Eigen::SelfAdjointEigenSolver<Matrix3d>(scatter).eigenvectors().col(0);
  if (mean.dot(out.axis) < 0) out.axis = -out.axis;
  out.half_angle = std::asin(std::clamp(mean.dot(out.axis), -1.0, 1.0));
  out.point = apex.ldlt().solve(right);
  if (!out.point.allFinite() || out.half_angle < 0.03 || out.half_angle > 1.45) return std::nullopt;
  return out;
}

std::optional<RoundFit> sphere_through(const std::vector<Vector3d>& points) {
  if (points.size() < 5) return std::nullopt;
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (const Vector3d& p : points) {
    const Eigen::Vector4d row(2 * p.x(), 2 * p.y(), 2 * p.z(), 1);
    normal += row * row.transpose();
    right += p.squaredNorm() * row;
  }
  const Eigen::Vector4d sphere = normal.ldlt().solve(right);
  const double square = sphere[3] + sphere.head<3>().squaredNorm();
  if (!sphere.allFinite() || square <= 0) return std::nullopt;
  RoundFit out;
  out.kind = RoundFit::Kind::sphere;
  out.point = sphere.head<3>();
  out.radius = std::sqrt(square);
  return out;
}

}  // namespace mmgrasp::detail
