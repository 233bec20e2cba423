#include "mmgrasp/plan/rrt_star_mg.hpp"

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {

void RrtStarMgOptions::check() const {
  require(max_iterations >= 1 && max_iterations <= 10000000, "max_iterations", max_iterations,
          "must be in [1, 10 million]");
  require_positive(range, "range", "rad or m");
  require_not_negative(gamma, "gamma");
  require(exploration >= 0 && exploration <= 1, "exploration", exploration, "must be in [0, 1]");
  require(goal_cost >= 0, "goal_cost", goal_cost, "must be >= 0");
}

}  // namespace mmgrasp
