#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "mmgrasp/robot/detail/joint_metric.hpp"

namespace mmgrasp::detail {

/// The rules for paths of plan_motion: which configurations are allowed, how two of them are joined, and in which steps
/// a joint-space edge is checked. Works on the checker it was made with.
class MotionEdges {
 public:
  using Waypoints = std::vector<Eigen::VectorXd>;

  MotionEdges(CollisionChecker& checker, const MotionOptions& options);

  CollisionChecker& checker() { return checker_; }
  /// Edges turn on the spot and drive straight instead of moving all values at once.
  bool steered() const { return steered_; }
  bool constrained() const { return cone_.has_value(); }
  const JointMetric& metric() const { return metric_; }

  bool is_free(const Eigen::VectorXd& q);
  /// The cause, with Rejection::grasp_filter for a tool outside its cone.
  Rejection rejection(const Eigen::VectorXd& q);

  /// Straight edge between two configurations without wrapping, but for `a`, which is known to be allowed, and for `b`
  /// where that is. `resolution` divides the steps of the options.
  bool straight_stays_free(const Eigen::VectorXd& a, const Eigen::VectorXd& b, double resolution = 1,
                           bool end_is_free = false);
  /// Appends the waypoints from `a` to `b` without `a`; the last may differ from `b` by full turns.
  void connect(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Waypoints& path) const;
  /// The same for the path that connect() gives, angles that wrap the short way round.
  bool edge_stays_free(const Eigen::VectorXd& a, const Eigen::VectorXd& b, double resolution = 1);

  /// Turns the tool back towards its cone; false when that does not succeed within limits.
  bool project(Eigen::VectorXd& q);

 private:
  double step(const Eigen::VectorXd& delta, double resolution) const;
  double tilt(const Eigen::VectorXd& q) const;
  bool edge_keeps_cone(const Eigen::VectorXd& a, const Eigen::VectorXd& b, double resolution) const;

  CollisionChecker& checker_;
  const JointGroup group_;
  const JointMetric metric_;
  const double joint_step_, workspace_step_;
  Eigen::VectorXd bounds_;  ///< Workspace motion per joint motion; empty without `workspace_step`.
  const bool steered_;
  std::optional<OrientationConstraint> cone_;
  Waypoints path_;
  Eigen::VectorXd delta_, target_;
};

}  // namespace mmgrasp::detail
