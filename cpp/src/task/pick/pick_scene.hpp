#pragma once

#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp {

/// Collision checkers for one pick from one base pose: part in place, part held, part gone; any opening of the fingers.
class PickScene {
 public:
  PickScene(const PartSupplyProblem& problem, const Eigen::Vector3d& base_pose, int tray, int part,
            const std::vector<std::pair<int, int>>& remaining);

  /// Part in place.
  CollisionChecker& before(double opening);
  /// Part gone.
  CollisionChecker& after(double opening);
  /// Part held; `T_tcp_part` changes from grasp to grasp, so this one is not kept.
  CollisionChecker holding(double opening, const Pose& T_tcp_part) const;

  /// Every opening between two can be taken with the arm at q, the part held or not there.
  static bool fingers_free(const PartSupplyProblem& problem, const Pose& T_world_root, const CollisionChecker& checker,
                           const Eigen::VectorXd& q, double from, double to);

  const Pose& T_world_root() const { return T_world_root_; }

 private:
  using Checkers = std::map<long, std::unique_ptr<CollisionChecker>>;
  CollisionChecker& kept(Checkers& checkers, const World& world, double opening);
  JointGroup arm(double opening) const { return arm_with_opening(problem_, opening).at(T_world_root_); }

  const PartSupplyProblem& problem_;
  Pose T_world_root_;
  std::string part_name_;
  World in_place_, gone_;
  Checkers before_, after_;
};

}  // namespace mmgrasp
