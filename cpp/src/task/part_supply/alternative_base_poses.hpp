#pragma once

#include <vector>

#include "mmgrasp/task/base_region.hpp"
#include "mmgrasp/task/base_sequence.hpp"

namespace mmgrasp::detail {

/// Radius of the largest disc around a stop's base pose, at one of the grid's headings, in the regions of all its trays
/// [m].
double room_around(const BaseGrid& grid, const std::vector<BaseRegion>& regions, const Stop& stop);

/// Alternatives to a stop's base pose: cell centres of the same layer whose disc inside the shared region of the stop's
/// trays is at least `min_radius`, widest first, no two nearer than `apart`. Their `radius` is that of the disc around
/// them.
std::vector<Stop> alternative_base_poses(const BaseGrid& grid, const std::vector<BaseRegion>& regions, const Stop& stop,
                                         double min_radius, double apart, std::size_t count);

}  // namespace mmgrasp::detail
