// Occupied cells of a set of points.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/geometry/octree.hpp"

namespace mmgrasp {

Voxels voxelize(const std::vector<Eigen::Vector3d>& points, double resolution) {
  require_length(resolution, "resolution");
  require(!points.empty(), "points", "0", "must hold at least one");
  std::vector<std::array<std::int64_t, 3>> cells;
  cells.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<std::int64_t, 3> cell{};
    for (int k = 0; k < 3; ++k) {
      // At most 1e15, and doubles number cells one by one up to 2^53.
      if (!(std::abs(points[i][k]) <= kLargestLength))
        require_coordinate(points[i][k], "points[" + std::to_string(i) + "][" + std::to_string(k) + "]");
      cell[k] = static_cast<std::int64_t>(std::floor(points[i][k] / resolution));
    }
    cells.push_back(cell);
  }
  detail::InterruptionPoll poll;
  std::sort(cells.begin(), cells.end(), [&](const auto& a, const auto& b) {
    poll();
    return a < b;
  });
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  auto centres = std::make_shared<std::vector<Eigen::Vector3d>>();
  centres->reserve(cells.size());
  for (const auto& cell : cells) {
    centres->push_back(resolution * Eigen::Vector3d(static_cast<double>(cell[0]) + 0.5,
                                                    static_cast<double>(cell[1]) + 0.5,
                                                    static_cast<double>(cell[2]) + 0.5));
  }
  return {centres, resolution};
}

}  // namespace mmgrasp
