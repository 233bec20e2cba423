#include <algorithm>

#include "mmgrasp/task/base_region.hpp"

namespace mmgrasp {

Eigen::Vector3d BaseGrid::centre(int heading, int ix, int iy) const {
  return Eigen::Vector3d(origin.x() + (ix + 0.5) * resolution, origin.y() + (iy + 0.5) * resolution,
                         headings[static_cast<std::size_t>(heading)]);
}

std::size_t BaseRegion::count() const {
  return static_cast<std::size_t>(std::count(cells.begin(), cells.end(), std::uint8_t{1}));
}

}  // namespace mmgrasp
