#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/geometry/fit_primitives.hpp"
#include "mmgrasp/geometry/segment_mesh.hpp"
#include "mmgrasp/grasp/keep_off.hpp"
#include "mmgrasp/gripper_design/minimal_grippers.hpp"
#include "mmgrasp/gripper_design/operation_load.hpp"

namespace mmgrasp {

/// Fingers that can be made, how they take parts, and what makes a set of grippers good, for plan_grippers().
struct MMGRASP_EXPORT PlanGrippersOptions {
  double finger_width = 0.015;      ///< Across approach and closing direction [m], > 0.
  double finger_thickness = 0.008;  ///< Along the closing direction [m], > 0.
  double clearance = 0.002;         ///< How far each finger opens to approach and to let go [m], >= 0.
  double shortest_finger = 0.01;    ///< No finger is shorter [m], > 0.
  double longest_finger = 0.15;     ///< No finger is longer [m], >= shortest_finger.
  double opening_margin = 0.001;    ///< Stroke kept free beyond the part at either end [m], >= 0.
  double length_margin = 0.001;     ///< Kept from either limit of the finger length [m], >= 0.
  double min_contact = 0.003;       ///< Pads overlap a segment by at least this, along the approach [m], > 0.
  /// Tips end this short of the far end of the segment they hold, as far as min_contact lets them [m]; >= 0, no more
  /// than the largest part that is moved.
  double tip_clearance = 0.0005;
  int directions = 12;  ///< Approaches about the closing axis, or turns of centric fingers; in [1, 360].
  /// Parts that stand in each other deeper than this, at the end of an operation or on the way, are an error of the
  /// order or of a pose [m], >= 0. Screws that are drawn with their thread in smaller holes need more.
  double max_overlap = 0.0005;
  double change_cost = 0;                     ///< Cost of changing the gripper between two operations, >= 0.
  int max_nodes = 20000;                      ///< Most nodes of the search for fewest changes, > 0.
  double time_limit = 60;                     ///< The search for the least set ends after this, on the clock [s], > 0.
  int max_rehearsals = 200;                   ///< Most sets that are rehearsed, each without what met something, > 0.
  int threads = 0;                            ///< 0: all.
  std::optional<HoldingRequirement> holding;  ///< None: weight and insertion are not looked at.
  void check() const;                         ///< Throws InvalidInput naming field, value and rule.
};

/// A part cut into segments, each with the primitive that stands for it.
struct MMGRASP_EXPORT SegmentedPart {
  MeshSegmentation segmentation;
  std::vector<FittedPrimitive> primitives;  ///< One per segment.
};

/// What became of one segment of a part in one operation.
struct MMGRASP_EXPORT SegmentFate {
  std::string step;               ///< The operation's name.
  std::string part;               ///< The part's name.
  int segment = 0;                ///< Its number.
  std::string name;               ///< Its name as segment_names() gives it: "cylinder_1".
  std::string kind;               ///< Its primitive's name.
  int fingers = 0;                ///< 2, 3, or 0: no gripper suits its primitive.
  int tried = 0;                  ///< Grasps of it, each once for every stroke of the drives that suit it.
  int free = 0;                   ///< How many of those have some finger length.
  std::string refused;            ///< Why it cannot be held, or what most of its grasps fell by; empty when held.
  std::vector<int> requirements;  ///< Numbers of the plan's requirements.
};

/// A grasp that the rehearsal of its operation refused.
struct MMGRASP_EXPORT RefusedGrasp {
  int requirement = -1;  ///< Its number in the plan.
  std::string met;       ///< What it met with the gripper chosen for it then.
};

/// The grippers of an assembly, and how they were come by.
struct MMGRASP_EXPORT PlanGrippersResult {
  /// `solved`: each operation has a gripper that was rehearsed, and the set is proven to be the least for the grasps
  /// that were not `left_out`; `infeasible`: an operation has no grasp to try, or its parts stand in each other (see
  /// `missing`), or no drive takes it (see `set`); `not_found`: no grasp that was tried goes through an operation, or a
  /// rehearsal refuses all of them (pads that slip, too), or refused one of each of `max_rehearsals` sets; `stopped`;
  /// else as `set`.
  Outcome outcome = Outcome::stopped;
  std::map<std::string, SegmentedPart> parts;    ///< The parts that are moved, by name.
  std::vector<SegmentFate> fates;                ///< Every segment of what is moved, in every operation.
  std::vector<SegmentRequirement> requirements;  ///< One per grasp kept; its `part` is the operation's name.
  std::vector<AssemblyGrasp> grasps;             ///< One per requirement, in the frame of the active subassembly.
  /// One per requirement, with pads as wide as fingers may be, of those that were chosen as wide as their gripper's;
  /// empty where nothing is asked of holding.
  std::vector<HeldLoad> holdings;
  std::vector<std::string> missing;  ///< Operations that cannot be done, each with the reasons.
  std::vector<std::string> help;     ///< Single changes each of which gives an operation its grasp: tried.
  /// The least set; none when an operation has no grasp; the last one that was rehearsed where none goes through.
  std::optional<MinimalGrippersResult> set;
  std::vector<std::string> met;  ///< What each operation's rehearsal with `set` met; empty: nothing, or no set.
  /// Grasps that a rehearsal refused, in that order. They were left out of the choice of the sets that followed, with
  /// whatever gripper: the last set is the least for the others.
  std::vector<RefusedGrasp> left_out;
  int rehearsals = 0;  ///< So many sets were rehearsed.
};

/// The least set of grippers that puts an assembly together (P1 chapter 5), from meshes and an order.
///
///     const auto result = plan_grippers(operations, {{"air chuck", 3, 0.008}, {"jaws", 2, 0.03}});
///     for (const Gripper& gripper : result.set->grippers) gripper.to_urdf("grippers/" + gripper.name);
///
/// Each part that is moved is cut into segments, each segment is given its primitive (boxes are for two jaws, cylinders
/// for three centric fingers, 5.2.1), and each grasp of it the finger lengths with which nothing is met over the whole
/// operation (5.3). Then the least set is chosen (5.3.4), and every operation is gone through again with the gripper
/// itself, by the collision checker; where that meets something, the set is chosen again without the grasp. Of several
/// segments and depths that no more grippers could take, the one is taken on which the insertion bears most evenly,
/// then the one held most safely, then the one touched on most surface. Throws InvalidInput for wrong operations (names
/// must differ, no part is moved twice), actuators, surface to keep off or options (tips that end farther from the end
/// of a part than any is large); what cannot be held is an answer.
MMGRASP_EXPORT PlanGrippersResult plan_grippers(const std::vector<AssemblyOperation>& operations,
                                                const std::vector<GripperActuator>& actuators,
                                                const std::vector<KeepOff>& keep_off = {},
                                                const PlanGrippersOptions& options = {}, const Monitor& monitor = {});

/// The grasps that plan_grippers() tries of a segment, in the frame of the active subassembly; fingers open as
/// far, and the palm is as wide, as the longest stroke asks. `actuators`: those with the fingers that suit the
/// primitive count; plan_grippers() asks for the drives of each stroke by themselves. Without one, or where fingers do
/// not suit it, there are none.
MMGRASP_EXPORT std::vector<AssemblyGrasp> assembly_grasps(const PlacedMesh& part, const MeshSegment& segment,
                                                          const FittedPrimitive& primitive,
                                                          const std::vector<GripperActuator>& actuators,
                                                          const PlanGrippersOptions& options = {});

}  // namespace mmgrasp
