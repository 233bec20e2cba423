#pragma once

#include <Eigen/Core>

#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/structure/beam_frame.hpp"

namespace mmgrasp::detail {

using Matrix12d = Eigen::Matrix<double, 12, 12>;
using Vector12d = Eigen::Matrix<double, 12, 1>;
/// Coefficients, one a column, of a cubic-to-quartic curve over the element in Bernstein's basis of degree four.
using Curve = Eigen::Matrix<double, 3, 5>;

/// One straight piece of a member. Ends' values are displacement and rotation of the first end, then of the second.
class BeamElement {
 public:
  BeamElement(const BeamMember& member, double length, const Eigen::Matrix3d& R_object_member);

  Matrix12d stiffness_in_object() const;
  /// Equivalent loads at both ends of a load per length [N/m], evenly spread, both in the object's frame. Local axes
  /// are as P2 figure 3.6 has them only for loads along -z: the printed signs hold for no other (docs/errata.md).
  Vector12d end_loads(const Eigen::Vector3d& per_length) const;
  /// Displacement along the element in the object's frame: the cubic of the ends' values and the quartic of the load,
  /// which is the exact solution.
  Curve displacement(const Vector12d& ends, const Eigen::Vector3d& per_length) const;
  /// What the nodes do to the element's ends, in the member's frame.
  Vector12d end_forces(const Vector12d& ends, const Eigen::Vector3d& per_length) const;
  /// Forces and moments in the member's frame at a distance x from the first end: N, Vy, Vz, torque, My, Mz.
  Vector6d section_forces(const Vector12d& end_forces, const Eigen::Vector3d& per_length, double x) const;

  double length() const { return length_; }
  /// Mass per length [kg/m].
  double line_density() const { return density_ * section_.area; }

 private:
  Vector12d to_member(const Vector12d& in_object) const;
  Vector12d local_end_loads(const Eigen::Vector3d& local_per_length) const;

  BeamSection section_;
  double density_, length_, E_, G_;
  Eigen::Matrix3d R_;  ///< R_object_member.
  Matrix12d local_;    ///< Stiffness in the member's frame.
};

}  // namespace mmgrasp::detail
