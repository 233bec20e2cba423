#include "mapping/sdf/key_frame.hpp"

#include <cmath>

namespace mmgrasp::detail {

namespace {

constexpr double kOneSide = 0.7;  // cosine of the largest angle between two ways of looking at one side of a part

}  // namespace

KeyFrame KeyFrame::of(const DepthImage& image) {
  constexpr int kColumns = 48, kRows = 36;
  KeyFrame out;
  out.T_world_camera = image.T_world_camera;
  const PinholeCamera& camera = image.camera;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const int u = (2 * column + 1) * camera.width / (2 * kColumns), v = (2 * row + 1) * camera.height / (2 * kRows);
      const double z = image.at(u, v);
      if (!(z >= camera.nearest && z <= camera.farthest)) continue;
      out.points.emplace_back((u - camera.cx) / camera.fx * z, (v - camera.cy) / camera.fy * z, z);
    }
  }
  return out;
}

Agreement KeyFrame::compare(const DepthImage& image, const Pose& T_camera_key, double tolerance) const {
  Agreement out;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d p = T_camera_key * point;
    const auto pixel = image.camera.project(p);
    if (!pixel) continue;
    const int u = std::min(image.camera.width - 1, static_cast<int>((*pixel)[0] + 0.5)),
              v = std::min(image.camera.height - 1, static_cast<int>((*pixel)[1] + 0.5));
    const double z = image.at(std::max(0, u), std::max(0, v));
    if (!(z > 0)) continue;
    const double nearer = p.z() - z, same = tolerance + 0.02 * z;
    // From another side the back of a part hides its front, and contradicts nothing.
    if (nearer > same && p.dot(T_camera_key.linear() * point) < kOneSide * p.norm() * point.norm()) continue;
    ++out.seen;
    out.confirmed += std::abs(nearer) <= same;
  }
  return out;
}

}  // namespace mmgrasp::detail
