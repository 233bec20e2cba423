#include "geometry/segmentation/diameter_clusters.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/segmentation/alpha_expansion.hpp"
#include "geometry/segmentation/gaussian_mixture.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

/// Diameters that differ by less than 5 % are not distinguished.
constexpr double kLeastSigma = 0.05;
/// Rounds of averaging over neighbours, and the difference at which a neighbour counts by exp(-1/2).
constexpr int kRounds = 3;
constexpr double kAlike = 0.15;
/// A face never pays more than this for a cluster, so that few faces without a good cluster cannot outvote the rest.
constexpr double kMostCost = 8;

std::vector<double> smoothed_logarithms(const FaceGraph& graph, const std::vector<double>& diameters) {
  std::vector<double> values(diameters.size(), NAN);
  for (std::size_t f = 0; f < values.size(); ++f) {
    if (diameters[f] > 0) values[f] = std::log(diameters[f]);
  }
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> next(values);
    for (int f = 0; f < graph.size(); ++f) {
      double sum = 0, weights = 0;
      const auto add = [&](double value, double weight) {
        if (std::isnan(value) || !(weight > 0)) return;
        sum += weight * value;
        weights += weight;
      };
      add(values[f], graph.areas[f]);
      for (int i = graph.first_border[f]; i < graph.first_border[f + 1]; ++i) {
        const int other = graph.other(graph.border_of[i], f);
        const double off = std::isnan(values[f]) ? 0 : (values[other] - values[f]) / kAlike;
        add(values[other], graph.areas[other] * std::exp(-0.5 * off * off));
      }
      if (weights > 0) next[f] = sum / weights;
    }
    values.swap(next);
  }
  return values;
}

}  // namespace

DiameterClusters cluster_diameters(const FaceGraph& graph, const std::vector<double>& diameters, int most_clusters,
                                   double smoothing, unsigned seed) {
  const std::vector<double> values = smoothed_logarithms(graph, diameters);
  std::vector<double> weights(graph.areas), samples(values);
  double known = 0, mean = 0;
  for (std::size_t f = 0; f < samples.size(); ++f) {
    if (std::isnan(samples[f])) samples[f] = weights[f] = 0;
    known += weights[f];
    mean += weights[f] * samples[f];
  }
  DiameterClusters out;
  out.labels.assign(samples.size(), 0);
  if (known <= 0) return out;
  // Faces are no independent samples; patches as wide as the solid is thick nearly are.
  const double patch = std::exp(2 * mean / known);
  const GaussianMixture mixture =
      fit_mixture(samples, weights, most_clusters, kLeastSigma, std::clamp(known / patch, 50.0, 2000.0), seed);
  out.count = static_cast<int>(mixture.components.size());
  if (out.count < 2) return out;
  Eigen::MatrixXd costs = Eigen::MatrixXd::Zero(out.count, graph.size());
  for (int f = 0; f < graph.size(); ++f) {
    if (weights[f] <= 0) continue;
    Eigen::VectorXd parts(out.count);
    for (int c = 0; c < out.count; ++c) parts[c] = mixture.log_part(c, samples[f]);
    const double total = parts.maxCoeff() + std::log((parts.array() - parts.maxCoeff()).exp().sum());
    costs.col(f) = (total - parts.array()).min(kMostCost) * (graph.areas[f] / graph.area);
  }
  std::vector<LabelLink> links;
  const double size = std::sqrt(graph.area);
  for (const FaceBorder& border : graph.borders) {
    const double inward = std::clamp(-border.bend / (kPi / 2), 0.0, 1.0);
    links.push_back({border.first, border.second, smoothing * (1 - 0.9 * inward) * border.length / size});
  }
  out.labels = alpha_expansion(costs, links);
  return out;
}

}  // namespace mmgrasp::detail
