#pragma once

#include <vector>

#include "mmgrasp/optim/set_cover.hpp"

namespace mmgrasp::detail {

/// No cover costs less than this: the prices of all elements, less what each set's elements are priced above its cost
/// (Lagrangian relaxation of the covering rows). Any prices >= 0 will do. Lowered by what rounding could have added.
double bound_by_prices(const SetCoverProblem& problem, const std::vector<double>& prices);

/// Cost of each set less the prices of its elements: what taking it adds to the bound, when positive.
std::vector<double> reduced_costs(const SetCoverProblem& problem, const std::vector<double>& prices);

struct PricedCover {
  std::vector<int> chosen;     ///< Best cover met, ascending.
  double cost = 0;             ///< Its cost.
  std::vector<double> prices;  ///< One per element.
  double bound = 0;            ///< bound_by_prices() of them, rounded up to a whole number when all costs are whole.
};

/// Whole numbers, so that bounds may be rounded up.
bool all_integral(const std::vector<double>& costs);

/// Prices by subgradient steps and covers by greedy choice on them, until both meet or nothing more is gained.
/// Deterministic. Costs must be given and every element coverable.
PricedCover price_set_cover(const SetCoverProblem& problem, int max_steps);

/// Looks for a cheaper cover: takes sets out of the best one at random and completes it again, on prices moved a
/// little. Deterministic; ends when the bound is met.
void search_covers(const SetCoverProblem& problem, PricedCover& best, int rounds);

}  // namespace mmgrasp::detail
