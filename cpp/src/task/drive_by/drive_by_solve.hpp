#pragma once

#include <optional>
#include <vector>

#include "mmgrasp/core/detail/stopwatch.hpp"
#include "task/drive_by/drive_by_goals.hpp"
#include "task/drive_by/drive_by_guess.hpp"
#include "task/drive_by/drive_by_route.hpp"
#include "task/drive_by/drive_by_scene_states.hpp"
#include "task/drive_by/drive_by_steps.hpp"

namespace mmgrasp::detail {

constexpr int kDwellIntervals = 4;  // of a task that takes time

/// A chain of stands as a problem with a first guess.
struct DriveByAttempt {
  WholeBodyProblem problem;
  std::vector<Eigen::VectorXd> knots;
  std::vector<int> intervals;
  std::vector<int> waypoints;  ///< Of the steps.
  std::vector<double> times;
  std::vector<CollisionChecker*> checkers;
  WholeBodyGuess guess;
};

/// The stands of a chain, up to full turns, and ways between them.
struct DriveByRoute {
  std::vector<Eigen::VectorXd> knots;  ///< From the start to the goal.
  std::vector<GuidedWay> ways;
};

/// How a chain is tried.
struct DriveByPatience {
  int iterations = 0;    ///< Of one solve at most.
  bool guided = false;   ///< Led around obstacles even when the straight guess meets none.
  bool by_road = false;  ///< See DriveByRoads::way.
};

/// Makes chains of stands into motions. What it is given has to outlive it; `worlds` null: nothing can collide.
class DriveByAttempts {
 public:
  DriveByAttempts(const JointGroup& group, const Eigen::VectorXd& start, const std::vector<DriveByStep>& steps,
                  const DriveByGoal& goal, const DriveByOptions& options, DriveByWorlds* worlds,
                  const Monitor& monitor);

  /// `checked`: with the checkers of its intervals, which are built anew for parts that are held. `route` null:
  /// straight from stand to stand.
  DriveByAttempt prepared(const std::vector<Stand>& chain, int waypoints, bool checked = true,
                          const DriveByRoute* route = nullptr);
  /// From a guess straight through the stands, or around obstacles when that collides; very many waypoints start from
  /// the solution with few. `waypoints` are those of the steps.
  WholeBodyResult solve(const std::vector<Stand>& chain, const DriveByPatience& patience, std::vector<int>& waypoints);
  /// At how many of its waypoints the first guess collides.
  int collisions(const std::vector<Stand>& chain);
  double seconds() const { return stopwatch_.seconds(); }

 private:
  void lead_around_obstacles(DriveByAttempt& a, const std::vector<Stand>& chain, const DriveByPatience& patience);
  WholeBodyResult optimize(const DriveByAttempt& a, double warm_start = 0);
  std::vector<Eigen::VectorXd> knots_of(const std::vector<Stand>& chain) const;
  /// Ways around obstacles; nothing when some are not found.
  std::optional<DriveByRoute> route(const std::vector<Stand>& chain, const DriveByAttempt& a, bool by_road);
  /// What can collide on the way to a step: with the part that is held, where that does not touch at either end.
  CollisionChecker& checker_between(const DriveByAttempt& a, std::size_t step, const Eigen::VectorXd& from,
                                    const Eigen::VectorXd& to);

  const JointGroup& group_;
  const Eigen::VectorXd& start_;
  const std::vector<DriveByStep>& steps_;
  const DriveByGoal& goal_;
  const DriveByOptions& options_;
  DriveByWorlds* worlds_;
  std::optional<DriveByRoads> roads_;
  int iterations_ = 0;  // of one solve
  const Monitor& monitor_;
  Stopwatch stopwatch_;
};

/// A configuration in the goal's box, near another.
Eigen::VectorXd goal_near(const DriveByGoal& goal, const Eigen::VectorXd& q);

/// How much of a result's constraints is broken; 0: nothing.
double broken(const WholeBodyResult& result);

}  // namespace mmgrasp::detail
