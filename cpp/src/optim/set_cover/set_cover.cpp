#include "mmgrasp/optim/set_cover.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>

#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "optim/set_cover/set_cover_branching.hpp"
#include "optim/set_cover/set_cover_prices.hpp"
#include "optim/set_cover/set_cover_reduction.hpp"

namespace mmgrasp {
namespace {

constexpr int kPriceSteps = 3000;
constexpr double kSearchWork = 5e6;     // Entries of the problem checked in search of a better cover.
constexpr double kShrunk = 0.8;         // Prices are sought again when no more than this share of the sets is left.
constexpr double kLeastSeconds = 1e-3;  // CBC gets this much time, however late it is.

constexpr double kWholeNumbers = 1e9;    // Costs below that are compared as whole numbers (all_integral).
constexpr double kMostTimesLeast = 1e9;  // Cheaper sets would vanish in the roundings of dear ones.

/// What costs are counted in, so that the tolerances of prices and of CBC are small beside them: the common factor of
/// whole numbers, else the power of two (it rounds nothing) below the least one.
double cost_unit(const std::vector<double>& costs) {
  const auto [least, most] = std::minmax_element(costs.begin(), costs.end());
  std::int64_t factor = 0;
  for (const double c : costs) {
    if (c != std::floor(c) || c > 9e15) {
      factor = 0;
      break;
    }
    factor = std::gcd(factor, static_cast<std::int64_t>(c));
  }
  if (factor > 0 && *most / static_cast<double>(factor) < kWholeNumbers) return static_cast<double>(factor);
  return std::exp2(std::ilogb(*least));
}

double cost_of(const SetCoverProblem& problem, int set) {
  return problem.costs.empty() ? 1.0 : problem.costs[set];
}

double cost_of(const SetCoverProblem& problem, const std::vector<int>& sets) {
  double sum = 0;
  for (int s : sets) sum += cost_of(problem, s);
  return sum;
}

double size_of(const SetCoverProblem& problem) {
  std::size_t size = 0;
  for (const auto& set : problem.sets) size += set.size();
  return static_cast<double>(size);
}

std::vector<int> elements_left_out(const SetCoverProblem& problem, const std::vector<int>& sets) {
  std::vector<bool> covered(problem.elements, false);
  for (int s : sets) {
    for (int e : problem.sets[s]) covered[e] = true;
  }
  std::vector<int> missing;
  for (int e = 0; e < problem.elements; ++e) {
    if (!covered[e]) missing.push_back(e);
  }
  return missing;
}

std::vector<int> elements_in_no_set(const SetCoverProblem& problem) {
  std::vector<int> all(problem.sets.size());
  std::iota(all.begin(), all.end(), 0);
  return elements_left_out(problem, all);
}

/// A part of a problem with its own numbers, and which of the problem's sets they are.
struct Part {
  SetCoverProblem problem;
  std::vector<int> sets;
};

/// The problem on some of its sets and elements; costs are written out.
Part part_of(const SetCoverProblem& problem, const std::vector<int>& sets, const std::vector<int>& elements) {
  Part part;
  part.problem.elements = static_cast<int>(elements.size());
  std::vector<int> new_index(problem.elements, -1);
  for (std::size_t i = 0; i < elements.size(); ++i) new_index[elements[i]] = static_cast<int>(i);
  for (int s : sets) {
    std::vector<int> kept;
    for (int e : problem.sets[s]) {
      if (new_index[e] >= 0) kept.push_back(new_index[e]);
    }
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    if (kept.empty()) continue;
    part.problem.sets.push_back(std::move(kept));
    part.problem.costs.push_back(cost_of(problem, s));
    part.sets.push_back(s);
  }
  return part;
}

/// Elements that no set joins can be covered apart.
std::vector<std::vector<int>> components(const SetCoverProblem& problem) {
  std::vector<int> root(problem.elements);
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&root](int e) {
    while (root[e] != e) {
      int& up = root[e];
      up = root[up];
      e = up;
    }
    return e;
  };
  for (const auto& set : problem.sets) {
    for (int e : set) root[find(e)] = find(set.front());
  }
  std::vector<std::vector<int>> lists(problem.elements);
  for (int e = 0; e < problem.elements; ++e) lists[find(e)].push_back(e);
  lists.erase(std::remove_if(lists.begin(), lists.end(), [](const auto& list) { return list.empty(); }), lists.end());
  return lists;
}

/// Divides and conquers: reductions, independent components, Lagrangian prices, then branch and bound with CBC.
class Solver {
 public:
  Solver(double time_limit, const Monitor& monitor) : time_limit_(std::min(time_limit, 1e6)), monitor_(monitor) {}

  struct Answer {
    std::vector<int> chosen;
    double bound = 0;
  };

  /// A cover and a proven bound; both meet when it is optimal. Reduced, in components, each by prices and then by
  /// branch and bound.
  Answer solve(const SetCoverProblem& problem) {
    const detail::ReducedCover reduced = detail::reduce_set_cover(problem);
    Answer answer{reduced.forced, cost_of(problem, reduced.forced)};
    if (reduced.elements.empty()) return answer;
    const Part rest = part_of(problem, reduced.sets, reduced.elements);
    std::vector<int> all(rest.problem.sets.size());
    std::iota(all.begin(), all.end(), 0);
    for (const std::vector<int>& elements : components(rest.problem)) {
      const Part part = part_of(rest.problem, all, elements);
      const Answer one = solve_connected(part.problem);
      for (int s : one.chosen) {
        answer.chosen.push_back(rest.sets[part.sets[s]]);
      }
      answer.bound += one.bound;
    }
    return answer;
  }

