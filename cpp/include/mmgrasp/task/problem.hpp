#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/grasp/grasp.hpp"
#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/reach/reach_database.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp {

/// One part in a tray.
struct MMGRASP_EXPORT Part {
  std::string name;               ///< Unique over the problem.
  std::vector<LinkShape> shapes;  ///< Its body, in the part's frame.
  Pose T_world_part = Pose::Identity();
  bool target = true;           ///< False: it stays, and is an obstacle.
  std::vector<Grasp> grasps;    ///< Candidates, best first; without postures.
  int grasps_too_wide = 0;      ///< Candidates dropped before planning because the gripper does not open so far.
  double mass = 0;              ///< [kg]; 0: not known, which suction cups cannot hold.
  bool grasps_sampled = false;  ///< Others may exist: that these are impossible proves nothing of the part.
};

/// A tray and the parts in it. The tray's own walls are scene objects.
struct MMGRASP_EXPORT Tray {
  std::string name;
  Pose T_world_tray = Pose::Identity();  ///< Middle of the tray's floor; a robot in front of it looks along its +x.
  Eigen::Vector3d size = Eigen::Vector3d(0.3, 0.4, 0.1);  ///< Depth (x), width (y), height (z) [m].
  std::vector<Part> parts;
  std::vector<double> headings;  ///< Base headings tried [rad]; empty: the one that faces the tray (its +x).
};

/// Where picked parts go: a bin fixed to the robot. A part is released level (as it lay in the tray, turned about the
/// vertical only) with its lowest point `drop_height` above the bin's top plane and its origin inside the bin's
/// rectangle.
struct MMGRASP_EXPORT PlaceRegion {
  Pose T_base_bin = Pose::Identity();                ///< Middle of the bin's top plane in the root frame, z up.
  Eigen::Vector2d size = Eigen::Vector2d(0.3, 0.3);  ///< Inner x and y [m], > 0.
  double drop_height = 0.03;                         ///< [m], >= 0
  /// So many parts fill the bin; then the robot drives to the goal, where it is emptied, and on from there. 0: it takes
  /// all.
  int capacity = 0;
};

/// Where a robot without a bin lets go what it carried to the goal in its hand: a rectangle in the world, as of a bin,
/// a chute or a conveyor that stands there as an object of the scene. Parts are released over it as over a PlaceRegion,
/// and are no obstacles any more.
struct MMGRASP_EXPORT UnloadRegion {
  Pose T_world_region = Pose::Identity();            ///< Its middle, z up.
  Eigen::Vector2d size = Eigen::Vector2d(0.3, 0.3);  ///< x and y [m], > 0.
  double drop_height = 0.03;                         ///< Height above it at which parts are released [m], >= 0.
};

/// The base poses tried around a tray: how dense, how far away, and with how many guesses for the arm.
struct MMGRASP_EXPORT BaseGridOptions {
  double resolution = 0.05;  ///< Cell edge [m]; > 0.
  double max_distance =
      0.0;  ///< Cells whose centre is farther than this from the tray's middle are not tried [m]; 0: the arm's reach.
  /// Database configurations refined for each grasp and base pose; > 0. More are where a part has few grasps:
  /// ik_seeds_of_a_grasp().
  int ik_seeds = 8;
};

/// Configurations of the database that are refined for each grasp: as many as `asked`, and more where the part with the
/// fewest grasps would be tried in fewer than 128 postures (its region lacked cells then from which a search from
/// random starts reaches it). `grasps_of_parts`: how many each target part has, blocked ones included; parts without
/// any do not count.
MMGRASP_EXPORT int ik_seeds_of_a_grasp(int asked, const std::vector<int>& grasps_of_parts);

/// What a part-supply plan must allow for (an imprecise base, straight moves at a part), and the budgets of its stages.
struct MMGRASP_EXPORT PartSupplyOptions {
  BaseGridOptions grid;
  double positioning_uncertainty = 0.10;  ///< Radius of the disc in which the base may come to stand [m]; >= 0.
  double approach_distance = 0.08;        ///< Straight move from pre-grasp to grasp, along the approach axis [m]; > 0.
  double lift_height = 0.12;              ///< Straight upward move after closing [m]; > 0.
  /// Wall-clock cap of each planned motion [s]; > 0. A budget of 2000 states drawn for each of these seconds normally
  /// ends the search earlier, so that the load of the machine does not change a plan.
  double motion_time_limit = 5.0;
  /// Smallest cell edge of the base route's search [m]; > 0. Cells of some 0.1 m are tried before smaller ones.
  double route_resolution = 0.10;
  int robustness_samples = 2000;  ///< Base poses drawn at each stop for the check before returning; >= 0.
  unsigned seed = 1;
  int threads = 0;
  void check() const;
};

/// Throws InvalidInput naming `arrival_covariance` when this is no covariance of x, y [m^2] and theta [rad^2]:
/// symmetric, without a negative eigenvalue, variances of at most 1.
MMGRASP_EXPORT void check_arrival_covariance(const Eigen::Matrix3d& covariance);

/// Everything the part-supply planner needs: the robot and its hand, the room, the trays with their parts, and where
/// parts go.
///
///     PartSupplyProblem problem{robot, arm, hand, room, trays, home};
///     problem.place_region.T_base_bin = T_base_bin;
///     problem.options.positioning_uncertainty = 0.05;
///     const PartSupplyPlan plan = plan_part_supply(problem, ReachDatabase::build(arm));
///
/// - `world` holds obstacles, tables, trays; parts are kept apart because they are removed one by one.
/// - `arm` has no base joints; its reference holds the other joints (head, ...) and the fingers at rest.
/// - Stops are planned so that they still work when the base comes to stand anywhere in the disc of
///   `options.positioning_uncertainty` about them.
struct MMGRASP_EXPORT PartSupplyProblem {
  Robot robot;
  JointGroup arm;
  Hand gripper;
  World world;  ///< Obstacles, tables and trays, without the parts.
  std::vector<Tray> trays;
  Eigen::VectorXd home;                             ///< Arm configuration while driving, fingers closed.
  Eigen::Vector3d start = Eigen::Vector3d::Zero();  ///< Base pose x, y, theta [m, m, rad].
  Eigen::Vector3d goal = Eigen::Vector3d::Zero();
  PlaceRegion place_region;
  PartSupplyOptions options;
  /// How far from a stop the base comes to stand: covariance of x, y [m^2] and theta [rad^2] in the world's axes,
  /// errors normally distributed. Stops then stand where most arrivals serve all their parts. Zero: not asked for,
  /// discs of the positioning uncertainty are all that counts.
  Eigen::Matrix3d arrival_covariance = Eigen::Matrix3d::Zero();
  /// Drives keep this far from all but the ground wherever the base is farther than kNearEnds from both their ends [m];
  /// 0: not asked for, or in [0.001, 10]. Motions in passing do not keep it.
  double drive_clearance = 0;
  /// Set: there is no bin, `place_region` is not used. The robot drives to the goal with each part in its hand, the arm
  /// at home, lets it go over this region from there, and drives back for the next part. Not for suction cups.
  std::optional<UnloadRegion> unload_region = {};
  /// Throws InvalidInput naming the field, the value and the rule.
  void check() const;
};

}  // namespace mmgrasp
