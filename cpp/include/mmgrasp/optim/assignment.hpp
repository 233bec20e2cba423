#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// Gives each row a column of its own so that the sum of costs is least (shortest augmenting paths, O(n^3)). `costs` is
/// square and finite. Deterministic. Throws InvalidInput otherwise.
MMGRASP_EXPORT std::vector<int> cheapest_assignment(const Eigen::MatrixXd& costs);

}  // namespace mmgrasp
