#include "verify/robot/ik.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace mmgrasp::verify::detail {
namespace {

constexpr double kLeastDamping = 1e-9;

/// Damped least-squares step that pushes no joint through a limit: joints that would leave are held and the rest
/// take over.
Eigen::VectorXd bounded_step(const Kinematics& kinematics, const Eigen::VectorXd& arm, Matrix6Xd J,
                             const Vector6d& error) {
  const double damping = 0.5 * error.squaredNorm() + kLeastDamping;
  Eigen::VectorXd step = Eigen::VectorXd::Zero(arm.size());
  for (Eigen::Index round = 0; round <= arm.size(); ++round) {
    Eigen::Matrix<double, 6, 6> A = J.lazyProduct(J.transpose());  // small: no blocking
    A.diagonal().array() += damping;
    step.noalias() = J.transpose() * A.llt().solve(error);
    bool held = false;
    for (Eigen::Index j = 0; j < arm.size(); ++j) {
      const bool at_limit =
          (arm[j] <= kinematics.lower()[j] && step[j] < 0) || (arm[j] >= kinematics.upper()[j] && step[j] > 0);
      if (!at_limit || J.col(j).isZero(0)) continue;
      J.col(j).setZero();
      held = true;
    }
    if (!held) break;
  }
  return step;
}

}  // namespace

bool solve_tip_pose(Kinematics& kinematics, const Pose& T_root_tip, const IkTolerance& tolerance,
                    Eigen::VectorXd& arm) {
  // Aim well inside the tolerance: the last step is quadratic and costs one iteration.
  const double near_position = 0.1 * tolerance.position, near_rotation = 0.1 * tolerance.rotation;
  Pose T_now;
  Matrix6Xd J;
  double best = 1e300;
  int stalled = 0;
  for (int i = 0; i < tolerance.iterations; ++i) {
    kinematics.tip_and_jacobian(arm, T_now, J);
    const Vector6d error = pose_difference(T_now, T_root_tip);
    if (error.head<3>().norm() <= near_position && error.tail<3>().norm() <= near_rotation) return true;
    const double squared = error.squaredNorm();
    stalled = squared < 0.9 * best ? 0 : stalled + 1;
    best = std::min(best, squared);
    if (stalled > 8) return false;
    Eigen::VectorXd step = bounded_step(kinematics, arm, J, error);
    const double largest = step.cwiseAbs().maxCoeff();
    if (largest > 1.0) step *= 1.0 / largest;
    arm = (arm + step).cwiseMax(kinematics.lower()).cwiseMin(kinematics.upper());
  }
  return false;
}

}  // namespace mmgrasp::verify::detail
