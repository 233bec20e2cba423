#pragma once

#include <Eigen/Core>
#include <vector>

namespace mmgrasp::detail {

/// A short way from start over all stops to goal (matrix as for shortest_visiting_tour(), finite entries): cheapest
/// insertion, then reversals and moves of runs until none helps, then the same again from places a random exchange of
/// neighbouring stretches leads to. Each move's gain comes from running sums in both directions, so directions may
/// differ. Deterministic.
std::vector<int> short_order(const Eigen::MatrixXd& lengths);

}  // namespace mmgrasp::detail
