#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/gripper_design/plan_grippers.hpp"

namespace mmgrasp::detail {

/// First how unevenly the insertion bears on the fingers, then how near they are to slipping, then how little they
/// touch: less is better.
using GraspRank = std::array<double, 3>;

/// A grasp that meets nothing, with some finger length.
struct FreeGrasp {
  AssemblyGrasp grasp;
  FingerLengthRange lengths;
  HeldLoad held;
  GraspRank rank{};
  double least_min_opening = 0;            ///< As SegmentRequirement's.
  double max_stroke = 0;                   ///< As SegmentRequirement's.
  std::vector<FreeGrasp> in_reserve = {};  ///< No better than it in any way: tried where its rehearsal meets something.
};

/// Single changes each of which would let one more segment be held.
struct Remedy {
  static constexpr double kNone = -1;
  double longest_finger = kNone, shortest_finger = kNone;  ///< A limit that would have to be this [m].
  double min_contact = kNone;                              ///< Pads would have to overlap by no more than this [m].
  /// Drives that are not at hand, by number of fingers: those that open by the whole clearance, and those of the
  /// shortest stroke. Each is the narrowest by which a segment was held.
  std::map<int, GripperActuator> drives, short_drives;
};

/// All that one operation's segments are judged by.
struct Judgement {
  const AssemblyOperation& operation;
  const std::vector<GripperActuator>& actuators;
  const PlanGrippersOptions& options;
  const OperationLoad* load;  ///< None: weight and insertion are not looked at.
  const std::map<std::string, SegmentedPart>& parts;
  const std::map<std::string, SurfacePieces>& keep_off;      ///< Pieces by part, in its mesh's frame.
  const std::set<std::pair<std::string, int>>& untouchable;  ///< Segments by part and number.
};

/// How far each finger opens with the longest of these drives: as far as asked, where the stroke allows that beside the
/// margin below the part [m].
double kept_clearance(const std::vector<GripperActuator>& drives, const PlanGrippersOptions& options);

/// 2 for a box, 3 for a cylinder, 0 for what no gripper suits (P1 5.2.1).
int fingers_for(PrimitiveKind kind);

/// A grasp by pads no wider than a gripper's, which three closed fingers may leave narrower than they are themselves.
AssemblyGrasp with_real_pad(AssemblyGrasp grasp, const Gripper& gripper);

/// The opening that a grasp asks of a gripper, in whole micrometres [m]: meshes of single precision are no better.
double asked_opening(const AssemblyGrasp& grasp);

/// What a grasp of a segment asks of a gripper.
SegmentRequirement required_by(const FreeGrasp& found, const SegmentFate& fate);

/// Stroke kept free above a part by fingers that open by a clearance to let go [m].
double kept_above(double clearance, double opening_margin);

/// Whether some grasp of the operation goes through it, and one of the drives takes that. False once stopped.
bool can_be_done(const Judgement& by, const Monitor& monitor);

/// Grasps of one segment that are worth choosing among, each with those in reserve that it does everything of: for each
/// opening those whose lengths no other one's hold, unless they are better.
std::vector<FreeGrasp> undominated(std::vector<FreeGrasp> found);

/// Tries every grasp of a segment; those that are undominated. Returns nothing more once stopped.
std::vector<FreeGrasp> judge_segment(const Judgement& by, const PlacedMesh& part, SegmentFate& fate, Remedy& remedy,
                                     const Monitor& monitor);

}  // namespace mmgrasp::detail
