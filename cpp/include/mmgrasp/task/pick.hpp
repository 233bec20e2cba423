#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/robot/trajectory.hpp"
#include "mmgrasp/task/ids.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp {

/// What the arm does in one motion of a pick.
enum class MotionKind { transit, approach, lift, stow, transfer, retreat };
MMGRASP_EXPORT const char* to_string(MotionKind kind);

/// One timed arm motion of a pick.
struct MMGRASP_EXPORT PickMotion {
  MotionKind kind = MotionKind::transit;
  double opening = 0;     ///< Opening of the fingers during the motion [m].
  bool attached = false;  ///< The object is attached during the motion.
  JointTrajectory trajectory;
};

/// Home - transit to the pre-grasp - approach straight - (close) - lift straight - transfer to where the object goes -
/// (open) - retreat to home. Where the object goes from another base pose: lift - stow, to home with the object in the
/// hand - the drive, which is no part of the pick - transfer from home - (open) - retreat to home.
struct MMGRASP_EXPORT Pick {
  Outcome outcome = Outcome::not_found;
  int stop = -1;   ///< Index of the plan's stop; -1: of no plan.
  PartRef part;    ///< The part of a part-supply problem; no tray for other objects.
  int grasp = -1;  ///< Index into the object's grasps.
  /// transit, approach, lift, transfer, retreat; without a place the first three; stow before a drive to the place.
  std::vector<PickMotion> motions;
  Rejections rejections;    ///< Grasps (and their configurations) rejected on the way.
  std::string failed_at;    ///< With no solution: the stage at which most candidates fell.
  double duration() const;  ///< [s]
};

/// Straight moves before and after a pick's grasp, and how much planning may be spent on it.
struct MMGRASP_EXPORT PickOptions {
  double approach_distance = 0.08;  ///< Straight move from pre-grasp to grasp, along the approach axis [m]; > 0.
  double lift_height = 0.12;        ///< Straight upward move after closing [m]; > 0.
  double motion_time_limit = 5.0;   ///< As PartSupplyOptions::motion_time_limit [s]; > 0.
  int ik_seeds = 8;                 ///< Database configurations refined for each grasp; > 0.
  unsigned seed = 1;                ///< Same seed, same pick.
  void check() const;               ///< Throws InvalidInput naming field, value and rule.
};

/// An object of a world that an arm is to pick, whatever it is and wherever it lies.
struct MMGRASP_EXPORT PickProblem {
  /// A group without base joints, its root where the robot stands (JointGroup::at); its reference holds the other
  /// joints (head,
  /// ...) and the fingers at rest.
  JointGroup arm;
  Hand gripper;
  World world;                ///< Everything in its place, the object among it.
  std::string object;         ///< Name of the world's object that is picked.
  std::vector<Grasp> grasps;  ///< Candidates in the object's frame, best first.
  Eigen::VectorXd home;       ///< Arm configuration at the beginning and at the end, fingers closed.
  std::vector<Pose> places;   ///< World poses of the object at which it may be released; empty: it stays in the hand.
  PickOptions options;
  double mass = 0;  ///< What the object weighs [kg]; 0: not known, which suction cups cannot hold.
  /// Where the robot's root stands when it releases the object, which it holds at home on the way there: a drive that
  /// the caller plans. None: it is released from where it is picked. Not for suction cups.
  std::optional<Pose> T_world_root_at_place = {};
  void check() const;  ///< Throws InvalidInput naming field, value and rule.
};

/// Picks an object: the first grasp with a collision-free configuration, straight approach and lift, and motions from
/// home and to a place. The database must be of the arm. No solution is a value that says at which stage most
/// candidates fell.
/// @code
///   PickProblem mug{arm.at(T_world_robot), gripper, world, "mug", grasps, home, {T_world_shelf}, {}};
///   const Pick pick = plan_object_pick(mug, database);
///   for (const PickMotion& motion : pick.motions) run(motion.trajectory);
/// @endcode
MMGRASP_EXPORT Pick plan_object_pick(const PickProblem& problem, const ReachDatabase& database,
                                     const Monitor& monitor = {});

/// The picks at one stop of the base.
struct MMGRASP_EXPORT StopPicks {
  Outcome outcome = Outcome::not_found;
  std::vector<Pick> picks;  ///< The picks in order; with no solution, those that failed.
};

/// Every pick of a stop, from where the base really stands: for what was measured after arriving. Those of the target
/// parts of these trays that are among `remaining`, the parts still in place; parts nearest to the base first, later
/// where others must leave before. Motions join as plain numbers, beginning at home; with an unload_region the drives
/// between stop and goal are not planned. Planned in parallel, the same
/// answer at any thread count. Throws InvalidInput when the robot at home is not free at the base pose.
MMGRASP_EXPORT StopPicks plan_stop_picks(const PartSupplyProblem& problem, const ReachDatabase& database,
                                         const Eigen::Vector3d& base_pose, const std::vector<TrayId>& trays,
                                         const std::vector<PartRef>& remaining, const Monitor& monitor = {});

/// Picks a part of a part-supply problem from a base pose and puts it into the bin on the robot, or, with an
/// unload_region, lets it go at the goal (the drive there is not planned). `remaining` are the parts still in place,
/// the picked one among them.
MMGRASP_EXPORT Pick plan_pick(const PartSupplyProblem& problem, const ReachDatabase& database,
                              const Eigen::Vector3d& base_pose, PartRef part, const std::vector<PartRef>& remaining,
                              const Monitor& monitor = {});

}  // namespace mmgrasp
