#pragma once

#include <Eigen/Core>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/edge.hpp"
#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/grasp/grasp.hpp"
#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/plan/improvement.hpp"
#include "mmgrasp/plan/roadmap.hpp"
#include "mmgrasp/plan/rrt_star_mg.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/robot/joint_weights.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp {

/// An object to be moved from one pose to another with any of many grasps (P2 4.2): the planner chooses the grasp.
struct MMGRASP_EXPORT ManipulationProblem {
  /// Arm, or arm and omni base; its tip is the tool. A diff-drive base could not drive the paths: it is refused.
  JointGroup group;
  World world;                    ///< Does not hold the object.
  std::vector<LinkShape> object;  ///< Shapes in the object's frame.
  Pose T_world_start = Pose::Identity(), T_world_goal = Pose::Identity();
  std::vector<Grasp> grasps{};          ///< T_object_hand is the pose of the group's tip.
  std::optional<Hand> gripper{};        ///< Sets the fingers to each grasp's opening or posture.
  std::set<std::string> touch_links{};  ///< Links that may touch the object; empty: the end effector's.
  std::string object_name = "object";
  /// Throws InvalidInput: a diff-drive base, no grasps, a pose that is no rigid transform (index and field named), a
  /// negative cost.
  void check() const;
};

/// Options of "prm_star_mg" alone.
struct MMGRASP_EXPORT PrmStarMgOptions {
  /// Grasps searched together before paths are checked (P2 4.3.4): 1 is the naive variant, 0 (all at once) the batch
  /// variant, anything between the standard one. The answer is the same, its cost in time is not.
  int batch = 0;
  /// Search a grasp only when its straight-line cost could still win (beyond P2); off: as in the paper.
  bool lazy_grasps = true;
  RoadmapOptions roadmap;  ///< How a roadmap is built when none is given.
  /// Once the best path over the roadmap is found, the roadmap's vertices are doubled and the search goes on, up to
  /// this many vertices; 0: never. Building denser roadmaps counts as search.
  int max_vertices = 0;
  /// Shorten the best path over the roadmap at the end, as plan_motion does; off: as in the paper.
  bool shorten = true;
  /// After that: rounds with small roadmaps drawn where a cheaper path can pass (informed sets of all grasps), each
  /// searched for a better path, within the time limit; none with `shorten` off; >= 0.
  int refinements = 4;
  void check() const;
};

/// The planner that plan_manipulation() runs, its budget, and what all planners share; `prm` and `rrt` belong to one
/// each.
struct MMGRASP_EXPORT ManipulationOptions {
  std::string planner = "prm_star_mg";  ///< A name of manipulation_planner_names().
  int ik_solutions = 8;                 ///< Arm postures of each grasp at each end at most, in all turns; > 0.
  /// A first path is searched for while arm configurations are found, grasp by grasp: after this many grasps the
  /// earlier ones are searched again, then twice as many follow, and so on. 0: all arm configurations before any
  /// search, as in the paper (also for "prm_star_mg" with `straight` or `shorten` off). >= 0.
  int first_grasps = 4;
  /// Try straight joint lines from start to goal (beyond P2): "prm_star_mg" joins all start and goal configurations,
  /// "rrt_star_mg" checks those of the cheapest grasps before the first sample. Off: start and goal are joined
  /// when the roadmap would join them, and by trees.
  bool straight = true;
  EdgeOptions edge{0.02, 0.005, false, 1e-4};  ///< Steps of edge checks.
  /// What a motion of each joint costs, in the path's length and wherever a planner measures distances; also for the
  /// roadmap that is built.
  JointWeights joint_weights;
  IkOptions ik;
  /// Above zero the grasps' costs decide: of the grasps with which a path no longer than this was found, the answer has
  /// the one of least cost. Zero: length and cost count together. For pipes whose grasps cost their sag, the one that
  /// sags least among those whose motion is short enough. >= 0, `rrt.goal_cost` must be zero then.
  double max_length = 0;
  double time_limit = 15;  ///< Wall-clock cap on IK and search together, without the roadmap's building [s]; > 0.
  unsigned seed = 1;       ///< Same seed, same path, as long as the time limit does not end the run.
  int threads = 0;         ///< 0: all; does not change the answer.
  PrmStarMgOptions prm;
  RrtStarMgOptions rrt;
  void check() const;
};

/// "prm_star_mg" searches a roadmap (P2 chapter 4), "rrt_star_mg" grows trees and gets better with time (chapter 5).
MMGRASP_EXPORT std::vector<std::string> manipulation_planner_names();

/// What became of one grasp.
struct MMGRASP_EXPORT GraspReport {
  Rejections start, goal;                       ///< Arm configurations rejected at either end.
  int start_solutions = 0, goal_solutions = 0;  ///< Arm configurations left.
  bool searched = false;                        ///< Whether prm_star_mg searched a roadmap for it.
};

