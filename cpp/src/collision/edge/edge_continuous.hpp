#pragma once

#include "collision/checker/engine.hpp"
#include "mmgrasp/collision/edge.hpp"

namespace mmgrasp::detail {

/// check_edge() by conservative advancement: free means that every configuration on the way is free, as long as nothing
/// comes nearer than `tolerance` [m]. `bend`: see EdgeOptions.
EdgeResult advance_edge(CheckerEngine& engine, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, double tolerance,
                        const Eigen::VectorXd& bend = {});

}  // namespace mmgrasp::detail
