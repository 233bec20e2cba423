#pragma once

#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/geometry/shape.hpp"
#include "mmgrasp/grasp/gripper.hpp"
#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp {

/// One way to hold an object.
struct MMGRASP_EXPORT Grasp {
  Pose T_object_tcp = Pose::Identity();
  double width = 0;    ///< Distance between the contacts [m]: the fingers' opening while holding.
  double quality = 1;  ///< Larger is better, in [0, 1].
};

struct MMGRASP_EXPORT GraspSamplerOptions {
  int approaches = 8;  ///< Approach directions around each closing axis; > 0.
  int positions = 3;   ///< Pad positions along each free direction of a box or cylinder (odd: the middle first); > 0.
  int mesh_samples = 400;  ///< Surface points tried on a mesh; > 0.
  int max_grasps = 200;    ///< Best kept, spread over approach directions; > 0.
  double friction =
      0.5;  ///< Coulomb coefficient; an antipodal pair's normals lie within atan(friction) of its axis; > 0.
  double standoff = 0.0;  ///< How far the tcp stays outside the object's middle along the approach [m].
  unsigned seed = 1;
  void check() const;
};

/// Antipodal grasps of a rigid body (box, cylinder, sphere, mesh or several shapes; P1 3.4.1, Algorithm 3): contact
/// pairs, tool centre point midway, approach directions across the closing axis. Pairs wider than the gripper are
/// counted in `too_wide`: a pair is too wide when it exceeds max_opening; a part that leaves less than the wanted
/// clearance is kept (the gap shrinks, see Gripper::pregrasp_opening) with a lower quality. Sorted by quality, then by
/// order of sampling.
///
/// Both hands of a grasp are given: turned by half a turn about the approach axis the same contacts are another grasp.
/// T_object_tcp turns Gripper::approach into the direction the hand moves in and Gripper::closing into the line of
/// contact. A single box, cylinder, sphere or capsule is sampled in closed form; anything else by rays through its
/// triangles: solids from outside to outside of their union, open surfaces from wall to wall. Quality is a product of
/// factors in [0.5, 1]: normals along the contact line, line through the centre of mass, share of the pad on a flat
/// face (boxes), little material behind the pads, clearance left. Collisions of the hand are not looked at here. Throws
/// InvalidInput on an empty object, a plane, a bad shape, gripper or option.
MMGRASP_EXPORT std::vector<Grasp> sample_grasps(const std::vector<LinkShape>& object, const Gripper& gripper,
                                                const GraspSamplerOptions& options = {}, int* too_wide = nullptr);

}  // namespace mmgrasp