/// What a stage contributed to a result's improvements.
struct MMGRASP_EXPORT StageReport {
  PlanStage stage = PlanStage::search;
  int improvements = 0;
  double first_seconds = 0,
         last_seconds = 0;  ///< When its first and its last improvement came, as Improvement::seconds.
  double cost = 0;          ///< Cost after its last improvement.
};

/// Time and work that plan_manipulation() spent, and bounds on the cost that its stages proved.
struct MMGRASP_EXPORT ManipulationStats {
  double ik_seconds = 0, roadmap_seconds = 0, search_seconds = 0;
  /// Cost of prm_star_mg's best path over the roadmap before shortening; 0: none costs less than the first path.
  double roadmap_cost = 0;
  /// prm_star_mg: no path over the roadmap, or straight, costs less; at most the result's cost. Infinite: there is
  /// none.
  double roadmap_bound = 0;
  /// No path between the arm postures that were found, in any of their whole turns, costs less; at most the result's
  /// cost. Redundant arms have others, of which ManipulationResult::lower_bound speaks too.
  double postures_bound = 0;
  std::size_t graph_searches = 0;
  /// Nodes pushed to the open lists of graph searches that ran before any path was checked (prm_star_mg, `lazy_grasps`
  /// off). Bounds spliced from the paths of other grasps keep it small (P2 4.3.2.5).
  std::size_t nodes_opened = 0;
  std::size_t grasps_searched = 0;         ///< Grasps for which prm_star_mg searched a roadmap; each counts once.
  std::size_t edges_checked_robot = 0;     ///< Edges checked for the robot alone, shared by all grasps of an opening.
  std::size_t edges_checked_attached = 0;  ///< Edges checked for the object in hand.
  std::size_t samples = 0;                 ///< Samples that rrt_star_mg drew or reassigned.
  std::size_t vertices = 0;                ///< Vertices of rrt_star_mg's trees, removed ones included.
  std::vector<StageReport> stages;         ///< Those that improved the path, in the order of their first improvement.
};

/// The cheapest manipulation path found, its grasp, how good it is proven to be, and what became of each grasp.
struct MMGRASP_EXPORT ManipulationResult {
  Outcome outcome = Outcome::timeout;
  int grasp_index = -1;
  std::optional<JointPath> path;  ///< Set if and only if solved; checked again at 0.005 rad with the object in hand.
  double cost = 0;                ///< Path length, weighted by the joints, plus the grasp's cost.
  /// No path with any grasp costs less, whoever plans it. The least straight line between arm postures, in any of their
  /// whole turns and angles without limits the short way round, where every posture was listed (closed forms of six
  /// joints with `ik_solutions` enough for all branches); else no more than what the tool's way takes with every joint
  /// at its longest lever. At most `cost`; infinite when it is proven that there is none.
  double lower_bound = 0;
  std::vector<Improvement> improvements;
  std::vector<std::string> warnings;  ///< What may have kept paths from being found: a roadmap in pieces.
  std::vector<GraspReport> grasps;    ///< One per grasp; empty for those not checked when the run ended early.
  std::vector<Contact> contacts;      ///< With invalid_start or invalid_goal: what touches there with the first grasp.
  Rejections rejections;              ///< Rejected arm configurations, summed over all grasps and both ends.
  std::vector<SearchTree> trees;      ///< With RrtStarMgOptions::keep_trees: those of grasps that are still candidates.
  ManipulationStats stats;
};

/// A manipulation (transfer) path: a collision-free path of the group that moves the object from start to goal with the
/// best of the grasps:
///
///     ManipulationProblem problem{arm, world, shapes, T_world_start, T_world_goal, grasps};
///     const ManipulationResult result = plan_manipulation(problem);
///     if (result.path) execute(problem.grasps[result.grasp_index], result.path->waypoints);
///
/// Every grasp is checked, unless the time limit, the cancel token or `goal_cost` ends the run. No grasp reachable at
/// the start: invalid_start; at the goal: invalid_goal; `rejections` and `grasps` say why. With `roadmap` no other is
/// built; it must be of the same robot, joints and weights. `on_improvement` is called with every better solution.
/// `checker`: a prepared checker of the problem's group and world, whose options then hold for all checks; throws
/// InvalidInput that says what differs when it is of others, or leaves out the robot itself (attached_only).
MMGRASP_EXPORT ManipulationResult plan_manipulation(const ManipulationProblem& problem,
                                                    const ManipulationOptions& options = {},
                                                    const Roadmap* roadmap = nullptr, const Monitor& monitor = {},
                                                    const ImprovementCallback& on_improvement = {},
                                                    const CollisionChecker* checker = nullptr);

}  // namespace mmgrasp
