#include "verify/base/searched_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "verify/base/floor.hpp"

namespace mmgrasp::verify::detail {
namespace {

constexpr double kBeyond = 0.02;  // Corners of a cell are looked at so much of its size farther out.

bool lists(const CheckedTray& tray, double heading) {
  return std::any_of(tray.headings.begin(), tray.headings.end(),
                     [&](double known) { return std::abs(wrap_angle(known - heading)) < kSameHeading; });
}

}  // namespace

bool SearchedCells::is_left_out(const Cell& cell) const {
  if (searched_ == plan_.searched.end() || !on_grid(cell) || has(cell)) return false;
  const CheckedTray& tray = searched_->second;
  const Eigen::Vector3d middle = pose(cell, 0.5, 0.5);
  if ((middle.head<2>() - tray.middle).norm() > tray.max_distance) return false;
  return lists(tray, middle.z()) || (tray.shares_headings && other_is_served(cell));
}

/// Whether some tray is served there at a heading of its own.
bool SearchedCells::other_is_served(const Cell& cell) const {
  return std::any_of(plan_.regions.begin(), plan_.regions.end(), [&](const CheckedRegion& other) {
    const auto tray = plan_.searched.find(other.tray);
    return tray != plan_.searched.end() && lists(tray->second, grid_.headings[cell.layer]) &&
           other.cells.size() == region_.cells.size() && other.cells[index(cell)] != 0;
  });
}

bool base_pose_serves(const PlanToCheck& plan, GraspSearch& search, const Eigen::Vector3d& pose,
                      const std::vector<int>& parts, Effort effort) {
  Faults none;
  return check_workspace(plan, pose, 0, "", none) && search.serves(pose, parts, effort);
}

bool whole_cell_serves(const PlanToCheck& plan, GraspSearch& search, const SearchedCells& cells, const Cell& cell,
                       const std::vector<int>& parts) {
  constexpr double kLow = -kBeyond, kHigh = 1 + kBeyond;
  constexpr std::array<std::array<double, 2>, 5> kPlaces = {
      {{kLow, kLow}, {kHigh, kHigh}, {kLow, kHigh}, {kHigh, kLow}, {0.5, 0.5}}};
  return std::all_of(kPlaces.begin(), kPlaces.end(), [&](const auto& place) {
    return base_pose_serves(plan, search, cells.pose(cell, place[0], place[1]), parts, Effort::without_ties);
  });
}

}  // namespace mmgrasp::verify::detail
