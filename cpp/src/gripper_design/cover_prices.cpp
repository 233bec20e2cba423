#include "gripper_design/cover_prices.hpp"

#include <algorithm>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kStallLimit = 15;      // Steps without a better bound before they are halved.
constexpr double kRounding = 1e-13;  // Share of all terms that roundings may have added to a bound.

}  // namespace

CoverPrices::CoverPrices(const std::vector<GripperCandidate>& candidates)
    : candidates_(candidates), takes_(candidates.size()), reduced_(candidates.size(), 0.0) {}

double CoverPrices::raise(const Bits& allowed, const Bits& uncovered, int steps, double enough,
                          std::vector<double>& prices) {
  uncovered_.clear();
  allowed_.clear();
  for (int p = uncovered.first(); p >= 0; p = uncovered.next(p + 1)) uncovered_.push_back(p);
  for (int g = allowed.first(); g >= 0; g = allowed.next(g + 1)) {
    Bits parts = candidates_[g].parts;
    parts &= uncovered;
    takes_[g].clear();
    for (int p = parts.first(); p >= 0; p = parts.next(p + 1)) takes_[g].push_back(p);
    allowed_.push_back(g);
  }
  std::vector<double> now = prices, open(prices.size());
  double best = -kInfinity, step = 1;
  int since = 0;
  for (int k = 0; k < steps; ++k) {
    reduce(now);
    const double reached = bound(now);
    if (reached > best) {
      best = reached;
      prices = now;
      since = 0;
    } else if (++since > kStallLimit) {
      since = 0;
      step /= 2;
      now = prices;
      continue;
    }
    if (best > enough) break;
    for (const int p : uncovered_) open[p] = 1;
    for (const int g : allowed_)
      if (reduced_[g] < 0)
        for (const int p : takes_[g]) open[p] -= 1;
    double squares = 0;
    for (const int p : uncovered_) {
      if (now[p] == 0 && open[p] < 0) open[p] = 0;
      squares += open[p] * open[p];
    }
    if (squares == 0) break;
    const double length = step * (1.05 * enough - reached) / squares;
    for (const int p : uncovered_) now[p] = std::max(0.0, now[p] + length * open[p]);
  }
  reduce(prices);
  return best;
}

void CoverPrices::reduce(const std::vector<double>& prices) {
  for (const int g : allowed_) {
    reduced_[g] = candidates_[g].cost;
    for (const int p : takes_[g]) reduced_[g] -= prices[p];
  }
}

double CoverPrices::bound(const std::vector<double>& prices) const {
  double sum = 0, terms = 0;
  for (const int p : uncovered_) sum += prices[p];
  terms = sum;
  for (const int g : allowed_) {
    terms += 2 * candidates_[g].cost - reduced_[g];
    sum += std::min(0.0, reduced_[g]);
  }
  return sum - kRounding * terms;
}

}  // namespace mmgrasp::detail
