#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/verify/plan_to_check.hpp"

namespace mmgrasp::verify {

/// How finely check_plan() looks at motions and regions, and from where on a difference is a fault.
struct MMGRASP_EXPORT PlanCheckOptions {
  double joint_step = 0.01;          ///< Arm paths are checked at least this finely [rad or m]; at most 0.1.
  double base_step = 0.01;           ///< The route [m, and rad x 2]; at most 0.1.
  double position_tolerance = 1e-4;  ///< How far a grasp may be off [m]; at most 0.01.
  double rotation_tolerance = 1e-3;  ///< How far a grasp may be turned [rad]; at most 0.1.
  int samples = 1000;                ///< Base poses drawn in the uncertainty disc of each stop; > 0.
  double required_rate = 0.999;      ///< Share of them from which every target part has a grasp; in (0, 1].
  /// Base poses drawn in each region, and cells drawn beside it and elsewhere; also poses drawn between the uncertainty
  /// disc of a stop and the radius that the plan claims. 0: none.
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
///   stand in the part, or clear of it), `no-seal` (a suction cup that is not on the part's surface), `payload` (a part
///   heavier than the hand may carry, or than its cups hold on the way), `no-lift` (or one that is too low),
///   `release-outside`, `release-tilted`, `release-height`;
/// - a motion in passing, besides those of arm motions: `drive-by-pick` (from home and not the first of its stop,
///   from a release that is none, twice, unknown),
///   `closing-time` (outside the motion, or faster than the fingers), `base-limit` (velocity or acceleration of the
///   base), `wheel-limit` (rims of its wheels), `base-off-course` (where its velocities do not lead);
/// - the route: `route-legs` (their number), `route-ends`, `route-not-driveable`, `route-collision` (a part that the
/// hand
///   carries included), `route-clearance`, `too-long`,
///   `unloading` (at a pick where it cannot be), `capacity` (more parts in the bin, or in the hand, than it takes);
/// - stops: `region-malformed`, `region-missing`, `region-too-small`, `stop-heading`, `stop-radius`,
///   `stop-outside-region`, `not-minimal`, `lower-bound`, `not-robust`, `arrival-rate` (arrivals serve all parts more
///   or less often than said, by more than chance), `region-inflated` (base poses in it that serve nothing),
///   `region-incomplete` (cells left out that serve everything: the least number of stops is then not proven);
/// - what only describes: `route-values` (length, turning, duration), `acceleration` (stored ones above the limits or
///   not those of the velocities), `wrong-values` (robustness rate below what is required or above 1, intersections
///   that lie elsewhere or name a tray twice).
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
  /// Whether cells were looked for that the regions lack: not with region_samples = 0, and not where bodies are padded.
  /// Without it the numbers of stops hold for the regions as they stand in the plan.
  bool regions_searched = false;
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
    const std::vector<CheckedBody>& bodies, const Monitor& monitor = {});

/// The fingers of a parallel gripper: unit axes in the tool frame, size of the pads [m].
struct CheckedPads {
  Eigen::Vector3d approach, closing;
  double max_opening, finger_depth, finger_width, clearance;
};

/// Down to which opening fingers may close to meet a part at a grasp of this width [m]: 10 mm below it or a quarter of
/// it, whichever is more, for collision shapes may stand back from the pads that the width is meant for.
MMGRASP_EXPORT double narrowest_grip(double width);

/// How far beside a part of this width pads and fingers may be that hold it [m]: 1.5 mm or a twentieth of it.
MMGRASP_EXPORT double grip_play(double width);

/// What is wrong with the seal of the cups at the grasp, which face along `approach` (unit, tool frame): the rims of
/// all must have the part's surface before them, no farther than max_gap, and what they enclose must be covered by it,
/// no deeper than their radius; empty: they seal. By FCL, with needles of those lengths.
MMGRASP_EXPORT std::string broken_seal(const CheckedSuction& suction, const Eigen::Vector3d& approach,
                                       const std::vector<LinkShape>& part, const CheckedGrasp& grasp);

/// How pads that close on the part otherwise meet it than the grasp says, empty where they do not: each must stop half
/// the opening from the hand's middle, within 1.5 mm or a twentieth of the opening, and find room at the opening before
/// (with the clearance on either side, as far as the hand opens).
MMGRASP_EXPORT std::string pads_unlike_grasp(const CheckedPads& pads, const std::vector<LinkShape>& part,
                                             const CheckedGrasp& grasp);

}  // namespace mmgrasp::verify
