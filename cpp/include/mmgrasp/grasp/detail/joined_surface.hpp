#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp::detail {

/// The triangles of all shapes of a body, in the body's frame; those without an area are left out.
struct JoinedSurface {
  TriangleMesh mesh;
  bool solid = true;  ///< Every shape is closed.
  /// Uniform density is taken: of volume for solids (shapes that overlap count twice there), of area for open surfaces
  /// [m].
  Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();
};

/// `segments`: how many sides round shapes get.
MMGRASP_EXPORT JoinedSurface joined_surface(const std::vector<LinkShape>& object, int segments = 24);

/// Throws InvalidInput unless the body has shapes, none of them a plane, all sound.
MMGRASP_EXPORT void check_object(const std::vector<LinkShape>& object);

}  // namespace mmgrasp::detail
