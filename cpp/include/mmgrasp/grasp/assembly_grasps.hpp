#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/geometry/opposite_facets.hpp"
#include "mmgrasp/grasp/finger_length_range.hpp"

namespace mmgrasp {

/// The fingers that jaw_grasps() and centric_grasps() put at a segment, and how densely they try approaches.
struct MMGRASP_EXPORT AssemblyGraspOptions {
  double facet_angle =
      OppositeFacetsOptions{}
          .facet_angle;  ///< Faces of one facet bend no more than this from its largest one [rad]; in (0, 0.5].
  double parallel_angle =
      OppositeFacetsOptions{}
          .parallel_angle;  ///< Facets held between jaws are off parallel by no more [rad]; in (0, 0.5].
  int directions = 12;      ///< Approaches in a turn about the closing axis, or turns of centric fingers; in [1, 360].
  double min_contact =
      OppositeFacetsOptions{}
          .min_contact;       ///< Length along the approach by which a pad must overlap the segment [m], > 0.
  double pad_length = 0.02;   ///< Length of a pad along the approach [m], >= min_contact.
  double max_opening = 0.25;  ///< Wider segments are left out [m], > 0.
  double finger_width = UsualFingers{}.width, finger_thickness = UsualFingers{}.thickness,
         clearance = 0.002;    ///< See AssemblyGrasp [m].
  double tip_clearance = 0;    ///< Tips end this short of the far end of what they hold, as far as min_contact
                               ///< lets them [m], >= 0.
  double palm_margin = 0.005;  ///< The palm reaches beyond the open fingers by this [m], >= 0.
  void check() const;          ///< Throws InvalidInput naming field, value and rule.
};

/// A cylinder that fits a segment: z is its axis, `low` and `high` its ends along it.
struct MMGRASP_EXPORT CylinderFit {
  Pose T_mesh_cylinder = Pose::Identity();
  double diameter = 0;       ///< [m], > 0.
  double low = 0, high = 0;  ///< [m], low < high.
};

/// Grasps by two parallel jaws: pairs of opposite, nearly parallel facets of a segment (`faces`; empty: the whole mesh)
/// whose shadows on each other overlap, approached from every direction across the closing axis; the tips reach past
/// the overlap's near end by `min_contact`, by half a pad and by a pad, as far as the overlap goes (P1 5.3.3,
/// figure 5.12). Pads stop at the outermost point of the facets under them: that is the opening where faces are rough
/// or tilted. Other faces of the segment count for it as far as they stand out of a facet by no more than its own
/// points under the pad differ.
MMGRASP_EXPORT std::vector<AssemblyGrasp> jaw_grasps(const TriangleMesh& mesh, const std::vector<int>& faces = {},
                                                     const AssemblyGraspOptions& options = {});

/// Grasps by three centric fingers: the axes of gripper and cylinder fall together, from either end, fingers turned in
/// steps, at the same depths (P1 5.2.3).
MMGRASP_EXPORT std::vector<AssemblyGrasp> centric_grasps(const CylinderFit& cylinder,
                                                         const AssemblyGraspOptions& options = {});

/// The same for the cylinder of a segment (`faces`; empty: the whole mesh) whose wall is rough: fingers open as far as
/// its outermost point under a pad. The wall's points are off the cylinder by six times the median at most, and by no
/// more than a wall turned by `parallel_angle` along a pad; what stands out farther is left to be met.
MMGRASP_EXPORT std::vector<AssemblyGrasp> centric_grasps(const TriangleMesh& mesh, const std::vector<int>& faces,
                                                         const CylinderFit& cylinder,
                                                         const AssemblyGraspOptions& options = {});

}  // namespace mmgrasp
