#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/plan/rrt_star_mg.hpp"
#include "plan/manipulation/rrt_star_mg/grasp_trees.hpp"

namespace mmgrasp::detail {

/// Copies the trees that have vertices for the caller (RrtStarMgOptions::keep_trees).
MMGRASP_EXPORT void append_search_trees(const GraspTrees& trees, std::vector<SearchTree>& out);

}  // namespace mmgrasp::detail
