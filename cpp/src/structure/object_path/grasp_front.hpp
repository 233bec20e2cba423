#pragma once

#include <functional>
#include <vector>

#include "mmgrasp/structure/optimize_grasp.hpp"

namespace mmgrasp::detail {

/// Indices of those that no other beats in one objective without losing in another, ascending in O1.
std::vector<int> pareto_front(const std::vector<FeasibleGrasp>& all);

/// Values to search with, one after the other, so that their best grasps are spread over the front: Chebyshev's largest
/// weighed distance from the best of each objective known, which every place of the front is best in for some weights,
/// also where the front is hollow and no weighted sum finds it. The first three lead to its corners, the others have
/// weights spread evenly (Halton). Distances are shares of what `known`, not empty, spans.
std::vector<std::function<double(const ObjectPathResult&)>> front_objectives(const std::vector<FeasibleGrasp>& known,
                                                                             int count);

}  // namespace mmgrasp::detail
