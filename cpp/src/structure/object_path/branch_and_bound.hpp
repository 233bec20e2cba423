#pragma once

#include "mmgrasp/structure/optimize_grasp.hpp"

namespace mmgrasp::detail {

/// What dividing boxes of grasps proves beside the best grasp that a search has found.
struct BoxSearch {
  double lower_bound = 0;
  int boxes = 0, evaluations = 0;
  bool stopped = false;
  std::vector<FeasibleGrasp> found;  ///< Grasps cheaper than all before them, each by follow_object_path.
};

/// Divides boxes, the one with the lowest bound first, until none can hold a grasp cheaper than (1 - max_gap) times the
/// best cost, which is `cost` at first (infinite: none is known).
BoxSearch divide_boxes(const ObjectPathProblem& problem, const Pipe& pipe, const ObjectPathOptions& path_options,
                       const GraspSearchOptions& options, double cost, const Monitor& monitor);

}  // namespace mmgrasp::detail
