#include "task/base_region/warm_started_ik.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/robot/ik.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kIterations = 8;
constexpr double kShrink =
    0.25;  // An iteration that shrinks the squared error less is a failure; the second ends the search.
constexpr double kDampingPerError = 0.03;  // As refine_ik() has it: none near the goal, where the step is Newton's.
constexpr double kLeastDamping = 1e-10;
constexpr double kLongestStep = 0.7;  // [rad or m]; longer ones lead away from the configuration one came from.

/// Lower triangle of a symmetric 6 x 6 matrix, solved in place of `b`. False when it is not positive definite.
bool solve_symmetric(std::array<double, 36>& A, Vector6d& b) {
  std::array<double, 6> inverse;
  for (std::size_t k = 0; k < 6; ++k) {
    double d = A[6 * k + k];
    for (std::size_t j = 0; j < k; ++j) d -= A[6 * k + j] * A[6 * k + j];
    if (!(d > 0)) return false;
    inverse[k] = 1 / std::sqrt(d);
    for (std::size_t i = k + 1; i < 6; ++i) {
      double s = A[6 * i + k];
      for (std::size_t j = 0; j < k; ++j) s -= A[6 * i + j] * A[6 * k + j];
      A[6 * i + k] = s * inverse[k];
    }
  }
  for (std::size_t i = 0; i < 6; ++i) {
    double s = b[static_cast<Eigen::Index>(i)];
    for (std::size_t j = 0; j < i; ++j) s -= A[6 * i + j] * b[static_cast<Eigen::Index>(j)];
    b[static_cast<Eigen::Index>(i)] = s * inverse[i];
  }
  for (std::size_t i = 6; i-- > 0;) {
    double s = b[static_cast<Eigen::Index>(i)];
    for (std::size_t j = i + 1; j < 6; ++j) s -= A[6 * j + i] * b[static_cast<Eigen::Index>(j)];
    b[static_cast<Eigen::Index>(i)] = s * inverse[i];
  }
  return true;
}

/// How one pose is off another: position, and the sine of the angle along the axis, which is the rotation vector to
/// third order.
Vector6d difference(const Pose& from, const Pose& to) {
  Vector6d error;
  error.head<3>() = to.translation() - from.translation();
  error.tail<3>() =
      0.5 * (from.linear().col(0).cross(to.linear().col(0)) + from.linear().col(1).cross(to.linear().col(1)) +
             from.linear().col(2).cross(to.linear().col(2)));
  return error;
}

}  // namespace

WarmStartedIk::WarmStartedIk(const JointGroup& arm) : arm_(arm), J_(6, arm.size()), dq_(arm.size()) {
  const IkOptions defaults;
  position_tolerance_ = defaults.position_tolerance;
  rotation_tolerance_ = defaults.rotation_tolerance;
}

bool WarmStartedIk::solve(const Pose& T_base_tip, Eigen::VectorXd& q) {
  Pose T_base_now;
  double before = kInfinity;
  for (int iteration = 0, strikes = 0;; ++iteration) {
    arm_.fk_jacobian(q, T_base_now, J_);
    const Vector6d error = difference(T_base_now, T_base_tip);
    if (error.head<3>().norm() <= position_tolerance_ && error.tail<3>().norm() <= rotation_tolerance_) {
      // The sine is small at half a turn, too.
      return (T_base_now.linear().transpose() * T_base_tip.linear()).trace() > 2;
    }
    const double squared = error.squaredNorm();
    if (squared > kShrink * before && ++strikes == 2) return false;
    if (iteration == kIterations) return false;
    before = squared;
    if (!step(q, error, kDampingPerError * squared + kLeastDamping)) return false;
  }
}

/// The damped least squares step, added to q. A joint that would cross its limit is set onto it; the others share what
/// is left.
bool WarmStartedIk::step(Eigen::VectorXd& q, const Vector6d& error, double damping) {
  const Eigen::Index n = q.size();
  const double* lower = arm_.lower().data();
  const double* upper = arm_.upper().data();
  std::uint64_t fixed = 0;
  Vector6d rest = error;
  for (Eigen::Index round = 0; round <= n; ++round) {
    std::array<double, 36> A{};
    for (Eigen::Index c = 0; c < n; ++c) {
      if (fixed >> c & 1) continue;
      const double* column = J_.data() + 6 * c;
      for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t j = 0; j <= i; ++j) A[6 * i + j] += column[i] * column[j];
      }
    }
    for (std::size_t i = 0; i < 6; ++i) A[7 * i] += damping;
    Vector6d y = rest;
    if (!solve_symmetric(A, y)) return false;
    bool again = false;
    for (Eigen::Index c = 0; c < n; ++c) {
      if (fixed >> c & 1) continue;
      const double* column = J_.data() + 6 * c;
      double d = 0;
      for (Eigen::Index i = 0; i < 6; ++i) d += column[i] * y[i];
      if (std::abs(d) > kLongestStep) return false;
      dq_[c] = d;
    }
    for (Eigen::Index c = 0; c < n; ++c) {
      if (fixed >> c & 1) continue;
      const double target = q[c] + dq_[c];
      const double inside = std::min(std::max(target, lower[c]), upper[c]);
      if (inside == target) continue;
      dq_[c] = inside - q[c];
      fixed |= std::uint64_t{1} << c;
      for (Eigen::Index i = 0; i < 6; ++i) rest[i] -= J_(i, c) * dq_[c];
      again = true;
    }
    if (!again) break;
  }
  for (Eigen::Index c = 0; c < n; ++c) q[c] = std::min(std::max(q[c] + dq_[c], lower[c]), upper[c]);
  return true;
}

}  // namespace mmgrasp::detail
