#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/grasp/grasp.hpp"
#include "mmgrasp/grasp/hand_model.hpp"
#include "mmgrasp/grasp/success_model.hpp"
#include "mmgrasp/grasp/surface_draws.hpp"
#include "mmgrasp/mapping/probabilistic_sdf.hpp"
#include "mmgrasp/robot/ik.hpp"

namespace mmgrasp {

class World;

/// What synthesize_grasps() may grasp, how much room the hand keeps, and how many grasps are tried for it.
struct MMGRASP_EXPORT SynthesisOptions {
  int samples = 200;       ///< Grasps evaluated: two thirds spread over the object, the rest around the best; > 0.
  int refined = 8;         ///< Grasps of the first search around which the second goes on; > 0.
  double shift = 0.012;    ///< Farthest that the second search shifts a grasp in the plane of its pads [m]; >= 0.
  double max_tilt = 1.05;  ///< Largest angle of the approach from straight down, in [0, 3.2] [rad]; from pi on any.
  std::optional<double> table;  ///< Height of the level table that the object stands on [m]; none: there is none.
  /// What the map has up to this, or to `sigmas` of its own, above the table is the table [m]; >= 0.
  double table_tolerance = 0.004;
  std::optional<Eigen::AlignedBox3d> object;  ///< What to grasp lies in this box [m]; none: all of the map.
  double sigmas = 2;                          ///< Standard deviations of the surface kept free around the hand; >= 0.
  double margin = 0.002;                      ///< Kept free beside them, and above the table [m]; >= 0.
  double approach_distance = 0.05;            ///< Straight way in that must be free [m]; >= 0.
  /// Between returned grasps that close along about one axis, of hands that are not parallel the same way [m]; >= 0.
  double min_distance = 0.01;
  int max_grasps = 20;  ///< Best kept; > 0.
  int threads = 0;      ///< 0: all. The answer does not depend on it.
  unsigned seed = 1;    ///< Same seed, same grasps.
  SuccessOptions success;
  ContactPatchOptions patch;
  void check() const;
};

/// What became of surface points drawn for a grasp, and of the grasps evaluated. Every point is counted once among the
/// first five or leads to an evaluation; every evaluated grasp is counted once among the others or is returned.
struct MMGRASP_EXPORT SynthesisCounts {
  std::size_t drawn = 0;        ///< Surface points, of which one grasp each was to be made.
  std::size_t no_opposite = 0;  ///< The map has no surface on the other side.
  std::size_t too_wide = 0;     ///< Wider there than the hand opens.
  std::size_t too_thin = 0;     ///< Thinner than the hand closes.
  std::size_t tilted = 0;       ///< Would take an approach beyond max_tilt.
  std::size_t evaluated = 0;    ///< Grasps, those of the second search included.
  std::size_t missed = 0;       ///< A pad meets too little of the surface, or the hand does not fit around it.
  std::size_t uneven = 0;       ///< A pad meets no plane.
  std::size_t slipping = 0;     ///< Outside the friction cones: no force closure.
  std::size_t uncertain = 0;    ///< Surface less certain than max_sigma.
  std::size_t collision = 0;    ///< The hand touches the map, open, on its way in or while it closes.
  std::size_t table = 0;        ///< The hand touches the table.
  std::size_t arm = 0;          ///< The arm does not get there; GraspSynthesis::arm says why.
  std::size_t near_better = 0;  ///< A better one lies beside it, or max_grasps better ones exist.
};

/// How a returned grasp was rated.
struct MMGRASP_EXPORT GraspRating {
  GraspSuccess success;
  std::vector<ContactPatch> patches;     ///< One a finger, in the world.
  double pretouch_opening = 0;           ///< Between the pads before closing, P3's g_n [m].
  std::vector<double> pretouch_posture;  ///< The same of hands with several joint groups; see Grasp::posture.
  std::optional<DrawnSuccess> drawn;     ///< What draw_success() found; none: it was not called.
  Eigen::VectorXd q;                     ///< The arm's configuration before closing; empty without an arm.
};

/// Grasps found in a map of uncertain surfaces, how each was rated, and what became of all others that were tried.
struct MMGRASP_EXPORT GraspSynthesis {
  Outcome outcome = Outcome::not_found;  ///< solved, not_found or stopped.
  std::vector<Grasp> grasps;             ///< Most probable first; T_object_hand is the pose in the world.
  std::vector<GraspRating> ratings;      ///< One for each grasp, in the same order.
  SynthesisCounts counts;
  Rejections arm;              ///< Why the arm did not reach grasps.
  ObjectExtent object;         ///< Middle and longest side of the box fitted to the map's points.
  double opens = 0;            ///< Largest opening of the hand [m].
  double median_too_wide = 0;  ///< Median distance of opposite walls that are farther apart than that [m]; 0: none.
  /// One sentence: how many grasps there are or what most of those tried failed on.
  std::string summary() const;
};

/// Configuration of the arm that brings the hand to a pose, or why there is none.
using ArmReach = std::function<Rejection(const Pose& T_world_hand, Eigen::VectorXd& q)>;

/// An arm whose tip is the hand's tool link, by inverse kinematics from `seed`; with a world free of collisions with it
/// and with itself, as of now. To be called by one thread at a time. Throws InvalidInput on a seed of another size.
MMGRASP_EXPORT ArmReach make_arm_reach(const JointGroup& arm, const Eigen::VectorXd& seed, const World* world = nullptr,
                                       const IkOptions& options = {});

/// Grasps of unknown parts in a map with uncertain surfaces (P3 4.6), most probable by (4.9) first.
///
/// - The first search draws a surface point, finds the opposite wall by a ray, and lets the hand come in along a
///   direction within max_tilt. Each pad casts its rays; the hand is centred between the patches and opened so that
///   each pad stays Hand::clearance away, or as far as it opens.
/// - The second search shifts the best in the plane of their pads and turns them to face their patches.
/// - Hands of several joint groups then close finger by finger until each pad is at that distance.
/// - Hand and map, hand and table must keep apart; then rays are cast again from the final pose, and what does not pass
///   this check is not returned. With `arm` grasps that it does not reach are left out before the second search;
///   parallel hands may be turned by half a turn for it.
///
/// Grasp::quality is the probability, Grasp::opening the distance between the pads when they touch. Throws
/// InvalidInput on options out of range, a map without a surface or without one where the object should be.
MMGRASP_EXPORT GraspSynthesis synthesize_grasps(const ProbabilisticSdf& map, const HandModel& hand,
                                                const SynthesisOptions& options = {}, const Monitor& monitor = {},
                                                const ArmReach& arm = {});
MMGRASP_EXPORT GraspSynthesis synthesize_grasps(const ProbabilisticSdf& map, const Hand& hand,
                                                const SynthesisOptions& options = {}, const Monitor& monitor = {},
                                                const ArmReach& arm = {});

/// Rates every grasp of a synthesis by (4.1) too: sets GraspRating::drawn. `options` are those it was made with.
MMGRASP_EXPORT void draw_success(const ProbabilisticSdf& map, const HandModel& hand, const SurfaceDrawOptions& draws,
                                 const SynthesisOptions& options, GraspSynthesis& found);

}  // namespace mmgrasp
