#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/grasp/grasp.hpp"
#include "mmgrasp/structure/beam_frame.hpp"

namespace mmgrasp {

/// Where a frame is held: a hand or a fixture that clamps a member, or hinders only some movements there.
struct MMGRASP_EXPORT BeamSupport {
  int member = 0;
  double distance = 0;  ///< From the member's first node, in [0, its length] [m].
  /// Displacement in x, y, z and rotation about x, y, z of the object's frame.
  std::array<bool, 6> fixed{true, true, true, true, true, true};
};

/// The clamp of a grasp drawn on a pipe: member and distance are its section and length. Throws InvalidInput for
/// others.
MMGRASP_EXPORT BeamSupport beam_support(const Grasp& grasp);

/// A place on a frame and a value there.
struct MMGRASP_EXPORT BeamExtreme {
  double value = 0;
  int member = 0;
  double distance = 0;  ///< From the member's first node [m].
};

/// How a supported frame bends under one load; all of it in the object's frame.
struct MMGRASP_EXPORT BeamState {
  Matrix6Xd nodes;  ///< Displacement [m] and rotation [rad] of each node; 6 x n.
  /// Force [N] and moment [N m] of each support on the frame, about the support's place; 6 x supports.
  Matrix6Xd reactions;
  BeamExtreme displacement;  ///< The largest anywhere along the members [m].
  /// Largest von Mises stress [Pa] of normal force, bending and torsion at the farthest fibres; shear forces, which
  /// are small in slender beams and zero there, are left out. Of the members whose section's extents are known; none
  /// without such a member.
  std::optional<BeamExtreme> stress;
  std::optional<BeamExtreme> over_limit;  ///< Largest stress over its material's limit [1]; none without either.
};

/// A frame held at some places, factorised once for all loads. The load is linear in gravity, so three right-hand sides
/// for gravity along x, y and z, and one for what stays fixed in the object's frame, serve every orientation.
///
///     const SupportedFrame held(frame, {beam_support(grasp)});
///     for (const Pose& T : path) sag += held.largest_displacement(gravity_in_object(T)).value;
///
/// A member is divided where it is held. Throws InvalidInput for a bad frame, supports that are not on it, or supports
/// that leave it movable.
class MMGRASP_EXPORT SupportedFrame {
 public:
  SupportedFrame(const BeamFrame& frame, const std::vector<BeamSupport>& supports);

  /// Displacements, reactions and stresses under gravity, which is given in the object's frame [m/s2].
  BeamState state(const Eigen::Vector3d& gravity) const;
  /// Displacement alone: what a search asks thousands of times. Exact along the members to 1e-9 of its value.
  BeamExtreme largest_displacement(const Eigen::Vector3d& gravity) const;
  /// Displacement in the object's frame at 0 <= distance <= length of a member [m].
  Eigen::Vector3d displacement(const Eigen::Vector3d& gravity, int member, double distance) const;
  /// Normal force, shear forces in y and z [N], torque and bending moments about y and z [N m] in the member's frame at
  /// a cut: what the part beyond does to the part before.
  Vector6d section_forces(const Eigen::Vector3d& gravity, int member, double distance) const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

/// Gravity as an object with this pose feels it, in the object's frame; down is the world's -z.
MMGRASP_EXPORT Eigen::Vector3d gravity_in_object(const Pose& T_world_object, double gravity = kGravity);

}  // namespace mmgrasp
