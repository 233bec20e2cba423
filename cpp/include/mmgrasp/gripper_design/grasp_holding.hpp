#pragma once

#include <Eigen/Core>
#include <limits>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/grasp/finger_length_range.hpp"
#include "mmgrasp/gripper_design/soft_contact.hpp"

namespace mmgrasp {

/// How fingers press and what their pads are made of.
struct MMGRASP_EXPORT FingerGrip {
  double force = 50;      ///< Each finger presses with this [N], > 0.
  double friction = 0.5;  ///< Coulomb's coefficient between pad and part, > 0.
  double modulus = 3e6;   ///< Plane strain modulus of pad and part together [Pa], > 0: a rubber pad's by default.
  double pad_radius = std::numeric_limits<double>::infinity();  ///< Hollow pads of centric fingers [m], > 0; flat
                                                                ///< where it is infinite or less than the wall's.
  void check() const;                                           ///< Throws InvalidInput naming field, value and rule.
};

/// What the held parts weigh, and what the hole does to them: everything in the frame of the grasp's pose.
struct MMGRASP_EXPORT AssemblyLoad {
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();      ///< Force of gravity [N].
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();      ///< Where it acts [m].
  Eigen::Vector3d resistance = Eigen::Vector3d::Zero();  ///< Against the motion of the insertion [N].
  Eigen::Vector3d hole = Eigen::Vector3d::Zero();        ///< A point on the hole's axis, where it acts [m].
  void check() const;                                    ///< Throws InvalidInput: numbers that are none.
};

/// What a grasp does about the loads of its operation.
struct MMGRASP_EXPORT GraspHolding {
  ContactArea contact;          ///< One pad's.
  double pad_torque = 0;        ///< Torque about its normal that a pad holds beside the forces it carries; least [N m].
  double insertion_moment = 0;  ///< The resistance about the middle between the pads: 0 where fingers stand evenly
                                ///< about the hole's axis [N m].
  /// The loads may grow at least by this factor before a pad slips; infinite where there are none. Above 1: held.
  double safety = 0;
};

/// Whether soft fingers hold a part against its weight, and against its weight and the insertion (P1 5.3.5 names both
/// as what is missing). Loads are shared between the pads so that the sum of squares is least; by the static theorem
/// this share bounds what can be held from below. A pad slips by the limit surface of soft_finger_torque(). Pressure
/// that the load adds to a pad is not counted, pressure that it takes away is. The pads' size is the grasp's
/// `contact_length` and `contact_width`, > 0; jaws touch flat faces, centric fingers round walls. Throws InvalidInput
/// for a wrong grasp, grip or load.
MMGRASP_EXPORT GraspHolding grasp_holding(const AssemblyGrasp& grasp, const FingerGrip& grip, const AssemblyLoad& load);

}  // namespace mmgrasp
