#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/robot_source.hpp"

namespace mmgrasp::verify {

/// A scene body as the plan file describes it.
struct MMGRASP_EXPORT CheckedBody {
  std::string name;
  std::vector<LinkShape> shapes;
  Pose T_world_body = Pose::Identity();
};

/// A grasp that the plan may use for a part: where the tool frame is in the part, and how far the hand is open.
struct MMGRASP_EXPORT CheckedGrasp {
  Pose T_object_hand = Pose::Identity();
  double opening = 0;  ///< Between the pads while holding [m].
};

/// A part in its tray, with the grasps that the plan lists for it.
struct MMGRASP_EXPORT CheckedPart {
  CheckedBody body;
  std::string tray;
  bool target = true;
  std::vector<CheckedGrasp> grasps;
  double mass = 0;  ///< [kg]; 0: not known.
  /// Its body is a cover around what sensors saw: where pads meet the part itself is not to be told from it.
  bool scanned = false;
};

/// A suction cup: its rim is a circle about `position` in the tool frame, across the approach [m].
struct MMGRASP_EXPORT CheckedCup {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// Suction cups of a hand in place of fingers.
struct MMGRASP_EXPORT CheckedSuction {
  std::vector<CheckedCup> cups;
  double max_gap = 0;   ///< A cup seals where the part's surface falls back from its rim by no more than this [m].
  double vacuum = 0;    ///< Below the pressure of the air [Pa].
  double friction = 0;  ///< Coulomb coefficient of rim and part.
  double safety = 1;    ///< The force must be so many times what holding needs.
};

/// A joint of the hand, and its values while the fingers are closed and open [rad or m].
struct MMGRASP_EXPORT CheckedFinger {
  std::string joint;
  double closed = 0, open = 0;
};

/// One motion of the arm as the plan stores it: times [s] and the joints' values at them [rad or m, and per second].
struct MMGRASP_EXPORT CheckedMotion {
  std::string kind;  ///< transit, approach, lift, transfer, retreat; stow after lift where the hand carries the part
  double opening = 0;
  bool attached = false;
  std::vector<double> times;
  std::vector<Eigen::VectorXd> positions, velocities;
  std::vector<Eigen::VectorXd> accelerations = {};  ///< Empty: not given.
};

/// How one part is picked at a stop: the grasp taken, as an index into the part's, and the arm's motions in order.
struct MMGRASP_EXPORT CheckedPick {
  int stop = -1;
  std::string tray, part;
  int grasp = -1;
  std::vector<CheckedMotion> motions;
};

/// A pick in one motion of base and arm, with the drive to its stop where it is the first one there. The fingers open
/// before it, and close while the tool keeps its place in the room.
struct MMGRASP_EXPORT CheckedDriveBy {
  int pick = -1;         ///< Index into the plan's picks.
  double close_at = 0;   ///< The fingers begin to close [s],
  double closed_at = 0;  ///< and from here on hold the part [s].
  CheckedMotion motion;  ///< Rows hold x, y, theta, then the arm's joints; `opening` is that before closing.
  /// Begins where the pick before lets its part go, in place of that pick's retreat; else at home, and the pick is the
  /// first of its stop.
  bool from_release = false;
  bool to_release = false;  ///< Ends where the part is let go, in place of the pick's transfer; else once it is lifted.
};

/// A stop: base pose (x, y, theta), the disc in which it may come to stand [m], and the trays it serves.
struct MMGRASP_EXPORT CheckedStop {
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();
  double radius = 0;
  std::vector<std::string> trays;
  int arrivals = 0, arrivals_served = 0;  ///< Arrivals that the planner drew, and those that served all parts.
};

/// The base region that the plan claims for a tray: flags of the cells that serve all its target parts.
struct MMGRASP_EXPORT CheckedRegion {
  std::string tray;
  std::vector<std::uint8_t> cells;  ///< (heading * ny + iy) * nx + ix
};

/// The square cells over the floor that base regions are made of, one layer for each heading, as a BaseGrid.
struct MMGRASP_EXPORT CheckedGrid {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  double resolution = 0.05;
  int nx = 0, ny = 0;
  std::vector<double> headings;
};

/// How base poses for a tray were searched.
struct MMGRASP_EXPORT CheckedTray {
  std::vector<double> headings;                                   ///< Base headings tried [rad].
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();               ///< Middle of the tray, in the world [m].
  double max_distance = std::numeric_limits<double>::infinity();  ///< Base poses farther from it were left out [m].
  bool shares_headings = false;  ///< Tried at other trays' headings, too, where one of these trays can be served.
};

/// What a plan says about a leg of its route.
struct MMGRASP_EXPORT CheckedLegValues {
  double length = 0, turning = 0, duration = 0;
};

/// Where parts are let go at the goal that the hand carried there: a rectangle in the world.
struct MMGRASP_EXPORT CheckedUnloadRegion {
  Pose T_world_region = Pose::Identity();            ///< Its middle, z up.
  Eigen::Vector2d size = Eigen::Vector2d(0.3, 0.3);  ///< x and y [m].
  double drop_height = 0.03;                         ///< Height above it at which parts are released [m].
};

/// A drive to the goal, where the bin is emptied or the part in the hand let go, and back to the stop where parts are
/// left (no poses: it goes on).
struct MMGRASP_EXPORT CheckedUnloading {
  int after_pick = -1;  ///< Index into the plan's picks.
  std::vector<Eigen::Vector3d> to_goal, back;
  CheckedLegValues to_goal_values, back_values = {};
};

/// A place that a plan says lies in the regions of several trays.
struct MMGRASP_EXPORT CheckedIntersection {
  std::vector<std::string> trays;
  double heading = 0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 0;
};

/// Two that may touch: links, obstacles or parts by their names.
using CheckedPair = std::pair<std::string, std::string>;

/// A whole plan, as read from plan.json: what the checker needs to know of robot, room and parts, and what is claimed.
/// Knows nothing of how it was made.
///
///     PlanToCheck plan(source);  // the URDFs, unread
///     plan.parts = parts;
///     plan.stops = stops;
///     for (const Fault& fault : check_plan(plan).faults) std::cout << fault.code << ": " << fault.message << "\n";
struct MMGRASP_EXPORT PlanToCheck {
  explicit PlanToCheck(RobotSource checked_robot) : robot(std::move(checked_robot)) {}

