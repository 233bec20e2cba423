#include "optim/set_cover/set_cover_prices.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kStallLimit = 30;   // Steps without a better bound before the step length is halved.
constexpr int kGreedyEvery = 10;  // Steps between two covers.
constexpr std::uint64_t kSearchSeed = 1;
constexpr double kFirstStep = 1.0;
constexpr double kLastStep = 2e-3;

using Lists = std::vector<std::vector<int>>;

Lists sets_by_element(const SetCoverProblem& problem) {
  Lists sets_of(problem.elements);
  for (std::size_t s = 0; s < problem.sets.size(); ++s) {
    for (int e : problem.sets[s]) sets_of[e].push_back(static_cast<int>(s));
  }
  return sets_of;
}

/// Greedy choice on prices: what a set costs beyond the prices of the elements it newly covers, per such element.
class Greedy {
 public:
  Greedy(const SetCoverProblem& problem, const Lists& sets_of) : problem_(problem), sets_of_(sets_of) {}

  /// `kept` are taken first.
  std::vector<int> cover(const std::vector<double>& prices, const std::vector<double>& reduced,
                         const std::vector<int>& kept = {}) {
    const std::size_t sets = problem_.sets.size();
    times_.assign(problem_.elements, 0);
    missing_.resize(sets);
    above_ = reduced;
    std::priority_queue<Entry> queue;
    for (std::size_t s = 0; s < sets; ++s) missing_[s] = static_cast<int>(problem_.sets[s].size());
    std::vector<int> chosen;
    open_ = problem_.elements;
    for (int s : kept) take(s, prices, chosen);
    for (std::size_t s = 0; s < sets; ++s) {
      if (missing_[s] > 0) queue.push({score(s), static_cast<int>(s)});
    }
    while (open_ > 0) {
      const Entry entry = queue.top();
      queue.pop();
      const std::size_t s = entry.set;
      if (missing_[s] == 0) continue;
      const double now = score(s);  // scores only get worse while elements get covered
      if (now > entry.score) {
        queue.push({now, entry.set});
        continue;
      }
      take(entry.set, prices, chosen);
    }
    drop_superfluous(chosen);
    return chosen;
  }

 private:
  struct Entry {
    double score;
    int set;
    bool operator<(const Entry& other) const { return score != other.score ? score > other.score : set > other.set; }
  };

  double score(std::size_t s) const { return above_[s] > 0 ? above_[s] / missing_[s] : above_[s] * missing_[s]; }

  void take(int set, const std::vector<double>& prices, std::vector<int>& chosen) {
    chosen.push_back(set);
    for (int e : problem_.sets[set]) {
      const std::size_t i = e;
      if (times_[i]++ > 0) continue;
      --open_;
      for (int other : sets_of_[i]) {
        --missing_[other];
        above_[other] += prices[i];
      }
    }
  }

  void drop_superfluous(std::vector<int>& chosen) {
    std::stable_sort(chosen.begin(), chosen.end(), [&](int a, int b) { return problem_.costs[a] > problem_.costs[b]; });
    std::vector<int> kept;
    for (int s : chosen) {
      const auto& set = problem_.sets[s];
      if (std::all_of(set.begin(), set.end(), [&](int e) { return times_[e] > 1; })) {
        for (int e : set) --times_[e];
      } else {
        kept.push_back(s);
      }
    }
    std::sort(kept.begin(), kept.end());
    chosen = std::move(kept);
  }

  const SetCoverProblem& problem_;
  const Lists& sets_of_;
  std::vector<int> times_, missing_;
  std::vector<double> above_;
  int open_ = 0;
};

double cost_of(const SetCoverProblem& problem, const std::vector<int>& chosen) {
  double sum = 0;
  for (int s : chosen) sum += problem.costs[s];
  return sum;
}

}  // namespace

bool all_integral(const std::vector<double>& costs) {
  return std::all_of(costs.begin(), costs.end(), [](double c) { return c == std::floor(c) && c < 1e9; });
}

std::vector<double> reduced_costs(const SetCoverProblem& problem, const std::vector<double>& prices) {
  std::vector<double> reduced = problem.costs;
  for (std::size_t s = 0; s < problem.sets.size(); ++s) {
    for (int e : problem.sets[s]) reduced[s] -= prices[e];
  }
  return reduced;
}

