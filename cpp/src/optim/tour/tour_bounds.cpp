#include "optim/tour/tour_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/optim/assignment.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kMaxSteps = 1000;
constexpr int kStallLimit = 20;
constexpr double kLastStep = 1e-4;

/// Shortest spanning tree of symmetric lengths plus prices (Prim); its length and each node's neighbours.
double spanning_tree(const Eigen::MatrixXd& lengths, const Eigen::VectorXd& prices, Eigen::VectorXi& degrees) {
  const auto n = lengths.rows();
  std::vector<double> nearest(n, kInfinity);
  std::vector<Eigen::Index> from(n, 0);
  std::vector<char> in(n, 0);
  degrees = Eigen::VectorXi::Zero(n);
  double total = 0;
  Eigen::Index at = 0;
  for (Eigen::Index joined = 1; joined < n; ++joined) {
    detail::throw_if_interrupted();
    in[at] = 1;
    Eigen::Index next = -1;
    for (Eigen::Index j = 0; j < n; ++j) {
      const std::size_t i = j;
      if (in[i]) continue;
      const double length = lengths(at, j) + prices(at) + prices(j);
      if (length < nearest[i]) {
        nearest[i] = length;
        from[i] = at;
      }
      if (next < 0 || nearest[i] < nearest[next]) next = j;
    }
    total += nearest[next];
    ++degrees(next);
    ++degrees(from[next]);
    at = next;
  }
  return total;
}

double tree_bound(const Eigen::MatrixXd& lengths, double reached) {
  const auto n = lengths.rows();
  Eigen::MatrixXd shorter = lengths.cwiseMin(lengths.transpose());
  // Never driven when there is a stop between.
  const double far = 4 * (reached + shorter.maxCoeff());
  shorter(n - 2, n - 1) = shorter(n - 1, n - 2) = far;
  // Nothing is ever driven into the start or out of the goal.
  for (Eigen::Index i = 0; i < n - 2; ++i) {
    shorter(n - 2, i) = shorter(i, n - 2) = lengths(n - 2, i);
    shorter(n - 1, i) = shorter(i, n - 1) = lengths(i, n - 1);
  }
  Eigen::VectorXi wanted = Eigen::VectorXi::Constant(n, 2), degrees;
  wanted.tail<2>().setOnes();
  Eigen::VectorXd prices = Eigen::VectorXd::Zero(n), best_prices = prices;
  double best = 0, step = 1;
  int since = 0;
  for (int k = 0; k < kMaxSteps && step > kLastStep; ++k) {
    const double bound = spanning_tree(shorter, prices, degrees) - prices.dot(wanted.cast<double>());
    if (bound > best + 1e-9 * reached) since = 0;
    if (bound > best) {
      best = bound;
      best_prices = prices;
    }
    const Eigen::VectorXd off = (degrees - wanted).cast<double>();
    if (off.squaredNorm() == 0 || best >= reached) break;
    if (++since > kStallLimit) {
      since = 0;
      step *= 0.5;
      prices = best_prices;
      continue;
    }
    prices += step * std::max(reached - bound, 1e-3 * reached) / off.squaredNorm() * off;
  }
  return best;
}

double assignment_bound(const Eigen::MatrixXd& lengths, double reached) {
  const auto n = lengths.rows();
  // Rows: stops and start; columns: stops and goal.
  Eigen::MatrixXd costs(n - 1, n - 1);
  costs.leftCols(n - 2) = lengths.topLeftCorner(n - 1, n - 2);
  costs.col(n - 2) = lengths.col(n - 1).head(n - 1);
  const double far = 4 * (reached + lengths.maxCoeff());
  for (Eigen::Index i = 0; i < n - 2; ++i) costs(i, i) = far;
  costs(n - 2, n - 2) = far;
  double total = 0;
  const std::vector<int> column = cheapest_assignment(costs);
  for (Eigen::Index i = 0; i < n - 1; ++i) total += costs(i, column[i]);
  return total;
}

}  // namespace

double tour_bound(const Eigen::MatrixXd& lengths, double reached) {
  if (lengths.rows() < 3) return lengths(0, 1);
  const double bound = std::max(tree_bound(lengths, reached), assignment_bound(lengths, reached));
  return std::clamp(bound - 1e-12 * static_cast<double>(lengths.rows()) * reached, 0.0, reached);
}

}  // namespace mmgrasp::detail
