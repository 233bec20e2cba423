// How the parts of an operation move from one pose of its motion to the next.
#include "mmgrasp/grasp/detail/motion_looks.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {

Eigen::Vector3d middle_of(const std::vector<PlacedMesh>& parts) {
  Eigen::AlignedBox3d box;
  for (const PlacedMesh& part : parts) {
    for (const Eigen::Vector3d& v : part.mesh->vertices) box.extend(part.pose * v);
  }
  return box.isEmpty() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(box.center());
}

MotionPiece::MotionPiece(const Pose& from, const Pose& to, const Eigen::Vector3d& middle)
    : from_(from), to_(to), middle_(middle), vector_(rotation_vector(from.linear().transpose() * to.linear())) {}

Pose MotionPiece::at(double share) const {
  if (share >= 1) return to_;
  Pose pose = from_;
  const double angle = vector_.norm();
  if (angle == 0) {
    pose.translation() += share * (to_.translation() - from_.translation());
    return pose;
  }
  pose.linear() = from_.linear() * Eigen::AngleAxisd(share * angle, vector_ / angle).toRotationMatrix();
  pose.translation() = middle_from() + share * way() - pose.linear() * middle_;
  return pose;
}

Eigen::Vector3d MotionPiece::way() const {
  return middle_to() - middle_from();
}

double MotionPiece::angle() const {
  return vector_.norm();
}

Eigen::Vector3d MotionPiece::middle_from() const {
  return from_ * middle_;
}

Eigen::Vector3d MotionPiece::middle_to() const {
  return to_ * middle_;
}

Poses motion_looks(const Poses& motion, const Eigen::Vector3d& middle, double step, double turn) {
  Poses out{motion.front()};
  for (std::size_t i = 1; i < motion.size(); ++i) {
    const MotionPiece piece(motion[i - 1], motion[i], middle);
    const double wanted = std::max(1.0, std::ceil(std::max(piece.way().norm() / step, piece.angle() / turn)));
    const double most = 1e6 - static_cast<double>(out.size());
    if (!(wanted <= most))
      throw InvalidInput("motion[" + std::to_string(i) + "]: the way is too long to be looked at every " +
                         std::to_string(step) + " m");
    const int looks = static_cast<int>(wanted);
    for (int k = 1; k <= looks; ++k) out.push_back(piece.at(static_cast<double>(k) / looks));
  }
  return out;
}

}  // namespace mmgrasp::detail
