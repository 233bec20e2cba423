#include "mmgrasp/optim/set_cover.hpp"

#include <coin/Cbc_C_Interface.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "mmgrasp/core/error.hpp"
#include "optim/set_cover_reduction.hpp"

namespace mmgrasp {
namespace {

double cost_of(const SetCoverProblem& problem, int set) {
  return problem.costs.empty() ? 1.0 : problem.costs[set];
}

double cost_of(const SetCoverProblem& problem, const std::vector<int>& sets) {
  double sum = 0;
  for (int s : sets) sum += cost_of(problem, s);
  return sum;
}

bool covers(const SetCoverProblem& problem, const std::vector<int>& sets) {
  std::vector<bool> covered(problem.elements, false);
  for (int s : sets) {
    for (int e : problem.sets[s]) covered[e] = true;
  }
  return std::all_of(covered.begin(), covered.end(), [](bool c) { return c; });
}

std::vector<int> elements_in_no_set(const SetCoverProblem& problem) {
  std::vector<bool> covered(problem.elements, false);
  for (const auto& set : problem.sets) {
    for (int e : set) covered[e] = true;
  }
  std::vector<int> missing;
  for (int e = 0; e < problem.elements; ++e) {
    if (!covered[e]) missing.push_back(e);
  }
  return missing;
}

/// The part of the problem the reductions left, renumbered.
SetCoverProblem restricted(const SetCoverProblem& problem, const detail::ReducedCover& reduced) {
  SetCoverProblem small;
  small.elements = static_cast<int>(reduced.elements.size());
  std::vector<int> new_index(problem.elements, -1);
  for (int i = 0; i < small.elements; ++i) new_index[reduced.elements[i]] = i;
  for (int s : reduced.sets) {
    std::vector<int> elements;
    for (int e : problem.sets[s]) {
      if (new_index[e] >= 0) elements.push_back(new_index[e]);
    }
    std::sort(elements.begin(), elements.end());
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
    small.sets.push_back(std::move(elements));
    small.costs.push_back(cost_of(problem, s));
  }
  return small;
}

/// Cheapest set per newly covered element first, then sets that became superfluous leave: the answer when CBC has none
/// in time.
std::vector<int> greedy_cover(const SetCoverProblem& problem) {
  std::vector<int> times_covered(problem.elements, 0), chosen;
  int missing = problem.elements;
  while (missing > 0) {
    int best = -1, best_gain = 0;
    for (int s = 0; s < static_cast<int>(problem.sets.size()); ++s) {
      const auto& set = problem.sets[s];
      const int gain =
          static_cast<int>(std::count_if(set.begin(), set.end(), [&](int e) { return times_covered[e] == 0; }));
      if (gain > 0 && (best < 0 || cost_of(problem, s) * best_gain < cost_of(problem, best) * gain)) {
        best = s;
        best_gain = gain;
      }
    }
    for (int e : problem.sets[best]) missing -= times_covered[e]++ == 0;
    chosen.push_back(best);
  }
  for (std::size_t i = 0; i < chosen.size();) {
    const auto& set = problem.sets[chosen[i]];
    if (std::all_of(set.begin(), set.end(), [&](int e) { return times_covered[e] > 1; })) {
      for (int e : set) --times_covered[e];
      chosen.erase(chosen.begin() + i);
    } else {
      ++i;
    }
  }
  return chosen;
}

bool all_integral(const std::vector<double>& costs) {
  return std::all_of(costs.begin(), costs.end(), [](double c) { return c == std::floor(c) && c < 1e9; });
}

struct BranchAndBoundAnswer {
  std::optional<std::vector<int>> chosen;
  double lower_bound = 0;
  bool proven = false;
};

/// CBC's command-line layer, which Cbc_solve goes through, keeps process-wide state: one run at a time.
std::mutex& cbc_mutex() {
  static std::mutex mutex;
  return mutex;
}

BranchAndBoundAnswer branch_and_bound(const SetCoverProblem& problem, double time_limit) {
  const std::lock_guard<std::mutex> lock(cbc_mutex());
  const std::unique_ptr<Cbc_Model, void (*)(Cbc_Model*)> model(Cbc_newModel(), Cbc_deleteModel);
  const int columns = static_cast<int>(problem.sets.size());
  std::vector<int> starts{0}, rows;
  for (const auto& set : problem.sets) {
    rows.insert(rows.end(), set.begin(), set.end());
    starts.push_back(static_cast<int>(rows.size()));
  }
  const std::vector<double> ones(rows.size(), 1.0), lower(columns, 0.0), upper(columns, 1.0);
  const std::vector<double> row_lower(problem.elements, 1.0);
  std::vector<double> row_upper(problem.elements);
  // No row bound from above is needed; the number of columns is never reached in vain and spares CBC an infinity.
  std::fill(row_upper.begin(), row_upper.end(), static_cast<double>(columns));
  Cbc_setLogLevel(model.get(), 0);
  Cbc_setParameter(model.get(), "log", "0");
  Cbc_setParameter(model.get(), "threads", "0");
  Cbc_setParameter(model.get(), "timeMode", "elapsed");
  if (!all_integral(problem.costs)) Cbc_setParameter(model.get(), "increment", "1e-9");
  Cbc_loadProblem(model.get(), columns, problem.elements, starts.data(), rows.data(), ones.data(), lower.data(),
                  upper.data(), problem.costs.data(), row_lower.data(), row_upper.data());
  for (int c = 0; c < columns; ++c) Cbc_setInteger(model.get(), c);
  Cbc_setAllowableGap(model.get(), 0.0);
  Cbc_setAllowableFractionGap(model.get(), 0.0);
  Cbc_setMaximumSeconds(model.get(), time_limit);
  Cbc_solve(model.get());

  BranchAndBoundAnswer answer;
  answer.proven = Cbc_isProvenOptimal(model.get());
  answer.lower_bound = Cbc_getBestPossibleObjValue(model.get());
  if (const double* solution = Cbc_bestSolution(model.get())) {
    answer.chosen.emplace();
    for (int c = 0; c < columns; ++c) {
      if (solution[c] > 0.5) answer.chosen->push_back(c);
    }
  }
  return answer;
}

/// A bound that rounding in the linear programmes cannot have lifted too far; whole-numbered costs allow rounding it
/// up.
double safe_bound(double bound, const std::vector<double>& costs) {
  if (!std::isfinite(bound) || bound < 0) return 0;
  const double lowered = bound - 1e-6 * std::max(1.0, std::abs(bound));
  return std::max(0.0, all_integral(costs) ? std::ceil(lowered) : lowered);
}

}  // namespace

void SetCoverProblem::check() const {
  require(elements >= 0, "elements", elements, "must be 0 or more");
  for (std::size_t s = 0; s < sets.size(); ++s) {
    for (int e : sets[s]) {
      require(e >= 0 && e < elements, "sets[" + std::to_string(s) + "]", e,
              "must be an element in [0, " + std::to_string(elements) + ")");
    }
  }
  if (costs.empty()) return;
  require(costs.size() == sets.size(), "costs", static_cast<double>(costs.size()),
          "must have one entry per set (" + std::to_string(sets.size()) + ")");
  for (std::size_t s = 0; s < costs.size(); ++s) {
    require(std::isfinite(costs[s]) && costs[s] > 0, "costs[" + std::to_string(s) + "]", costs[s],
            "must be finite and > 0");
  }
}

SetCoverResult solve_set_cover(const SetCoverProblem& problem, double time_limit) {
  problem.check();
  require(time_limit > 0, "time_limit", time_limit, "must be > 0");
  SetCoverResult result;
  result.uncoverable = elements_in_no_set(problem);
  if (!result.uncoverable.empty()) {
    result.outcome = Outcome::infeasible;
    return result;
  }
  const detail::ReducedCover reduced = detail::reduce_set_cover(problem);
  result.chosen = reduced.forced;
  result.lower_bound = cost_of(problem, reduced.forced);
  bool proven = true;
  if (!reduced.elements.empty()) {
    const SetCoverProblem small = restricted(problem, reduced);
    const BranchAndBoundAnswer answer = branch_and_bound(small, time_limit);
    std::vector<int> chosen = greedy_cover(small);
    const bool usable = answer.chosen && covers(small, *answer.chosen);
    proven = answer.proven && usable;
    if (usable && (proven || cost_of(small, *answer.chosen) <= cost_of(small, chosen))) chosen = *answer.chosen;
    for (int c : chosen) result.chosen.push_back(reduced.sets[c]);
    result.lower_bound += proven ? cost_of(small, chosen) : safe_bound(answer.lower_bound, small.costs);
  }
  std::sort(result.chosen.begin(), result.chosen.end());
  result.cost = cost_of(problem, result.chosen);
  result.lower_bound = proven ? result.cost : std::min(result.lower_bound, result.cost);
  if (!covers(problem, result.chosen)) throw Error("set cover: the answer leaves an element uncovered");
  // A greedy cover that meets the bound is proven as well.
  result.outcome = proven || result.cost <= result.lower_bound ? Outcome::solved : Outcome::approximate;
  return result;
}

}  // namespace mmgrasp
