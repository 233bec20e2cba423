#pragma once

#include <Eigen/Core>
#include <optional>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"

namespace mmgrasp {

/// Pinhole camera without distortion. Its frame looks along +z, x to the right of the image, y down.
struct MMGRASP_EXPORT PinholeCamera {
  int width = 640, height = 480;  ///< [pixels], > 0
  double fx = 525, fy = 525;      ///< Focal lengths [pixels], > 0
  double cx = 319.5, cy = 239.5;  ///< Principal point [pixels]
  double nearest = 0.1;           ///< What lies closer along the axis is not seen [m], > 0
  double farthest = 5.0;          ///< What lies farther is not seen [m], > nearest
  void check() const;

  /// Pixel (u, v) of a point in the camera's frame, or nothing when it lies outside the image or the depth range: the
  /// inequality proj(p, c) <= w of P3 3.1.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_camera_point) const;
};

}  // namespace mmgrasp
