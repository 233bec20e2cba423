#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// Small deterministic generator (xoshiro256**, seeded by splitmix64): the same numbers on every platform.
/// `stream` gives independent sequences of one seed, so that work item i draws the same numbers at any thread count.
///
///     parallel_for(items, threads, [&](std::size_t i, int) { Rng rng(seed, i); use(rng.uniform(lower, upper)); });
class MMGRASP_EXPORT Rng {
 public:
  explicit Rng(std::uint64_t seed, std::uint64_t stream = 0);

  std::uint64_t next();
  double uniform();                            ///< Uniform in [0, 1).
  double uniform(double lower, double upper);  ///< Uniform in [lower, upper).
  std::size_t index(std::size_t size);         ///< Uniform in [0, size); size > 0.
  double normal();                             ///< Standard normal.
  Eigen::VectorXd uniform(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);
  Eigen::Quaterniond rotation();           ///< Uniform over rotations.
  Eigen::Vector2d in_disc(double radius);  ///< Uniform over the disc.

 private:
  std::uint64_t state_[4];
};

}  // namespace mmgrasp
