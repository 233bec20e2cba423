#pragma once

#include <cstdint>
#include <vector>

#include "mmgrasp/task/base_sequence.hpp"

namespace mmgrasp::detail {

/// A disc of exactly the least radius counts, and one that is smaller by this much, a rounding, too [m]. (The check of
/// finished plans has the same, verify/base/shared_discs.hpp.)
constexpr double kRadiusSlack = 1e-9;

/// Tolerance for the radii of largest discs [m]: below kRadiusSlack, so that every search judges a disc alike.
constexpr double kCircleError = 1e-10;

/// The same for a plain bitmap of unit cells, row by row; lengths and `tolerance` in cells.
InscribedCircle inscribed_circle_in_cells(int nx, int ny, const std::vector<std::uint8_t>& cells, double tolerance);

}  // namespace mmgrasp::detail
