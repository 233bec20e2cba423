#pragma once

#include <Eigen/Core>
#include <vector>

namespace mmgrasp::detail {

/// The configuration equal to `target` up to full turns of the values that wrap, nearest to `from`: the end of the
/// shortest joint-space edge between the two.
Eigen::VectorXd nearest_turn(const std::vector<bool>& wraps, const Eigen::VectorXd& from,
                             const Eigen::VectorXd& target);

/// Values that wrap brought into [-pi, pi].
Eigen::VectorXd wrapped(const std::vector<bool>& wraps, const Eigen::VectorXd& q);

}  // namespace mmgrasp::detail
