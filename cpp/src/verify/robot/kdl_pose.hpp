#pragma once

#include <kdl/frames.hpp>

#include "mmgrasp/core/pose.hpp"

namespace mmgrasp::verify::detail {

inline KDL::Frame to_kdl(const Pose& T) {
  const Eigen::Matrix3d R = T.linear();
  const Eigen::Vector3d p = T.translation();
  return {KDL::Rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
          KDL::Vector(p.x(), p.y(), p.z())};
}

inline Pose from_kdl(const KDL::Frame& frame) {
  Pose T = Pose::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) T(row, column) = frame.M(row, column);
    T(row, 3) = frame.p(row);
  }
  return T;
}

}  // namespace mmgrasp::verify::detail
