#include "verify/motion/hermite.hpp"

#include <algorithm>
#include <cmath>

namespace mmgrasp::verify::detail {
namespace {

void include(Range& range, double value) {
  range.low = std::min(range.low, value);
  range.high = std::max(range.high, value);
}

}  // namespace

HermiteSegment::HermiteSegment(const CheckedMotion& motion, std::size_t index)
    : motion_(motion), i_(index), h_(motion.times[index + 1] - motion.times[index]) {}

double HermiteSegment::position(int j, double s) const {
  const double s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * p0(j) + (s3 - 2 * s2 + s) * h_ * v0(j) + (3 * s2 - 2 * s3) * p1(j) +
         (s3 - s2) * h_ * v1(j);
}

Eigen::VectorXd HermiteSegment::at(double s) const {
  Eigen::VectorXd q(motion_.positions[i_].size());
  for (Eigen::Index j = 0; j < q.size(); ++j) q[j] = position(static_cast<int>(j), s);
  return q;
}

Range HermiteSegment::position_range(int j) const {
  Range range{std::min(p0(j), p1(j)), std::max(p0(j), p1(j))};
  // dp/ds = a s^2 + b s + c
  const double d = p1(j) - p0(j);
  const double a = 3 * h_ * (v0(j) + v1(j)) - 6 * d, b = 6 * d - 2 * h_ * (2 * v0(j) + v1(j)), c = h_ * v0(j);
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return range;
  // The stable pair of roots: no difference of nearly equal numbers.
  const double w = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  for (const double root : {w / a, c / w}) {
    if (root > 0 && root < 1) include(range, position(j, root));  // false for the NaN of 0 / 0
  }
  return range;
}

Range HermiteSegment::velocity_range(int j) const {
  Range range{std::min(v0(j), v1(j)), std::max(v0(j), v1(j))};
  const double d = (p1(j) - p0(j)) / h_;
  const double a = 3 * (v0(j) + v1(j)) - 6 * d, b = 6 * d - 2 * (2 * v0(j) + v1(j));
  const double vertex = -b / (2 * a);
  if (vertex > 0 && vertex < 1) include(range, (a * vertex + b) * vertex + v0(j));
  return range;
}

double HermiteSegment::travel(int j) const {
  const Range v = velocity_range(j);
  return std::max(-v.low, v.high) * h_;
}

double HermiteSegment::needed_acceleration(int j) const {
  // Under |a| <= A the double integrator gets from (p0, v0) to (p1, v1) in time h if and only if |dv| <= A h and
  // |dp - h (v0 + v1) / 2| <= (A^2 h^2 - dv^2) / (4 A): solved for the least A.
  const double dv = v1(j) - v0(j);
  // A tenth of a micrometre or microradian is rounding: over a very short step it would pass for a large acceleration.
  const double miss = std::max(0.0, std::abs(p1(j) - p0(j) - 0.5 * h_ * (v0(j) + v1(j))) - 1e-7);
  return (2 * miss + std::sqrt(4 * miss * miss + h_ * h_ * dv * dv)) / (h_ * h_);
}

}  // namespace mmgrasp::verify::detail
