#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/plan/improvement.hpp"
#include "mmgrasp/robot/joint_weights.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp {

/// Path constraint: an axis of the tool stays within an angle of an axis of the world (a cup that is carried upright).
struct MMGRASP_EXPORT OrientationConstraint {
  Eigen::Vector3d tool_axis = Eigen::Vector3d::UnitZ();   ///< Direction in the tip's frame; any length > 0.
  Eigen::Vector3d world_axis = Eigen::Vector3d::UnitZ();  ///< Any length > 0.
  double half_angle = 0.2;                                ///< Largest angle between the two [rad], in (0, pi].
  void check() const;
};

/// The planner that plan_motion() runs, its budget, how finely it checks edges, and what the path must keep to.
struct MMGRASP_EXPORT MotionOptions {
  std::string planner = "rrt_connect";  ///< A name of planner_names().
  double time_limit = 5.0;              ///< Wall-clock cap [s]; > 0.
  /// Budget in states drawn (rounds, where a planner draws none); > 0. Ends a run reproducibly.
  int max_iterations = 20000;
  /// What a motion of each joint costs, in the path's length and wherever a planner measures distances.
  JointWeights joint_weights;
  /// Longest tree edge [rad or m, times the root mean square of the weights]; 0: a share of the diagonal of the
  /// sampling bounds (RRT-Connect 1/20, others 1/5).
  double range = 0.0;
  /// Chance that a roadmap planner (prm, prm_star, lazy_prm_star) draws a state around the start or a goal, which are
  /// hardly joined otherwise; 0: uniform draws alone, as OMPL has them; in [0, 1).
  double near_end_probability = 0.2;
  double base_margin = 2.0;  ///< With base joints: x and y are drawn this far around start and goals [m]; > 0.
  double joint_step = 0.02;  ///< Largest joint motion between two checks of an edge [rad or m]; > 0.
  /// Largest motion of any point of the robot (and of what is attached) between two checks of an edge [m]; > 0,
  /// infinite: no such bound.
  double workspace_step = std::numeric_limits<double>::infinity();
  std::optional<OrientationConstraint> orientation_constraint;  ///< Kept along the whole path, start and goal included.
  bool shorten = true;                                          ///< Shortcut the path (never leaves free space).
  int shorten_iterations = 200;                                 ///< Shortcuts tried at most; >= 0.
  /// Arm postures wanted at each tool pose (and at each pose drawn in a region), each in all its turns; > 0.
  int ik_solutions = 8;
  int region_samples = 16;  ///< Tool poses drawn in each region; > 0.
  /// Called with each better path while a planner that keeps improving runs, and with the final one. All of them are
  /// free at the finer steps of the last check.
  ImprovementCallback on_improvement;
  unsigned seed = 1;  ///< Same seed, same path, as long as the time limit does not end the run.
  void check() const;
};

/// What a motion cost to plan, and how long its path was before it was shortened.
struct MMGRASP_EXPORT MotionStats {
  double seconds = 0;
  std::size_t collision_queries = 0;
  double length_before_shortening = 0;
};

/// A collision-free path to one of the goals, or why there is none.
struct MMGRASP_EXPORT MotionResult {
  Outcome outcome = Outcome::timeout;
  /// Set if and only if solved; re-checked at a 64th of the edge steps, at an eighth when the planner is one that keeps
  /// improving (PRM*, RRT* and their like). Has at least two waypoints, the first is the start. Values that wrap run on
  /// continuously, so that the last waypoint equals its goal up to full turns of these.
  std::optional<JointPath> path;
  double cost = 0;                ///< The path's length, weighted by the joints.
  int goal_index = -1;            ///< Which of the goals the path reaches.
  std::vector<Contact> contacts;  ///< With invalid_start or invalid_goal: what touches.
  /// Why the start, or goals, were rejected; grasp_filter counts those outside the orientation constraint.
  Rejections rejections;
  /// With invalid_start or invalid_goal: which joint is outside of its limits, its value and these; empty: none is.
  std::string beyond_limits;
  int via_reached = 0;  ///< plan_motion_via(): waypoints that a path was found to; all of them when solved.
  MotionStats stats;
};

/// A box of tool poses: T_world_region times a translation within +-position times a rotation rpy within +-rotation.
struct MMGRASP_EXPORT ToolRegion {
  Pose T_world_region = Pose::Identity();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< Half lengths along the region's axes [m], >= 0.
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< Roll, pitch and yaw [rad], in [0, pi].
  void check(const std::string& field) const;
};

/// What a motion may end at; goal_index counts through the three lists in this order.
struct MMGRASP_EXPORT MotionGoals {
  std::vector<Eigen::VectorXd> configurations;
  Poses tool_poses;                 ///< T_world_tip; reached by inverse kinematics.
  std::vector<ToolRegion> regions;  ///< Poses are drawn in them, the region's own pose first.
};

/// "rrt_connect" (ours, fast, the default) and OMPL's: "ompl_rrt_connect", "rrt", "est", "bi_est", "kpiece", "bkpiece",
/// "prm" end with their first path; "prm_star", "lazy_prm_star", "rrt_star", "informed_rrt_star", "bit_star",
/// "abit_star" and "ait_star" spend the whole budget on shorter ones.
MMGRASP_EXPORT std::vector<std::string> planner_names();

/// A collision-free path of the checker's group from `start` to any of `goals`:
///
///     CollisionChecker checker(arm, world);
///     const MotionResult result = plan_motion(checker, start, {goal});
///     if (result.path) drive(result.path->waypoints);
///
/// Throws InvalidInput on wrong lengths,
/// non-finite numbers, an empty goal list or an unknown planner (the known ones are listed); IoError when the planner
/// plugin cannot be opened. A straight edge to one of the goals, the nearest first, is taken at once when it is free.
/// The same seed gives the same path, from any thread, as long as the time limit does not end the run. Calls with
/// rrt_connect run side by side; OMPL's planners draw from OMPL's process-wide seeds and wait for each other.
///
/// Groups with base joints: an omni base moves in x, y and theta at once; a diff-drive base turns on the spot, drives
/// straight (forwards or backwards) and turns again, so that every edge of its path can be driven.
MMGRASP_EXPORT MotionResult plan_motion(CollisionChecker& checker, const Eigen::VectorXd& start,
                                        const std::vector<Eigen::VectorXd>& goals, const MotionOptions& options = {},
                                        const Monitor& monitor = {});
/// plan_motion() with tool poses and regions as goals. A pose without any allowed configuration counts as one
/// rejection.
MMGRASP_EXPORT MotionResult plan_motion_to(CollisionChecker& checker, const Eigen::VectorXd& start,
                                           const MotionGoals& goals, const MotionOptions& options = {},
                                           const Monitor& monitor = {});
/// plan_motion_to() by way of `via`: to each of them in turn, then from the last one to a goal. The segments share the
/// time limit, each has the iterations; each begins where the one before ended, so that values that wrap run on.
/// Without a path the result is that of the segment that failed (invalid_goal: the waypoint itself is not allowed).
MMGRASP_EXPORT MotionResult plan_motion_via(CollisionChecker& checker, const Eigen::VectorXd& start,
                                            const std::vector<Eigen::VectorXd>& via, const MotionGoals& goals,
                                            const MotionOptions& options = {}, const Monitor& monitor = {});

}  // namespace mmgrasp
