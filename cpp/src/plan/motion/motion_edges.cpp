#include "plan/motion/motion_edges.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "mmgrasp/collision/detail/edge_steps.hpp"
#include "mmgrasp/collision/edge.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "plan/motion/steered_base.hpp"
#include "plan/motion/turn_drive_turn.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kProjections = 20;      // Newton steps towards the cone.
constexpr double kInsideCone = 0.9;   // Share of the half angle that a projection aims at.
constexpr double kLargestTurn = 0.3;  // Turn of the tool in one step [rad].
constexpr double kProjectionDamping = 1e-4;

}  // namespace

MotionEdges::MotionEdges(CollisionChecker& checker, const MotionOptions& options)
    : checker_(checker),
      group_(checker.group()),
      metric_(group_.wraps(), options.joint_weights.of(group_)),
      joint_step_(options.joint_step),
      workspace_step_(options.workspace_step),
      steered_(has_steered_base(group_)),
      cone_(options.orientation_constraint) {
  if (std::isfinite(workspace_step_)) bounds_ = motion_bounds(checker);
  if (cone_) {
    cone_->tool_axis.normalize();
    cone_->world_axis.normalize();
  }
}

double MotionEdges::step(const Eigen::VectorXd& delta, double resolution) const {
  return edge_step(delta, bounds_, joint_step_, workspace_step_) / resolution;
}

double MotionEdges::tilt(const Eigen::VectorXd& q) const {
  const Eigen::Vector3d axis = group_.fk(q).linear() * cone_->tool_axis;
  return std::atan2(axis.cross(cone_->world_axis).norm(), axis.dot(cone_->world_axis));
}

bool MotionEdges::edge_keeps_cone(const Eigen::VectorXd& a, const Eigen::VectorXd& b, double resolution) const {
  const Eigen::VectorXd delta = b - a;
  const double pieces = std::max(1.0, std::ceil(delta.lpNorm<Eigen::Infinity>() / step(delta, resolution)));
  for (double i = 0; i <= pieces; ++i) {  // a whole number: there may be more than an int counts
    if (tilt(a + (i / pieces) * delta) > cone_->half_angle) return false;
  }
  return true;
}

Rejection MotionEdges::rejection(const Eigen::VectorXd& q) {
  const Rejection cause = checker_.rejection(q);
  if (cause != Rejection::none || !cone_) return cause;
  return tilt(q) <= cone_->half_angle ? Rejection::none : Rejection::grasp_filter;
}

bool MotionEdges::is_free(const Eigen::VectorXd& q) {
  return checker_.is_free(q) && (!cone_ || tilt(q) <= cone_->half_angle);
}

bool MotionEdges::straight_stays_free(const Eigen::VectorXd& a, const Eigen::VectorXd& b, double resolution,
                                      bool end_is_free) {
  if (cone_ && !edge_keeps_cone(a, b, resolution)) return false;
  delta_ = b - a;
  return checker_.edge_stays_free(a, b, step(delta_, resolution), end_is_free);
}

void MotionEdges::connect(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Waypoints& path) const {
  if (!steered_) {
    path.push_back(b);
    return;
  }
  append_turn_drive_turn(a, b, path);
}

bool MotionEdges::edge_stays_free(const Eigen::VectorXd& a, const Eigen::VectorXd& b, double resolution) {
  target_ = b;
  for (const int i : metric_.wrapping()) target_[i] = JointMetric::nearest_angle(a[i], b[i]);
  if (!steered_) return straight_stays_free(a, target_, resolution);
  path_.clear();
  connect(a, target_, path_);
  for (std::size_t i = 0; i < path_.size(); ++i) {
    if (!straight_stays_free(i == 0 ? a : path_[i - 1], path_[i], resolution)) return false;
  }
  return true;
}

bool MotionEdges::project(Eigen::VectorXd& q) {
  if (!cone_) return true;
  Pose T;
  Matrix6Xd J(6, q.size());
  for (int i = 0; i < kProjections; ++i) {
    group_.fk_jacobian(q, T, J);
    const Eigen::Vector3d axis = T.linear() * cone_->tool_axis;
    Eigen::Vector3d turn = axis.cross(cone_->world_axis);
    const double sine = turn.norm();
    const double angle = std::atan2(sine, axis.dot(cone_->world_axis));
    if (angle <= cone_->half_angle) return group_.within_limits(q);
    // Upside down, any axis across the tool's will do.
    turn = sine > 1e-9 ? Eigen::Vector3d(turn / sine) : axis.unitOrthogonal();
    turn *= std::min(kLargestTurn, angle - kInsideCone * cone_->half_angle);
    // Turning about the tool's own axis is free: only turns across it count.
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
    const Eigen::Matrix<double, 3, Eigen::Dynamic> turning = across * J.bottomRows<3>();
    Eigen::Matrix3d gram = turning * turning.transpose();
    gram.diagonal().array() += kProjectionDamping;
    q += turning.transpose() * gram.ldlt().solve(turn);
    for (Eigen::Index k = 0; k < q.size(); ++k) q[k] = std::clamp(q[k], group_.lower()[k], group_.upper()[k]);
  }
  return tilt(q) <= cone_->half_angle && group_.within_limits(q);
}

}  // namespace mmgrasp::detail
