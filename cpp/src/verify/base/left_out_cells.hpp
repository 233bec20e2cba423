#pragma once

#include "verify/base/grasp_search.hpp"

namespace mmgrasp::verify::detail {

/// "region-incomplete" where the least number of stops is less with cells that the regions lack and that serve.
void check_left_out_cells(const Context& context, const Pools& pools, Faults& faults, std::size_t& configurations);

}  // namespace mmgrasp::verify::detail
