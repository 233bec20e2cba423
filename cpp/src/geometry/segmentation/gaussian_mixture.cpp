#include "geometry/segmentation/gaussian_mixture.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kLogSqrtTwoPi = 0.91893853320467274178;
/// Samples are gathered in this many bins of equal width, each counted at the mean of its samples.
constexpr int kBins = 512;
constexpr int kMostSteps = 200;
constexpr double kConverged = 1e-7;
/// First centres drawn for each number of components; the best fit is kept.
constexpr int kStarts = 4;

struct Bins {
  std::vector<double> x, weight;  ///< Weights sum to 1.
};

Bins gather(const std::vector<double>& samples, const std::vector<double>& weights) {
  double low = kInfinity, high = -low, total = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!(weights[i] > 0)) continue;
    low = std::min(low, samples[i]);
    high = std::max(high, samples[i]);
    total += weights[i];
  }
  std::vector<double> sum(kBins, 0), weight(kBins, 0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!(weights[i] > 0)) continue;
    const double at = high > low ? (samples[i] - low) / (high - low) * kBins : 0;
    const int bin = std::min(kBins - 1, static_cast<int>(at));
    sum[bin] += weights[i] * samples[i];
    weight[bin] += weights[i];
  }
  Bins out;
  for (int b = 0; b < kBins; ++b) {
    if (weight[b] <= 0) continue;
    out.x.push_back(sum[b] / weight[b]);
    out.weight.push_back(weight[b] / total);
  }
  return out;
}

std::size_t draw(const std::vector<double>& chances, Rng& rng) {
  double total = 0;
  for (const double c : chances) total += c;
  double left = rng.uniform() * total;
  for (std::size_t i = 0; i + 1 < chances.size(); ++i) {
    left -= chances[i];
    if (left < 0) return i;
  }
  return chances.size() - 1;
}

GaussianMixture first_guess(const Bins& bins, int components, double least_sigma, Rng& rng) {
  std::vector<double> centres{bins.x[draw(bins.weight, rng)]};
  double spread = 0;
  while (static_cast<int>(centres.size()) < components) {
    std::vector<double> chances(bins.x.size());
    for (std::size_t i = 0; i < bins.x.size(); ++i) {
      double nearest = kInfinity;
      for (const double c : centres) nearest = std::min(nearest, std::abs(bins.x[i] - c));
      chances[i] = bins.weight[i] * nearest * nearest;
    }
    centres.push_back(bins.x[draw(chances, rng)]);
  }
  for (std::size_t i = 0; i < bins.x.size(); ++i) {
    double nearest = kInfinity;
    for (const double c : centres) nearest = std::min(nearest, std::abs(bins.x[i] - c));
    spread += bins.weight[i] * nearest * nearest;
  }
  GaussianMixture out;
  for (const double c : centres)
    out.components.push_back({1.0 / components, c, std::max(least_sigma, std::sqrt(spread))});
  return out;
}

void maximise(const Bins& bins, double least_sigma, GaussianMixture& mixture) {
  const std::size_t k = mixture.components.size();
  double before = -kInfinity;
  for (int step = 0; step < kMostSteps; ++step) {
    std::vector<double> share(k, 0), sum(k, 0), square(k, 0), parts(k);
    mixture.log_likelihood = 0;
    for (std::size_t i = 0; i < bins.x.size(); ++i) {
      double largest = -kInfinity, total = 0;
      for (std::size_t c = 0; c < k; ++c) {
        parts[c] = mixture.log_part(static_cast<int>(c), bins.x[i]);
        largest = std::max(largest, parts[c]);
      }
      for (std::size_t c = 0; c < k; ++c) total += parts[c] = std::exp(parts[c] - largest);
      mixture.log_likelihood += bins.weight[i] * (largest + std::log(total));
      for (std::size_t c = 0; c < k; ++c) {
        const double w = bins.weight[i] * parts[c] / total;
        share[c] += w;
        sum[c] += w * bins.x[i];
        square[c] += w * bins.x[i] * bins.x[i];
      }
    }
    if (mixture.log_likelihood - before < kConverged) return;
    before = mixture.log_likelihood;
    for (std::size_t c = 0; c < k; ++c) {
      if (share[c] < 1e-12) continue;
      auto& component = mixture.components[c];
      component.share = share[c];
      component.mean = sum[c] / share[c];
      const double variance = square[c] / share[c] - component.mean * component.mean;
      component.sigma = std::max(least_sigma, std::sqrt(std::max(0.0, variance)));
    }
  }
}

}  // namespace

double GaussianMixture::log_part(int component, double x) const {
  const Component& c = components[component];
  const double z = (x - c.mean) / c.sigma;
  return std::log(c.share) - kLogSqrtTwoPi - std::log(c.sigma) - 0.5 * z * z;
}

GaussianMixture fit_mixture(const std::vector<double>& samples, const std::vector<double>& weights, int most,
                            double least_sigma, double count, unsigned seed) {
  const Bins bins = gather(samples, weights);
  GaussianMixture best;
  double least = kInfinity;
  for (int k = 1; k <= std::min<int>(most, static_cast<int>(bins.x.size())); ++k) {
    for (int start = 0; start < (k == 1 ? 1 : kStarts); ++start) {
      Rng rng(seed, static_cast<std::uint64_t>(k * kStarts + start));
      GaussianMixture mixture = first_guess(bins, k, least_sigma, rng);
      maximise(bins, least_sigma, mixture);
      const double criterion = (3 * k - 1) * std::log(count) - 2 * count * mixture.log_likelihood;
      if (criterion >= least) continue;
      least = criterion;
      best = std::move(mixture);
    }
  }
  std::sort(best.components.begin(), best.components.end(),
            [](const auto& a, const auto& b) { return a.mean < b.mean; });
  return best;
}

}  // namespace mmgrasp::detail
