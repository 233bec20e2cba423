#pragma once

#include <cstdint>
#include <vector>

#include "mmgrasp/grasp/hand_mask.hpp"

namespace mmgrasp::detail {

/// Row sums of a binary image with a border, from which a run of cells is counted by one subtraction. Sums wrap around
/// at 65,536, differences of a run do not.
class RowSums {
 public:
  RowSums() = default;
  RowSums(const std::vector<std::uint8_t>& image, int nx, int ny, int border, bool outside);

  int nx() const { return nx_; }
  int ny() const { return ny_; }
  bool empty() const { return empty_; }  ///< No cell of the image itself is one.
  int first_row() const { return first_row_; }
  int last_row() const { return last_row_; }  ///< Rows of the image that hold ones.
  /// Sums of row y before each cell, such that row(y)[x1 + 1] - row(y)[x0] counts cells x0..x1; from -border on.
  const std::uint16_t* row(int y) const {
    return sums_.data() + static_cast<std::size_t>(y + border_) * stride_ + border_;
  }

 private:
  int nx_ = 0, ny_ = 0, border_ = 0, stride_ = 0;
  int first_row_ = 0, last_row_ = -1;
  bool empty_ = true;
  std::vector<std::uint16_t> sums_;
};

/// A mask as horizontal runs of ones.
struct MaskRuns {
  struct Run {
    int dy, x0, x1;
  };
  explicit MaskRuns(const MaskImage& mask);
  std::vector<Run> runs;
  int radius = 0;
};

/// Counts of one row of the convolution into out[0, nx).
void convolve_row(const RowSums& image, const MaskRuns& mask, int y, std::uint16_t* out);

}  // namespace mmgrasp::detail
