#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp {

struct MMGRASP_EXPORT MotionOptions {
  std::string planner = "rrt_connect";  ///< A name of planner_names().
  double time_limit = 5.0;              ///< Wall-clock cap [s]; > 0.
  int max_iterations =
      20000;  ///< Budget in states drawn (rounds, where a planner draws none); > 0. Ends a run reproducibly.
  double range =
      0.0;  ///< Longest tree edge [rad]; 0: a share of the joint box's diagonal (rrt_connect 1/20, others 1/5).
  double base_margin = 2.0;  ///< With base joints: x and y are drawn this far around start and goals [m]; > 0.
  double edge_step = 0.02;   ///< Largest joint motion between two checks of an edge [rad or m]; > 0.
  bool shorten = true;       ///< Shortcut the path (never leaves free space).
  int shorten_iterations = 200;
  unsigned seed = 1;
  void check() const;
};

struct MMGRASP_EXPORT MotionStats {
  double seconds = 0;
  std::size_t collision_queries = 0;
  double length_before_shortening = 0;
};

struct MMGRASP_EXPORT MotionResult {
  Outcome outcome = Outcome::timeout;
  /// Set if and only if solved; re-checked at an eighth of edge_step. Has at least two waypoints, the first is the
  /// start. Values that wrap run on continuously, so that the last waypoint equals its goal up to full turns of these.
  std::optional<JointPath> path;
  double cost = 0;                ///< Its length.
  int goal_index = -1;            ///< Which of the goals it reaches.
  std::vector<Contact> contacts;  ///< With invalid_start or invalid_goal: what touches.
  Rejections rejections;          ///< Of goals turned down.
  MotionStats stats;
};

/// "rrt_connect" (fast, the default), "rrt", "est", "bi_est", "kpiece", "bkpiece", "prm" end with their first path;
/// "prm_star", "lazy_prm_star", "rrt_star", "informed_rrt_star", "bit_star" spend the whole budget on shorter ones. All
/// are OMPL's.
MMGRASP_EXPORT std::vector<std::string> planner_names();

/// A collision-free path of the checker's group from `start` to any of `goals`. Throws InvalidInput on wrong lengths,
/// non-finite numbers, an empty goal list or an unknown planner (the known ones are listed); IoError when the planner
/// plugin cannot be opened. A straight edge to one of the goals, the nearest first, is taken at once when it is free.
/// The same seed gives the same path, from any thread, as long as the clock does not end the run. Calls with
/// rrt_connect run side by side; the other planners draw from OMPL's process-wide seeds and wait for each other.
MMGRASP_EXPORT MotionResult plan_motion(CollisionChecker& checker, const Eigen::VectorXd& start,
                                        const std::vector<Eigen::VectorXd>& goals, const MotionOptions& options = {},
                                        const Monitor& monitor = {});

}  // namespace mmgrasp
