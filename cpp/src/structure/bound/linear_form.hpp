#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

/// What is known of a function of two variables in [-1, 1]: everywhere it lies within `error` of
/// centre + slope[0] x + slope[1] y. Each operation encloses its exact result (affine arithmetic with the remainder of
/// Taylor's first order), so errors shrink with the square of the box. Rounding is not followed.
struct LinearForm {
  double centre = 0;
  std::array<double, 2> slope{};
  double error = 0;

  LinearForm() = default;
  LinearForm(double constant) : centre(constant) {}  // NOLINT: numbers take part in formulas
  LinearForm(double c, double x, double y, double e) : centre(c), slope{x, y}, error(e) {}
  /// Everything between two numbers.
  static LinearForm between(double low, double high) { return {(low + high) / 2, 0, 0, (high - low) / 2}; }

  double radius() const { return std::abs(slope[0]) + std::abs(slope[1]) + error; }
  double low() const { return centre - radius(); }
  double high() const { return centre + radius(); }

  LinearForm operator-() const { return {-centre, -slope[0], -slope[1], error}; }
  LinearForm& operator+=(const LinearForm& b) {
    centre += b.centre;
    slope[0] += b.slope[0];
    slope[1] += b.slope[1];
    error += b.error;
    return *this;
  }
  LinearForm& operator-=(const LinearForm& b) { return *this += -b; }
  LinearForm& operator*=(double k) {
    centre *= k;
    slope[0] *= k;
    slope[1] *= k;
    error *= std::abs(k);
    return *this;
  }
};

inline LinearForm operator+(LinearForm a, const LinearForm& b) {
  return a += b;
}
inline LinearForm operator-(LinearForm a, const LinearForm& b) {
  return a -= b;
}
inline LinearForm operator*(double k, LinearForm a) {
  return a *= k;
}
inline LinearForm operator*(const LinearForm& a, const LinearForm& b) {
  return {a.centre * b.centre, a.centre * b.slope[0] + b.centre * a.slope[0],
          a.centre * b.slope[1] + b.centre * a.slope[1],
          std::abs(a.centre) * b.error + std::abs(b.centre) * a.error + a.radius() * b.radius()};
}
inline LinearForm squared(const LinearForm& a) {  // the remainder lies in [0, radius^2]
  const double half = a.radius() * a.radius() / 2;
  return {a.centre * a.centre + half, 2 * a.centre * a.slope[0], 2 * a.centre * a.slope[1],
          2 * std::abs(a.centre) * a.error + half};
}

/// f of a, where f(centre), f'(centre) and the largest |f''| on a's range are given.
inline LinearForm composed(const LinearForm& a, double value, double first, double second) {
  LinearForm f = first * a;
  f.centre = value;
  f.error += second / 2 * a.radius() * a.radius();
  return f;
}

inline LinearForm cosine(const LinearForm& a) {
  const double r = a.radius();
  if (r > 1) return {0, 0, 0, 1};
  return composed(a, std::cos(a.centre), -std::sin(a.centre), std::min(1.0, std::abs(std::cos(a.centre)) + r));
}
inline LinearForm sine(const LinearForm& a) {
  const double r = a.radius();
  if (r > 1) return {0, 0, 0, 1};
  return composed(a, std::sin(a.centre), std::cos(a.centre), std::min(1.0, std::abs(std::sin(a.centre)) + r));
}

/// The one of two enclosures of the same value that leaves less open: a plain range has no slopes, and its width is all
/// error.
inline LinearForm sharper(const LinearForm& a, const LinearForm& range) {
  return a.error < range.error ? a : range;
}

/// sqrt(a) where a is not negative; its range must reach above 0.
inline LinearForm square_root(const LinearForm& a) {
  const double low = std::max(0.0, a.low()), root = std::sqrt(std::max(0.0, a.centre));
  const LinearForm range = LinearForm::between(std::sqrt(low), std::sqrt(a.high()));
  if (low == 0) return range;
  const LinearForm f = composed(a, root, 0.5 / root, 0.25 / (low * std::sqrt(low)));
  return f.low() > 0 ? sharper(f, range) : range;  // so that its reciprocal can be taken
}

/// 1 / a for an a whose range is above 0.
inline LinearForm reciprocal(const LinearForm& a) {
  const double low = a.low();
  const LinearForm f = composed(a, 1 / a.centre, -1 / (a.centre * a.centre), 2 / (low * low * low));
  return sharper(f, LinearForm::between(1 / a.high(), 1 / low));
}

/// acos(a) where a lies in [-1, 1]; the range of a must meet that.
inline LinearForm arc_cosine(const LinearForm& a) {
  const double low = std::max(-1.0, a.low()), high = std::min(1.0, a.high()), most = std::max(-a.low(), a.high());
  const double least = std::acos(high), largest = std::acos(low);
  const LinearForm range = LinearForm::between(least, largest);
  if (most >= 1 || std::abs(a.centre) >= 1) return range;
  const double rest = 1 - most * most;
  const LinearForm f =
      composed(a, std::acos(a.centre), -1 / std::sqrt(1 - a.centre * a.centre), most / (rest * std::sqrt(rest)));
  return sharper(f, range);
}

/// Any angle.
inline LinearForm full_circle() {
  return {0, 0, 0, kPi};
}

/// The angle of the vector (x, y), near its value in the middle.
inline LinearForm angle_of(const LinearForm& y, const LinearForm& x) {
  const double r = std::hypot(x.centre, y.centre), off = std::hypot(x.radius(), y.radius());
  if (off >= r) return full_circle();
  const double angle = std::atan2(y.centre, x.centre), r2 = r * r;
  const LinearForm wide{angle, 0, 0, std::asin(off / r)};
  LinearForm f = (x.centre / r2) * y - (y.centre / r2) * x;
  f.centre = angle;
  f.error += off * off / (2 * (r - off) * (r - off));
  return sharper(f, wide);
}

using FormVector = std::array<LinearForm, 3>;

inline FormVector operator+(const FormVector& a, const FormVector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline FormVector operator-(const FormVector& a, const FormVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline FormVector form(const Eigen::Vector3d& v) {
  return {LinearForm(v.x()), LinearForm(v.y()), LinearForm(v.z())};
}
inline LinearForm dot(const Eigen::Vector3d& a, const FormVector& b) {
  return a.x() * b[0] + a.y() * b[1] + a.z() * b[2];
}
inline LinearForm dot(const FormVector& a, const FormVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline LinearForm squared_norm(const FormVector& a) {
  return squared(a[0]) + squared(a[1]) + squared(a[2]);
}
inline FormVector cross(const Eigen::Vector3d& a, const FormVector& b) {
  return {a.y() * b[2] - a.z() * b[1], a.z() * b[0] - a.x() * b[2], a.x() * b[1] - a.y() * b[0]};
}
inline FormVector cross(const FormVector& a, const FormVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline FormVector operator*(const LinearForm& k, const FormVector& a) {
  return {k * a[0], k * a[1], k * a[2]};
}

/// R(axis, angle) v with the angle's cosine and sine.
inline FormVector turned(const Eigen::Vector3d& axis, const LinearForm& c, const LinearForm& s, const FormVector& v) {
  const LinearForm along = dot(axis, v);
  const FormVector lengthwise{axis.x() * along, axis.y() * along, axis.z() * along};
  return lengthwise + c * (v - lengthwise) + s * cross(axis, v);
}

}  // namespace mmgrasp::detail
