#include "mmgrasp/mapping/depth_camera.hpp"

#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {

constexpr double kLeastSigma = 1e-7;  // [m]; maps hold weights, one over its square, as floats

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
  for (int k = 0; k < 5; ++k) require_number(fields[k], names[k]);
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
  require(least >= kLeastSigma, "noise", least,
          "must be a standard deviation of at least 1e-7 m over the camera's range");
}

DepthNoise constant_noise(double sigma) {
  require_positive(sigma, "sigma", "m");
  require(sigma >= kLeastSigma, "sigma", sigma, "must be at least 1e-7 m");
  return {sigma};
}

DepthNoise structured_light_noise() {
  return {0.0012 + 0.0019 * 0.16, -2 * 0.0019 * 0.4, 0.0019, 0.0001, -0.5};
}

DepthNoise stereo_noise(double focal, double baseline, double disparity_sigma) {
  require_positive(focal, "focal", "pixels");
  require_positive(baseline, "baseline", "m");
  require_positive(disparity_sigma, "disparity_sigma", "pixels");
  return {0, 0, disparity_sigma / (focal * baseline)};
}

DepthNoise time_of_flight_noise() {
  return {0.0015, -0.0005, 0.0003, 0.0001, 1.5};
}

void DepthCamera::check() const {
  require(!name.empty(), "camera.name", "\"\"", "must not be empty");
  intrinsics.check();
  require_number(intrinsics.farthest, "camera.farthest");
  noise.check(intrinsics.nearest, intrinsics.farthest);
  require_not_negative(systematic, "camera.systematic", "m");
  require_not_negative(systematic_scale, "camera.systematic_scale");
}

FrameUncertainty FrameUncertainty::of_pose(double translation, double rotation) {
  require_not_negative(translation, "translation", "m");
  require_not_negative(rotation, "rotation", "rad");
  FrameUncertainty out;
  out.pose_covariance.diagonal() << Eigen::Vector3d::Constant(translation * translation),
      Eigen::Vector3d::Constant(rotation * rotation);
  return out;
}

}  // namespace mmgrasp
