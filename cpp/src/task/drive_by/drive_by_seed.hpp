#pragma once

#include <vector>

#include "task/drive_by/drive_by_goals.hpp"
#include "task/drive_by/drive_by_guess.hpp"
#include "task/drive_by/drive_by_scene_states.hpp"
#include "task/drive_by/drive_by_steps.hpp"

namespace mmgrasp::detail {

/// Intervals of a task that takes time: a pose pinned at waypoints 0.12 s apart hardly strays between them (at 0.2 s by
/// 0.02 rad now and then, which check_whole_body() refuses).
int dwell_intervals(double dwell);

/// A configuration sequence as a problem for the optimiser, with the guess that it starts from.
struct SeededProblem {
  WholeBodyProblem problem;
  std::vector<Eigen::VectorXd> via_points;
  std::vector<int> intervals;  ///< Number of intervals of each segment.
  std::vector<int> waypoints;  ///< Waypoint of each step.
  std::vector<double> times;   ///< Duration of each segment in the guess [s].
  std::vector<CollisionChecker*> checkers;
  WholeBodyGuess guess;
};

/// Via points from the start to the goal, up to full turns, and the ways between them.
struct DriveByRoute {
  std::vector<Eigen::VectorXd> via_points;
  std::vector<GuidedWay> ways;
};

/// Makes configuration sequences into seeded problems. What it is given has to outlive it; `scene_states` null: nothing
/// can collide.
class DriveBySeeds {
 public:
  DriveBySeeds(const JointGroup& group, const Eigen::VectorXd& start, const std::vector<DriveByStep>& steps,
               const DriveByGoal& goal, const DriveByOptions& options, SceneStates* scene_states);

  /// `checked`: with the checkers of its intervals, which are built anew for parts that are held. `route` null:
  /// straight from one configuration to the next.
  SeededProblem make(const ConfigurationSequence& sequence, int waypoints, bool checked = true,
                     const DriveByRoute* route = nullptr);
  /// The start, the sequence and the goal nearest to its end.
  std::vector<Eigen::VectorXd> via_points(const ConfigurationSequence& sequence) const;

 private:
  const JointGroup& group_;
  const Eigen::VectorXd& start_;
  const std::vector<DriveByStep>& steps_;
  const DriveByGoal& goal_;
  const DriveByOptions& options_;
  SceneStates* scene_states_;
};

/// The configuration in the goal's box that is nearest to another.
Eigen::VectorXd goal_near(const DriveByGoal& goal, const Eigen::VectorXd& q);

}  // namespace mmgrasp::detail
