#pragma once

#include <Eigen/Core>
#include <string>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/mapping/probabilistic_sdf.hpp"

namespace mmgrasp {

/// How register_frame() searches and what it accepts.
struct MMGRASP_EXPORT RegistrationOptions {
  int max_points = 4000;        ///< Pixels that are compared, spread evenly over the image; >= 100.
  int max_iterations = 30;      ///< Steps of Gauss-Newton; > 0.
  double max_distance = 0.05;   ///< Pixels farther from the map's surface are not compared with it [m]; > 0.
  double min_overlap = 0.3;     ///< Share of the compared pixels that must meet the map; in (0, 1].
  double max_correction = 4.0;  ///< Farther from the given pose, in its own standard deviations, is refused; > 0.
  /// Directions along which the surface moves by less than this share of the motion (in the mean of squares) are left
  /// as given: a plane slid in itself, a cylinder turned about its axis; in [0, 1).
  double min_observability = 0.0015;
  int threads = 0;  ///< 0: all. The result does not depend on it.
  void check() const;
};

/// Where a frame's camera stood, by what the map holds.
struct MMGRASP_EXPORT FrameRegistration {
  bool registered = false;  ///< Else the pose is the given one, and `reason` says why.
  Pose T_world_camera = Pose::Identity();
  /// Covariance of the error of T_world_camera, as in FrameUncertainty: the given one where nothing was observed.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  int compared = 0;       ///< Pixels that were looked for in the map.
  int matched = 0;        ///< Compared pixels that met its surface and agree with it in the end.
  int observed = 0;       ///< Directions of the six that the surface fixes.
  int iterations = 0;     ///< Steps of Gauss-Newton.
  double rms_before = 0;  ///< Distance of the matched pixels from the map's surface at the given pose [m].
  double rms = 0;         ///< The same at the registered one [m].
  double correction = 0;  ///< From the given pose, in its standard deviations.
  std::string reason;     ///< Why it was refused, or empty.
};

/// Moves a frame's pose so that its depths meet the map: point to plane, by Gauss-Newton on the map's own field where
/// that is known around a point and along the pixel's ray where it is not, weighted by the variances of both and robust
/// to a share of wrong pixels. The given pose counts with its covariance, which must have no direction without error:
/// it says how far the pose may be moved. What the surface does not fix is not moved.
///
/// The map stays as it is; integrate the frame with the pose and the covariance that come back. The covariance is that
/// against the map: what all its frames are wrong by together, registration can not tell.
///
///     const FrameRegistration found = register_frame(sdf, image, camera, FrameUncertainty::of_pose(0.01, 0.02));
///     image.T_world_camera = found.T_world_camera;
///     FrameUncertainty uncertainty;
///     uncertainty.pose_covariance = found.covariance;
///     sdf.integrate(image, camera, uncertainty);
///
/// Throws InvalidInput as ProbabilisticSdf::integrate() does on frames that do not fit, on a map without a frame, a
/// covariance that is not positive definite and options out of range.
MMGRASP_EXPORT FrameRegistration register_frame(const ProbabilisticSdf& sdf, const DepthImage& image,
                                                const DepthCamera& camera, const FrameUncertainty& uncertainty,
                                                const RegistrationOptions& options = {});

}  // namespace mmgrasp
