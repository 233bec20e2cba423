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

/// A solid box centred in its frame, edges along the axes.
struct Box {
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  ///< Full lengths along x, y and z [m].
};
/// A solid sphere around its frame's origin.
struct Sphere {
  double radius = 1;  ///< [m]
};
/// A solid cylinder along z, centred in its frame.
struct Cylinder {
  double radius = 1;  ///< [m]
  double length = 1;  ///< [m]
};
/// A solid cylinder along z with a half sphere on either end, centred in its frame.
struct Capsule {
  double radius = 1;  ///< [m]
  double length = 1;  ///< Length without the half spheres [m].
};
/// A half-space, such as level ground: solid where normal . x <= offset.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< Unit, out of the solid.
  double offset = 0;                                  ///< [m]
};
/// Triangles [m]: a solid where they are closed, else a surface (TriangleMesh::closed).
struct MeshShape {
  std::shared_ptr<const TriangleMesh> mesh;
};
/// Axis-aligned solid voxels of one edge length, e.g. leaves of an OctoMap or a point cloud's cells [m].
struct Voxels {
  std::shared_ptr<const std::vector<Eigen::Vector3d>> centres;
  double resolution = 0.01;
};

/// What a rigid body may be made of; each is placed by a pose beside it (LinkShape, World).
using Shape = std::variant<Box, Sphere, Cylinder, Capsule, Plane, MeshShape, Voxels>;

/// Throws InvalidInput naming `field` on a dimension outside of [1e-9, 1e6] m or a point beyond (core/limits.hpp).
MMGRASP_EXPORT void check_shape(const Shape& shape, const std::string& field);

/// Axis-aligned bounds of the shape placed at T; infinite for a plane.
MMGRASP_EXPORT Eigen::AlignedBox3d shape_bounds(const Shape& shape, const Pose& T = Pose::Identity());

/// "box", "sphere", "cylinder", "capsule", "plane", "mesh", "voxels".
MMGRASP_EXPORT const char* shape_kind(const Shape& shape);

/// Surface as triangles, for pictures and for algorithms that need one. Throws InvalidInput for a plane.
MMGRASP_EXPORT std::shared_ptr<const TriangleMesh> shape_mesh(const Shape& shape, int segments = 24);

}  // namespace mmgrasp
