#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// A sum of Gaussians over the real line.
struct GaussianMixture {
  struct Component {
    double share = 1, mean = 0, sigma = 1;
  };
  std::vector<Component> components;  ///< Sorted by ascending mean.
  double log_likelihood = 0;          ///< Mean over the samples.

  /// log(share * density) of a component at x.
  double log_part(int component, double x) const;
};

/// Fits mixtures of 1 to `most` components to weighted samples by expectation-maximisation from k-means++ centres
/// (Arthur and Vassilvitskii 2007) and returns the one with the least Bayesian information criterion, for which the
/// samples count as `count` independent ones. No sigma falls below `least_sigma`.
MMGRASP_EXPORT GaussianMixture fit_mixture(const std::vector<double>& samples, const std::vector<double>& weights,
                                           int most, double least_sigma, double count, unsigned seed);

}  // namespace mmgrasp::detail
