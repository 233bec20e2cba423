#pragma once

namespace mmgrasp::detail {

/// Lengths that differ by no more are equal [m]: sums, and units of files, are off by roundings.
inline constexpr double kSameLength = 1e-9;

/// Whether a length is no longer than a limit, roundings aside [m].
inline bool at_most(double length, double limit) {
  return length <= limit + kSameLength;
}

}  // namespace mmgrasp::detail
