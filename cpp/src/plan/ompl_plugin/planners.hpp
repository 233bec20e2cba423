#pragma once

#include <ompl/base/Planner.h>

#include <cstddef>

namespace mmgrasp_ompl {

/// How a planner is made and what it needs to repeat itself.
struct PlannerEntry {
  const char* name;
  ompl::base::PlannerPtr (*make)(const ompl::base::SpaceInformationPtr& si);
  /// Draws from OMPL's own generators, which are seeded process-wide: runs alone. Others run side by side.
  bool runs_alone;
  /// Spends rounds without drawing states: rounds count towards the budget, too.
  bool count_rounds;
  /// Goes on after its first path until its budget is spent.
  bool keeps_improving;
  /// Draws a roadmap in which the ends are two vertices, instead of growing trees from them.
  bool roadmap;
  /// Longest tree edge when the caller names none, as a share of the diagonal of the sampling bounds; 0: OMPL's choice
  /// (a fifth).
  double range_share;
  /// One round may take seconds (edges blocked one by one, each followed by a search), with no check of the budget.
  bool long_rounds = false;
};

extern const PlannerEntry kPlanners[];
extern const std::size_t kPlannerCount;

}  // namespace mmgrasp_ompl
