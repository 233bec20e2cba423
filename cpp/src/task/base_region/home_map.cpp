#include "task/base_region/home_map.hpp"

#include <algorithm>

namespace mmgrasp::detail {

HomeMap::HomeMap(const BaseGrid& grid)
    : nx_(grid.nx),
      centres_(grid.headings.size(), std::vector<std::uint8_t>(static_cast<std::size_t>(grid.nx) * grid.ny, unknown)),
      corners_(grid.headings.size(),
               std::vector<std::uint8_t>(static_cast<std::size_t>(grid.nx + 1) * (grid.ny + 1), unknown)) {}

void HomeMap::forget_collisions() {
  for (auto* layers : {&centres_, &corners_}) {
    for (std::vector<std::uint8_t>& states : *layers)
      std::replace(states.begin(), states.end(), std::uint8_t{in_collision}, std::uint8_t{unknown});
  }
}

}  // namespace mmgrasp::detail
