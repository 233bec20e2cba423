#pragma once

#include <Eigen/Core>
#include <memory>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/edge.hpp"
#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// A checker of a robot with one attached object, whose pose in its link can be changed for about the price of one
/// query: many grasps of one object need no checker each. Answers are those of a CollisionChecker made for the pose.
/// Not thread-safe.
class MMGRASP_EXPORT AttachedChecker {
 public:
  /// As CollisionChecker; throws InvalidInput unless `world` has exactly one attached object.
  AttachedChecker(const JointGroup& group, const World& world, const CheckerOptions& options = {});
  AttachedChecker(AttachedChecker&&) noexcept;
  AttachedChecker& operator=(AttachedChecker&&) noexcept;
  ~AttachedChecker();

  void place_attached(const Pose& T_link_object);

  bool is_free(const Eigen::VectorXd& q);
  Rejection rejection(const Eigen::VectorXd& q);
  /// check_edge(...).free. No point of what is checked (with CheckerOptions::attached_only: of the object) moves more
  /// than the workspace step.
  bool edge_is_free(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, const EdgeOptions& options);
  /// The same for an edge whose ends are known to be free: they are not checked again.
  bool edge_stays_free(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, const EdgeOptions& options);
  /// As CollisionChecker::distance: the closest pair, or the one that overlaps most.
  DistanceResult distance(const Eigen::VectorXd& q);
  /// As mmgrasp::motion_bounds, of the robot and the object where it is held.
  const Eigen::VectorXd& motion_bounds();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mmgrasp::detail
