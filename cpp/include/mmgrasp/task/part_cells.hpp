#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/task/base_grid.hpp"

namespace mmgrasp {

/// The cells of a BaseGrid from which one part can be grasped: flags, kept for the rows and columns that hold any,
/// since a grid over a whole storeroom is much larger than what one part needs.
class MMGRASP_EXPORT PartCells {
 public:
  /// Flags of a block of cells of one layer, row by row.
  struct Window {
    int heading, x0, y0, nx, ny;
    std::vector<std::uint8_t> flags;
  };
  PartCells() = default;
  explicit PartCells(const BaseGrid& grid) : nx_(grid.nx), ny_(grid.ny), size_(grid.size()) {}
  /// The same again from what nx(), ny(), size() and windows() returned.
  PartCells(int nx, int ny, std::size_t size, std::vector<Window> windows)
      : nx_(nx), ny_(ny), size_(size), windows_(std::move(windows)) {}
  int nx() const { return nx_; }              ///< Columns of the grid.
  int ny() const { return ny_; }              ///< Rows of the grid.
  std::size_t size() const { return size_; }  ///< Cells of the grid, all layers.
  const std::vector<Window>& windows() const { return windows_; }
  bool operator[](std::size_t cell) const;  ///< `cell`: see BaseGrid::index().
  std::size_t count() const;
  CellMask mask() const;  ///< One flag a cell of the grid.
  bool operator==(const PartCells& other) const;
  /// Adds flags of a block of one layer, row by row; at most one block a layer.
  void add_window(int heading, int x0, int y0, int nx, int ny, const std::vector<std::uint8_t>& flags);

 private:
  int nx_ = 0, ny_ = 0;
  std::size_t size_ = 0;
  std::vector<Window> windows_;
};

}  // namespace mmgrasp
