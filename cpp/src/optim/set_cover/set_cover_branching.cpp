#include "optim/set_cover/set_cover_branching.hpp"

#include <coin/Cbc_C_Interface.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include "mmgrasp/core/detail/stopwatch.hpp"
#include "optim/set_cover/set_cover_prices.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kNodesWithoutCuts = 800;

/// CBC's command-line layer, which Cbc_solve goes through, keeps process-wide state: one run at a time.
std::mutex& cbc_mutex() {
  static std::mutex mutex;
  return mutex;
}

bool covers(const SetCoverProblem& problem, const std::vector<int>& sets) {
  std::vector<bool> covered(static_cast<std::size_t>(problem.elements), false);
  for (int s : sets) {
    for (int e : problem.sets[s]) covered[e] = true;
  }
  return std::all_of(covered.begin(), covered.end(), [](bool c) { return c; });
}

/// Whole-numbered costs allow rounding the bound up.
double safe_bound(double bound, const std::vector<double>& costs) {
  if (!std::isfinite(bound) || bound < 0) return 0;
  const double lowered = bound - 1e-6 * std::max(1.0, std::abs(bound));
  return std::max(0.0, all_integral(costs) ? std::ceil(lowered) : lowered);
}

BranchAndBoundAnswer run_cbc(const SetCoverProblem& problem, double known_cost, bool with_cuts, int max_nodes,
                             double time_limit) {
  const std::unique_ptr<Cbc_Model, void (*)(Cbc_Model*)> model(Cbc_newModel(), Cbc_deleteModel);
  const int columns = static_cast<int>(problem.sets.size());
  std::vector<int> starts{0}, rows;
  for (const auto& set : problem.sets) {
    rows.insert(rows.end(), set.begin(), set.end());
    starts.push_back(static_cast<int>(rows.size()));
  }
  const auto elements = static_cast<std::size_t>(problem.elements);
  const std::vector<double> ones(rows.size(), 1.0), lower(problem.sets.size(), 0.0), upper(problem.sets.size(), 1.0);
  const std::vector<double> row_lower(elements, 1.0);
  // No row bound from above is needed; the number of columns is never reached in vain and spares CBC an infinity.
  const std::vector<double> row_upper(elements, static_cast<double>(columns));
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
  if (max_nodes >= 0) Cbc_setMaximumNodes(model.get(), max_nodes);
  if (!with_cuts) {
    Cbc_setParameter(model.get(), "cutsOnOff", "off");
    Cbc_setParameter(model.get(), "heuristicsOnOff", "off");
    if (all_integral(problem.costs)) Cbc_setCutoff(model.get(), known_cost - 0.5);
  }
  Cbc_solve(model.get());

  BranchAndBoundAnswer answer;
  answer.lower_bound = safe_bound(Cbc_getBestPossibleObjValue(model.get()), problem.costs);
  if (const double* solution = Cbc_bestSolution(model.get())) {
    std::vector<int> chosen;
    for (int c = 0; c < columns; ++c) {
      if (solution[c] > 0.5) chosen.push_back(c);
    }
    if (covers(problem, chosen)) answer.chosen = std::move(chosen);
  }
  answer.proven = Cbc_isProvenOptimal(model.get()) && answer.chosen.has_value();
  answer.none_cheaper = Cbc_isProvenInfeasible(model.get());
  return answer;
}

}  // namespace

BranchAndBoundAnswer branch_and_bound(const SetCoverProblem& problem, double known_cost, double time_limit) {
  const std::lock_guard<std::mutex> lock(cbc_mutex());
  const TimeLimit limit(time_limit);
  // Cutting planes decide sparse problems such as floors full of trays and only cost time on dense ones: nodes are
  // cheap without them, so some are tried first.
  BranchAndBoundAnswer answer = run_cbc(problem, known_cost, false, kNodesWithoutCuts, time_limit);
  const double left = limit.seconds_left();
  if (answer.proven || answer.none_cheaper || left <= 0) return answer;
  BranchAndBoundAnswer second = run_cbc(problem, known_cost, true, -1, left);
  second.lower_bound = std::max(second.lower_bound, answer.lower_bound);
  if (!second.chosen) second.chosen = answer.chosen;
  return second;
}

}  // namespace mmgrasp::detail
