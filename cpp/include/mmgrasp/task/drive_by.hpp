#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/grasp/push_grasp.hpp"
#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/robot/robot_motion.hpp"
#include "mmgrasp/trajopt/optimize_whole_body.hpp"
#include "mmgrasp/trajopt/whole_body_program.hpp"

namespace mmgrasp {

/// A gripper that closes while the hand moves on along the approach (P1 4.3). The task's poses are the planned grasp,
/// at engagement closing.planned_depth; the hand comes straight, closing begins where push_grasp() says and takes as
/// long as the fingers need.
struct MMGRASP_EXPORT DriveByPush {
  PushGraspProblem closing;
  Eigen::Vector3d approach =
      Eigen::Vector3d::UnitX();  ///< Direction in the tip's frame: one of its axes, of either sign.
  double free_length = 0.10;     ///< Straight way before the finger tips reach the object [m]; > 0.
  /// Covariance of the object's position in the world's axes [m^2], symmetric, no eigenvalue below 0: along the
  /// approach and the closing direction its deviations take the place of closing's where they are larger, those of the
  /// candidate with the largest.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Eigen::Vector3d closing_direction =
      Eigen::Vector3d::UnitY();  ///< The fingers close along it, in the tip's frame; unit length.
};

/// Something the tool does on the way: it passes one of several poses, perhaps slowly or for a while.
struct MMGRASP_EXPORT DriveByTask {
  std::vector<Pose> candidates;           ///< Poses of the group's tip, any of which will do; at least one.
  Vector6d tolerance = Vector6d::Zero();  ///< Per axis of the pose's frame, x y z [m], then turns [rad]; >= 0, < inf.
  std::vector<bool> free_axes =
      std::vector<bool>(6, false);  ///< True for axes of the pose along or about which any error is allowed.
  double max_tool_speed =
      std::numeric_limits<double>::infinity();  ///< Speed limit of the tip at the task [m/s]; > 0 (P1 4.3).
  double dwell = 0;  ///< The tool's pose is kept that long [s], e.g. while a gripper closes; >= 0.
  /// Object of the world that is attached afterwards, in place of what was attached before; empty: none. It is an
  /// obstacle for the whole robot, the open hand included, until the task is reached; while the tool dwells there the
  /// fingers alone may touch it, and once attached it keeps clear of everything. One that rests on something counts as
  /// 1 mm higher from then on.
  std::string object;
  std::optional<DriveByPush>
      push;  ///< A push-grasp at the task, which then has no dwell, max_tool_speed, tolerance or free axes.
};

/// The closing of a task's push-grasp with the deviations that its covariance has along approach and closing direction.
/// Throws InvalidInput for a task without a push-grasp.
MMGRASP_EXPORT PushGraspProblem push_closing(const DriveByTask& task);

/// Where the motion ends.
struct MMGRASP_EXPORT DriveByGoal {
  Eigen::VectorXd lower, upper;  ///< Box of end configurations; equal: prescribed, infinite: free.
};

/// Waypoints of a motion in passing, and how many guesses and grasp assignments plan_drive_by() tries for it.
struct MMGRASP_EXPORT DriveByOptions {
  int waypoints = 35;  ///< >= 2 + 2 per task, 2 + 6 per push-grasp.
  int seeds = 8;       ///< Guesses tried until one leads to a solution; > 0.
  int solutions = 1;   ///< Solutions compared for one grasp assignment; > 0.
  /// Grasp assignments (one candidate for each task) planned, the fastest motion is returned; those that a lower bound
  /// shows to be slower are left out. 1: the one that looks quickest and leads to a solution. > 0.
  int grasp_assignments = 8;
  int goal_configurations = 64;  ///< Goal configurations sought per candidate; > 0.
  int iterations = 1500;         ///< Iteration budget of all solves; none begins when it is spent; > 0.
  double time_limit = 600.0;     ///< Wall-clock cap [s], for plans that are not to end by their iterations; > 0.
  double jerk_time = 0;          ///< See WholeBodyProblem [s], >= 0; 0: no limit on jerk.
  bool collisions = true;        ///< The robot keeps clear of the world and of itself.
  unsigned seed = 1;             ///< Same seed, same answer.
  int threads = 1;               ///< Threads that search configurations; 0: all.
  WholeBodyOptions trajectory;
  void check() const;
};

/// What happens at one task.
struct MMGRASP_EXPORT DriveByEvent {
  int waypoint = 0;                      ///< Waypoint of the task; of a push-grasp, where both fingers touch.
  double time = 0;                       ///< [s]
  double close_time = 0;                 ///< When a gripper begins to close [s].
  std::string object;                    ///< What is attached from then on; empty: nothing new.
  Pose T_tip_object = Pose::Identity();  ///< Pose of the attached object in the tip's frame.
  double attach_time = 0;                ///< When the object begins to move with the tip [s]: the end of the dwell.
  int candidate = 0;                     ///< Index of the candidate that was taken.
  double base_speed = 0;                 ///< Speed of the base at the waypoint [m/s].
  double tool_speed = 0;                 ///< Speed of the tip at the waypoint [m/s].
  /// What a push-grasp survives: tolerances of the object's position, covered standard deviations, probability.
  std::optional<ClosingOutcome> push;
};

/// A motion of base and arm through all tasks, what happens at each, and what it breaks if anything.
struct MMGRASP_EXPORT DriveByResult {
  Outcome outcome = Outcome::not_found;
  std::shared_ptr<const WholeBodyTrajectory> trajectory;  ///< Null when there was not even a guess.
  std::vector<DriveByEvent> events;                       ///< One per task.
  std::vector<Violation> violations;                      ///< The trajectory's, one per kind.
  int grasp_assignments = 0;                              ///< Grasp assignments planned.
  int solves = 0;                                         ///< Solves, each from a seed of its own.
  int iterations = 0;                                     ///< Iterations of all solves.
  double seconds = 0;                                     ///< Wall-clock time [s].
  std::string report;                                     ///< What was tried, and what is broken where, by how much.

