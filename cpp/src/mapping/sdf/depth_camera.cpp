#include "mmgrasp/mapping/depth_camera.hpp"

#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp {

double DepthNoise::sigma(double depth, double incidence) const {
  double out = constant + depth * (linear + depth * quadratic);
  if (slant > 0) {
    const double ratio = incidence / (detail::kPi / 2 - incidence);
    out += slant * std::pow(depth, slant_power) * ratio * ratio;
  }
  return out;
}

void DepthNoise::check() const {
  const double fields[] = {constant, linear, quadratic, slant, slant_power};
  const char* names[] = {"noise.constant", "noise.linear", "noise.quadratic", "noise.slant", "noise.slant_power"};
  for (int k = 0; k < 5; ++k) require(std::isfinite(fields[k]), names[k], fields[k], "must be finite");
  require(slant >= 0, "noise.slant", slant, "must be zero or positive [m]");
  // Above zero in front of the camera: at the lens, far away, or at the vertex between.
  const bool somewhere = constant > 0 || quadratic > 0 || (quadratic == 0 && linear > 0) ||
                         (quadratic < 0 && linear > 0 && constant > linear * linear / (4 * quadratic));
  require(somewhere, "noise.constant", constant, "must make a positive standard deviation [m] at some depth");
}

void DepthNoise::check(double nearest, double farthest) const {
  check();
  // A parabola is least at an end or at its vertex.
  double least = std::min(sigma(nearest), sigma(farthest));
  const double vertex = quadratic != 0 ? -linear / (2 * quadratic) : nearest;
  if (vertex > nearest && vertex < farthest) least = std::min(least, sigma(vertex));
  require(least > 0, "noise", least, "must be a positive standard deviation [m] over the camera's range");
}

DepthNoise constant_noise(double sigma) {
  require(std::isfinite(sigma) && sigma > 0, "sigma", sigma, "must be positive and finite [m]");
  return {sigma};
}

DepthNoise structured_light_noise() {
  return {0.0012 + 0.0019 * 0.16, -2 * 0.0019 * 0.4, 0.0019, 0.0001, -0.5};
}

DepthNoise stereo_noise(double focal, double baseline, double disparity_sigma) {
  require(std::isfinite(focal) && focal > 0, "focal", focal, "must be positive and finite [pixels]");
  require(std::isfinite(baseline) && baseline > 0, "baseline", baseline, "must be positive and finite [m]");
  require(std::isfinite(disparity_sigma) && disparity_sigma > 0, "disparity_sigma", disparity_sigma,
          "must be positive and finite [pixels]");
  return {0, 0, disparity_sigma / (focal * baseline)};
}

DepthNoise time_of_flight_noise() {
  return {0.0015, -0.0005, 0.0003, 0.0001, 1.5};
}

void DepthCamera::check() const {
  require(!name.empty(), "camera.name", "\"\"", "must not be empty");
  intrinsics.check();
  require(std::isfinite(intrinsics.farthest), "camera.farthest", intrinsics.farthest, "must be finite");
  noise.check(intrinsics.nearest, intrinsics.farthest);
  require(std::isfinite(systematic) && systematic >= 0, "camera.systematic", systematic,
          "must be zero or positive and finite [m]");
  require(std::isfinite(systematic_scale) && systematic_scale >= 0, "camera.systematic_scale", systematic_scale,
          "must be zero or positive and finite");
}

FrameUncertainty FrameUncertainty::of_pose(double translation, double rotation) {
  require(std::isfinite(translation) && translation >= 0, "translation", translation,
          "must be zero or positive and finite [m]");
  require(std::isfinite(rotation) && rotation >= 0, "rotation", rotation, "must be zero or positive and finite [rad]");
  FrameUncertainty out;
  out.pose_covariance.diagonal() << Eigen::Vector3d::Constant(translation * translation),
      Eigen::Vector3d::Constant(rotation * rotation);
  return out;
}

}  // namespace mmgrasp
