#pragma once

#include <fcl/geometry/collision_geometry.h>
#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/robot/robot_source.hpp"

namespace mmgrasp::verify::detail {

using Bounds = Eigen::AlignedBox3d;

/// One shape fixed to a body, as FCL sees it.
struct Solid {
  std::shared_ptr<const fcl::CollisionGeometryd> geometry;
  /// The triangles of a mesh or a box: between triangles FCL's distances are right, of boxes they may be far off.
  std::shared_ptr<const fcl::CollisionGeometryd> faces;
  Pose T_body_shape = Pose::Identity();
  Bounds local;                              ///< Bounds in the shape's frame.
  bool unbounded = false;                    ///< A plane: all that lies below it.
  std::shared_ptr<const TriangleMesh> mesh;  ///< Set for meshes; closed ones are solid inside.
  std::vector<Eigen::Vector3d> probes;       ///< One point on or in each connected piece, shape frame.
};

/// Throws InvalidInput for an unusable shape.
void check_shapes(const std::vector<LinkShape>& shapes);

/// FCL geometry for a shape (voxels give one box each). Throws InvalidInput for an unusable shape.
MMGRASP_EXPORT std::vector<Solid> make_solids(const std::vector<LinkShape>& shapes);

/// Axis-aligned bounds of the solid with its shape frame at T.
Bounds bounds_at(const Solid& solid, const Pose& T_world_shape);

/// True when two solids at these shape frames share a point. A solid wholly inside a closed mesh touches it.
MMGRASP_EXPORT bool touches(const Solid& a, const Pose& T_world_a, const Solid& b, const Pose& T_world_b);

/// True when two solids at these shape frames touch or come closer than `margin` [m].
MMGRASP_EXPORT bool closer_than(double margin, const Solid& a, const Pose& T_world_a, const Solid& b,
                                const Pose& T_world_b);

/// Largest distance of any point of the shapes from the body's origin (an upper bound); infinite for planes.
double radius_of(const std::vector<Solid>& solids);

/// Smallest z over all points of the shapes with the body at T; minus infinity for planes.
double lowest_z(const std::vector<LinkShape>& shapes, const Pose& T_world_body);

}  // namespace mmgrasp::verify::detail
