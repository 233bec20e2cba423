#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
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
};

/// A joint of the hand, and its values while the fingers are closed and open [rad or m].
struct MMGRASP_EXPORT CheckedFinger {
  std::string joint;
  double closed = 0, open = 0;
};

/// One motion of the arm as the plan stores it: times [s] and the joints' values at them [rad or m, and per second].
struct MMGRASP_EXPORT CheckedMotion {
  std::string kind;  ///< transit, approach, lift, transfer, retreat
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

/// Drive to a stop and the first pick there up to its lift, in one motion of base and arm. The fingers open before it,
/// and close while the tool keeps its place in the room.
struct MMGRASP_EXPORT CheckedDriveBy {
  int pick = -1;         ///< Index into the plan's picks.
  double close_at = 0;   ///< The fingers begin to close [s],
  double closed_at = 0;  ///< and from here on hold the part [s].
  CheckedMotion motion;  ///< Rows hold x, y, theta, then the arm's joints; `opening` is that before closing.
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

  RobotSource robot;          ///< What the robot really is: its URDFs as they were given.
  RobotSource planned_robot;  ///< As the planners understood it (Robot::to_urdf()); without URDFs: not compared.
  std::vector<std::string> arm_joints;
  std::vector<double> velocity_limits, acceleration_limits;  ///< One an arm joint.
  std::string tip_link;
  std::map<std::string, double> other_joints;
  double max_opening = 0.1, clearance = 0.01;
  Eigen::Vector3d approach = Eigen::Vector3d::UnitX();  ///< Unit axis in the tip frame.
  Eigen::Vector3d closing = Eigen::Vector3d::UnitY();   ///< Unit axis in the tip frame along which the pads close.
  double finger_depth = 0;       ///< Size of a pad along the approach axis [m]; 0: widths are not compared with parts.
  double finger_width = 0;       ///< Size of a pad across approach and closing [m]; 0: likewise.
  double approach_distance = 0;  ///< Least straight way to a grasp [m]; >= 0.
  double lift_height = 0.01;     ///< Least straight way up after closing [m]; > 0.
  std::vector<CheckedFinger> fingers;
  /// Openings at equal steps of the finger joints from closed to open [m], rising; empty: linear from 0 to max_opening.
  std::vector<double> openings;
  std::vector<std::string> finger_links;
  Eigen::VectorXd home;
  Eigen::Vector3d start = Eigen::Vector3d::Zero(), goal = Eigen::Vector3d::Zero();
  double positioning_uncertainty = 0.1;
  /// Covariance of x, y [m^2] and theta [rad^2] about a stop, in the world's axes; zero: arrivals are not judged.
  Eigen::Matrix3d arrival_covariance = Eigen::Matrix3d::Zero();
  Pose T_base_bin = Pose::Identity();
  Eigen::Vector2d bin_size = Eigen::Vector2d(0.3, 0.3);
  double drop_height = 0.03;
  /// Everything below this height is ground [m], which what the arm joints move must not touch: the arm, the fingers, a
  /// attached part. Other links may (wheels stand on it). -infinity: there is none.
  double floor = -std::numeric_limits<double>::infinity();
  std::vector<CheckedBody> obstacles;
  std::vector<CheckedPart> parts;
  std::vector<CheckedPair> allowed_collisions;  ///< Not checked: what else these touch is.
  /// The planner kept bodies apart by more than touching: cells beside a region, which serve without that, prove
  /// nothing.
  bool padded = false;
  std::vector<std::string> trays;
  std::map<std::string, CheckedTray>
      searched;  ///< What was searched for each tray, by name; one that is not named may have any region.
  CheckedGrid grid;
  std::vector<CheckedRegion> regions;
  std::vector<CheckedStop> stops;
  std::vector<std::vector<Eigen::Vector3d>> route;  ///< stops.size() + 1 legs of base poses.
  std::vector<CheckedPick> picks;
  std::vector<CheckedDriveBy> drive_by;  ///< What of route and picks is done in passing.
  double closing_speed = 0.1;            ///< How fast the gripper's opening shrinks [m/s], for drive_by.
  int lower_bound = 0;
  std::vector<CheckedLegValues> leg_values;  ///< One a leg; empty: not given.
  std::vector<CheckedIntersection> intersections;
  double robustness_rate = std::numeric_limits<double>::quiet_NaN();  ///< NaN: not given.
};

/// How finely check_plan() looks at motions and regions, and from where on a difference is a fault.
struct MMGRASP_EXPORT PlanCheckOptions {
  double joint_step = 0.01;          ///< Arm paths are checked at least this finely [rad or m]; > 0.
  double base_step = 0.01;           ///< The route [m, and rad x 2]; > 0.
  double position_tolerance = 1e-4;  ///< How far a grasp may be off [m]; > 0.
  double rotation_tolerance = 1e-3;  ///< How far a grasp may be turned [rad]; > 0.
  int samples = 1000;                ///< Base poses drawn in the uncertainty disc of each stop; > 0.
  double required_rate = 0.999;      ///< Share of them from which every target part has a grasp; in (0, 1].
  /// Base poses drawn in each region, and cells drawn beside it; also poses drawn between the uncertainty disc of a
  /// stop and the radius that the plan claims. 0: none.
  int region_samples = 20;
  unsigned seed = 20240607;
  int threads = 0;
  void check() const;
};

/// One thing that is physically wrong with the plan. The codes, by what they are about:
/// - the data: `malformed` (names, lengths, numbers; nothing else is checked then), `stopped` (ended by the monitor);
/// - the robot: `robot-unreadable` (urdfdom, KDL or assimp cannot make sense of it; nothing else is checked then),
///   `robot-differs` (a link or joint that was planned for is not the one of the URDF);
/// - the scene: `part-overlap` (a part in another one, in an obstacle or in the ground, deeper than 1e-4 m),
///   `tray-overlap` (a tray's walls in the ground, likewise);
/// - home: `home-limit`, `home-collision` (robot with itself), `start-collision`, `finger-limit`,
///   `finger-links` (fewer than two), `limit-exceeds-robot` (velocity limits above the URDF's), `base-workspace`
///   (start, goal, a stop with its uncertainty or a drive outside the base's workspace);
/// - which part is picked: `part-unknown`, `part-forgotten`, `part-repeated`, `part-not-target`, `wrong-tray`,
///   `wrong-stop`, `stop-order`, `grasp-invalid` (no such index), `tray-unknown`, `tray-forgotten`, `tray-repeated`;
/// - one arm motion: `motion-order`, `motion-shape` (lengths, NaN), `times`, `too-long`, `position-limit`,
///   `velocity-limit`, `acceleration-limit`, `discontinuous`, `not-at-rest`, `opening`, `attachment`, `self-collision`,
///   `scene-collision`, `attached-collision`;
/// - what it is for: `not-straight` (approach, lift), `short-approach`, `grasp-missed`, `grasp-empty` (fewer than two
///   fingers close on it, or a listed grasp has nothing between the pads), `grasp-opening` (pads at this width would
///   stand in the part, or clear of it), `no-lift` (or one that is too low), `release-outside`, `release-tilted`,
///   `release-height`;
/// - a motion in passing, besides those of arm motions: `drive-by-pick` (not the first of its stop, twice, unknown),
///   `closing-time` (outside the motion, or faster than the fingers), `base-limit` (velocity or acceleration of base or
///   wheels), `base-off-course` (where its velocities do not lead);
/// - the route: `route-legs` (their number), `route-ends`, `route-not-driveable`, `route-collision`, `too-long`;
/// - stops: `region-malformed`, `region-missing`, `region-too-small`, `stop-heading`, `stop-radius`,
///   `stop-outside-region`, `not-minimal`, `lower-bound`, `not-robust`, `arrival-rate` (arrivals serve all parts more
///   or less often than said, by more than chance), `region-inflated` (base poses in it that serve nothing),
///   `region-incomplete` (cells left out that serve everything: the least number of stops is then not proven);
/// - what only describes: `route-values` (length, turning, duration), `acceleration` (stored ones above the limits or
///   not those of the velocities), `wrong-values` (robustness rate below what is required or above 1, intersections
///   that lie elsewhere).
struct MMGRASP_EXPORT Fault {
  std::string code;
  std::string where;    ///< E.g. "pick 3 (A/bracket_02), lift, t = 1.24 s".
  std::string message;  ///< What is wrong, with the value and the bound.
};

/// How often every target part of a stop's trays could be grasped. `samples` is lower than asked when so many were lost
/// that the rest could not have changed the verdict.
struct MMGRASP_EXPORT StopRate {
  int stop = -1;
  int samples = 0;
  int good = 0;
  std::string worst_part;
};

/// The faults of a plan, and what the checker found again by itself: rates of the stops, least number of stops.
struct MMGRASP_EXPORT PlanCheckResult {
  std::vector<Fault> faults;  ///< Empty: the plan holds.
  std::vector<StopRate> rates;
  int minimal_stops = 0;    ///< So many stops are enough for the plan's regions: found again.
  int lower_bound = 0;      ///< Fewer are not: proven again. Below `minimal_stops`: the least number is not decided.
  bool search_cut = false;  ///< The search for shared regions ended at its limit, which `lower_bound` allows for.
  std::size_t configurations_checked = 0;
};

/// Checks a finished plan against its scenario: the robot read again by urdfdom and assimp, kinematics by KDL,
/// collisions by FCL, the cover solved again by CBC on discs found by searching the floor. No planner, robot model,
/// kinematics or collision code of mmgrasp takes part; docs/methods/verify.md lists the little that is shared (poses,
/// random numbers, threads, closing of meshes). A broken plan gives faults, never an exception; only unusable options
/// throw (InvalidInput). Same answer at any thread count.
///
/// Between samples a motion is the cubic through positions and velocities. Limits on positions hold on all of it (slack
/// 1e-6), on velocities at the samples (1 %) and between them (5 %), and some motion within 1 % of the acceleration
/// limits must join each two samples. A disc lies in a region when nothing outside comes nearer to its middle than its
/// radius less 1e-9 m, as for the planners: discs that fit exactly count. Motions join in the numbers as they stand,
/// within a pick and from pick to pick; only home may be reached whole turns away. Pairs of links that the robot's own
/// description disables are not tested, except those said to touch never.
MMGRASP_EXPORT PlanCheckResult check_plan(const PlanToCheck& plan, const PlanCheckOptions& options = {},
                                          const Monitor& monitor = {});

/// Indices of the pairs of bodies that overlap by more than 1e-4 m, each pair once and in ascending order: bodies that
/// just touch do not. Throws InvalidInput for an unusable shape.
MMGRASP_EXPORT std::vector<std::pair<std::size_t, std::size_t>> overlapping_bodies(
    const std::vector<CheckedBody>& bodies);

}  // namespace mmgrasp::verify
