#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace mmgrasp::detail {

/// Removes waypoints until none is left whose neighbours could be joined by a straight edge for which `edge_is_free`
/// holds. The path gets no longer, for straight edges are shortest. Not for bases that turn and drive.
template <class EdgeIsFree>
void remove_redundant_waypoints(std::vector<Eigen::VectorXd>& waypoints, const EdgeIsFree& edge_is_free) {
  for (std::size_t i = 1; i + 1 < waypoints.size();) {
    if (!edge_is_free(waypoints[i - 1], waypoints[i + 1])) {
      ++i;
      continue;
    }
    waypoints.erase(waypoints.begin() + static_cast<std::ptrdiff_t>(i));
    if (i > 1) --i;  // The waypoint before has another neighbour now.
  }
}

}  // namespace mmgrasp::detail
