#pragma once

#include <memory>
#include <optional>

#include "mmgrasp/collision/checker.hpp"
#include "task/drive_by/drive_by_guess.hpp"

namespace mmgrasp::detail {

/// Ways of base and arm around obstacles, found by sampling; where passages are too narrow for that, along a road: a
/// drive from start to goal with the arm folded as at the start, looked for once.
class DriveByRoads {
 public:
  /// `checker`: everything in its place.
  DriveByRoads(const JointGroup& group, CollisionChecker& checker, const Eigen::VectorXd& start,
               const Eigen::VectorXd& goal, unsigned seed, const Monitor& monitor)
      : group_(group), checker_(checker), start_(start), goal_(goal), seed_(seed), monitor_(monitor) {}

  /// Free of collisions; its end equals `to` up to full turns. `by_road`: along the road where there is one, else only
  /// where sampling finds nothing. Nothing when none was found.
  std::optional<GuidedWay> way(CollisionChecker& checker, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                               bool by_road);

 private:
  using Points = std::vector<Eigen::VectorXd>;
  std::optional<Points> sampled(CollisionChecker& checker, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                                int tries);
  std::optional<Points> along_road(CollisionChecker& checker, const Eigen::VectorXd& from, const Eigen::VectorXd& to);
  /// Places of the road to try to get to from a configuration, the best first.
  std::vector<std::size_t> exits(const Eigen::VectorXd& q) const;
  const Points& road();

  const JointGroup& group_;
  CollisionChecker& checker_;
  Eigen::VectorXd start_, goal_;
  unsigned seed_;
  const Monitor& monitor_;
  std::optional<Points> road_;  ///< Empty points: there is none.
};

}  // namespace mmgrasp::detail
