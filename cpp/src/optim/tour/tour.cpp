#include "mmgrasp/optim/tour.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "optim/tour/tour_bounds.hpp"
#include "optim/tour/tour_search.hpp"

namespace mmgrasp {
namespace {

constexpr int kExactStops = 15;
constexpr double kProven = 1e-9;  // Relative gap that is rounding.

void check_lengths(const Eigen::MatrixXd& lengths) {
  require(lengths.rows() == lengths.cols() && lengths.rows() >= 2, "lengths",
          std::to_string(lengths.rows()) + " x " + std::to_string(lengths.cols()),
          "must be square, (stops + 2) x (stops + 2)");
  for (int i = 0; i < lengths.rows(); ++i) {
    for (int j = 0; j < lengths.cols(); ++j) {
      require(lengths(i, j) >= 0 || i == j, "lengths(" + std::to_string(i) + ", " + std::to_string(j) + ")",
              lengths(i, j), "must be 0 or more (infinite: no way)");
    }
  }
}

double length_of(const Eigen::MatrixXd& lengths, const std::vector<int>& order) {
  const int start = static_cast<int>(lengths.rows()) - 2, goal = start + 1;
  double sum = 0;
  int from = start;
  for (int stop : order) {
    sum += lengths(from, stop);
    from = stop;
  }
  return sum + lengths(from, goal);
}

/// Held and Karp: best[mask][j] is the shortest way from the start through all of `mask` that ends in j.
std::vector<int> exact_order(const Eigen::MatrixXd& lengths, int n) {
  if (n == 0) return {};
  const int start = n, goal = n + 1;
  const std::size_t masks = std::size_t{1} << n;
  std::vector<double> best(masks * n, detail::kInfinity);
  std::vector<signed char> previous(masks * n, -1);
  for (int j = 0; j < n; ++j) best[(std::size_t{1} << j) * n + j] = lengths(start, j);
  detail::InterruptionPoll poll;
  for (std::size_t mask = 1; mask < masks; ++mask) {
    poll();
    for (int last = 0; last < n; ++last) {
      const double so_far = best[mask * n + last];
      if (so_far == detail::kInfinity) continue;
      for (int next = 0; next < n; ++next) {
        if (mask >> next & 1) continue;
        const std::size_t to = (mask | std::size_t{1} << next) * n + next;
        const double candidate = so_far + lengths(last, next);
        if (candidate < best[to]) {
          best[to] = candidate;
          previous[to] = static_cast<signed char>(last);
        }
      }
    }
  }
  std::size_t mask = masks - 1;
  int last = -1;
  double shortest = detail::kInfinity;
  for (int j = 0; j < n; ++j) {
    const double total = best[mask * n + j] + lengths(j, goal);
    if (total < shortest) {
      shortest = total;
      last = j;
    }
  }
  std::vector<int> order;
  while (last >= 0) {
    order.push_back(last);
    const int before = previous[mask * n + last];
    mask &= ~(std::size_t{1} << last);
    last = before;
  }
  std::reverse(order.begin(), order.end());
  return order;
}

/// "No way" as a length beyond any tour without one, so that the heuristics can compare tours that use some.
Eigen::MatrixXd with_large_finite(const Eigen::MatrixXd& lengths) {
  double largest = 1.0;
  for (double value : lengths.reshaped()) {
    if (std::isfinite(value)) largest = std::max(largest, value);
  }
  const double large = largest * 10.0 * static_cast<double>(lengths.rows());
  return lengths.unaryExpr([large](double value) { return std::isfinite(value) ? value : large; });
}

}  // namespace

TourResult shortest_visiting_tour(const Eigen::MatrixXd& lengths) {
  check_lengths(lengths);
  const int n = std::max(0, static_cast<int>(lengths.rows()) - 2);
  TourResult result;
  const bool exact = n <= kExactStops;
  const Eigen::MatrixXd finite = exact ? Eigen::MatrixXd() : with_large_finite(lengths);
  result.order = exact ? exact_order(lengths, n) : detail::short_order(finite);
  result.length = static_cast<int>(result.order.size()) == n ? length_of(lengths, result.order) : detail::kInfinity;
  if (!std::isfinite(result.length)) {
    result.proven = exact;
    result.lower_bound = exact ? detail::kInfinity : 0;
    result.order.clear();
    result.outcome = exact ? Outcome::infeasible : Outcome::not_found;
    return result;
  }
  result.lower_bound = exact ? result.length : detail::tour_bound(finite, result.length);
  result.proven = result.lower_bound >= result.length * (1 - kProven);
  result.outcome = result.proven ? Outcome::solved : Outcome::approximate;
  return result;
}

}  // namespace mmgrasp
