#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/ik.hpp"

namespace mmgrasp {

/// All arm configurations that put the tip at a pose, and what became of the others.
struct MMGRASP_EXPORT IkBranches {
  /// Inside limits, confirmed by forward kinematics, allowed by the filter; the one nearest to the middle of the limits
  /// first, then always the one farthest from those before it.
  std::vector<Eigen::VectorXd> solutions;
  /// Every branch was computed (with seven joints: for every sampled value), none searched. False, too, in a
  /// singularity that leaves a joint free: of infinitely many configurations one is kept.
  bool complete = false;
  int redundant_joint = -1;  ///< Configuration entry that was sampled; -1 for none.
  Rejections rejections;  ///< Rejected branches and descents that failed; `unreachable` counts sampled values without
                          ///< any, too.
};

/// Every inverse kinematics branch of an arm of six turning joints in closed form, and of one of seven joints for
/// `redundant_values` values of its redundant joint, spread evenly over its range (0: about the wanted density for a
/// diverse set, 24). Whether a closed form fits is read from where the axes lie: three of them meeting at one end
/// (spherical wrist or shoulder), or the joints 2-4 parallel; geometry that is special only to 0.1 mm will do, since
/// each branch is polished by Newton's method on the true chain. A branch is an arm posture: joints that may turn more
/// than once stand in the turn nearest to the middle of their limits. With `all_turns` each branch comes in every whole
/// turn of its joints within limits (what ssik calls windings), one branch after the other, of each the turns nearest
/// to the middle first; up to 64 for six joints of two turns. Arms without closed form and groups with a base get
/// random descents until the time limit or the monitor ends them, and so do singularities whose one branch falls:
/// `complete` is false then. Throws InvalidInput on bad options or a pose that is none.
MMGRASP_EXPORT IkBranches solve_ik_branches(const JointGroup& group, const Pose& T_world_tip,
                                            const IkOptions& options = {}, const ConfigurationFilter& valid = {},
                                            int redundant_values = 0, const Monitor& monitor = {},
                                            bool all_turns = false);

/// Puts solutions in an order in which the first ones are as different as can be: first the one nearest to the middle
/// of the limits, then always the one farthest from those before it (joint-space distance, angles without limits the
/// short way).
MMGRASP_EXPORT void spread_apart(const JointGroup& group, std::vector<Eigen::VectorXd>& solutions);

}  // namespace mmgrasp
