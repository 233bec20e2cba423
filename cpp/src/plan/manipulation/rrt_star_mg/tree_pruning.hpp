#pragma once

#include "mmgrasp/core/export.hpp"
#include "plan/manipulation/common/informed_union.hpp"
#include "plan/manipulation/rrt_star_mg/grasp_trees.hpp"
#include "plan/manipulation/rrt_star_mg/incumbent.hpp"
#include "plan/manipulation/rrt_star_mg/tree_sampler.hpp"

namespace mmgrasp::detail {

/// PruneAndReassign (P2 5.3.3; Algorithm 5.13, line 9) after the incumbent became better: makes the informed sets
/// smaller, and removes trees of grasps that cannot win any more and leaves outside of their informed sets. The sampler
/// gets the configurations that no tree has any more. Roots are arm configurations of their own grasp and serve no
/// other.
MMGRASP_EXPORT void prune_and_reassign(const Incumbent& incumbent, GraspTrees& trees, InformedUnion& informed,
                                       TreeSampler& sampler);

}  // namespace mmgrasp::detail
