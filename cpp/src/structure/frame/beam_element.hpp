#pragma once

#include <Eigen/Core>
#include <array>

#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/structure/beam_frame.hpp"

namespace mmgrasp::detail {

template <class Scalar>
using Matrix12 = Eigen::Matrix<Scalar, 12, 12>;
template <class Scalar>
using Vector12 = Eigen::Matrix<Scalar, 12, 1>;
using Vector12d = Vector12<double>;
/// Coefficients, one a column, of a cubic-to-quartic curve over the element in Bernstein's basis of degree four.
using Curve = Eigen::Matrix<double, 3, 5>;

/// R_object_member of a member; columns x, y, z.
template <class Scalar>
Eigen::Matrix<Scalar, 3, 3> member_axes(const BeamFrame& frame, int member);
/// Length of a member [m].
template <class Scalar>
Scalar member_length(const BeamFrame& frame, int member);

/// One straight piece of a member, computed in `Scalar`: double, or Wide where that loses the answer. Ends' values are
/// displacement and rotation of the first end, then of the second.
template <class Scalar>
class BeamElement {
 public:
  using Vector3 = Eigen::Matrix<Scalar, 3, 1>;

  BeamElement(const BeamMember& member, const Scalar& length, const Eigen::Matrix<Scalar, 3, 3>& R_object_member);

  Matrix12<Scalar> stiffness_in_object() const;
  /// Equivalent loads at both ends of a load per length [N/m], evenly spread, both in the object's frame. Local axes
  /// are as P2 figure 3.6 has them only for loads along -z: the printed signs hold for no other (docs/errata.md).
  Vector12<Scalar> end_loads(const Vector3& per_length) const;
  /// Displacement along the element in the object's frame: the cubic of the ends' values and the quartic of the load,
  /// which is the exact solution.
  Curve displacement(const Vector12<Scalar>& ends, const Vector3& per_length) const;
  /// What the nodes do to the element's ends, in the member's frame.
  Vector12<Scalar> end_forces(const Vector12<Scalar>& ends, const Vector3& per_length) const;

 private:
  Vector12<Scalar> to_member(const Vector12<Scalar>& in_object) const;
  Vector12<Scalar> local_end_loads(const Vector3& local_per_length) const;

  Scalar length_, axial_, bending_y_, bending_z_;  ///< EA, E Iy, E Iz
  Eigen::Matrix<Scalar, 3, 3> R_;                  ///< R_object_member.
  Matrix12<Scalar> local_;                         ///< Stiffness in the member's frame.
};

/// Forces and moments in the member's frame at a distance x from an element's first end: N, Vy, Vz, torque, My, Mz. The
/// load per length [N/m] is in the object's frame.
Vector6d section_forces(const Vector12d& end_forces, const Eigen::Matrix3d& R_object_member,
                        const Eigen::Vector3d& per_length, double x);

}  // namespace mmgrasp::detail
