#pragma once

// Frames for the tests of the probabilistic map.

#include <Eigen/Geometry>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/mapping/probabilistic_sdf.hpp"
#include "support/temporary_folder.hpp"

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

/// All pixels at the same depth.
inline DepthImage wall(const DepthCamera& camera, double depth) {
  DepthImage image{camera.intrinsics, Pose::Identity(), {}};
  image.depth.assign(static_cast<std::size_t>(camera.intrinsics.width) * camera.intrinsics.height,
                     static_cast<float>(depth));
  return image;
}

/// From all around a ball at the origin.
inline std::vector<DepthImage> noisy_sphere_frames(int count, const DepthCamera& camera, double radius) {
  std::vector<DepthImage> frames;
  for (int k = 0; k < count; ++k) {
    frames.push_back(frame_of({{Sphere{radius}}}, camera, look_at(0.3 * direction_of(k, count), {0, 0, 0})));
    Rng rng(7, static_cast<std::uint64_t>(k));
    disturb(frames.back(), camera, rng);
  }
  return frames;
}

/// Even in a cube around the origin.
inline Eigen::Matrix3Xd random_points(int count, double spread) {
  Rng rng(3);
  Eigen::Matrix3Xd points(3, count);
  for (double& value : points.reshaped()) value = rng.uniform(-spread, spread);
  return points;
}

/// The map as save() writes it.
inline std::string bytes_of(const ProbabilisticSdf& sdf) {
  const TemporaryFolder folder;
  const std::string path = folder.file("bytes.sdf");
  sdf.save(path);
  std::ostringstream out;
  out << std::ifstream(path, std::ios::binary).rdbuf();
  return out.str();
}

}  // namespace mmgrasp::test
