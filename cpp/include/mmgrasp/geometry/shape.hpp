#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp {

struct Box {
  Eigen::Vector3d size = Eigen::Vector3d::Ones();
};  ///< Full lengths [m], centred.
struct Sphere {
  double radius = 1;
};  ///< [m]
struct Cylinder {
  double radius = 1;
  double length = 1;
};  ///< Along z, centred [m].
struct Capsule {
  double radius = 1;
  double length = 1;
};  ///< Along z, centred; `length` without the caps [m].
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0;
};  ///< Solid where normal . x <= offset.
struct MeshShape {
  std::shared_ptr<const TriangleMesh> mesh;
};
/// Axis-aligned solid voxels of one edge length, e.g. leaves of an OctoMap or a point cloud's cells [m].
struct Voxels {
  std::shared_ptr<const std::vector<Eigen::Vector3d>> centres;
  double resolution = 0.01;
};

using Shape = std::variant<Box, Sphere, Cylinder, Capsule, Plane, MeshShape, Voxels>;

/// Throws InvalidInput naming `field` on a zero, negative, infinite or NaN dimension.
MMGRASP_EXPORT void check_shape(const Shape& shape, const std::string& field);

/// Axis-aligned bounds of the shape placed at T; infinite for a plane.
MMGRASP_EXPORT Eigen::AlignedBox3d shape_bounds(const Shape& shape, const Pose& T = Pose::Identity());

/// "box", "sphere", "cylinder", "capsule", "plane", "mesh", "voxels".
MMGRASP_EXPORT const char* shape_kind(const Shape& shape);

/// Surface as triangles, for pictures and for algorithms that need one. Throws InvalidInput for a plane.
MMGRASP_EXPORT std::shared_ptr<const TriangleMesh> shape_mesh(const Shape& shape, int segments = 24);

}  // namespace mmgrasp
