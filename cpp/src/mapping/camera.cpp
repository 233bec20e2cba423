#include "mmgrasp/mapping/camera.hpp"

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {

constexpr double kMostPixels = 5e7;

void PinholeCamera::check() const {
  require(width > 0, "camera.width", width, "must be positive");
  require(height > 0, "camera.height", height, "must be positive");
  require(double(width) * height <= kMostPixels, "camera.width", width,
          "times camera.height must be at most 50 million pixels");
  require_positive(fx, "camera.fx");
  require_positive(fy, "camera.fy");
  require_number(cx, "camera.cx");
  require_number(cy, "camera.cy");
  require_positive(nearest, "camera.nearest");
  require(farthest > nearest, "camera.farthest", farthest, "must be more than camera.nearest");
}

std::optional<Eigen::Vector2d> PinholeCamera::project(const Eigen::Vector3d& p_camera_point) const {
  const double depth = p_camera_point[2];
  if (!(depth >= nearest && depth <= farthest)) return std::nullopt;
  const Eigen::Vector2d pixel(cx + fx * p_camera_point[0] / depth, cy + fy * p_camera_point[1] / depth);
  // Pixel centres lie on whole numbers: the image reaches from -0.5 to width - 0.5.
  const bool seen = pixel[0] >= -0.5 && pixel[0] <= width - 0.5 && pixel[1] >= -0.5 && pixel[1] <= height - 0.5;
  return seen ? std::optional<Eigen::Vector2d>(pixel) : std::nullopt;
}

}  // namespace mmgrasp
