#pragma once

#include <array>
#include <map>
#include <optional>
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
};

/// Single changes each of which would let one more segment be held.
struct Remedy {
  static constexpr double kNone = -1;
  double longest_finger = kNone, shortest_finger = kNone;  ///< A limit that would have to be this [m].
  double min_contact = kNone;                              ///< Pads would have to overlap by no more than this [m].
  std::map<int, GripperActuator> drives;                   ///< A drive that is not at hand, by number of fingers.
};

/// All that one operation's segments are judged by.
struct Judgement {
  const AssemblyOperation& operation;
  const std::vector<GripperActuator>& actuators;
  const PlanGrippersOptions& options;
  const std::optional<OperationLoad>& load;
  const std::map<std::string, SurfacePieces>& keep_off;  ///< Pieces by part, in its mesh's frame.
};

/// How far each finger opens with the longest of these drives: as far as asked, where the stroke allows that beside the
/// margin below the part [m].
double kept_clearance(const std::vector<GripperActuator>& drives, const PlanGrippersOptions& options);

/// 2 for a box, 3 for a cylinder, 0 for what no gripper suits (P1 5.2.1).
int fingers_for(PrimitiveKind kind);

/// Tries every grasp of a segment; those that are worth keeping: for each opening those whose lengths no other one's
/// hold, unless they are better. Returns nothing more once stopped.
std::vector<FreeGrasp> judge_segment(const Judgement& by, const PlacedMesh& part, const SegmentedPart& segmented,
                                     SegmentFate& fate, Remedy& remedy, const Monitor& monitor);

}  // namespace mmgrasp::detail
