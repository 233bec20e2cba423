#include "task/base_region/tray_window.hpp"

#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {
namespace {

/// What is known of a base pose and a part.
enum Mark : std::uint8_t { kTried = 1, kGood = 2 };

/// Cells along one axis that may be in range: one more each way, the distance decides.
void span(double middle, double radius, double resolution, double cells, int& begin, int& count) {
  const double low = std::floor((middle - radius) / resolution) - 1,
               high = std::ceil((middle + radius) / resolution) + 1;
  begin = static_cast<int>(std::clamp(low, 0.0, cells));
  count = static_cast<int>(std::clamp(high, 0.0, cells)) - begin;
}

}  // namespace

TrayWindow::TrayWindow(TrayId tray, int heading, std::vector<int> parts, const BaseGrid& grid,
                       const Eigen::Vector2d& middle, double radius)
    : tray_(tray), heading_(heading), parts_(std::move(parts)) {
  span(middle.x() - grid.origin.x(), radius, grid.resolution, grid.nx, x0_, nx_);
  span(middle.y() - grid.origin.y(), radius, grid.resolution, grid.ny, y0_, ny_);
  in_range_.assign(static_cast<std::size_t>(nx_) * ny_, 0);
  for (int iy = 0; iy < ny_; ++iy) {
    for (int ix = 0; ix < nx_; ++ix)
      in_range_[cell(ix, iy)] = (pose(grid, false, ix, iy).head<2>() - middle).norm() <= radius;
  }
  totals_.resize(parts_.size());
}

bool TrayWindow::keep_only(const BaseGrid& grid, const CellMask& cells) {
  bool any = false;
  for (int iy = 0; iy < ny_; ++iy) {
    for (int ix = 0; ix < nx_; ++ix) {
      std::uint8_t& flag = in_range_[cell(ix, iy)];
      flag &= cells[grid.index(heading_, grid_x(ix), grid_y(iy))];
      any = any || flag;
    }
  }
  return any;
}

Eigen::Vector3d TrayWindow::pose(const BaseGrid& grid, bool corner, int ix, int iy) const {
  Eigen::Vector3d p = grid.centre(heading_, x0_ + ix, y0_ + iy);
  if (corner) p.head<2>().array() -= 0.5 * grid.resolution;
  return p;
}

void TrayWindow::begin() {
  if (begun()) return;
  good_anywhere_.assign(static_cast<std::size_t>(nx_ + 1) * (ny_ + 1), 0);
  centres_.assign(parts_.size(), good_anywhere_);
  corners_ = centres_;
}

void TrayWindow::forget() {
  for (auto* marks : {&centres_, &corners_}) std::vector<std::vector<std::uint8_t>>().swap(*marks);
  good_anywhere_.clear();
  totals_.assign(parts_.size(), {});
  blocked_.clear();
}

bool TrayWindow::wanted(std::size_t slot, bool corner, int ix, int iy) const {
  return corner ? beside(centres_[slot], ix, iy) : in_range(ix, iy);
}

bool TrayWindow::wanted_for_any(bool corner, int ix, int iy) const {
  if (parts_.empty()) return false;
  return corner ? beside(good_anywhere_, ix, iy) : in_range(ix, iy);
}

bool TrayWindow::beside(const std::vector<std::uint8_t>& good, int ix, int iy) const {
  for (int cy = std::max(iy - 1, 0); cy <= std::min(iy, ny_ - 1); ++cy) {
    for (int cx = std::max(ix - 1, 0); cx <= std::min(ix, nx_ - 1); ++cx) {
      if (good[at(cx, cy)] & kGood) return true;
    }
  }
  return false;
}

bool TrayWindow::tried(std::size_t slot, bool corner, int ix, int iy) const {
  return ((corner ? corners_ : centres_)[slot][at(ix, iy)] & kTried) != 0;
}

void TrayWindow::mark_tried(std::size_t slot, bool corner, int ix, int iy) {
  (corner ? corners_ : centres_)[slot][at(ix, iy)] |= kTried;
}

void TrayWindow::mark_good(std::size_t slot, bool corner, int ix, int iy) {
  (corner ? corners_ : centres_)[slot][at(ix, iy)] |= kGood;
  if (!corner) good_anywhere_[at(ix, iy)] = kGood;
}

bool TrayWindow::in_region(std::size_t slot, int ix, int iy) const {
  const std::vector<std::uint8_t>& corners = corners_[slot];
  return (centres_[slot][at(ix, iy)] & corners[at(ix, iy)] & corners[at(ix + 1, iy)] & corners[at(ix, iy + 1)] &
          corners[at(ix + 1, iy + 1)] & kGood) != 0;
}

std::vector<std::uint8_t> TrayWindow::region_flags(std::size_t slot) const {
  std::vector<std::uint8_t> flags(in_range_.size());
  for (int iy = 0; iy < ny_; ++iy) {
    for (int ix = 0; ix < nx_; ++ix) flags[cell(ix, iy)] = good_anywhere_[at(ix, iy)] && in_region(slot, ix, iy);
  }
  return flags;
}

void TrayWindow::add(std::size_t slot, std::size_t tried, std::size_t feasible, const Rejections& rejections) {
  PartExplanation& total = totals_[slot];
  total.base_poses_tried += tried;
  total.base_poses_feasible += feasible;
  total.rejections += rejections;
}

void TrayWindow::add_blocked(const std::vector<BlockedPose>& poses) {
  blocked_.insert(blocked_.end(), poses.begin(), poses.end());
}

void TrayWindow::resume_without(const std::vector<std::uint8_t>& removed) {
  for (const BlockedPose& pose : blocked_) {
    const std::size_t slot = pose.slot;
    (pose.corner ? corners_ : centres_)[slot][at(pose.ix, pose.iy)] = 0;
    PartExplanation& total = totals_[slot];
    --total.base_poses_tried;
    total.rejections.unreachable -= pose.causes[0];
    total.rejections.limits -= pose.causes[1];
    total.rejections.self_collision -= pose.causes[2];
    total.rejections.scene -= pose.causes[3];
    total.rejections.grasp_filter -= pose.causes[4];
  }
  blocked_.clear();
  for (std::size_t slot = parts_.size(); slot-- > 0;) {
    if (!removed[parts_[slot]]) continue;
    const auto at = static_cast<std::ptrdiff_t>(slot);
    parts_.erase(parts_.begin() + at);
    centres_.erase(centres_.begin() + at);
    corners_.erase(corners_.begin() + at);
    totals_.erase(totals_.begin() + at);
  }
}

}  // namespace mmgrasp::detail
