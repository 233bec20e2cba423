#include "mmgrasp/grasp/hand_mask.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "grasp/hand/hand_outline.hpp"
#include "grasp/hand/row_spans.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

constexpr int kMostRadius = 10000;  // cells

/// A rectangle in the hand's frame: closing axis u, across it v.
struct HandRectangle {
  double u0, u1, v0, v1;
  HandRectangle grown(double by) const { return {u0 - by, u1 + by, v0 - by, v1 + by}; }
  double reach() const {
    return std::hypot(std::max(std::abs(u0), std::abs(u1)), std::max(std::abs(v0), std::abs(v1)));
  }
};

/// Cosine and sine that give exactly the same masks a quarter turn further on.
Eigen::Vector2d exact_direction(double angle) {
  const double quarters = std::floor(angle / (detail::kPi / 2) + 1e-12);
  const double rest = angle - quarters * (detail::kPi / 2);
  Eigen::Vector2d d(std::cos(rest), std::sin(rest));
  if (std::abs(rest) < 1e-12) d = {1, 0};
  const int turns = static_cast<int>(std::fmod(std::fmod(quarters, 4.0) + 4.0, 4.0));
  for (int i = 0; i < turns; ++i) d = {-d.y(), d.x()};
  return d;
}

/// Cells whose centre lies in the rectangle turned by the angle.
void draw(const HandRectangle& r, double angle, double resolution, MaskImage& mask) {
  const Eigen::Vector2d along = exact_direction(angle), across(-along.y(), along.x());
  constexpr double kSlack = 1e-9;
  for (int dy = -mask.radius; dy <= mask.radius; ++dy) {
    detail::throw_if_interrupted();
    for (int dx = -mask.radius; dx <= mask.radius; ++dx) {
      const double u = (dx * along.x() + dy * along.y()) * resolution,
                   v = (dx * across.x() + dy * across.y()) * resolution;
      if (u >= r.u0 - kSlack && u <= r.u1 + kSlack && v >= r.v0 - kSlack && v <= r.v1 + kSlack)
        mask.cells[static_cast<std::size_t>(dy + mask.radius) * mask.width() + dx + mask.radius] = 1;
    }
  }
}

MaskImage mask_of(const std::vector<HandRectangle>& rectangles, double angle, double resolution) {
  MaskImage mask;
  double cells = 0;
  for (const HandRectangle& r : rectangles) cells = std::max(cells, std::ceil(r.reach() / resolution));
  require(cells <= kMostRadius, "resolution", resolution,
          "must not make masks of the hand reach farther than 10000 cells");
  mask.radius = static_cast<int>(cells);
  mask.cells.assign(static_cast<std::size_t>(mask.width()) * mask.width(), 0);
  for (const HandRectangle& r : rectangles) draw(r, angle, resolution, mask);
  return mask;
}

}  // namespace

int MaskImage::count() const {
  return static_cast<int>(std::count_if(cells.begin(), cells.end(), [](std::uint8_t c) { return c != 0; }));
}

void MaskImage::check(const char* field) const {
  require(radius >= 0 && radius <= kMostRadius, std::string(field) + ".radius", radius,
          "must be from 0 to 10000 cells");
  require(cells.size() == static_cast<std::size_t>(width()) * width(), field, std::to_string(cells.size()) + " cells",
          "must be (2 radius + 1) squared");
  require(count() <= 65535, field, std::to_string(count()) + " ones", "must be at most 65535 (use coarser cells)");
}

HandMasks make_hand_masks(const Hand& hand, double opening, double angle, double resolution, double margin) {
  hand.check_fingers();
  require_number(angle, "angle", "rad");
  require_positive(resolution, "resolution", "m");
  require_not_negative(margin, "margin", "m");
  const detail::HandOutline o(hand, opening);
  // A cell is touched when its centre lies within half its diagonal.
  const double grow = margin + resolution * std::sqrt(0.5);
  HandMasks masks;
  masks.contact = mask_of({{-o.inner, o.inner, -o.side, o.side}}, angle, resolution);
  masks.fingers = mask_of({HandRectangle{-o.outer, -o.inner, -o.side, o.side}.grown(grow),
                           HandRectangle{o.inner, o.outer, -o.side, o.side}.grown(grow)},
                          angle, resolution);
  masks.palm = mask_of({HandRectangle{-o.palm, o.palm, -o.palm_side, o.palm_side}.grown(grow)}, angle, resolution);
  masks.contact.check("contact mask");
  masks.fingers.check("finger mask");
  masks.palm.check("palm mask");
  return masks;
}

namespace detail {

RowSums::RowSums(const std::vector<std::uint8_t>& image, int nx, int ny, int border, bool outside)
    : nx_(nx), ny_(ny), border_(border), stride_(nx + 2 * border + 1) {
  sums_.resize(static_cast<std::size_t>(ny + 2 * border) * stride_);
  for (int y = -border; y < ny + border; ++y) {
    std::uint16_t* sums = sums_.data() + static_cast<std::size_t>(y + border) * stride_;
    std::uint16_t sum = 0;
    sums[0] = 0;
    for (int x = -border; x < nx + border; ++x) {
      const bool inside = y >= 0 && y < ny && x >= 0 && x < nx;
      const bool one = inside ? image[static_cast<std::size_t>(y) * nx + x] != 0 : outside;
      if (inside && one) {
        if (empty_) first_row_ = y;
        empty_ = false;
        last_row_ = y;
      }
      sum = static_cast<std::uint16_t>(sum + one);
      sums[x + border + 1] = sum;
    }
  }
}

MaskRuns::MaskRuns(const MaskImage& mask) : radius(mask.radius) {
  for (int dy = -mask.radius; dy <= mask.radius; ++dy) {
    for (int dx = -mask.radius; dx <= mask.radius;) {
      if (!mask.at(dx, dy)) {
        ++dx;
        continue;
      }
      const int x0 = dx;
      while (dx <= mask.radius && mask.at(dx, dy)) ++dx;
      runs.push_back({dy, x0, dx - 1});
    }
  }
}

void convolve_row(const RowSums& image, const MaskRuns& mask, int y, std::uint16_t* out) {
  const int nx = image.nx();
  std::fill(out, out + nx, std::uint16_t{0});
  for (const MaskRuns::Run& run : mask.runs) {
    const std::uint16_t* before = image.row(y + run.dy) + run.x0;
    const std::uint16_t* after = image.row(y + run.dy) + run.x1 + 1;
    for (int x = 0; x < nx; ++x) out[x] = static_cast<std::uint16_t>(out[x] + after[x] - before[x]);
  }
}

}  // namespace detail

std::vector<std::uint16_t> convolve_mask(const std::vector<std::uint8_t>& image, int nx, int ny, const MaskImage& mask,
                                         bool outside) {
  mask.check("mask");
  require(nx > 0 && ny > 0 && image.size() == static_cast<std::size_t>(nx) * ny, "image",
          std::to_string(image.size()) + " cells", "must be nx * ny of them");
  const detail::RowSums sums(image, nx, ny, mask.radius, outside);
  const detail::MaskRuns runs(mask);
  std::vector<std::uint16_t> counts(image.size());
  for (int y = 0; y < ny; ++y) detail::convolve_row(sums, runs, y, counts.data() + static_cast<std::size_t>(y) * nx);
  return counts;
}

}  // namespace mmgrasp
