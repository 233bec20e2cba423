#pragma once

// Notices poses that do not fit together.

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/mapping/depth_image.hpp"

namespace mmgrasp::detail {

/// How many of a frame's measured points another frame should see, and at how many of them it measured the same depth.
/// Points that it sees from another side and behind what it measured are hidden from it and do not count.
struct Agreement {
  int seen = 0, confirmed = 0;
  double share() const { return seen > 0 ? static_cast<double>(confirmed) / seen : 0; }
};

/// Some points of an earlier frame, in its camera's frame, and its pose as it was given.
struct KeyFrame {
  Pose T_world_camera = Pose::Identity();
  std::vector<Eigen::Vector3d> points;

  static KeyFrame of(const DepthImage& image);
  /// `T_camera_key`: the pose of the key frame's camera in the image's. Depths count as the same within `tolerance`.
  Agreement compare(const DepthImage& image, const Pose& T_camera_key, double tolerance) const;
};

}  // namespace mmgrasp::detail
