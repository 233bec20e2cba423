#pragma once

// Maps of single objects for the tests of grasp synthesis.

#include <vector>

#include "mapping/sdf_scenes.hpp"
#include "mmgrasp/grasp/hand.hpp"

namespace mmgrasp::test {

inline PlacedShape table_plane() {
  return {Plane{Eigen::Vector3d::UnitZ(), 0.0}, Pose::Identity()};
}

inline Pose at(double x, double y, double z, double yaw = 0) {
  Pose T = Pose::Identity();
  T.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(x, y, z);
  return T;
}

/// Frames from all around, 0.35 m from the origin and 25 to 65 degrees above the table, without noise unless given.
inline ProbabilisticSdf scan(const std::vector<PlacedShape>& scene, double sigma = 0.0005, bool noisy = false,
                             int frames = 10) {
  SdfOptions options;
  options.threads = 1;
  ProbabilisticSdf map(options);
  const DepthCamera camera = small_camera(sigma);
  Rng rng(5);
  for (int k = 0; k < frames; ++k) {
    const double angle = 2.399963229728653 * k, up = (25 + 40.0 * (k % 3) / 2) / 57.29578;
    const Eigen::Vector3d eye =
        0.35 * Eigen::Vector3d(std::cos(up) * std::cos(angle), std::cos(up) * std::sin(angle), std::sin(up));
    DepthImage image = frame_of(scene, camera, look_at(eye, {0, 0, 0.03}));
    if (noisy) disturb(image, camera, rng);
    map.integrate(image, camera);
  }
  return map;
}

/// Opens 90 mm; pads 20 x 18 mm.
inline Hand test_hand() {
  Hand hand;
  hand.tool_link = "tool";
  hand.approach = Eigen::Vector3d::UnitZ();
  hand.closing = Eigen::Vector3d::UnitY();
  hand.max_opening = 0.09;
  hand.finger_depth = 0.02;
  hand.finger_width = 0.018;
  hand.clearance = 0.008;
  hand.body.finger_thickness = 0.01;
  hand.body.finger_length = 0.07;
  hand.body.palm_length = 0.12;
  hand.body.palm_width = 0.06;
  return hand;
}

}  // namespace mmgrasp::test
