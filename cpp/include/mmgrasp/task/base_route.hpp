#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/robot/robot_motion.hpp"

namespace mmgrasp {

/// Stops lie close to what is picked there: within this distance of either end of a drive no clearance is asked for
/// [m].
inline constexpr double kNearEnds = 1.0;

/// How the base can move, where it may, and how finely plan_base_route() searches the floor.
struct MMGRASP_EXPORT BaseRouteOptions {
  BaseKind base = BaseKind::diff_drive;
  /// Cell edge of the search [m]; > 0. Made coarser where the floor would have more than 500,000 cells.
  double resolution = 0.10;
  double check_step = 0.02;  ///< Largest motion of the base between two collision checks [m]; > 0.
  /// The whole robot stays this far from all but horizontal planes, wherever the base is farther than kNearEnds from
  /// both ends [m]; in [0, 10].
  double clearance = 0;
  Eigen::AlignedBox2d
      bounds;  ///< The search stays in here [m]; empty: the scene's bounds plus start and goal, grown by 2 m.
  void check() const;
};

/// A drive of the base as poses joined by primitive motions: for diff_drive either a straight drive along the heading
/// (forwards or backwards) or a turn on the spot; for omni any straight line in (x, y, theta).
struct MMGRASP_EXPORT BasePath {
  Outcome outcome = Outcome::not_found;
  std::vector<Eigen::Vector3d> poses;  ///< x, y, theta; theta is continuous (not wrapped) along the path.
  double length = 0;                   ///< Driven distance [m].
  double turning = 0;                  ///< Sum of absolute heading changes [rad].
  double cell = 0;  ///< Cell edge of the search that found it, or that was the last [m]; 0: none was needed.
};

/// Plans a drive of the whole robot with its arm at `home`, collision-checked in 3-D: A* over a grid of base poses,
/// then shortened and checked again at half the step. The base stays in its workspace (BaseLimits). The checker's group
/// is the arm, without base joints. No way is a value: invalid_start, invalid_goal, not_found (the search has a finite
/// resolution), infeasible for a fixed base that should drive, or timeout when 400,000 base poses were tried and others
/// are left. Throws InvalidInput for options out of range.
/// @code
///   CollisionChecker checker(arm, world);
///   const BasePath path = plan_base_route(checker, home, {0, 0, 0}, {4, 2, 1.57}, {});
///   for (const Eigen::Vector3d& pose : path.poses) std::cout << pose.transpose() << "\n";
/// @endcode
MMGRASP_EXPORT BasePath plan_base_route(CollisionChecker& checker, const Eigen::VectorXd& home,
                                        const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                        const BaseRouteOptions& options, const Monitor& monitor = {});

/// Lengths of the drives between all pairs of some base poses, the arm at `home`, around obstacles [m]: one search of
/// the whole floor for each pose instead of one for each pair. Symmetric; infinite where no way was found
/// (plan_base_route() may still find a narrow one). Estimates, good to some per cent: cells of `resolution` (coarser
/// when the floor would have more than 40,000) that the robot may pass in one of 16 directions; turns cost nothing.
/// Empty when the monitor ended it. `bounds` and `check_step` of the options are not used.
MMGRASP_EXPORT Eigen::MatrixXd route_lengths(const CollisionChecker& checker, const Eigen::VectorXd& home,
                                             const std::vector<Eigen::Vector3d>& poses, const BaseRouteOptions& options,
                                             int threads = 0, const Monitor& monitor = {});

/// Time to drive it under the limits (a diff-drive's wheels included) with trapezoidal profiles, stopping at every pose
/// where the motion changes [s]. Where an omni base drives and turns at once, both follow one profile, so that it stays
/// on the straight line that was checked.
MMGRASP_EXPORT double base_path_duration(const BasePath& path, BaseKind base, const BaseLimits& base_limits);

/// The same drive on its clock, base_path_duration() long, with the arm's `joints` at `q`: points where the
/// acceleration changes and at most `period` [s] apart. Throws InvalidInput for a path without poses and a period that
/// is not positive.
MMGRASP_EXPORT RobotMotion base_path_motion(const BasePath& path, BaseKind base, const BaseLimits& base_limits,
                                            const std::vector<std::string>& joints, const Eigen::VectorXd& q,
                                            double period = 0.1);

}  // namespace mmgrasp
