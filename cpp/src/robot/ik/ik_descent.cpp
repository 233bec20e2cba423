#include "mmgrasp/robot/detail/ik_descent.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/robot/detail/joint_group_data.hpp"

namespace mmgrasp {
namespace detail {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kDampingPerError =
    0.03;  // damping = this x squared error: gauss-newton near the goal, gradient far away
constexpr double kLeastDamping = 1e-10;
constexpr double kLongestStep = 1.0;  // [rad or m] per joint and iteration
constexpr int kStallLimit = 8;        // iterations in which the error must shrink ...
constexpr double kShrink = 0.8;       // ... to this part, else the descent sits in a local minimum

void clamp(const JointGroup& group, Eigen::VectorXd& q) {
  q = q.cwiseMax(group.lower()).cwiseMin(group.upper());
}

/// Solves (J W^-1 J^T + damping) y = error over the joints that are free to move and puts the step W^-1 J^T y into
/// `step`, W the joints' weights. A joint that would cross its limit is set onto it; what it still contributes is taken
/// off the error, and the others share the rest.
void limited_step(const JointGroup& group, const Eigen::VectorXd& q, const Vector6d& error, double damping,
                  const std::vector<double>& weights, bool keep_limits, IkWorkspace& workspace) {
  const Matrix6Xd& J = workspace.J;
  const auto ease = [&weights](Eigen::Index i) { return weights.empty() ? 1.0 : 1.0 / weights[i]; };
  Eigen::VectorXd& step = workspace.step;
  const Eigen::Index n = q.size();
  std::array<bool, kMaxGroupSize> fixed{};
  Vector6d rest = error;
  Matrix6d A;
  if (weights.empty()) {
    A.noalias() = J * J.transpose();
  } else {
    A.setZero();
    for (Eigen::Index i = 0; i < n; ++i) A.noalias() += ease(i) * J.col(i) * J.col(i).transpose();
  }
  for (Eigen::Index round = 0; round <= n; ++round) {
    Matrix6d damped = A;
    damped.diagonal().array() += damping;
    const Vector6d y = damped.llt().solve(rest);
    double longest = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (fixed[i]) continue;
      step[i] = ease(i) * J.col(i).dot(y);
      longest = std::max(longest, std::abs(step[i]));
    }
    const double scale = longest > kLongestStep ? kLongestStep / longest : 1.0;
    bool again = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (fixed[i]) continue;
      step[i] *= scale;
      if (!keep_limits) continue;
      const double target = q[i] + step[i];
      const double inside = std::min(std::max(target, group.lower()[i]), group.upper()[i]);
      if (inside == target) continue;
      step[i] = inside - q[i];
      fixed[i] = true;
      rest.noalias() -= J.col(i) * step[i];
      A.noalias() -= ease(i) * J.col(i) * J.col(i).transpose();
      again = true;
    }
    if (!again) return;
  }
}

}  // namespace

DescentEnd descend(const JointGroup& group, const Pose& T_world_tip, Eigen::VectorXd& q, const IkOptions& options,
                   IkWorkspace& workspace, bool keep_limits) {
  workspace.J.resize(6, q.size());
  workspace.step.resize(q.size());
  if (keep_limits) clamp(group, q);
  DescentEnd end;
  Pose T_world_now;
  double checkpoint = kInfinity;
  for (;; ++end.iterations) {
    group.fk_jacobian(q, T_world_now, workspace.J);
    const Vector6d error = pose_difference(T_world_now, T_world_tip);
    end.position_error = error.head<3>().norm();
    end.rotation_error = error.tail<3>().norm();
    end.converged =
        end.position_error <= options.position_tolerance && end.rotation_error <= options.rotation_tolerance;
    if (end.converged || end.iterations >= options.max_iterations) return end;
    const double squared = error.squaredNorm();
    if (end.iterations % kStallLimit == 0) {
      if (!(squared < kShrink * checkpoint)) return end;
      checkpoint = squared;
    }
    limited_step(group, q, error, kDampingPerError * squared + kLeastDamping, options.joint_weights, keep_limits,
                 workspace);
    q += workspace.step;
    if (keep_limits) clamp(group, q);  // q + (limit - q) may miss the limit by a rounding
  }
}

bool maybe_in_reach(const JointGroup& group, const Eigen::Vector3d& position, double tolerance) {
  if (group.has_base()) return true;
  const GroupModel& model = *group.data().model;
  const double distance = (position - group.T_world_root() * model.first_joint).norm();
  return !(distance > model.reach + tolerance + 1e-6);
}

}  // namespace detail

bool refine_ik(const JointGroup& group, const Pose& T_world_tip, Eigen::VectorXd& q, const IkOptions& options,
               IkWorkspace& workspace) {
  if (!detail::maybe_in_reach(group, T_world_tip.translation(), options.position_tolerance)) return false;
  return detail::descend(group, T_world_tip, q, options, workspace, true).converged;
}

}  // namespace mmgrasp
