#pragma once

// Frames for the tests of the probabilistic map.

#include <Eigen/Geometry>
#include <vector>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/mapping/probabilistic_sdf.hpp"

namespace mmgrasp::test {

/// 160 x 120 pixels, a little less than a millimetre wide at 0.3 m.
inline DepthCamera small_camera(double sigma = 0.001) {
  DepthCamera camera;
  camera.intrinsics.width = 160;
  camera.intrinsics.height = 120;
  camera.intrinsics.fx = camera.intrinsics.fy = 200;
  camera.intrinsics.cx = 79.5;
  camera.intrinsics.cy = 59.5;
  camera.noise = constant_noise(sigma);
  return camera;
}

/// A camera at `eye` that looks at `target`, x of the image level.
inline Pose look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
  const Eigen::Vector3d z = (target - eye).normalized();
  const Eigen::Vector3d up = std::abs(z.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d x = z.cross(up).normalized();
  Pose T = Pose::Identity();
  T.linear() << x, z.cross(x), z;
  T.translation() = eye;
  return T;
}

inline DepthImage frame_of(const std::vector<PlacedShape>& scene, const DepthCamera& camera, const Pose& T) {
  RenderOptions exact;
  exact.threads = 1;
  return render_depth(scene, camera.intrinsics, T, exact);
}

/// Adds the camera's own noise; the incidence is taken as zero.
inline void disturb(DepthImage& image, const DepthCamera& camera, Rng& rng) {
  for (float& z : image.depth) {
    if (z > 0) z = static_cast<float>(z + camera.noise.sigma(z) * rng.normal());
  }
}

/// A direction spread evenly over the sphere, k of n.
inline Eigen::Vector3d direction_of(int k, int n) {
  const double z = 1 - (2 * k + 1.0) / n, angle = 2.399963229728653 * k;
  return {std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z};
}

}  // namespace mmgrasp::test
