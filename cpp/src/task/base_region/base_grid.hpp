#pragma once

#include <vector>

#include "mmgrasp/task/problem.hpp"

namespace mmgrasp {

/// The tray's headings without repetitions; the facing one when it lists none.
std::vector<double> tray_headings(const Tray& tray);

/// Base poses farther than this from the tray's middle are not tried [m].
double base_search_radius(const PartSupplyProblem& problem, const Tray& tray, const ReachDatabase& database);

}  // namespace mmgrasp
