#pragma once

#include "mmgrasp/collision/edge.hpp"

namespace mmgrasp::detail {

/// check_edge by conservative advancement (options.continuous); lengths and numbers have been checked.
EdgeResult advance_edge(CollisionChecker& checker, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1,
                        const EdgeOptions& options);

}  // namespace mmgrasp::detail
