#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/geometry/shape.hpp"
#include "mmgrasp/mapping/camera.hpp"

namespace mmgrasp {

/// What a depth camera saw. Depth is measured along the camera's axis, not along the pixel's ray [m]; 0 stands where
/// nothing was measured.
struct MMGRASP_EXPORT DepthImage {
  PinholeCamera camera;
  Pose T_world_camera = Pose::Identity();
  std::vector<float> depth;  ///< width * height, row by row.
  int invalid = 0;           ///< Pixels that clean() found NaN, infinite or negative.

  /// Throws InvalidInput on a bad camera or a wrong number of pixels. NaN, infinity and negative depths mean "nothing
  /// measured" too: clean() turns them into 0 and counts them.
  void check() const;
  void clean();
  float at(int u, int v) const { return depth[static_cast<std::size_t>(v) * camera.width + u]; }
  /// The measured point of a pixel in the world [m]; meaningless where the depth is 0.
  Eigen::Vector3d point(int u, int v) const;
  /// Every measured point, row by row, in the world.
  std::vector<Eigen::Vector3d> points() const;
};

/// A body of the rendered scene.
struct MMGRASP_EXPORT PlacedShape {
  Shape shape;
  Pose T_world_shape = Pose::Identity();
};

/// How a rendered depth image differs from a perfect one: its noise, and pixels without a measurement.
struct MMGRASP_EXPORT RenderOptions {
  double noise = 0;    ///< Standard deviation of the depth at 1 m; it grows with the square of the distance [m]; >= 0.
  double missing = 0;  ///< Share of pixels without a measurement, in [0, 1].
  unsigned seed = 1;   ///< Same seed, same image, at any thread count.
  int threads = 0;     ///< 0: all.
  void check() const;
};

/// The depth image of a scene: through every pixel's centre one ray, the first surface it meets in front of the camera;
/// nothing when that lies outside the camera's range. Boxes, spheres, cylinders, capsules and planes are met exactly,
/// meshes triangle by triangle from both sides without gaps at shared edges, voxels as the mesh of their outer faces.
/// Throws InvalidInput on a bad shape, camera or option.
MMGRASP_EXPORT DepthImage render_depth(const std::vector<PlacedShape>& scene, const PinholeCamera& camera,
                                       const Pose& T_world_camera, const RenderOptions& options = {});

/// A level camera pose looking along -z of the world from `eye` (x of the image along the world's x).
MMGRASP_EXPORT Pose look_down(const Eigen::Vector3d& eye);

}  // namespace mmgrasp
