#include "task/part_supply/arrivals.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "task/part_supply/alternative_base_poses.hpp"

namespace mmgrasp::detail {
namespace {

constexpr std::size_t kFewArrivals = 100;   // Drawn at each base pose that could be the stop.
constexpr std::size_t kMoreArrivals = 800;  // Drawn at the best of them.
constexpr std::size_t kFinalists = 8;
constexpr std::size_t kMostPoses = 400;

/// A matrix whose product with its transpose is the covariance; variances of 0 are no obstacle.
Eigen::Matrix3d square_root(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// The stops that most arrivals serve, best first; among equals the order stays.
std::vector<Stop> best_of(std::vector<Stop> stops, const std::vector<StopShare>& shares, std::size_t count) {
  std::vector<std::size_t> order(stops.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return shares[a].good > shares[b].good; });
  std::vector<Stop> best;
  for (std::size_t i = 0; i < std::min(count, order.size()); ++i) best.push_back(stops[order[i]]);
  return best;
}

}  // namespace

StopSamples count_arrivals(const PartSupplyProblem& problem, const BasePoseEvaluator& evaluator,
                           const std::vector<Stop>& stops, std::size_t samples, bool chosen, const Monitor& monitor) {
  const Eigen::Matrix3d root = square_root(problem.arrival_covariance);
  const auto arrival = [&root](const Stop& stop, Rng& rng) {
    const double x = rng.normal(), y = rng.normal(), theta = rng.normal();
    return Eigen::Vector3d(stop.pose + root * Eigen::Vector3d(x, y, theta));
  };
  return sample_base_poses(problem, evaluator, stops, samples, problem.options.seed + (chosen ? 79 : 78), true, arrival,
                           monitor);
}

void seek_likely_poses(const PartSupplyProblem& problem, const BasePoseEvaluator& evaluator, const BaseGrid& grid,
                       const std::vector<BaseRegion>& regions, std::vector<Stop>& stops, double required_rate,
                       const Monitor& monitor) {
  for (Stop& stop : stops) {
    std::vector<Stop> places = alternative_base_poses(grid, regions, stop, problem.options.positioning_uncertainty,
                                                      1.5 * grid.resolution, kMostPoses);
    places.insert(places.begin(), stop);
    StopSamples seen = count_arrivals(problem, evaluator, places, kFewArrivals, false, monitor);
    places = best_of(std::move(places), seen.stops, kFinalists);
    places.insert(places.begin(), stop);  // to be compared by as many arrivals
    seen = count_arrivals(problem, evaluator, places, kMoreArrivals, false, monitor);
    for (const Stop& place : best_of(places, seen.stops, places.size())) {
      if (monitor.stopped()) return;
      if (place.pose == stop.pose) break;
      std::vector<BaseRegion> scratch = regions;
      const RobustnessResult check = check_robustness(problem, evaluator, grid, {place}, scratch, monitor);
      if (check.stopped || check.rate() < required_rate) continue;
      stop = place;
      break;
    }
  }
}

}  // namespace mmgrasp::detail
