#pragma once

#include <functional>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp {

/// A better solution found while a planner runs; checked as its result's path is.
struct MMGRASP_EXPORT Improvement {
  double seconds = 0;  ///< Time since the call began; plan_manipulation leaves out building the first roadmap.
  double cost = 0;     ///< What the planner minimises: path length, plus the grasp's cost where there are grasps.
  int grasp = -1;      ///< Index of the grasp it uses; -1 without grasps.
  JointPath path;
};

/// Called with each better solution, from the thread that called the planner. Empty: nobody wants to know.
using ImprovementCallback = std::function<void(const Improvement& better)>;

}  // namespace mmgrasp
