#include "plan/manipulation/common/carry_planner.hpp"

#include <utility>

#include "mmgrasp/core/error.hpp"
#include "plan/manipulation/prm_star_mg/prm_star_mg.hpp"
#include "plan/manipulation/rrt_star_mg/rrt_star_mg.hpp"

namespace mmgrasp {
namespace detail {
namespace {

constexpr CarryPlanner kPlanners[] = {
    {"prm_star_mg", run_prm_star_mg, 1},
    {"rrt_star_mg", run_rrt_star_mg, 8},  // Most edges of trees are never part of a path.
};

}  // namespace

const CarryPlanner& carry_planner(const std::string& name) {
  std::string known;
  for (const CarryPlanner& planner : kPlanners) {
    if (name == planner.name) return planner;
    known += (known.empty() ? "" : ", ") + std::string(planner.name);
  }
  throw InvalidInput("planner = \"" + name + "\": must be one of " + known);
}

void take_path(const CarryInput& input, Carry carry, ManipulationResult& result) {
  if (result.path && carry.cost >= result.cost) return;
  result.grasp_index = carry.grasp;
  result.cost = carry.cost;
  result.improvements.push_back({input.clock.seconds(), carry.cost, carry.grasp, carry.path});
  result.path = std::move(carry.path);
  if (input.improved) input.improved(result.improvements.back());
}

}  // namespace detail

std::vector<std::string> manipulation_planner_names() {
  std::vector<std::string> names;
  for (const detail::CarryPlanner& planner : detail::kPlanners) names.emplace_back(planner.name);
  return names;
}

}  // namespace mmgrasp
