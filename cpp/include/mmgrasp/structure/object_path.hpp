#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/grasp/grasp.hpp"
#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/robot/trajectory.hpp"
#include "mmgrasp/structure/supported_frame.hpp"

namespace mmgrasp {

/// A robot that carries an object along given poses (P2 3.2.1).
struct MMGRASP_EXPORT ObjectPathProblem {
  JointGroup group;                    ///< Its tip is the tool frame of grasps.
  World world;                         ///< All but the object.
  std::vector<LinkShape> object;       ///< The object's shapes, placed in its frame; never empty.
  Poses T_world_object;                ///< Where it lies, then where it goes: at least two.
  std::optional<Hand> gripper;         ///< Opens its fingers as each grasp says; none: they stay as the group has them.
  std::set<std::string> touch_links;   ///< Links that may touch the object; empty: as World::attach says.
  std::optional<BeamFrame> frame;      ///< How the object bends; none: it is stiff.
  std::string object_name = "object";  ///< Its name in allowed pairs and paddings of `world`.
  /// Throws InvalidInput naming field, value and rule.
  void check() const;
};

/// Cost(O) = sum of weight times objective over scale. The objectives are P2's (3.2.3.3): the sums over the waypoints
/// after the first of the joint-space distance from the one before (O1; the plain norm of the formula, not the square
/// of the text), of the largest displacement of the object (O2), and of the force manipulability along the tool's
/// motion, a twist in m and rad (O3; 0 where the tool stands still, where P2's direction is undefined).
struct MMGRASP_EXPORT ObjectPathOptions {
  /// P2's comparison matrix by P2's method; it prints 0.56, 0.12, 0.32, which belong to another. >= 0.
  double motion_weight = 0.587, deflection_weight = 0.089, manipulability_weight = 0.324;
  double motion_scale = 1;          ///< [rad or m]; > 0. P2 adds the objectives as they are, without naming units.
  double deflection_scale = 1e-3;   ///< [m]; > 0.
  double manipulability_scale = 1;  ///< > 0.
  double max_joint_step = 0.5;  ///< A joint that moves more between waypoints jumps to another posture [rad or m]; > 0.
  double position_tolerance = 0.01;  ///< Half way between waypoints the object is this near to its path [m]; > 0.
  double rotation_tolerance = 0.05;  ///< There it is turned by no more than this from it [rad]; > 0.
  double edge_step = 0.02;           ///< No joint moves more than this between two collision checks [rad or m]; > 0.
  bool check_edges = true;           ///< Check motions between waypoints, which P2's Algorithm 3.1 leaves out.
  /// Only one arm configuration at each pose, as P2's single-IK variant has it (3.5.2.4): the nearest to the one
  /// before, at first to where the arm stands (JointGroup::reference). Arms without closed form and moving bases: what
  /// a numerical solver finds from there, and from random starts where that fails.
  bool single_configuration = false;
  bool all_turns = true;      ///< Joints that may turn more than once come in every turn.
  int redundant_values = 0;   ///< Samples of a seventh joint, evenly over its range; 0: 24. >= 0.
  double base_spacing = 0.2;  ///< Distance of the places where a moving base may stand, a grid along x and y [m]; > 0.
  int base_headings = 4;      ///< Base headings tried at each place, evenly over a turn; > 0.
  double gravity = kGravity;  ///< Acceleration along the world's -z [m/s2]; >= 0.
  double max_sag = 0;         ///< The object may bend by no more than this at a pose [m]; 0: as it likes. >= 0.
  void check() const;
};

/// What one grasp costs along a path, and the arm's motion.
struct MMGRASP_EXPORT ObjectPathResult {
  Outcome outcome = Outcome::not_found;  ///< solved or not_found.
  double cost = 0;                       ///< Cost(O); only when solved.
  double joint_motion = 0;               ///< O1 [rad or m]
  double deflection = 0;                 ///< O2 [m]
  double force_manipulability = 0;       ///< O3
  JointPath path;                        ///< One configuration for each pose; only when solved.
  std::vector<double> sag;               ///< Largest displacement at each pose [m]; the first is not part of O2.
  /// Poses at which the object bends by more than `max_sag`, or bears more stress than its material's limit where one
  /// is given.
  std::vector<int> overloaded;
  /// Cost(C) of P2 3.3.1, zero if and only if solved: the sum of `violations` plus one for each pose in `overloaded`.
  /// When that sum is zero and there is still no path, the number of pairs of neighbouring poses between which no
  /// motion is allowed.
  int violation = 0;
  /// One number for each pose: 2 when no arm configuration reaches it, 1 when all that do collide, else 0.
  std::vector<int> violations;
  /// When every pose can be reached, but there is no path: for each pose but the last, how the next one is missed. 0:
  /// it is not; 1: each motion there jumps to another posture of the arm; 2: each that does not collides or leaves the
  /// object's path. Else empty.
  std::vector<int> gaps;
  Rejections rejections;   ///< Configurations rejected, of those that were checked.
  int refused_edges = 0;   ///< Motions between waypoints that collide or leave the object's path.
  int configurations = 0;  ///< Arm configurations found over all poses.
};

/// Evaluates what one grasp after another costs along the same path; what does not depend on the grasp is prepared
/// once. For each grasp the cheapest sequence of arm configurations, one at each pose, is found by dynamic programming.
/// Only the cheapest sequence is checked for collisions; configurations and motions that collide are removed and the
/// next cheapest is found, until one is free: the same answer as checking every configuration. Not thread-safe; clones
/// share nothing.
///
///     ObjectPathEvaluator evaluator(problem);
///     for (const Grasp& grasp : grasps) keep_best(grasp, evaluator.evaluate(grasp));
class MMGRASP_EXPORT ObjectPathEvaluator {
 public:
  ObjectPathEvaluator(const ObjectPathProblem& problem, const ObjectPathOptions& options = {});
  ObjectPathEvaluator(ObjectPathEvaluator&&) noexcept;
  ObjectPathEvaluator& operator=(ObjectPathEvaluator&&) noexcept;
  ~ObjectPathEvaluator();
  ObjectPathEvaluator clone() const;

  const ObjectPathProblem& problem() const;
  const ObjectPathOptions& options() const;
  /// Throws InvalidInput for a grasp that is none, or that is on no section of the frame.
  ObjectPathResult evaluate(const Grasp& grasp);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The cheapest motion of the arm that carries the object through all poses with one grasp; motions between waypoints
/// are checked at steps of at most 0.005 rad or m, and every waypoint by forward kinematics.
MMGRASP_EXPORT ObjectPathResult follow_object_path(const ObjectPathProblem& problem, const Grasp& grasp,
                                                   const ObjectPathOptions& options = {});

}  // namespace mmgrasp
