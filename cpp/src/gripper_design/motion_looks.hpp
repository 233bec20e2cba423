#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/pose.hpp"

namespace mmgrasp::detail {

/// Poses along the straight lines and even turns between `motion`, no farther apart than `step` [m] and `turn` [rad].
/// Throws InvalidInput where these are more than a million.
inline Poses motion_looks(const Poses& motion, double step, double turn) {
  Poses out{motion.front()};
  for (std::size_t i = 1; i < motion.size(); ++i) {
    const Pose &from = motion[i - 1], &to = motion[i];
    const Eigen::Vector3d way = to.translation() - from.translation();
    const Eigen::Vector3d vector = rotation_vector(from.linear().transpose() * to.linear());
    const double angle = vector.norm();
    const double wanted = std::max(1.0, std::ceil(std::max(way.norm() / step, angle / turn)));
    const double most = 1e6 - static_cast<double>(out.size());
    if (!(wanted <= most))
      throw InvalidInput("motion[" + std::to_string(i) + "]: the way is too long to be looked at every " +
                         std::to_string(step) + " m");
    const int looks = static_cast<int>(wanted);
    for (int k = 1; k <= looks; ++k) {
      const double share = static_cast<double>(k) / looks;
      Pose pose = Pose::Identity();
      pose.translation() = from.translation() + share * way;
      pose.linear() = from.linear();
      if (angle > 0)
        pose.linear() = from.linear() * Eigen::AngleAxisd(share * angle, vector / angle).toRotationMatrix();
      out.push_back(pose);
    }
  }
  return out;
}

}  // namespace mmgrasp::detail
