#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/structure/beam_section.hpp"
#include "mmgrasp/structure/pipe.hpp"

namespace mmgrasp {

struct BeamState;
struct BeamSupport;
struct Grasp;
inline constexpr double kGravity = 9.81;  ///< [m/s2], as P2 takes it.

/// A straight beam welded to its two nodes.
struct MMGRASP_EXPORT BeamMember {
  std::array<int, 2> nodes{};  ///< First and second; x of the cross section runs from the first to the second.
  BeamSection section;
  BeamMaterial material;
  /// y of the cross section is this direction of the object's frame turned into the plane across the member; zero: as
  /// in Pipe::T_object_section.
  Eigen::Vector3d y_towards = Eigen::Vector3d::Zero();
};

/// What hangs on a node: a mass (a valve, a flange), whose weight turns with gravity, and a force and a moment that
/// stay as they are in the object's frame.
struct MMGRASP_EXPORT NodeLoad {
  int node = 0;
  double mass = 0;                                   ///< [kg]; >= 0.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< [N m]
};

/// A frame of straight Euler-Bernoulli beams, welded at nodes, in the object's frame (P2 3.2.3.3.2): linear elastic,
/// small displacements, no shear deformation. SupportedFrame says how it bends.
///
///     BeamFrame frame = beam_frame(pipe, 0.026, copper());
///     frame.loads.push_back({valve_node, 0.4});  // a valve of 0.4 kg
///     const double mass = frame.mass();
struct MMGRASP_EXPORT BeamFrame {
  std::vector<Eigen::Vector3d> nodes;  ///< [m]
  std::vector<BeamMember> members;
  std::vector<NodeLoad> loads;

  /// Throws InvalidInput naming field, value and rule: finite nodes, each of a member; members at least kShortest long,
  /// no two of the same nodes, all connected; sections and materials that can be, stress limits only where stresses are
  /// known; loads on nodes that exist.
  void check() const;

  static constexpr double kShortest = 1e-6;           ///< [m]
  double length(int member) const;                    ///< Between the member's nodes [m].
  Eigen::Matrix3d R_object_member(int member) const;  ///< Columns: x along the member, y and z of its cross section.
  double mass() const;                                ///< Mass of members and loads together [kg].
  Eigen::Vector3d centre_of_mass() const;             ///< [m]; throws InvalidInput when nothing has mass.
  /// The same frame with a node more on a member, 0 < distance < length: the member keeps the first part, the second
  /// part comes last. Nothing else changes, nor does how it bends.
  BeamFrame split(int member, double distance) const;
  /// How it bends when a hand holds it there in this pose, or several supports do; include supported_frame.hpp. For
  /// many poses of one grasp keep a SupportedFrame. Throws as that does. `gravity` along the world's -z [m/s2].
  BeamState deflection(const Grasp& grasp, const Pose& T_world_object, double gravity = kGravity) const;
  BeamState deflection(const std::vector<BeamSupport>& supports, const Pose& T_world_object,
                       double gravity = kGravity) const;
  /// (6n, 6n) of the free frame: node by node displacement, then rotation, in the object's frame.
  Eigen::MatrixXd stiffness() const;
};

/// A pipe as a frame: member i is section i, a tube of the pipe's diameter and this inner diameter (0: a bar).
MMGRASP_EXPORT BeamFrame beam_frame(const Pipe& pipe, double inner_diameter, const BeamMaterial& material);

}  // namespace mmgrasp
