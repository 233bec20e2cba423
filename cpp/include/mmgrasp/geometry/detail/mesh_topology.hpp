#pragma once

#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::detail {

/// Shells of a mesh: triangles joined over edges.
struct Shells {
  std::vector<int> shell_of_triangle;
  int count = 0;
};

/// Shells that lie wholly within the material of others and change nothing there.
struct EnclosedBodies {
  int count = 0, triangles = 0;
};

/// Orients the triangles of a mesh without boundary consistently and outwards (voids inwards), and leaves out what lies
/// wholly in material: geometry/nested_shells says which shell is what. False, with the triangles untouched, when an
/// edge is not shared by pairs of triangles or the surface is one-sided.
bool orient_closed(const std::vector<Eigen::Vector3d>& vertices, std::vector<std::array<int, 3>>& triangles,
                   EnclosedBodies* enclosed = nullptr);

/// Turns the triangles of an open mesh that look another way than their neighbours over edges of two triangles: each
/// shell then looks away from its middle or, where it encloses nothing, as most of its area did. Shells at one with
/// themselves stay as they are. False, with the triangles untouched, when the surface is one-sided.
bool orient_open(const std::vector<Eigen::Vector3d>& vertices, std::vector<std::array<int, 3>>& triangles);

/// Triangles grouped by shared edges; works for open meshes too.
Shells find_shells(const std::vector<std::array<int, 3>>& triangles);

/// True when the closed, outward oriented mesh is one shell and equals its convex hull up to rounding.
bool is_convex(const TriangleMesh& mesh);

/// Twice the signed area of the shadow triangle (a, b) with the origin; exactly antisymmetric in a and b.
inline double edge_side(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Signed count of how often triangle (a, b, c) is crossed by the ray from the origin along the generic direction: +1
/// when the ray leaves through its front, -1 when it enters, 0 when it misses. Neighbours decide alike on a shared
/// edge, so that the sum over a closed mesh is its winding number around the origin. The ray caster's test
/// (geometry/hierarchy) cannot stand in for it: a ray through an edge meets both triangles there, which does no harm to
/// a nearest hit but would count one crossing twice.
int ray_crossing(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Direction of that ray, not normalised: z is 1.
Eigen::Vector3d ray_direction();

}  // namespace mmgrasp::detail
