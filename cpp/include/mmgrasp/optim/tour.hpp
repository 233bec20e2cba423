#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/outcome.hpp"

namespace mmgrasp {

struct MMGRASP_EXPORT TourResult {
  Outcome outcome = Outcome::infeasible;
  std::vector<int> order;  ///< Visiting order of the stops, indices into 0..n-1.
  double length = 0;
  bool proven = false;  ///< True when exact (dynamic programming, up to 15 stops); else 2-opt / Or-opt.
};

/// Shortest path start -> all stops -> goal. `lengths` is (n + 2) x (n + 2): stops first, then start, then goal; an
/// infinite entry means "no way". May be asymmetric. Exact up to 15 stops (Held-Karp).
MMGRASP_EXPORT TourResult shortest_visiting_tour(const Eigen::MatrixXd& lengths);

}  // namespace mmgrasp
