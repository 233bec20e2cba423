#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/geometry/opposite_facets.hpp"
#include "mmgrasp/geometry/segment_mesh.hpp"

namespace mmgrasp {

/// The simple solids that a segment of a mechanical part is described by.
enum class PrimitiveKind { cylinder, box, cone, sphere };

/// "cylinder", "box", "cone", "sphere".
MMGRASP_EXPORT const char* primitive_kind_name(PrimitiveKind kind);

/// A width at which fingers may close on a segment: opposite facets where a box stands for it, or its round wall.
struct MMGRASP_EXPORT GraspWidth {
  double width = 0;  ///< [m]
  Eigen::Vector3d axis =
      Eigen::Vector3d::UnitX();  ///< Closing direction of a box, axis of a round wall; unit, mesh frame.
  double covered = 0;  ///< Share of the box' shadow along the axis on which facets lie opposite each other, or of the
                       ///< turn around the wall that is surface.
};

/// The primitive that stands for a segment (P1, section 5.2.2).
struct MMGRASP_EXPORT FittedPrimitive {
  PrimitiveKind kind = PrimitiveKind::box;
  Pose T_mesh_primitive = Pose::Identity();  ///< Centre; z along the axis of a cylinder or cone, which narrows along z.
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< Box: lengths; cylinder: (d, d, length); cone: (d at its foot, d
                                                   ///< at its top, length); sphere: (d, d, d) [m].
  double volume = 0;                               ///< Volume of the primitive [m^3].
  double hull_volume = 0;                          ///< Volume of the segment's convex hull [m^3].
  double deviation = 0;  ///< Mean distance of the segment's faces from the primitive's surface they lie on [m].
  std::vector<GraspWidth> widths;  ///< Most covered first; none where the primitive has no surface to hold.
};

/// Fits a cylinder, a box, a cone and a sphere to each segment of a mesh and keeps the one whose volume is closest to
/// that of the segment's convex hull, of those that have surface on them (P1, section 5.2.2; cones and spheres are
/// ours). Cylinders, cones and spheres are found by RANSAC (PCL, Schnabel, Wahl and Klein 2007's criteria: distance and
/// normal) and refined by least squares over the corners of the faces, which lie on the true surface where chords do
/// not. A cylinder is as long as its outward wall: bores, which may run on, do not count. Round walls that face inwards
/// (bores) have no width of their own. Where nothing round lies on the surface, the hull's corners are asked, too:
/// grooves, knurls and flutes have the width of their outline. The widths of a box are those of the pairs of facets by
/// which jaw_grasps() holds it and which its usual fingers reach from outside (visit_opposite_facets(); facets lie
/// opposite each other over at least `min_contact` [m], > 0). `labels`: the segment of each face, as in
/// MeshSegmentation. Throws InvalidInput when there is not one label >= 0 a face, or for threads of other meshes.
/// Nothing when the monitor stops it. A number below the largest label that no face has is an empty segment: a box of
/// no size, without widths. `threads`: those found by segment_mesh(), which count as the cylinder through their crests.
MMGRASP_EXPORT std::vector<FittedPrimitive> fit_primitives(const TriangleMesh& mesh, const std::vector<int>& labels,
                                                           const std::vector<ScrewThread>& threads = {},
                                                           const Monitor& monitor = {},
                                                           double min_contact = OppositeFacetsOptions{}.min_contact);

/// A name for each segment: the kind of its primitive and its place among those of the kind, from 1, in the order of
/// the segments, which segment_mesh() gives by size: "cylinder_1", "box_1", "cylinder_2".
MMGRASP_EXPORT std::vector<std::string> segment_names(const std::vector<FittedPrimitive>& primitives);

}  // namespace mmgrasp
