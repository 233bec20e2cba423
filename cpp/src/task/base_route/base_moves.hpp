#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/robot/planar_base.hpp"

namespace mmgrasp::detail {

/// Whether a base pose lies in the workspace of the base and the whole robot, arm at home, is free of collisions there
/// with what the checker's world has attached to it.
class BaseClearance {
 public:
  BaseClearance(CollisionChecker& checker, const Eigen::VectorXd& home, double check_step);
  BaseClearance(const BaseClearance&) = delete;

  /// From now on the robot also keeps `clearance` [m] to all but horizontal planes where the base is farther than
  /// kNearEnds from all of `ends`, between two poses that are looked at, too.
  void keep(double clearance, const std::vector<Eigen::Vector3d>& ends);
  bool free(const Eigen::Vector3d& pose);
  /// Straight in (x, y, theta), ends included, at steps of at most check_step and 0.05 rad.
  bool segment_free(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
  /// Radius of the disc around the root that the robot at home never leaves [m].
  double radius() const { return radius_; }

 private:
  bool nothing_near(const Eigen::Vector2d& position) const;
  bool is_near_an_end(const Eigen::Vector2d& position) const;

  CollisionChecker& checker_;
  const Eigen::VectorXd& home_;
  double check_step_;
  bool home_is_sound_ = true;  // inside limits and without self-collision
  double radius_ = 0;
  std::vector<Eigen::AlignedBox2d> obstacles_;  // floor plans of the objects at the robot's height
  std::vector<Eigen::Vector2d> ends_;           // near which no clearance is asked for
  std::optional<CollisionChecker> padded_;      // the robot grown by the clearance, without the ground
  std::unique_ptr<BaseClearance> padded_clearance_;
};

/// Ways to get from one base pose to another by few primitive motions, cheapest first: turn - drive - turn (forwards or
/// backwards, either way round) for diff_drive, one straight line for omni. Each is the list of poses after the first.
std::vector<std::vector<Eigen::Vector3d>> direct_ways(BaseKind base, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                                      double turn_weight);

/// Driven length plus turn_weight x turned angle.
double way_cost(const Eigen::Vector3d& from, const std::vector<Eigen::Vector3d>& way, double turn_weight);

}  // namespace mmgrasp::detail
