#pragma once

#include <chrono>
#include <vector>

#include "task/drive_by_guess.hpp"
#include "task/drive_by_stands.hpp"
#include "task/drive_by_steps.hpp"
#include "task/drive_by_worlds.hpp"

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

/// Makes chains of stands into motions. What it is given has to outlive it; `worlds` null: nothing can collide.
class DriveByAttempts {
 public:
  DriveByAttempts(const JointGroup& group, const Eigen::VectorXd& start, const std::vector<DriveByStep>& steps,
                  const DriveByGoal& goal, const DriveByOptions& options, DriveByWorlds* worlds,
                  const Monitor& monitor);

  /// `checked`: with the checkers of its intervals, which are built anew for parts that are held.
  DriveByAttempt prepared(const std::vector<Stand>& chain, int waypoints, bool checked = true);
  /// Straight through the stands, and around obstacles when that fails or is bound to; many waypoints start from the
  /// solution with few. `waypoints` are those of the steps; no solve takes more than `iterations`,
  /// and fewer than the options allow also mean fewer refinements.
  WholeBodyResult solve(const std::vector<Stand>& chain, int iterations, std::vector<int>& waypoints);
  /// At how many of its waypoints the first guess collides.
  int collisions(const std::vector<Stand>& chain);
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

 private:
  WholeBodyResult around_obstacles(DriveByAttempt& a, const std::vector<Stand>& chain);
  WholeBodyResult optimize(const DriveByAttempt& a, double warm_start = 0);
  /// Leads the base around obstacles; false when no way was found.
  bool guide(DriveByAttempt& a);

  const JointGroup& group_;
  const Eigen::VectorXd& start_;
  const std::vector<DriveByStep>& steps_;
  const DriveByGoal& goal_;
  const DriveByOptions& options_;
  DriveByWorlds* worlds_;
  int iterations_ = 0;  // of one solve
  const Monitor& monitor_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// A configuration in the goal's box, near another.
Eigen::VectorXd goal_near(const DriveByGoal& goal, const Eigen::VectorXd& q);

/// How much of a result's constraints is broken; 0: nothing.
double broken(const WholeBodyResult& result);

}  // namespace mmgrasp::detail
