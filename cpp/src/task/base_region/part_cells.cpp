#include "mmgrasp/task/part_cells.hpp"

#include <algorithm>

namespace mmgrasp {

void PartCells::add_window(int heading, int x0, int y0, int nx, int ny, const std::vector<std::uint8_t>& flags) {
  int left = nx, right = -1, low = ny, high = -1;
  const auto at = [nx](int ix, int iy) { return static_cast<std::size_t>(iy) * nx + ix; };
  for (int iy = 0; iy < ny; ++iy) {
    for (int ix = 0; ix < nx; ++ix) {
      if (!flags[at(ix, iy)]) continue;
      left = std::min(left, ix);
      right = std::max(right, ix);
      low = std::min(low, iy);
      high = std::max(high, iy);
    }
  }
  if (right < 0) return;
  Window window{heading, x0 + left, y0 + low, right - left + 1, high - low + 1, {}};
  for (int iy = low; iy <= high; ++iy) {
    const auto row = flags.begin() + static_cast<std::ptrdiff_t>(at(0, iy));
    window.flags.insert(window.flags.end(), row + left, row + right + 1);
  }
  windows_.push_back(std::move(window));
}

bool PartCells::operator[](std::size_t cell) const {
  const std::size_t row = nx_;
  const int ix = static_cast<int>(cell % row), iy = static_cast<int>(cell / row % ny_),
            heading = static_cast<int>(cell / row / ny_);
  for (const Window& w : windows_) {
    if (w.heading != heading || ix < w.x0 || iy < w.y0 || ix >= w.x0 + w.nx || iy >= w.y0 + w.ny) continue;
    return w.flags[static_cast<std::size_t>(iy - w.y0) * w.nx + ix - w.x0] != 0;
  }
  return false;
}

std::size_t PartCells::count() const {
  std::size_t sum = 0;
  for (const Window& w : windows_) sum += std::count(w.flags.begin(), w.flags.end(), std::uint8_t{1});
  return sum;
}

CellMask PartCells::mask() const {
  CellMask cells(size_, 0);
  for (const Window& w : windows_) {
    for (int iy = 0; iy < w.ny; ++iy) {
      const std::size_t row = (static_cast<std::size_t>(w.heading) * ny_ + w.y0 + iy) * nx_ + w.x0;
      std::copy_n(w.flags.begin() + static_cast<std::ptrdiff_t>(iy) * w.nx, w.nx,
                  cells.begin() + static_cast<std::ptrdiff_t>(row));
    }
  }
  return cells;
}

bool PartCells::operator==(const PartCells& other) const {
  return nx_ == other.nx_ && ny_ == other.ny_ && mask() == other.mask();
}

}  // namespace mmgrasp