  // Robot
  RobotSource robot;          ///< What the robot really is: its URDFs as they were given.
  RobotSource planned_robot;  ///< As the planners understood it (Robot::to_urdf()); without URDFs: not compared.
  std::vector<std::string> arm_joints;
  std::vector<double> velocity_limits, acceleration_limits;  ///< One an arm joint [rad/s or m/s, and per second].
  std::map<std::string, double> other_joints;                ///< Where joints stand that the plan does not move.
  Eigen::VectorXd home;  ///< Values of the arm joints at the beginning, while driving and at the end.

  // Hand
  std::string tip_link;                                 ///< Link whose frame is the tool frame.
  Eigen::Vector3d approach = Eigen::Vector3d::UnitX();  ///< Unit axis in the tip frame.
  Eigen::Vector3d closing = Eigen::Vector3d::UnitY();   ///< Unit axis in the tip frame along which the pads close.
  double max_opening = 0.1;                             ///< Between the pads [m].
  double clearance = 0.01;  ///< Kept free on either side of a part while the hand moves in [m], where it opens so far.
  double finger_depth = 0;  ///< Size of a pad along the approach axis [m]; 0: widths are not compared with parts.
  double finger_width = 0;  ///< Size of a pad across approach and closing [m]; 0: likewise.
  std::vector<CheckedFinger> fingers;
  /// Openings at equal steps of the finger joints from closed to open [m], rising; empty: linear from 0 to max_opening.
  std::vector<double> openings;
  std::vector<std::string> finger_links;  ///< Links that may touch the attached part.
  double closing_speed = 0.1;             ///< How fast the gripper's opening shrinks [m/s], for drive_by.
  /// The hand holds by these; then it has no fingers, and max_opening is 0. Without a cup: a hand with fingers.
  CheckedSuction suction;
  double payload = std::numeric_limits<double>::infinity();  ///< Heaviest part that may be picked [kg].

  // Room and parts
  /// Everything below this height is ground [m], which what the arm joints move must not touch: the arm, the fingers,
  /// an attached part. Other links may (wheels stand on it). -infinity: there is none.
  double floor = -std::numeric_limits<double>::infinity();
  std::vector<CheckedBody> obstacles;
  std::vector<std::string> trays;
  std::vector<CheckedPart> parts;
  std::vector<CheckedPair> allowed_collisions;  ///< Not checked: what else these touch is.

  // Task
  Eigen::Vector3d start = Eigen::Vector3d::Zero();  ///< Base pose (x, y, theta) at the beginning of the route.
  Eigen::Vector3d goal = Eigen::Vector3d::Zero();   ///< The same at its end.
  double positioning_uncertainty = 0.1;             ///< Radius of the disc in which the base comes to stand [m].
  /// Covariance of x, y [m^2] and theta [rad^2] about a stop, in the world's axes; zero: arrivals are not judged.
  Eigen::Matrix3d arrival_covariance = Eigen::Matrix3d::Zero();
  /// Drives stay this far from all but the ground where the base is farther than 1 m from both their ends [m]; >= 0.
  double drive_clearance = 0;
  double approach_distance = 0;                          ///< Least straight way to a grasp [m]; >= 0.
  double lift_height = 0.01;                             ///< Least straight way up after closing [m]; > 0.
  Pose T_base_bin = Pose::Identity();                    ///< Middle of the bin's top plane in the root frame, z up.
  Eigen::Vector2d bin_size = Eigen::Vector2d(0.3, 0.3);  ///< Inner x and y [m].
  double drop_height = 0.03;  ///< Height above the bin's top plane at which parts are released [m].
  int capacity = 0;           ///< So many parts fill the bin; 0: it takes all.
  /// Set: the robot has no bin. The hand carries one part at a time to the goal, where it is let go over this.
  std::optional<CheckedUnloadRegion> unload_region;

  // What is claimed of base regions and stops
  CheckedGrid grid;
  std::vector<CheckedRegion> regions;
  /// What was searched for each tray, by name; one that is not named may have any region.
  std::map<std::string, CheckedTray> searched;
  /// The planner kept bodies apart by more than touching: cells beside a region, which serve without that, prove
  /// nothing.
  bool padded = false;
  std::vector<CheckedIntersection> intersections;
  std::vector<CheckedStop> stops;
  int lower_bound = 0;                                                ///< Fewer stops are not enough.
  double robustness_rate = std::numeric_limits<double>::quiet_NaN();  ///< Lowest rate of a stop; NaN: not given.

  // Motions
  std::vector<std::vector<Eigen::Vector3d>> route;  ///< stops.size() + 1 legs of base poses.
  std::vector<CheckedUnloading> unloadings;         ///< As they are carried out.
  std::vector<CheckedLegValues> leg_values;         ///< One a leg; empty: not given.
  std::vector<CheckedPick> picks;
  std::vector<CheckedDriveBy> drive_by;  ///< What of route and picks is done in passing.
};

}  // namespace mmgrasp::verify
