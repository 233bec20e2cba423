// The planners over many grasps by name.
#include "mmgrasp/core/error.hpp"
#include "plan/manipulation/common/manipulation_planner.hpp"
#include "plan/manipulation/prm_star_mg/prm_star_mg.hpp"
#include "plan/manipulation/rrt_star_mg/rrt_star_mg_planner.hpp"

namespace mmgrasp {
namespace detail {
namespace {

bool run_tuned_rrt_star_mg(ManipulationInput& input, ManipulationResult& result) {
  return run_rrt_star_mg(input, result, {});
}

constexpr ManipulationPlanner kPlanners[] = {
    {"prm_star_mg", run_prm_star_mg},
    {"rrt_star_mg", run_tuned_rrt_star_mg},
};

}  // namespace

const ManipulationPlanner& manipulation_planner(const std::string& name) {
  std::string known;
  for (const ManipulationPlanner& planner : kPlanners) {
    if (name == planner.name) return planner;
    known += (known.empty() ? "" : ", ") + std::string(planner.name);
  }
  throw InvalidInput("planner = \"" + name + "\": must be one of " + known);
}

}  // namespace detail

std::vector<std::string> manipulation_planner_names() {
  std::vector<std::string> names;
  for (const detail::ManipulationPlanner& planner : detail::kPlanners) names.emplace_back(planner.name);
  return names;
}

}  // namespace mmgrasp
