#include "mmgrasp/mapping/depth_image.hpp"

#include <cmath>
#include <string>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {

void DepthImage::check() const {
  camera.check();
  const std::size_t pixels = static_cast<std::size_t>(camera.width) * camera.height;
  require(depth.size() == pixels, "depth image", std::to_string(depth.size()) + " pixels",
          "must have the camera's " + std::to_string(pixels));
}

void DepthImage::clean() {
  for (float& z : depth) {
    if (z >= 0 && z <= kLargestLength) continue;
    z = 0;
    ++invalid;
  }
}

Eigen::Vector3d DepthImage::point(int u, int v) const {
  const double z = at(u, v);
  return T_world_camera * Eigen::Vector3d((u - camera.cx) / camera.fx * z, (v - camera.cy) / camera.fy * z, z);
}

std::vector<Eigen::Vector3d> DepthImage::points() const {
  check();
  std::vector<Eigen::Vector3d> out;
  for (int v = 0; v < camera.height; ++v) {
    detail::throw_if_interrupted();
    for (int u = 0; u < camera.width; ++u) {
      const float z = at(u, v);
      if (z > 0 && std::isfinite(z)) out.push_back(point(u, v));
    }
  }
  return out;
}

Pose look_down(const Eigen::Vector3d& eye) {
  Pose T = Pose::Identity();
  T.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  T.translation() = eye;
  return T;
}

}  // namespace mmgrasp
