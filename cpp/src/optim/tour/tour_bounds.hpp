#pragma once

#include <Eigen/Core>

namespace mmgrasp::detail {

/// No way from start over all stops to goal is shorter (matrix as for shortest_visiting_tour(), finite entries): the
/// better of two relaxations. `reached` is the length of some way: it scales the steps, and meeting it ends the search.
///  - Spanning trees: a way is a tree in which stops have two neighbours, start and goal one. Prices on the nodes push
///    the shortest tree towards that (Held and Karp's ascent). Uses the shorter direction of each pair.
///  - Assignment: every place has one successor and one predecessor, directions kept apart.
double tour_bound(const Eigen::MatrixXd& lengths, double reached);

}  // namespace mmgrasp::detail
