#pragma once

#include <functional>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp {

/// What found a path: `search` stands for plan_motion's planners; those over many grasps have stages of their own.
enum class PlanStage {
  search,
  first_grasps,    ///< RRT-Connect for one grasp after the other.
  straight_lines,  ///< A straight joint line from start to goal.
  roadmap,         ///< prm_star_mg's roadmap.
  refinement,      ///< prm_star_mg's small roadmaps where a cheaper path can pass.
  trees,           ///< rrt_star_mg's trees and their shortcuts.
  shortening,  ///< Shortcuts on the cheapest path so far; others, once shortened, count for the stage that found them.
};

MMGRASP_EXPORT const char* to_string(PlanStage stage);

/// A better solution found while a planner runs; checked as its result's path is.
struct MMGRASP_EXPORT Improvement {
  double seconds = 0;  ///< Time since the call began; plan_manipulation leaves out building the first roadmap.
  double cost = 0;     ///< What the planner minimises: path length, plus the grasp's cost where there are grasps.
  int grasp = -1;      ///< Index of the grasp it uses; -1 without grasps.
  JointPath path;
  PlanStage stage = PlanStage::search;
};

/// Called with each better solution, from the thread that called the planner. Empty: nobody wants to know.
using ImprovementCallback = std::function<void(const Improvement& better)>;

}  // namespace mmgrasp
