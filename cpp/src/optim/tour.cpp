#include "mmgrasp/optim/tour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

constexpr int kExactStops = 15;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

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
  std::vector<double> best(masks * n, kInfinity);
  std::vector<signed char> previous(masks * n, -1);
  for (int j = 0; j < n; ++j) best[(std::size_t{1} << j) * n + j] = lengths(start, j);
  for (std::size_t mask = 1; mask < masks; ++mask) {
    for (int last = 0; last < n; ++last) {
      const double so_far = best[mask * n + last];
      if (so_far == kInfinity) continue;
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
  double shortest = kInfinity;
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

std::vector<int> nearest_insertion(const Eigen::MatrixXd& lengths, int n) {
  std::vector<int> order;
  std::vector<bool> placed(n, false);
  for (int round = 0; round < n; ++round) {
    int best_stop = -1;
    std::size_t best_place = 0;
    double best_extra = kInfinity;
    for (int stop = 0; stop < n; ++stop) {
      if (placed[stop]) continue;
      for (std::size_t place = 0; place <= order.size(); ++place) {
        const int before = place == 0 ? n : order[place - 1], after = place == order.size() ? n + 1 : order[place];
        const double extra = lengths(before, stop) + lengths(stop, after) - lengths(before, after);
        if (best_stop < 0 || extra < best_extra) {
          best_stop = stop;
          best_place = place;
          best_extra = extra;
        }
      }
    }
    order.insert(order.begin() + best_place, best_stop);
    placed[best_stop] = true;
  }
  return order;
}

/// Reverses stretches and moves runs of up to three stops (either way round) while that shortens the tour.
void improve(const Eigen::MatrixXd& lengths, std::vector<int>& order) {
  const int n = static_cast<int>(order.size());
  double length = length_of(lengths, order);
  const auto keep_if_shorter = [&](std::vector<int>& trial) {
    const double trial_length = length_of(lengths, trial);
    if (trial_length >= length - 1e-12 * (1 + length)) return false;
    order = trial;
    length = trial_length;
    return true;
  };
  std::vector<int> trial, run;
  bool improved = true;
  while (improved) {
    improved = false;
    for (int i = 0; i < n; ++i) {
      for (int j = i + 1; j < n; ++j) {
        trial = order;
        std::reverse(trial.begin() + i, trial.begin() + j + 1);
        improved |= keep_if_shorter(trial);
      }
    }
    for (int size = 1; size <= 3 && size < n; ++size) {
      for (int from = 0; from + size <= n; ++from) {
        for (int to = 0; to <= n - size; ++to) {
          for (const bool reversed : {false, true}) {
            trial = order;
            run.assign(trial.begin() + from, trial.begin() + from + size);
            if (reversed) std::reverse(run.begin(), run.end());
            trial.erase(trial.begin() + from, trial.begin() + from + size);
            trial.insert(trial.begin() + to, run.begin(), run.end());
            improved |= keep_if_shorter(trial);
          }
        }
      }
    }
  }
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
  result.proven = n <= kExactStops;
  if (result.proven) {
    result.order = exact_order(lengths, n);
  } else {
    const Eigen::MatrixXd finite = with_large_finite(lengths);
    result.order = nearest_insertion(finite, n);
    improve(finite, result.order);
  }
  result.length = static_cast<int>(result.order.size()) == n ? length_of(lengths, result.order) : kInfinity;
  if (std::isfinite(result.length)) {
    result.outcome = result.proven ? Outcome::solved : Outcome::approximate;
  } else {
    result.order.clear();
    result.outcome = result.proven ? Outcome::infeasible : Outcome::timeout;
  }
  return result;
}

}  // namespace mmgrasp
