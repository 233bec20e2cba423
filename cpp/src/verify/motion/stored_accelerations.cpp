#include "verify/motion/stored_accelerations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::verify::detail {
namespace {

constexpr double kFit = 1e-3;  // Share of the limit by which a stored acceleration may be off the cubics' ...
// ... and this many times what the cubics before and after disagree by: they are as inexact where the acceleration
// bends. At a jump, where they disagree by what it is high, no more than this share of the limit.
constexpr double kDisagreement = 5, kMostByDisagreement = 0.02;
constexpr double kShort = 5e-4;  // [s] Jumps that are nearer to each other have no sample of their own.

/// Accelerations of the cubic between samples `i` and `i + 1` at its ends and its mean, and how exact these are for the
/// digits that there are.
struct CubicEnds {
  double begin = 0, end = 0, mean = 0, rounding = 0;
};

CubicEnds cubic_ends(const CheckedMotion& motion, std::size_t i, Eigen::Index j) {
  const double h = motion.times[i + 1] - motion.times[i];
  const double p0 = motion.positions[i][j], p1 = motion.positions[i + 1][j];
  const double v0 = motion.velocities[i][j], v1 = motion.velocities[i + 1][j];
  const double mean = (p1 - p0) / h;
  constexpr double kDigits = 20 * std::numeric_limits<double>::epsilon();
  return {(6 * mean - 4 * v0 - 2 * v1) / h, (2 * v0 + 4 * v1 - 6 * mean) / h, (v1 - v0) / h,
          kDigits * (std::max(std::abs(p0), std::abs(p1)) / h + std::max(std::abs(v0), std::abs(v1))) / h};
}

/// How far a stored acceleration is off what is allowed; below 0: not at all.
double excess(const CheckedMotion& motion, std::size_t i, Eigen::Index j, double limit) {
  const double said = motion.accelerations[i][j];
  const std::size_t last = motion.times.size() - 1;
  double off = mmgrasp::detail::kInfinity, disagreement = 0, rounding = 0;
  CubicEnds before, after;
  if (i > 0) {
    before = cubic_ends(motion, i - 1, j);
    off = std::min({off, std::abs(said - before.end), std::abs(said - before.mean)});
    rounding += before.rounding;
  }
  if (i < last) {
    after = cubic_ends(motion, i, j);
    off = std::min({off, std::abs(said - after.begin), std::abs(said - after.mean)});
    rounding += after.rounding;
  }
  if (i == 0 || i == last) off = std::min(off, std::abs(said));  // it rests before and afterwards
  if (i > 0 && i < last) disagreement = std::abs(before.end - after.begin);
  if (std::isnan(said)) return mmgrasp::detail::kInfinity;
  return off - rounding - kFit * limit - std::min(kDisagreement * disagreement, kMostByDisagreement * limit);
}

}  // namespace

void check_accelerations_fit(const CheckedMotion& motion, const std::vector<double>& limits,
                             const std::vector<std::string>& names, const std::string& where, Faults& faults) {
  double worst = 0;
  std::size_t at = 0, column = 0;
  const std::size_t last = motion.times.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    if (i < last && motion.times[i + 1] - motion.times[i] < kShort) continue;
    for (std::size_t j = 0; j < names.size(); ++j) {
      const double now = excess(motion, i, static_cast<Eigen::Index>(j), limits[j]) / limits[j];
      if (now <= worst) continue;
      worst = now;
      at = i;
      column = j;
    }
  }
  if (worst <= 0) return;
  const auto j = static_cast<Eigen::Index>(column);
  faults.push_back({"acceleration", where + ", t = " + text(motion.times[at]) + " s",
                    "the stored acceleration of '" + names[column] + "' is " + text(motion.accelerations[at][j]) +
                        ", positions and velocities say " +
                        text(at < last ? cubic_ends(motion, at, j).begin : cubic_ends(motion, last - 1, j).end)});
}

}  // namespace mmgrasp::verify::detail
