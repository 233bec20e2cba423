#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/mapping/camera.hpp"

namespace mmgrasp {

/// Standard deviation of a depth along the camera's axis, independent from pixel to pixel and from frame to frame:
///
///     sigma(z, theta) = constant + linear z + quadratic z^2 + slant z^slant_power theta^2 / (pi/2 - theta)^2
///
/// with z the depth [m] and theta the angle of incidence, between the ray and the surface's normal.
struct MMGRASP_EXPORT DepthNoise {
  double constant = 0.001;  ///< [m]
  double linear = 0;        ///< [1]
  double quadratic = 0;     ///< [1/m]
  double slant = 0;         ///< [m], at a depth of 1 m; >= 0
  double slant_power = 0;   ///< How the slant's part grows with the depth.

  /// [m]; `incidence` in [0, pi/2).
  double sigma(double depth, double incidence = 0) const;
  /// Throws InvalidInput unless the coefficients are finite, slant is not negative and sigma is positive at some depth.
  void check() const;
  /// Throws InvalidInput unless finite and positive from `nearest` to `farthest` [m].
  void check(double nearest, double farthest) const;
};

/// The same standard deviation everywhere [m]; > 0.
MMGRASP_EXPORT DepthNoise constant_noise(double sigma);
/// Structured light, the first Kinect: C. V. Nguyen, S. Izadi, D. Lovell, "Modeling Kinect sensor noise for improved 3D
/// reconstruction and tracking", 3DIMPVT 2012: 0.0012 + 0.0019 (z - 0.4)^2 + 0.0001 / sqrt(z) theta^2 / (pi/2 -
/// theta)^2.
MMGRASP_EXPORT DepthNoise structured_light_noise();
/// Stereo, active or passive: z^2 disparity_sigma / (focal baseline), for instance K. Khoshelham, S. O. Elberink,
/// "Accuracy and resolution of Kinect depth data for indoor mapping applications", Sensors 12(2), 2012, whose Kinect
/// has 1.425e-3 z^2. `focal` and `disparity_sigma` in pixels, `baseline` in metres; all > 0.
MMGRASP_EXPORT DepthNoise stereo_noise(double focal, double baseline, double disparity_sigma);
/// Time of flight, the second Kinect: P. Fankhauser et al., "Kinect v2 for mobile robot navigation: evaluation and
/// modeling", ICAR 2015: 0.0015 - 0.0005 z + 0.0003 z^2 + 0.0001 z^1.5 theta^2 / (pi/2 - theta)^2.
MMGRASP_EXPORT DepthNoise time_of_flight_noise();

/// A depth camera: what it sees and how well it measures.
struct MMGRASP_EXPORT DepthCamera {
  std::string name = "camera";  ///< Frames of one name share their systematic error.
  PinholeCamera intrinsics;
  DepthNoise noise;
  /// Standard deviation of an offset of all depths, the same in every frame of this camera, so that it never averages
  /// away: what calibration and temperature leave [m]; >= 0.
  double systematic = 0;
  double systematic_scale = 0;  ///< The same in proportion to the depth; >= 0.
  void check() const;
};

/// What is known about one frame beside its pixels.
struct MMGRASP_EXPORT FrameUncertainty {
  /// Covariance of the error of T_world_camera, independent from frame to frame: displacement [m] in the first three
  /// rows, rotation vector about the camera's origin [rad] in the last, both along the world's axes.
  Eigen::Matrix<double, 6, 6> pose_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// Standard deviation of each depth [m] in place of the camera's noise; > 0 where something was measured. Empty: the
  /// camera's noise.
  std::vector<float> sigma;

  /// A pose error alike in all directions: standard deviations of the displacement [m] and of the rotation [rad] along
  /// each axis.
  static FrameUncertainty of_pose(double translation, double rotation);
};

}  // namespace mmgrasp