  bool usable() const { return outcome == Outcome::solved || outcome == Outcome::approximate; }
  double duration() const { return trajectory ? trajectory->duration() : 0; }
};

/// The trajectory's to_csv with two columns more: `task`, its index in the row of a task's waypoint, and `attached`,
/// the object in the hand. Throws InvalidInput without a trajectory.
MMGRASP_EXPORT std::string drive_by_csv(const DriveByResult& result, int between = 0);

/// What a robot carries out: points at the waypoints and at most `period` [s] apart, and the gripper closing at every
/// task that takes an object, to the next of `openings` [m] (empty: not known). Throws InvalidInput without a
/// trajectory and for another number of openings.
MMGRASP_EXPORT RobotMotion drive_by_motion(const DriveByResult& result, const std::vector<double>& openings = {},
                                           double period = 0.02);

/// Grasping while driving (P1 chapter 4): the fastest motion of base and arm from `start` (at rest) through the tasks,
/// in order, to the goal (at rest), without stopping for them.
///
/// The optimiser (optimize_whole_body()) needs a guess; what P1 leaves to trials is done here:
/// - goal configurations of base and arm at the tasks, by IK;
/// - grasp assignments (a candidate for each task), bounded from below, and configuration sequences for them;
/// - ways between the configurations, led around obstacles where the straight ones collide;
/// - time steps, which waypoint belongs to which task, and other seeds when one fails.
///
/// Values that wrap reach the goal up to full turns where it is one number, and an interval of it as it stands. Throws
/// InvalidInput for what makes no sense; no solution is a value with a report.
/// @code
///   DriveByTask pick;
///   pick.candidates = {T_world_part * grasp.T_object_hand};
///   pick.object = "part";
///   pick.dwell = 0.5;  // until the gripper has closed
///   const DriveByResult result = plan_drive_by(robot.group("base_arm"), world, start, {pick}, {goal, goal});
///   if (result.usable()) std::cout << result.duration() << " s\n";
/// @endcode
MMGRASP_EXPORT DriveByResult plan_drive_by(const JointGroup& group, const World& world, const Eigen::VectorXd& start,
                                           const std::vector<DriveByTask>& tasks, const DriveByGoal& goal,
                                           const DriveByOptions& options = {}, const Monitor& monitor = {});

/// The same with a prepared checker in place of group and world; its options hold for all checks of configurations and
/// ways. The answer is that of a checker made here.
MMGRASP_EXPORT DriveByResult plan_drive_by(const CollisionChecker& checker, const Eigen::VectorXd& start,
                                           const std::vector<DriveByTask>& tasks, const DriveByGoal& goal,
                                           const DriveByOptions& options = {}, const Monitor& monitor = {});

/// A motion from rest to rest through tasks, free of collisions, that may stop on the way, e.g. a drive and a pick one
/// after the other.
struct MMGRASP_EXPORT KnownMotion {
  std::vector<double> times;               ///< [s], increasing; at least two.
  std::vector<Eigen::VectorXd> positions;  ///< Configuration at each time; straight between them.
  std::vector<double> task_times;          ///< When each task is reached [s]; the dwell follows.
};

/// The same as plan_drive_by, from a motion that is known instead of guesses: from its first position to its last, in
/// the numbers as they stand. The answer is near that motion, need not be the fastest, and takes the way round
/// obstacles that is known; two solves at most. Each task has one candidate and no push. Options for guesses are not
/// used.
MMGRASP_EXPORT DriveByResult shorten_drive_by(const JointGroup& group, const World& world,
                                              const std::vector<DriveByTask>& tasks, const KnownMotion& known,
                                              const DriveByOptions& options = {}, const Monitor& monitor = {});

/// What plan_drive_by's first solve hands to the optimiser, without collisions; empty when a task is out of reach.
struct MMGRASP_EXPORT DriveByStart {
  WholeBodyProblem problem;
  WholeBodyGuess guess;
};
MMGRASP_EXPORT std::optional<DriveByStart> first_drive_by_guess(const JointGroup& group, const Eigen::VectorXd& start,
                                                                const std::vector<DriveByTask>& tasks,
                                                                const DriveByGoal& goal,
                                                                const DriveByOptions& options = {});

/// The same as a nonlinear problem, for solvers and costs of one's own.
MMGRASP_EXPORT std::optional<WholeBodyProgram> drive_by_program(const JointGroup& group, const Eigen::VectorXd& start,
                                                                const std::vector<DriveByTask>& tasks,
                                                                const DriveByGoal& goal,
                                                                const DriveByOptions& options = {});

}  // namespace mmgrasp
