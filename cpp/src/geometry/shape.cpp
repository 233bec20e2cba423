#include "mmgrasp/geometry/shape.hpp"

#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {

namespace {

template <class... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};
template <class... Handlers>
Overloaded(Handlers...) -> Overloaded<Handlers...>;

// Read as a matrix, where they lie.
Eigen::Map<const Eigen::Matrix3Xd> columns(const std::vector<Eigen::Vector3d>& points) {
  return {points.empty() ? nullptr : points.front().data(), 3, static_cast<Eigen::Index>(points.size())};
}

Eigen::AlignedBox3d around(const Eigen::Vector3d& centre, const Eigen::Vector3d& half) {
  return {Eigen::Vector3d(centre - half), Eigen::Vector3d(centre + half)};
}

// Half extents of a disc of this radius whose axis is the unit vector z.
Eigen::Vector3d disc_half(const Eigen::Vector3d& z, double radius) {
  return radius * (1.0 - z.array().square()).max(0.0).sqrt().matrix();
}

}  // namespace

void check_shape(const Shape& shape, const std::string& field) {
  std::visit(Overloaded{
                 [&](const Box& s) {
                   const char* names[] = {".size.x", ".size.y", ".size.z"};
                   for (int k = 0; k < 3; ++k) require_length(s.size[k], field + names[k]);
                 },
                 [&](const Sphere& s) { require_length(s.radius, field + ".radius"); },
                 [&](const Cylinder& s) {
                   require_length(s.radius, field + ".radius");
                   require_length(s.length, field + ".length");
                 },
                 [&](const Capsule& s) {
                   require_length(s.radius, field + ".radius");
                   require_within(s.length, 0, kLargestLength, field + ".length", "m");
                 },
                 [&](const Plane& s) {
                   require_coordinate(s.offset, field + ".offset");
                   require(s.normal.allFinite() && std::abs(s.normal.norm() - 1) < 1e-6, field + ".normal length",
                           s.normal.norm(), "must be a unit vector");
                 },
                 [&](const MeshShape& s) {
                   require(s.mesh != nullptr, field + ".mesh", "null", "must be set");
                   require(!s.mesh->triangles.empty(), field + ".mesh", "0 triangles", "must hold at least one");
                   require_positions(columns(s.mesh->vertices), field + ".mesh vertex");
                 },
                 [&](const Voxels& s) {
                   require_length(s.resolution, field + ".resolution");
                   require(s.centres != nullptr, field + ".centres", "null", "must be set");
                   require_positions(columns(*s.centres), field + ".centres");
                 },
             },
             shape);
}

Eigen::AlignedBox3d shape_bounds(const Shape& shape, const Pose& T) {
  const Eigen::Matrix3d R = T.linear();
  const Eigen::Vector3d t = T.translation();
  return std::visit(
      Overloaded{
          [&](const Box& s) { return around(t, R.cwiseAbs() * (0.5 * s.size)); },
          [&](const Sphere& s) { return around(t, Eigen::Vector3d::Constant(s.radius)); },
          [&](const Cylinder& s) {
            return around(t, disc_half(R.col(2), s.radius) + 0.5 * s.length * R.col(2).cwiseAbs());
          },
          [&](const Capsule& s) {
            return around(t, Eigen::Vector3d::Constant(s.radius) + 0.5 * s.length * R.col(2).cwiseAbs());
          },
          [&](const Plane&) { return around(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(detail::kInfinity)); },
          [&](const MeshShape& s) {
            Eigen::AlignedBox3d box;
            for (const Eigen::Vector3d& v : s.mesh->vertices) box.extend(T * v);
            return box;
          },
          [&](const Voxels& s) {
            Eigen::AlignedBox3d box;
            for (const Eigen::Vector3d& c : *s.centres) box.extend(T * c);
            const Eigen::Vector3d half = R.cwiseAbs() * Eigen::Vector3d::Constant(0.5 * s.resolution);
            if (!box.isEmpty()) box = {Eigen::Vector3d(box.min() - half), Eigen::Vector3d(box.max() + half)};
            return box;
          },
      },
      shape);
}

const char* shape_kind(const Shape& shape) {
  constexpr const char* names[] = {"box", "sphere", "cylinder", "capsule", "plane", "mesh", "voxels"};
  return names[shape.index()];
}

}  // namespace mmgrasp
