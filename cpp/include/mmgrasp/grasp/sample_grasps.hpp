#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/grasp/grasp.hpp"
#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp {

/// Approaches within this angle of a direction are straight along it [rad]: poses with angles of four decimals are.
inline constexpr double kStraightApproach = 1e-3;

/// How densely sample_grasps() covers a body with grasps, and which pairs of contacts it takes for antipodal.
struct MMGRASP_EXPORT GraspSamplerOptions {
  int approaches = 8;  ///< Approach directions around each closing axis; > 0.
  int positions = 3;   ///< Pad positions along each free direction of a box or cylinder (odd: the middle first); > 0.
  /// Surface points tried on a mesh, eight times as many where few pairs fit the hand, and on its hull unless it is
  /// convex; > 0.
  int mesh_samples = 400;
  int max_grasps = 200;  ///< Best kept, spread over approach directions; > 0.
  /// Coulomb coefficient; an antipodal pair's normals lie within atan(friction) of its axis; > 0.
  double friction = 0.5;
  /// How far the tool frame stays before the contacts along the approach [m]. Pads that then miss them (farther off
  /// than half their length), or a box' faces, hold nothing: such grasps are left out.
  double standoff = 0.0;
  /// Every grasp approaches along this unit vector in the object's frame, within kStraightApproach. None: all around.
  std::optional<Eigen::Vector3d> approach_direction{};
  unsigned seed = 1;
  void check() const;
};

/// Antipodal grasps of a rigid body (box, cylinder, sphere, mesh or several shapes; P1 3.4.1, Algorithm 3): pairs of
/// opposed contacts, tool frame midway, approach directions across the closing axis. Sorted by quality, then by order
/// of sampling.
///
/// - Both hands of a grasp are given: turned by half a turn about the approach axis the same contacts are another
/// grasp.
/// - T_object_hand turns Hand::approach into the direction the hand moves in and Hand::closing into the line of
/// contact.
/// - A single box, cylinder, sphere or capsule is sampled in closed form; anything else by rays through its triangles:
///   solids from outside to outside of their union, open surfaces from wall to wall. There the pads, flat and of
///   finger_depth x finger_width, rest on the outermost points under them: that gives opening and middle of the grasp.
///   Left out are those at which what they touch is steeper than friction allows, or lies so far apart on the two sides
///   that the part would turn. What leaves no room for a finger behind a pad counts as under it. Crests of a closed
///   mesh (threads, grooves) hold like the convex hull over them where a pad touches more than one edge can.
/// - Where the tips of the pads would reach beyond the object's far face along the approach, since it is thinner than
///   they are long or the contacts are near that face, a second hand stops with them flush with it (`tips_flush`): the
///   object may lie on something. It goes first among equally good ones; pairs one behind the other give one such hand.
/// - With an `approach_direction` contacts are sought across it: round shapes in closed form, meshes along lines across
/// it. A box, cylinder or capsule that is neither along nor across it is sampled as its mesh.
/// - Pairs wider than max_opening are counted in `too_wide`, those too wide under the pads from everywhere as well. A
/// part that leaves less than the wanted clearance is kept
///   (the clearance shrinks, see Hand::pregrasp_opening) with a lower quality.
/// - Quality has five parts of weight 0.5: `alignment` of the normals with the contact line, `centring` of that line on
///   the centre of mass, `support` (share of the pad on a flat face), `insertion` (little material behind the pads) and
///   `clearance` left.
///
/// Collisions of the hand are not checked here. Throws InvalidInput on an empty object, a plane, a bad shape, hand or
/// option.
MMGRASP_EXPORT SampledGrasps sample_grasps(const std::vector<LinkShape>& object, const Hand& hand,
                                           const GraspSamplerOptions& options = {});

}  // namespace mmgrasp
