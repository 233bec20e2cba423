#include "mapping/sdf/frame_checks.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

std::string size_of(const PinholeCamera& camera) {
  return std::to_string(camera.width) + " x " + std::to_string(camera.height);
}

std::string percent(double share) {
  return std::to_string(static_cast<int>(std::lround(100 * share))) + " %";
}

void check_uncertainty(const FrameUncertainty& uncertainty, const DepthImage& image) {
  const auto& C = uncertainty.pose_covariance;
  require(C.allFinite(), "pose_covariance", "not finite", "must be finite");
  const double size = C.cwiseAbs().maxCoeff();
  require((C - C.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * size, "pose_covariance", "not symmetric",
          "must be symmetric");
  const double least =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(C, Eigen::EigenvaluesOnly).eigenvalues().minCoeff();
  require(least >= -1e-9 * size, "pose_covariance", least, "must have no negative eigenvalue");
  if (uncertainty.sigma.empty()) return;
  require(uncertainty.sigma.size() == image.depth.size(), "sigma", std::to_string(uncertainty.sigma.size()) + " pixels",
          "must have the camera's " + std::to_string(image.depth.size()));
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    const float sigma = uncertainty.sigma[i];
    if (image.depth[i] > 0 && !(std::isfinite(sigma) && sigma > 0)) {
      require(false, "sigma", sigma, "must be positive and finite [m] where a depth was measured");
    }
  }
}

}  // namespace

void check_frame(const DepthImage& image, const DepthCamera& camera, const FrameUncertainty& uncertainty) {
  camera.check();
  const PinholeCamera &a = image.camera, &b = camera.intrinsics;
  require(a.width == b.width && a.height == b.height, "depth image", size_of(a) + " pixels",
          "must have the size of camera '" + camera.name + "', " + size_of(b));
  image.check();
  require(a.fx == b.fx && a.fy == b.fy && a.cx == b.cx && a.cy == b.cy, "depth image", "other intrinsics",
          "must have those of camera '" + camera.name + "'");
  checked_pose(image.T_world_camera.matrix(), "T_world_camera");
  check_uncertainty(uncertainty, image);
}

void check_depths(const DepthImage& image) {
  const PinholeCamera& camera = image.camera;
  std::vector<float> measured;
  std::size_t in_range = 0;
  for (const float z : image.depth) {
    if (!(z > 0)) continue;
    measured.push_back(z);
    in_range += z >= camera.nearest && z <= camera.farthest;
  }
  require(!measured.empty(), "depth image", "no pixel measured", "must hold at least one depth above zero");
  if (in_range * 20 > measured.size()) return;
  std::nth_element(measured.begin(), measured.begin() + measured.size() / 2, measured.end());
  const double median = measured[measured.size() / 2];
  const std::string range = "[" + std::to_string(camera.nearest) + ", " + std::to_string(camera.farthest) + "] m";
  for (const double scale : {1e-3, 1e3}) {
    const double scaled = median * scale;
    require(!(scaled >= camera.nearest && scaled <= camera.farthest), "depth image", median,
            std::string("is its median depth, outside the camera's range ") + range + " unless " +
                (scale < 1 ? "divided" : "multiplied") + " by 1000: depths must be in metres, check the depth scale");
  }
  require(in_range > 0, "depth image", median, "is its median depth, and none is in the camera's range " + range);
}

void check_pose(const KeyFrame& key_frame, const DepthImage& image, const SdfOptions& options,
                IntegrationReport& report) {
  constexpr int kEnough = 100;
  const Pose &T_first = key_frame.T_world_camera, &T_second = image.T_world_camera;
  const double tolerance = 2 * options.truncation;
  const Pose T_inverse = T_second.inverse(Eigen::Isometry);
  const Agreement given = key_frame.compare(image, T_inverse * T_first, tolerance);
  Agreement inverted;
  std::string how;
  for (const auto& [T_camera_key, said] :
       {std::pair{Pose(T_second * T_first.inverse(Eigen::Isometry)), "when the poses are inverted"},
        {Pose(T_second * T_first), "when its own pose is inverted"},
        {Pose(T_inverse * T_first.inverse(Eigen::Isometry)), "when the earlier one's pose is inverted"}}) {
    const Agreement found = key_frame.compare(image, T_camera_key, tolerance);
    if (found.confirmed <= inverted.confirmed) continue;
    inverted = found;
    how = said;
  }
  // Both ways nearly the same view say nothing.
  const bool fits_inverted = inverted.confirmed >= kEnough && inverted.share() > 0.8 &&
                             inverted.confirmed > 2 * given.confirmed && given.share() < 0.5;
  const std::string inverted_says = percent(inverted.share()) + " " + how;
  if (given.seen < kEnough) {
    // Views that hardly overlap, as of a camera that turns on the spot, are not contradicted by what they show.
    if (fits_inverted)
      report.warning = "this frame and an earlier one hardly see the same place, but agree on " + inverted_says +
                       ": do poses lead from the camera to the world?";
    return;
  }
  if (fits_inverted) {
    throw InvalidInput("T_world_camera: this frame confirms " + percent(given.share()) +
                       " of what an earlier one saw, but " + inverted_says +
                       ": poses must lead from the camera to the world");
  }
  report.agreement = given.share();
  if (given.share() < 0.25) {
    report.warning = "this frame confirms only " + percent(given.share()) +
                     " of what an earlier one saw in the same place: is its pose right?";
  }
}

}  // namespace mmgrasp::detail