double bound_by_prices(const SetCoverProblem& problem, const std::vector<double>& prices) {
  double sum = 0, terms = 0;
  for (double price : prices) sum += price;
  terms = sum;
  for (std::size_t s = 0; s < problem.sets.size(); ++s) {
    double above = problem.costs[s], size = problem.costs[s];
    for (int e : problem.sets[s]) {
      above -= prices[e];
      size += prices[e];
    }
    if (above < 0) sum += above;
    terms += size;
  }
  // Each term carries at most some hundred roundings of 1.2e-16 of its size.
  return sum - 1e-13 * terms;
}

void search_covers(const SetCoverProblem& problem, PricedCover& best, int rounds) {
  const Lists sets_of = sets_by_element(problem);
  Greedy greedy(problem, sets_of);
  Rng rng(kSearchSeed);
  std::vector<int> current = best.chosen;
  double cost = best.cost;
  std::vector<double> prices(best.prices.size());
  for (int round = 0; round < rounds && best.bound < best.cost; ++round) {
    const double leave = rng.uniform(0.05, 0.4);
    std::vector<int> kept;
    for (int s : current) {
      if (rng.uniform() > leave) kept.push_back(s);
    }
    for (std::size_t e = 0; e < prices.size(); ++e) prices[e] = best.prices[e] * rng.uniform(0.8, 1.2);
    std::vector<int> chosen = greedy.cover(prices, reduced_costs(problem, prices), kept);
    const double found = cost_of(problem, chosen);
    if (found > cost) continue;  // equal ones are taken too: they lead elsewhere
    cost = found;
    current = std::move(chosen);
    if (cost < best.cost) {
      best.cost = cost;
      best.chosen = current;
    }
  }
}

PricedCover price_set_cover(const SetCoverProblem& problem, int max_steps) {
  const Lists sets_of = sets_by_element(problem);
  const std::size_t elements = problem.elements;
  const bool integral = all_integral(problem.costs);
  Greedy greedy(problem, sets_of);
  PricedCover best;
  best.chosen = greedy.cover(std::vector<double>(elements, 0.0), problem.costs);
  best.cost = cost_of(problem, best.chosen);

  std::vector<double> prices(elements, kInfinity);
  for (std::size_t s = 0; s < problem.sets.size(); ++s) {
    for (int e : problem.sets[s]) {
      double& price = prices[e];
      price = std::min(price, problem.costs[s] / static_cast<double>(problem.sets[s].size()));
    }
  }
  best.prices = prices;
  best.bound = -kInfinity;
  double step = kFirstStep;
  int since = 0;
  std::vector<double> open(elements);
  for (int k = 0; k < max_steps && step > kLastStep; ++k) {
    const std::vector<double> reduced = reduced_costs(problem, prices);
    double bound = std::accumulate(prices.begin(), prices.end(), 0.0);
    open.assign(elements, 1.0);
    for (std::size_t s = 0; s < problem.sets.size(); ++s) {
      if (!(reduced[s] < 0)) continue;
      bound += reduced[s];
      for (int e : problem.sets[s]) open[e] -= 1;
    }
    if (bound > best.bound + 1e-6 * std::max(1.0, std::abs(best.bound))) since = 0;
    if (bound > best.bound) {
      best.bound = bound;
      best.prices = prices;
    }
    if (++since > kStallLimit) {
      since = 0;
      step *= 0.5;
      prices = best.prices;
      continue;
    }
    if (k % kGreedyEvery == 0 || bound >= best.bound) {
      std::vector<int> chosen = greedy.cover(prices, reduced);
      const double cost = cost_of(problem, chosen);
      if (cost < best.cost) {
        best.cost = cost;
        best.chosen = std::move(chosen);
      }
    }
    const double reached = integral ? std::ceil(best.bound - 1e-6) : best.bound;
    if (reached >= best.cost) break;
    double squares = 0;
    for (std::size_t e = 0; e < elements; ++e) {
      if (prices[e] == 0 && open[e] < 0) open[e] = 0;  // it could only go below zero
      squares += open[e] * open[e];
    }
    if (squares == 0) break;
    // Aiming a little above the best cover keeps steps useful when bound and cover are close.
    const double length = step * (1.01 * best.cost - bound) / squares;
    for (std::size_t e = 0; e < elements; ++e) prices[e] = std::max(0.0, prices[e] + length * open[e]);
  }
  best.bound = std::max(0.0, bound_by_prices(problem, best.prices));
  if (integral) best.bound = std::ceil(best.bound - 1e-6);
  best.bound = std::min(best.bound, best.cost);
  return best;
}

}  // namespace mmgrasp::detail
