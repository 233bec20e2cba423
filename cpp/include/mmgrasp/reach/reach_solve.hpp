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

/// How many solutions solve_reach() returns, and from how many stored configurations it looks for them.
struct MMGRASP_EXPORT ReachSolveOptions {
  int count = 8;          ///< Solutions asked for; > 0.
  int candidates = 64;    ///< Stored configurations that descents start from; > 0.
  double distinct = 0.1;  ///< Solutions differ by more than this in some joint [rad or m]; >= 0.
  IkOptions ik;           ///< Tolerances and iterations of the descents; restarts are not used.
  int threads = 0;        ///< Threads that share a batch; 0: all. Does not change the answer.
  void check() const;
};

/// P1 3.2.2 made exact: configurations near the pose in the database, each refined until the tool stands at the pose
/// within the tolerances, the most different ones first. `arm` is the database's (throws InvalidInput when the number
/// of joints differs); the pose is relative to the robot's root wherever `arm` or the checker stands. With a checker
/// only those that are free; its group must have the same joints. Every answer lies within the limits and was confirmed
/// by forward kinematics.
MMGRASP_EXPORT std::vector<Eigen::VectorXd> solve_reach(const ReachDatabase& database, const JointGroup& arm,
                                                        const Pose& T_base_tip, const ReachSolveOptions& options = {},
                                                        CollisionChecker* checker = nullptr);

/// The same for many poses at a time. Poses are left out (no solutions) once stopped.
MMGRASP_EXPORT std::vector<std::vector<Eigen::VectorXd>> solve_reach_batch(
    const ReachDatabase& database, const JointGroup& arm, const Poses& T_base_tip,
    const ReachSolveOptions& options = {}, const CollisionChecker* checker = nullptr, const Monitor& monitor = {});

}  // namespace mmgrasp
