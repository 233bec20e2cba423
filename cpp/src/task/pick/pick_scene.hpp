#pragma once

#include <map>
#include <memory>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/task/pick.hpp"

namespace mmgrasp::detail {

/// Collision checkers for one pick: object in place, object held, object gone; any opening of the fingers. The problem
/// must outlive it.
class PickScene {
 public:
  explicit PickScene(const PickProblem& problem);

  /// Object in place.
  CollisionChecker& before(double opening);
  /// Object gone.
  CollisionChecker& after(double opening);
  /// Object held; `T_hand_object` changes from grasp to grasp, so this one is not kept.
  CollisionChecker holding(double opening, const Pose& T_hand_object) const;
  /// The same for the way up from where the object stands: raised by a hair, so that it may leave what it rests on.
  CollisionChecker lifting(double opening, const Pose& T_world_hand, const Pose& T_world_object) const;

  /// The fingers can take every opening between two with the arm at q, among what the checker knows.
  bool fingers_free(const CollisionChecker& checker, const Eigen::VectorXd& q, double from, double to) const;

 private:
  using Checkers = std::map<long, std::unique_ptr<CollisionChecker>>;
  CollisionChecker& kept(Checkers& checkers, const World& world, double opening);
  JointGroup arm(double opening) const;

  const PickProblem& problem_;
  World removed_;
  Checkers before_, after_;
};

}  // namespace mmgrasp::detail
