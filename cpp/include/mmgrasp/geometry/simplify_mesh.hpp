#pragma once

#include <memory>
#include <string>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp {

/// What may stand in for a mesh in collision checks.
struct MMGRASP_EXPORT MeshStandIn {
  std::string chosen = "mesh";  ///< "mesh" (nothing better), "box", "sphere", "cylinder", "hull" or "decimated".
  Shape shape = MeshShape{};    ///< The mesh itself for "mesh", and for "hull" when the mesh is convex already.
  Pose T_mesh_shape = Pose::Identity();
  int triangles_saved = 0;  ///< Triangles of the mesh less those of the stand-in.
  double deviation = 0;     ///< Proven: no point of the stand-in lies farther than this from the mesh [m].
};

/// The simplest solid that contains the mesh (up to rounding, 1e-9 of its size) and has no point farther than
/// `tolerance` [m] from it: a primitive, else its hull, else one of fewer triangles if the mesh is closed. Points
/// inside a closed mesh belong to it; an open mesh is a surface, from which the inside of a stand-in is away too. With
/// tolerance 0 the solid stays the same: a closed convex mesh is its hull, one with the eight corners of a box (to 1e-9
/// of its size) that box, any other stays a mesh. The bound is no sample: for primitives it follows from convexity (the
/// distance from a convex set is largest at extreme points), for others from subdividing space until every cell's
/// centre distance plus half its diagonal is below it. A bound that is not reached within a fixed number of cells
/// counts as not met. Throws InvalidInput for a negative or infinite tolerance.
MMGRASP_EXPORT MeshStandIn simplify_mesh(const std::shared_ptr<const TriangleMesh>& mesh, double tolerance = 0);

/// Upper bound of the distance from any point of a closed mesh to another mesh [m], refined until it is below `limit`
/// and within a tenth of the truth, or the work is used up; infinite when a point farther than `limit` was found.
/// Throws InvalidInput when `solid` is open or the limit is not positive and finite.
MMGRASP_EXPORT double bound_deviation(const TriangleMesh& solid, const TriangleMesh& mesh, double limit);

}  // namespace mmgrasp
