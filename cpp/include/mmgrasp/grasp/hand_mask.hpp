#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/grasp/hand.hpp"

namespace mmgrasp {

/// Zeros and ones over cells, around a middle cell: what a part of the hand covers seen along the approach.
struct MMGRASP_EXPORT MaskImage {
  int radius = 0;                   ///< It is 2 radius + 1 cells wide and high; >= 0.
  std::vector<std::uint8_t> cells;  ///< Row by row.

  int width() const { return 2 * radius + 1; }
  bool at(int dx, int dy) const { return cells[static_cast<std::size_t>(dy + radius) * width() + (dx + radius)] != 0; }
  int count() const;
  void check(const char* field) const;  ///< Throws InvalidInput on a wrong size or more than 65,535 ones.
};

/// The hand seen along its approach, closing axis at an angle [rad] from x (P1 3.7.2, figure 3.21): between the fingers
/// where the part should be, at the fingers where nothing may be, and at the palm above them. Fingers and palm cover
/// every cell that they touch or that comes within `margin` [m], the contact region those whose centre it holds.
struct MMGRASP_EXPORT HandMasks {
  MaskImage contact, fingers, palm;
};
MMGRASP_EXPORT HandMasks make_hand_masks(const Hand& hand, double opening, double angle, double resolution,
                                         double margin = 0.001);

/// How many ones of the mask fall on ones of the image, for the mask's middle at every cell: the convolution (strictly
/// the correlation) of the two. Cells outside the image count as `outside`.
MMGRASP_EXPORT std::vector<std::uint16_t> convolve_mask(const std::vector<std::uint8_t>& image, int nx, int ny,
                                                        const MaskImage& mask, bool outside);

}  // namespace mmgrasp
