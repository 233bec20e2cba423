#include "structure/frame/beam_element.hpp"

#include "structure/frame/wide.hpp"
#include "structure/section_axes.hpp"

namespace mmgrasp::detail {
namespace {

/// The 12 x 12 matrix of P2 3.2.3.3.2 from EA, E Iy, E Iz, G J and the length.
template <class Scalar>
Matrix12<Scalar> local_stiffness(const Scalar& EA, const Scalar& EIy, const Scalar& EIz, const Scalar& GJ,
                                 const Scalar& L) {
  Matrix12<Scalar> K = Matrix12<Scalar>::Zero();
  const auto axial = [&](int i, const Scalar& k) {
    K(i, i) = K(i + 6, i + 6) = k;
    K(i, i + 6) = K(i + 6, i) = -k;
  };
  axial(0, EA / L);
  axial(3, GJ / L);
  // Displacement v and rotation r of either end; `sign` is that of r against dv/dx.
  const auto bending = [&](int v, int r, const Scalar& EI, int sign) {
    const Scalar a = 12 * EI / (L * L * L), b = sign * 6 * EI / (L * L), c = 4 * EI / L, d = 2 * EI / L;
    const int at[4] = {v, r, v + 6, r + 6};
    const Scalar k[4][4] = {{a, b, -a, b}, {b, c, -b, d}, {-a, -b, a, -b}, {b, d, -b, c}};
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) K(at[i], at[j]) = k[i][j];
    }
  };
  bending(1, 5, EIz, 1);
  bending(2, 4, EIy, -1);
  return K;
}

template <class Scalar>
Vector3<Scalar> along(const BeamFrame& frame, int member) {
  const auto [a, b] = frame.members.at(member).nodes;
  return frame.nodes.at(b).cast<Scalar>() - frame.nodes.at(a).cast<Scalar>();
}

}  // namespace

template <class Scalar>
Matrix3<Scalar> member_axes(const BeamFrame& frame, int member) {
  const Eigen::Vector3d& towards = frame.members.at(member).y_towards;
  const Eigen::Vector3d y = towards.isZero(0) ? usual_y(along<double>(frame, member)) : towards;
  return axes_across<Scalar>(along<Scalar>(frame, member), y.cast<Scalar>());
}

template <class Scalar>
Scalar member_length(const BeamFrame& frame, int member) {
  return along<Scalar>(frame, member).norm();
}

template <class Scalar>
BeamElement<Scalar>::BeamElement(const BeamMember& member, const Scalar& length, const Matrix3<Scalar>& R_object_member)
    : length_(length),
      axial_(Scalar(member.material.youngs_modulus) * member.section.area),
      bending_y_(Scalar(member.material.youngs_modulus) * member.section.iy),
      bending_z_(Scalar(member.material.youngs_modulus) * member.section.iz),
      R_(R_object_member),
      local_(local_stiffness<Scalar>(axial_, bending_y_, bending_z_,
                                     Scalar(member.material.shear_modulus) * member.section.torsion, length)) {}

template <class Scalar>
Matrix12<Scalar> BeamElement<Scalar>::stiffness_in_object() const {
  Matrix12<Scalar> K;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      K.template block<3, 3>(3 * i, 3 * j) = R_ * local_.template block<3, 3>(3 * i, 3 * j) * R_.transpose();
    }
  }
  return K;
}

template <class Scalar>
Vector12<Scalar> BeamElement<Scalar>::to_member(const Vector12<Scalar>& in_object) const {
  Vector12<Scalar> out;
  for (int i = 0; i < 4; ++i) out.template segment<3>(3 * i) = R_.transpose() * in_object.template segment<3>(3 * i);
  return out;
}

template <class Scalar>
Vector12<Scalar> BeamElement<Scalar>::local_end_loads(const Vector3& w) const {
  const Scalar half = length_ / 2, moment = length_ * length_ / 12;
  Vector12<Scalar> loads = Vector12<Scalar>::Zero();
  loads.template segment<3>(0) = loads.template segment<3>(6) = half * w;
  loads(4) = -moment * w.z();
  loads(5) = moment * w.y();
  loads(10) = moment * w.z();
  loads(11) = -moment * w.y();
  return loads;
}

template <class Scalar>
Vector12<Scalar> BeamElement<Scalar>::end_loads(const Vector3& per_length) const {
  const Vector12<Scalar> local = local_end_loads(R_.transpose() * per_length);
  Vector12<Scalar> loads;
  for (int i = 0; i < 4; ++i) loads.template segment<3>(3 * i) = R_ * local.template segment<3>(3 * i);
  return loads;
}

template <class Scalar>
Curve BeamElement<Scalar>::displacement(const Vector12<Scalar>& ends, const Vector3& per_length) const {
  const Vector12<Scalar> d = to_member(ends);
  const Vector3 w = R_.transpose() * per_length;
  const Scalar& L = length_;
  Eigen::Matrix<Scalar, 3, 5> local;
  for (int k = 0; k <= 4; ++k) local(0, k) = d(0) + (d(6) - d(0)) * k / 4;
  const Scalar stretch = w.x() * L * L / (2 * axial_);  // times t (1 - t)
  local(0, 1) += stretch / 4;
  local(0, 2) += stretch / 3;
  local(0, 3) += stretch / 4;
  // A cubic b0..b3 from values and slopes at the ends, raised to degree four; t^2 (1 - t)^2 is a sixth of the middle
  // one.
  const auto bend = [&](int row, const Scalar& v0, const Scalar& slope0, const Scalar& v1, const Scalar& slope1,
                        const Scalar& load, const Scalar& EI) {
    const Scalar b1 = v0 + L * slope0 / 3, b2 = v1 - L * slope1 / 3;
    local(row, 0) = v0;
    local(row, 1) = (v0 + 3 * b1) / 4;
    local(row, 2) = (b1 + b2) / 2 + load * L * L * L * L / (24 * EI) / 6;
    local(row, 3) = (3 * b2 + v1) / 4;
    local(row, 4) = v1;
  };
  bend(1, d(1), d(5), d(7), d(11), w.y(), bending_z_);
  bend(2, d(2), -d(4), d(8), -d(10), w.z(), bending_y_);
  return (R_ * local).template cast<double>();
}

template <class Scalar>
Vector12<Scalar> BeamElement<Scalar>::end_forces(const Vector12<Scalar>& ends, const Vector3& per_length) const {
  return local_ * to_member(ends) - local_end_loads(R_.transpose() * per_length);
}

Vector6d section_forces(const Vector12d& first, const Eigen::Matrix3d& R_object_member,
                        const Eigen::Vector3d& per_length, double x) {
  const Eigen::Vector3d w = R_object_member.transpose() * per_length;
  Vector6d cut;
  cut.head<3>() = -(first.head<3>() + x * w);
  cut(3) = -first(3);
  cut(4) = -(first(4) + x * first(2) + x * x / 2 * w.z());
  cut(5) = -(first(5) - x * first(1) - x * x / 2 * w.y());
  return cut;
}

template class BeamElement<double>;
template class BeamElement<Wide>;
template Matrix3<double> member_axes(const BeamFrame&, int);
template Matrix3<Wide> member_axes(const BeamFrame&, int);
template double member_length(const BeamFrame&, int);
template Wide member_length(const BeamFrame&, int);

}  // namespace mmgrasp::detail
