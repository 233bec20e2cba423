#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// A finger joint and its value as a function of the opening: linear between (0, closed) and (max_opening, open).
struct MMGRASP_EXPORT FingerJoint {
  std::string name;
  double closed = 0;  ///< Value at opening 0 [rad] or [m].
  double open = 0;    ///< Value at max_opening.
};

/// A parallel-jaw gripper. The tool centre point (tcp) lies midway between the pads' centres.
struct MMGRASP_EXPORT Gripper {
  std::string tcp_link;                                 ///< Robot link whose frame is the tcp.
  Eigen::Vector3d approach = Eigen::Vector3d::UnitX();  ///< Unit axis of the tcp frame along which the hand moves in.
  Eigen::Vector3d closing = Eigen::Vector3d::UnitY();   ///< Unit axis of the tcp frame along which the pads close.
  double max_opening = 0.1;                             ///< Widest part that fits [m], > 0.
  double finger_depth = 0.03;  ///< Pad length along the approach axis [m], > 0: half of it reaches past the tcp.
  double finger_width = 0.02;  ///< Pad size across approach and closing [m], > 0.
  double clearance = 0.01;     ///< Gap left on each side of the part while moving in [m], >= 0.
  std::vector<FingerJoint> joints;
  std::vector<std::string> finger_links;  ///< Links that may touch the held part.

  void check() const;  ///< Throws InvalidInput: axes unit and orthogonal, sizes positive.
  /// Finger joint values at an opening in [0, max_opening].
  std::map<std::string, double> joint_values(double opening) const;
  /// Opening while moving in on a part of this width: width + 2 clearance, at most max_opening.
  double pregrasp_opening(double width) const;
};

}  // namespace mmgrasp
