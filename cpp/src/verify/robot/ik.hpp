#pragma once

#include "verify/robot/kinematics.hpp"

namespace mmgrasp::verify::detail {

struct IkTolerance {
  double position = 1e-4;  ///< [m]
  double rotation = 1e-3;  ///< [rad]
  int iterations = 60;
};

/// Levenberg-Marquardt on the KDL Jacobian, damped in proportion to the error, joints kept inside limits throughout.
/// Turns `arm` into a configuration whose tip is at T_root_tip; false when it ends elsewhere.
bool solve_tip_pose(Kinematics& kinematics, const Pose& T_root_tip, const IkTolerance& tolerance, Eigen::VectorXd& arm);

}  // namespace mmgrasp::verify::detail
