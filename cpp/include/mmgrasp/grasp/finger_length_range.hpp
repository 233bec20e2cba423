#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp {

/// A part where it is in its subassembly. Closed meshes are solids, open ones surfaces.
struct MMGRASP_EXPORT PlacedMesh {
  std::string name;  ///< For messages.
  std::shared_ptr<const TriangleMesh> mesh;
  Pose pose = Pose::Identity();  ///< T_subassembly_mesh.
};

/// One operation of an assembly (P1 5.3.1): a gripper brings the active subassembly to the passive one, lets go of it
/// and moves away, back along its approach.
struct MMGRASP_EXPORT AssemblyOperation {
  std::vector<PlacedMesh> active;   ///< Held; not empty.
  std::vector<PlacedMesh> passive;  ///< Stays where it is: fixture and table too.
  /// T_passive_active from before the operation to its end, at least one pose. Between two of them the middle of the
  /// box around the active parts goes straight, and they turn evenly. The last one is where the gripper opens.
  std::vector<Pose> motion;
  std::string name = {};       ///< For messages and results.
  double insertion_force = 0;  ///< With which the hole resists, against the motion's last straight line [N]; >= 0.
  /// A point on the hole's axis, in the frame of the active subassembly [m]; none: its centre of mass.
  std::optional<Eigen::Vector3d> hole = {};
  void check() const;  ///< Throws InvalidInput: a mesh missing, no motion, poses that are none, a force without a way.
};

/// How a gripper with straight fingers takes the active subassembly. The tool frame lies in the plane of the finger
/// tips with z along the approach; the first finger moves along x.
struct MMGRASP_EXPORT AssemblyGrasp {
  Pose T_active_tool = Pose::Identity();
  int fingers = 2;            ///< 2: parallel jaws, 3: centric fingers.
  double opening = 0.02;      ///< Between the pads while it holds, or the diameter that three of them touch [m]; > 0.
  double width = 0.015;       ///< Width of a finger, across approach and closing direction [m]; > 0.
  double thickness = 0.008;   ///< Thickness of a finger, along the closing direction [m]; > 0.
  double clearance = 0.002;   ///< How far each finger opens to approach and to let go [m]; >= 0.
  double palm_radius = 0.03;  ///< Radius of the palm and of all behind it, about the tool's z [m]; > 0.
  /// How far a pad overlaps what it holds, along the approach from the tips and across it [m]; >= 0, 0: not known.
  double contact_length = 0, contact_width = 0;
  void check() const;  ///< Throws InvalidInput naming field, value and rule.
};

/// Which finger lengths take a part through an operation: P1's L- and L+, from the geometry alone. Where there is none,
/// both are as far as was looked.
struct MMGRASP_EXPORT FingerLengthRange {
  bool free = false;                                         ///< There is such a length.
  double shortest = 0;                                       ///< The palm meets nothing [m].
  double longest = std::numeric_limits<double>::infinity();  ///< The fingers meet nothing [m].
  /// What sets `shortest`, and what sets `longest` or leaves no length at all: "<mesh> at <when>", or empty.
  std::string shortest_by, longest_by;
};

/// The finger lengths with which neither fingers nor palm meet the subassemblies: while the gripper approaches the
/// active one, along the whole motion, and while it opens and moves back at the end (P1 5.3.2 and 5.3.3). The palm and
/// what carries it count as endless behind the finger's roots. Exact for motions along the approach; others are looked
/// at every `step` [m] of what moves farthest, with as much margin as is moved between two looks. Touching within
/// 1e-6 m is no collision.
/// Throws InvalidInput for a wrong grasp, operation or step.
MMGRASP_EXPORT FingerLengthRange finger_length_range(const AssemblyGrasp& grasp, const AssemblyOperation& operation,
                                                     double step = 0.0005);

}  // namespace mmgrasp
