#include "structure/frame/beam_element.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

/// The 12 x 12 matrix of P2 3.2.3.3.2.
Matrix12d local_stiffness(const BeamSection& s, double E, double G, double L) {
  Matrix12d K = Matrix12d::Zero();
  const auto axial = [&](int i, double k) {
    K(i, i) = K(i + 6, i + 6) = k;
    K(i, i + 6) = K(i + 6, i) = -k;
  };
  axial(0, E * s.area / L);
  axial(3, G * s.torsion / L);
  // Displacement v and rotation r of either end; `sign` is that of r against dv/dx.
  const auto bending = [&](int v, int r, double EI, double sign) {
    const double a = 12 * EI / (L * L * L), b = sign * 6 * EI / (L * L), c = 4 * EI / L, d = 2 * EI / L;
    const int at[4] = {v, r, v + 6, r + 6};
    const double k[4][4] = {{a, b, -a, b}, {b, c, -b, d}, {-a, -b, a, -b}, {b, d, -b, c}};
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) K(at[i], at[j]) = k[i][j];
    }
  };
  bending(1, 5, E * s.iz, 1);
  bending(2, 4, E * s.iy, -1);
  return K;
}

}  // namespace

BeamElement::BeamElement(const BeamMember& member, double length, const Eigen::Matrix3d& R_object_member)
    : section_(member.section),
      density_(member.material.density),
      length_(length),
      E_(member.material.youngs_modulus),
      G_(member.material.shear_modulus),
      R_(R_object_member),
      local_(local_stiffness(section_, E_, G_, length)) {}

Matrix12d BeamElement::stiffness_in_object() const {
  Matrix12d K;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      K.block<3, 3>(3 * i, 3 * j) = R_ * local_.block<3, 3>(3 * i, 3 * j) * R_.transpose();
    }
  }
  return K;
}

Vector12d BeamElement::to_member(const Vector12d& in_object) const {
  Vector12d out;
  for (int i = 0; i < 4; ++i) out.segment<3>(3 * i) = R_.transpose() * in_object.segment<3>(3 * i);
  return out;
}

Vector12d BeamElement::local_end_loads(const Vector3d& w) const {
  const double half = length_ / 2, moment = length_ * length_ / 12;
  Vector12d loads = Vector12d::Zero();
  loads.segment<3>(0) = loads.segment<3>(6) = half * w;
  loads(4) = -moment * w.z();
  loads(5) = moment * w.y();
  loads(10) = moment * w.z();
  loads(11) = -moment * w.y();
  return loads;
}

Vector12d BeamElement::end_loads(const Vector3d& per_length) const {
  const Vector12d local = local_end_loads(R_.transpose() * per_length);
  Vector12d loads;
  for (int i = 0; i < 4; ++i) loads.segment<3>(3 * i) = R_ * local.segment<3>(3 * i);
  return loads;
}

Curve BeamElement::displacement(const Vector12d& ends, const Vector3d& per_length) const {
  const Vector12d d = to_member(ends);
  const Vector3d w = R_.transpose() * per_length;
  const double L = length_;
  Curve local;
  for (int k = 0; k <= 4; ++k) local(0, k) = d(0) + (d(6) - d(0)) * k / 4;
  const double stretch = w.x() * L * L / (2 * E_ * section_.area);  // times t (1 - t)
  local(0, 1) += stretch / 4;
  local(0, 2) += stretch / 3;
  local(0, 3) += stretch / 4;
  // A cubic b0..b3 from values and slopes at the ends, raised to degree four; t^2 (1 - t)^2 is a sixth of the middle
  // one.
  const auto bend = [&](int row, double v0, double slope0, double v1, double slope1, double load, double EI) {
    const double b1 = v0 + L * slope0 / 3, b2 = v1 - L * slope1 / 3;
    local(row, 0) = v0;
    local(row, 1) = (v0 + 3 * b1) / 4;
    local(row, 2) = (b1 + b2) / 2 + load * L * L * L * L / (24 * EI) / 6;
    local(row, 3) = (3 * b2 + v1) / 4;
    local(row, 4) = v1;
  };
  bend(1, d(1), d(5), d(7), d(11), w.y(), E_ * section_.iz);
  bend(2, d(2), -d(4), d(8), -d(10), w.z(), E_ * section_.iy);
  return R_ * local;
}

Vector12d BeamElement::end_forces(const Vector12d& ends, const Vector3d& per_length) const {
  return local_ * to_member(ends) - local_end_loads(R_.transpose() * per_length);
}

Vector6d BeamElement::section_forces(const Vector12d& first, const Vector3d& per_length, double x) const {
  const Vector3d w = R_.transpose() * per_length;
  Vector6d cut;
  cut.head<3>() = -(first.head<3>() + x * w);
  cut(3) = -first(3);
  cut(4) = -(first(4) + x * first(2) + x * x / 2 * w.z());
  cut(5) = -(first(5) - x * first(1) - x * x / 2 * w.y());
  return cut;
}

}  // namespace mmgrasp::detail
