#pragma once

#include <vector>

#include "mmgrasp/task/base_grid.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp::detail {

/// The tray's headings without repetitions; the facing one when it lists none.
std::vector<double> tray_headings(const Tray& tray);

/// Headings closer than this are one, as for verify: people round them (3.1416), and the hand of an arm of 1 m moves by
/// no more than 1 mm [rad].
constexpr double kSameHeading = 1e-3;

/// Adds a heading unless the list has it, up to full turns and kSameHeading.
void add_heading(std::vector<double>& headings, double heading);

/// Indices of the tray's headings in the grid's; a grid made by hand may leave some out.
std::vector<int> tray_layers(const BaseGrid& grid, const Tray& tray);

/// Base poses farther than this from the tray's middle are not tried [m].
double base_search_radius(const PartSupplyProblem& problem, const Tray& tray, const ReachDatabase& database);

}  // namespace mmgrasp::detail
