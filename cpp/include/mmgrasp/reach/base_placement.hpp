#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/reach/reach_database.hpp"
#include "mmgrasp/robot/ik.hpp"

namespace mmgrasp {

/// Base poses that the database votes for, and how many of the best are checked exactly and improved.
struct MMGRASP_EXPORT BasePlacementOptions {
  double step = 0.05;   ///< Grid of base positions [m]; > 0.
  int headings = 24;    ///< Headings of the base tried, evenly over the circle; > 0.
  int candidates = 64;  ///< Best base poses of the grid that are checked exactly; > 0.
  int seeds = 8;        ///< Stored configurations tried for a target; > 0.
  int refinements = 4;  ///< Rounds of smaller steps about the best base pose; >= 0.
  IkOptions ik;         ///< Tolerances and iterations of the descents; restarts are not used.
  int threads = 0;      ///< 0: all. Does not change the answer.
  BasePlacementOptions() { ik.max_iterations = 25; }  // from a near start: what takes longer hardly ever arrives
  void check() const;
};

/// A base pose (x, y, theta) on the floor from which the arm brings its tool to a pose.
struct MMGRASP_EXPORT BaseReach {
  Eigen::Vector3d base_pose = Eigen::Vector3d::Zero();
  Eigen::VectorXd q;  ///< Exact within the tolerances, free when a checker was given.
};

/// Inverse query: up to `count` base poses of the grid from which the tool reaches a pose in the world, the base level
/// on the floor; those in whose voxel the database holds most configurations first. Each was confirmed by forward
/// kinematics and, with a checker (of a group with the same joints, without base joints; where it stands does not
/// matter), is free of collisions. Throws InvalidInput.
MMGRASP_EXPORT std::vector<BaseReach> base_poses_for(const ReachDatabase& database, const JointGroup& arm,
                                                     const Pose& T_world_tip, int count,
                                                     const BasePlacementOptions& options = {},
                                                     const CollisionChecker* checker = nullptr,
                                                     const Monitor& monitor = {});

/// One base pose, and the configurations in which the arm reaches the targets from there.
struct MMGRASP_EXPORT BasePlacement {
  Eigen::Vector3d base_pose = Eigen::Vector3d::Zero();
  std::vector<Eigen::VectorXd> configurations;  ///< One per target; empty where it is not reached.
  int reached = 0;
};

/// One base pose from which as many of the targets (tool poses in the world) as possible are reached, each on its own.
/// The database votes for base poses on a grid; the best are checked exactly, and smaller steps are tried about the
/// best of those. Found by search: more may be possible. Confirmed as base_poses_for() does. Nothing reached: base_pose
/// is zero.
MMGRASP_EXPORT BasePlacement find_base_placement(const ReachDatabase& database, const JointGroup& arm,
                                                 const Poses& T_world_tips, const BasePlacementOptions& options = {},
                                                 const CollisionChecker* checker = nullptr,
                                                 const Monitor& monitor = {});

}  // namespace mmgrasp
