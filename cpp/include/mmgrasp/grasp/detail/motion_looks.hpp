#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/grasp/finger_length_range.hpp"

namespace mmgrasp::detail {

/// The middle of the box around the parts, in the frame of their subassembly: the point that moves straight while they
/// turn, wherever their files have the origin.
MMGRASP_EXPORT Eigen::Vector3d middle_of(const std::vector<PlacedMesh>& parts);

/// The way from one pose of a motion to the next: the moved parts' middle goes straight, the parts turn evenly about
/// one axis. Whatever looks at a motion looks at this.
class MMGRASP_EXPORT MotionPiece {
 public:
  MotionPiece(const Pose& from, const Pose& to, const Eigen::Vector3d& middle);
  Pose at(double share) const;          ///< `share` in [0, 1] of the way.
  Eigen::Vector3d way() const;          ///< The middle's [m].
  double angle() const;                 ///< [rad], in [0, pi].
  Eigen::Vector3d middle_from() const;  ///< Where the middle is at either end [m].
  Eigen::Vector3d middle_to() const;

 private:
  Pose from_, to_;
  Eigen::Vector3d middle_, vector_;  // The turn as a rotation vector in the moved frame.
};

/// Poses along a motion, no farther apart than `step` [m], of the moved parts' `middle`, and `turn` [rad]. Throws
/// InvalidInput where these are more than a million.
MMGRASP_EXPORT Poses motion_looks(const Poses& motion, const Eigen::Vector3d& middle, double step, double turn);

}  // namespace mmgrasp::detail
