#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/task/base_region.hpp"
#include "mmgrasp/task/base_route.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "mmgrasp/task/pick.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp {

/// Seconds of wall time a stage took.
struct MMGRASP_EXPORT StageTime {
  std::string stage;
  double seconds = 0;
};

/// Why there is no plan, and what would help. The fields after `message` are advice that can be applied as it stands.
struct MMGRASP_EXPORT Obstruction {
  std::string tray, part;           ///< What blocks; part empty when the whole tray does.
  std::string stage;                ///< "grasp", "region", "robustness", "motion", "route".
  std::string message;              ///< One sentence a person can act on.
  double largest_uncertainty = -1;  ///< Largest positioning uncertainty that still works [m]; < 0: none does.
  /// How far the nearest base pose at which the robot may stand falls short of the part at a single grasp [m]; 0: reach
  /// is not it. It only brings that grasp to the edge of the reach: the move that suffices is `advised_move`.
  double reach_deficit = 0;
  /// Shortest translation found, in the world's x and y [m], after which a disc of the positioning uncertainty has
  /// room: `move_trays` (this tray first) with their parts and `move_objects` of the scene move together by it. It was
  /// checked in the moved scene for base poses, start and goal; not for arm motions and the drive. Zero: moving does
  /// not help or is not needed. Obstructions of trays that move together tell the same move: apply it once.
  Eigen::Vector2d advised_move = Eigen::Vector2d::Zero();
  std::vector<std::string> move_trays;    ///< Empty when advised_move is zero.
  std::vector<std::string> move_objects;  ///< What carries the trays, and what else stands on that.
  /// Gripper opening at which a part that is too wide can be held with the gripper's clearance on both sides [m]; 0:
  /// width is not it. From the bounds of the part's shapes along its own axes, those that stand upright in the world
  /// left out.
  double needed_opening = 0;
};

/// A drive to the goal to empty the full bin, or to let go the part in the hand. Parts may be left at its stop.
struct MMGRASP_EXPORT Unloading {
  int after_pick = -1;  ///< Index of the plan's pick that filled bin or hand.
  BasePath to_goal;     ///< From the stop of that pick.
  BasePath back;        ///< To the same stop, where parts are left; without poses: the next leg of the route goes on.
};

/// A whole plan: where the base stops, how it drives there, and every pick.
struct MMGRASP_EXPORT PartSupplyPlan {
  Outcome outcome = Outcome::not_found;
  BaseGrid grid;
  std::vector<BaseRegion> regions;  ///< One a tray, in the problem's order.
  Intersections intersections;      ///< Robust sets of trays: all when there are not too many, else the maximal ones.
  std::vector<Stop> stops;          ///< Stops in visiting order.
  int lower_bound = 0;              ///< Proven: fewer stops cannot serve these regions.
  /// The stops are as few as the regions allow. False when that is not proven: the search for shared regions or for the
  /// least cover ended early, or no stops were found.
  bool proven_minimal = false;
  /// stops.size() + 1 legs, from start to goal; a leg after a stop that was left to unload begins at the goal.
  std::vector<BasePath> route;
  std::vector<Unloading> unloadings;  ///< As they are carried out; one less than trips.
  std::vector<Pick> picks;            ///< Picks in the order in which they are carried out.
  /// Share of the base poses drawn at a stop from which all its parts stay graspable: the least of all stops.
  double robustness_rate = 0;
  std::vector<Obstruction> obstructions;  ///< Empty if and only if solved.
  std::vector<StageTime> timings;
};

/// Plans a part supply (P1 Algorithm 1 and the motions around it): with as few stops of the base as possible, pick
/// every target part of every tray into the bin on the robot, robustly against errors in the base's position.
///
/// 1. Base regions: from where can all parts of a tray be grasped (compute_base_regions())?
/// 2. Stops: the fewest whose discs of `positioning_uncertainty` lie in shared regions (plan_stops_exact()). Base poses
/// are
///    drawn in the discs and checked; regions lose the cells that fail, and the stops are solved again.
/// 3. Picks at every stop (plan_pick()), and the drives between the stops (plan_base_route()).
///
/// Every part of the answer is checked before it is returned. No plan is a value: `obstructions` say what is in the way
/// and what would help. Throws InvalidInput for a problem that makes no sense.
/// @code
///   const ReachDatabase database = ReachDatabase::build(problem.arm, {});
///   const PartSupplyPlan plan = plan_part_supply(problem, database);
///   for (const Obstruction& what : plan.obstructions) std::cout << what.message << "\n";
/// @endcode
MMGRASP_EXPORT PartSupplyPlan plan_part_supply(const PartSupplyProblem& problem, const ReachDatabase& database,
                                               const Monitor& monitor = {});

}  // namespace mmgrasp
