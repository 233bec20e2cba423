#pragma once

#include <cstdint>
#include <vector>

#include "mmgrasp/task/base_grid.hpp"

namespace mmgrasp::detail {

/// May the robot at home stand at a base pose? Kept for the centres of all cells of a grid and for their corners, the
/// same for all trays of a layer.
class HomeMap {
 public:
  enum State : std::uint8_t { unknown, free, in_collision, queried };

  explicit HomeMap(const BaseGrid& grid);
  /// State at the centre of a cell, or at its lower corner (cells up to nx, ny then).
  std::uint8_t& at(int heading, bool corner, int ix, int iy) {
    return (corner ? corners_ : centres_)[heading][index(corner, ix, iy)];
  }
  std::uint8_t at(int heading, bool corner, int ix, int iy) const {
    return (corner ? corners_ : centres_)[heading][index(corner, ix, iy)];
  }
  /// Where the robot collides becomes unknown: something was removed.
  void forget_collisions();

 private:
  std::size_t index(bool corner, int ix, int iy) const {
    return static_cast<std::size_t>(iy) * (nx_ + (corner ? 1 : 0)) + ix;
  }

  int nx_;
  std::vector<std::vector<std::uint8_t>> centres_, corners_;  // [heading]
};

}  // namespace mmgrasp::detail
