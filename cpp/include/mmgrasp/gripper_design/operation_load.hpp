#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/gripper_design/grasp_holding.hpp"

namespace mmgrasp {

/// Grasps are to hold the weight of their parts and the resistance of holes.
struct MMGRASP_EXPORT HoldingRequirement {
  FingerGrip grip;
  double density = 7850;    ///< All parts have this density [kg/m^3], > 0; steel by default.
  double least_safety = 1;  ///< Grasps that hold less than this many times the load are refused; >= 0.
  void check() const;       ///< Throws InvalidInput naming field, value and rule.
};

/// Weight and insertion of one operation, in the frame of its active subassembly.
struct MMGRASP_EXPORT OperationLoad {
  FingerGrip grip;
  double mass = 0;                                       ///< The active parts weigh this [kg].
  std::vector<Eigen::Vector3d> weights;                  ///< One per pose of the motion: gravity turns with it [N].
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();      ///< Centre of mass [m].
  Eigen::Vector3d resistance = Eigen::Vector3d::Zero();  ///< The hole pushes with this, at the end [N].
  Eigen::Vector3d hole = Eigen::Vector3d::Zero();        ///< A point on its axis [m].
};

/// What a grasp does about the load of its operation.
struct MMGRASP_EXPORT HeldLoad {
  double safety = 0;  ///< The loads may grow at least by this factor before a pad slips, on the way and at its end.
  double insertion_moment = 0;  ///< The resistance has this moment about the middle between the pads [N m].
  double pad_torque = 0;        ///< About its normal, that a pad holds beside the forces it carries at the end [N m].
  double contact_area = 0;      ///< One pad touches this much [m^2].
};

/// The load of an operation; gravity acts along -z of the passive subassembly. Throws InvalidInput for a wrong
/// operation or requirement, and for an active part whose mesh is not closed: it has no volume.
MMGRASP_EXPORT OperationLoad operation_load(const AssemblyOperation& operation,
                                            const HoldingRequirement& requirement = {});

/// The least safety over the motion and its end, the rest at the end; see grasp_holding().
MMGRASP_EXPORT HeldLoad held_load(const AssemblyGrasp& grasp, const OperationLoad& load);

}  // namespace mmgrasp
