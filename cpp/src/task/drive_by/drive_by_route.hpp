#pragma once

#include <memory>
#include <optional>

#include "mmgrasp/collision/checker.hpp"
#include "task/drive_by/drive_by_guess.hpp"

namespace mmgrasp::detail {

/// Finds ways of base and arm around obstacles by sampling; where passages are too narrow for that, along a reference
/// base path: a drive from start to goal with the arm folded as at the start, planned once.
class PathGuide {
 public:
  /// `checker`: everything in its place.
  PathGuide(const JointGroup& group, CollisionChecker& checker, const Eigen::VectorXd& start,
            const Eigen::VectorXd& goal, unsigned seed, const Monitor& monitor)
      : group_(group), checker_(checker), start_(start), goal_(goal), seed_(seed), monitor_(monitor) {}

  /// A way that is free of collisions; its end equals `to` up to full turns. `by_reference_path`: along the reference
  /// path where there is one, else only where sampling finds nothing. Nothing when none was found.
  std::optional<GuidedWay> way(CollisionChecker& checker, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                               bool by_reference_path);

 private:
  using Points = std::vector<Eigen::VectorXd>;
  std::optional<Points> sampled(CollisionChecker& checker, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                                int tries);
  std::optional<Points> along_reference_path(CollisionChecker& checker, const Eigen::VectorXd& from,
                                             const Eigen::VectorXd& to);
  /// Places on the reference path to be reached from a configuration, the best first.
  std::vector<std::size_t> exits(const Eigen::VectorXd& q) const;
  const Points& reference_path();

  const JointGroup& group_;
  CollisionChecker& checker_;
  Eigen::VectorXd start_, goal_;
  unsigned seed_;
  const Monitor& monitor_;
  std::optional<Points> reference_path_;  ///< Base and arm along it; no points: there is none.
};

}  // namespace mmgrasp::detail