 private:
  double seconds_left() const { return std::max(kLeastSeconds, time_limit_.seconds_left()); }

  Answer solve_connected(const SetCoverProblem& problem) {
    const int rounds = static_cast<int>(kSearchWork / (1000.0 + size_of(problem)));
    detail::PricedCover priced = detail::price_set_cover(problem, kPriceSteps);
    detail::search_covers(problem, priced, rounds);
    Answer answer{priced.chosen, priced.bound};
    if (priced.bound >= priced.cost || monitor_.stopped()) return answer;
    // Only sets that could be part of a cheaper cover: taking any other lifts the bound to the cost of the one at hand.
    const std::vector<double> reduced = detail::reduced_costs(problem, priced.prices);
    const double bound = detail::bound_by_prices(problem, priced.prices);
    const double wanted = detail::all_integral(problem.costs) ? priced.cost - 1 : priced.cost;
    std::vector<int> useful, elements(problem.elements);
    std::iota(elements.begin(), elements.end(), 0);
    for (int s = 0; s < static_cast<int>(problem.sets.size()); ++s) {
      if (bound + std::max(0.0, reduced[s]) <= wanted + 1e-9 * priced.cost) useful.push_back(s);
    }
    if (!elements_left_out(problem, useful).empty()) return proven(answer, priced.cost);
    const Part part = part_of(problem, useful, elements);
    if (static_cast<double>(useful.size()) < kShrunk * static_cast<double>(problem.sets.size())) {
      return better(problem, answer, lifted(solve(part.problem), part.sets));
    }
    const detail::BranchAndBoundAnswer branched =
        detail::branch_and_bound(part.problem, priced.cost, seconds_left(), monitor_);
    if (monitor_.stopped()) return answer;
    Answer inner{priced.chosen, branched.lower_bound};
    if (branched.chosen) inner = lifted({*branched.chosen, branched.lower_bound}, part.sets);
    if (branched.proven) inner.bound = cost_of(problem, inner.chosen);
    if (branched.none_cheaper) inner = {priced.chosen, priced.cost};
    return better(problem, answer, inner);
  }

  static Answer proven(Answer answer, double cost) {
    answer.bound = cost;
    return answer;
  }

  static Answer lifted(const Answer& inner, const std::vector<int>& sets) {
    Answer answer{{}, inner.bound};
    for (int s : inner.chosen) answer.chosen.push_back(sets[s]);
    return answer;
  }

  /// The better of a cover and one made of the sets that could be part of a cheaper one, whose bound holds for cheaper
  /// covers only.
  static Answer better(const SetCoverProblem& problem, const Answer& known, const Answer& inner) {
    const double known_cost = cost_of(problem, known.chosen), inner_cost = cost_of(problem, inner.chosen);
    Answer best = inner_cost < known_cost ? inner : known;
    best.bound = std::max(known.bound, std::min({inner.bound, known_cost, inner_cost}));
    return best;
  }

  detail::TimeLimit time_limit_;
  const Monitor& monitor_;
};

}  // namespace

void SetCoverProblem::check() const {
  require_within(elements, 0, 1e7, "elements", "");
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
    require_positive(costs[s], "costs[" + std::to_string(s) + "]", "", std::numeric_limits<double>::max());
  }
  const auto [least, most] = std::minmax_element(costs.begin(), costs.end());
  require(*most <= kMostTimesLeast * *least, "costs[" + std::to_string(most - costs.begin()) + "]", *most,
          "must be at most 1e9 times the least one");
}

SetCoverResult solve_set_cover(const SetCoverProblem& problem, double time_limit, const Monitor& monitor) {
  problem.check();
  require(time_limit > 0, "time_limit", time_limit, "must be > 0");
  SetCoverResult result;
  result.uncoverable = elements_in_no_set(problem);
  if (!result.uncoverable.empty()) {
    result.outcome = Outcome::infeasible;
    return result;
  }
  const double unit = problem.costs.empty() ? 1 : cost_unit(problem.costs);
  SetCoverProblem counted = problem;
  for (double& cost : counted.costs) cost /= unit;
  Solver::Answer answer = Solver(time_limit, monitor).solve(counted);
  answer.bound *= unit;
  std::sort(answer.chosen.begin(), answer.chosen.end());
  result.chosen = std::move(answer.chosen);
  result.cost = cost_of(problem, result.chosen);
  if (!elements_left_out(problem, result.chosen).empty()) {
    throw Error("set cover: the answer leaves an element uncovered");
  }
  const bool proven = answer.bound >= result.cost - 1e-9 * result.cost;  // the same sums in another order
  result.lower_bound = proven ? result.cost : answer.bound;
  result.outcome = proven ? Outcome::solved : monitor.stopped() ? Outcome::stopped : Outcome::approximate;
  return result;
}

}  // namespace mmgrasp
