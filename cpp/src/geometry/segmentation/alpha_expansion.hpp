#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// Two nodes that pay `cost` when their labels differ.
struct LabelLink {
  int a = 0, b = 0;
  double cost = 0;  ///< >= 0.
};

/// Labels of low total cost by expansion moves (Boykov, Veksler and Zabih 2001), each the optimum by a minimum cut:
/// `costs(label, node)` plus what the links pay. At the end no single expansion lowers the total, which then is at most
/// twice the least; with two labels it is the least. Starts from the cheapest label of each node.
MMGRASP_EXPORT std::vector<int> alpha_expansion(const Eigen::MatrixXd& costs, const std::vector<LabelLink>& links);

/// The total of some labels.
MMGRASP_EXPORT double labelling_cost(const Eigen::MatrixXd& costs, const std::vector<LabelLink>& links,
                                     const std::vector<int>& labels);

}  // namespace mmgrasp::detail
