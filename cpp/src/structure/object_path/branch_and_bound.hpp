#pragma once

#include <functional>

#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/structure/optimize_grasp.hpp"

namespace mmgrasp::detail {

/// Called for each grasp that was evaluated, in an order that does not depend on the number of threads.
using GraspCounter = std::function<void(const Grasp& grasp, const ObjectPathResult& result)>;

/// What dividing boxes of grasps proves beside the best grasp that a search has found.
struct BoxSearch {
  double lower_bound = 0;
  int boxes = 0;
};

/// Divides boxes, the one with the lowest bound first, until none can hold a grasp cheaper than (1 - max_gap) times the
/// best cost, which is `cost` at first (infinite: none is known), or time is up. Middles of boxes that could be cheaper
/// are evaluated.
BoxSearch divide_boxes(const ObjectPathProblem& problem, const Pipe& pipe, const ObjectPathOptions& path_options,
                       const GraspSearchOptions& options, double cost, const GraspCounter& count,
                       const TimeLimit& time_limit, const Monitor& monitor);

}  // namespace mmgrasp::detail
