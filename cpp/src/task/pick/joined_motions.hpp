#pragma once

#include <vector>

#include "mmgrasp/task/pick.hpp"

namespace mmgrasp::detail {

/// Shifts every motion, in the joints that `wraps` marks, by whole turns so that the first starts at `from` and each
/// other where the one before it ended; other joints are never shifted. First samples off by rounding only become equal
/// to what comes before them. Returns where the last motion ends.
Eigen::VectorXd join_motions(const std::vector<bool>& wraps, const Eigen::VectorXd& from,
                             std::vector<PickMotion>& motions);

}  // namespace mmgrasp::detail
