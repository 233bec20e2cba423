// Which grasps of a segment go through an operation, with which finger lengths, and what the others fell by.
#include "gripper_design/segment_judgement.hpp"

#include <algorithm>
#include <cmath>

#include "gripper_design/counted_texts.hpp"
#include "gripper_design/gripper_candidates.hpp"
#include "gripper_design/millimetres.hpp"
#include "gripper_design/set_options.hpp"
#include "mmgrasp/core/detail/lengths.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/grasp/assembly_grasps.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kPalmMargin = 0.005;   // The palm reaches beyond the open fingers by this [m].
constexpr double kPad = 0.02;           // Length of a pad along the approach [m].
constexpr double kAnyOpening = 2.0;     // [m]
constexpr double kLeastStroke = 0.001;  // [m]
constexpr double kSameOpening = 2e-5;   // Rough faces give each grasp an opening of its own: alike within this [m].
constexpr double kOpeningStep = 1e-6;   // [m]
constexpr double kLeastPad = 1e-6;      // Narrower ones are edges [m].
constexpr double kLeastContact = 5e-4;  // Thinner segments are not told to be held by less contact [m].

bool is_shorter(const GripperActuator& a, const GripperActuator& b) {
  return a.stroke < b.stroke;
}

/// Drives with so many fingers, in groups of one stroke.
std::vector<std::vector<GripperActuator>> by_stroke(std::vector<GripperActuator> drives) {
  std::stable_sort(drives.begin(), drives.end(), is_shorter);
  std::vector<std::vector<GripperActuator>> out;
  for (const GripperActuator& a : drives) {
    if (out.empty() || !at_most(a.stroke, out.back().front().stroke)) out.emplace_back();
    out.back().push_back(a);
  }
  return out;
}

std::vector<GripperActuator> with_fingers(const std::vector<GripperActuator>& actuators, int fingers) {
  std::vector<GripperActuator> out;
  for (const GripperActuator& a : actuators)
    if (a.fingers == fingers) out.push_back(a);
  return out;
}

double widest(const std::vector<GripperActuator>& drives) {
  double out = 0;
  for (const GripperActuator& a : drives) out = std::max(out, std::min(a.max_opening, kAnyOpening));
  return out;
}

/// How one grasp fared.
struct Tried {
  std::string fell_by;  // Empty: free.
  FreeGrasp found;
  double longest_needed = Remedy::kNone, shortest_needed = Remedy::kNone;
};

double rounded(double value, double step) {
  return step * std::round(value / step);
}

GraspRank rank_of(const AssemblyGrasp& grasp, const OperationLoad* load, const HeldLoad& held) {
  if (!load) return {0, 0, -rounded(grasp.contact_length * grasp.contact_width, 1e-8)};
  return {rounded(held.insertion_moment, 1e-4), -rounded(std::min(held.safety, 1e6), 1e-3),
          -rounded(held.contact_area, 1e-8)};
}

/// How far a gripper may close for its pads to be wide enough to hold the load; none: they never are. Pads are the
/// wider the less it closes, and hold the more.
std::optional<double> least_min_opening(const Judgement& by, const AssemblyGrasp& grasp) {
  const auto holds = [&](double min_opening) {
    Gripper gripper;
    gripper.fingers = grasp.fingers;
    gripper.min_opening = min_opening;
    gripper.finger_width = by.options.finger_width;
    return held_load(with_real_pad(grasp, gripper), *by.load).safety >= by.options.holding->least_safety;
  };
  const double most = std::max(0.0, asked_opening(grasp) - by.options.opening_margin);
  if (holds(0)) return 0;
  if (!holds(most)) return std::nullopt;
  double slips = 0, held = most;
  while (held - slips > kSameLength) {
    const double between = (slips + held) / 2;
    (holds(between) ? held : slips) = between;
  }
  return std::min(held + kSameLength, most);  // Openings that are less by roundings hold, too.
}

Tried try_grasp(const Judgement& by, const AssemblyGrasp& grasp, const SurfacePieces& keep_off) {
  Tried out;
  out.found.grasp = grasp;
  if (pads_touch(grasp, keep_off)) {
    out.fell_by = "pads lie on surface that is not to be touched";
    return out;
  }
  if (by.load) out.found.held = held_load(grasp, *by.load);
  const std::optional<double> closes_to = by.load ? least_min_opening(by, grasp) : 0;
  if (closes_to) out.found.least_min_opening = *closes_to;
  if (!closes_to) {
    out.fell_by = "pads slip: the grasp does not hold weight and insertion";
    return out;
  }
  out.found.rank = rank_of(grasp, by.load, out.found.held);
  const FingerLengthRange lengths = finger_length_range(grasp, by.operation);
  out.found.lengths = lengths;
  const double margin = by.options.length_margin;
  const double shortest = lengths.shortest + margin, longest = lengths.longest - margin;
  if (!lengths.free || !at_most(shortest, longest)) {
    const bool by_finger = !lengths.longest_by.empty();
    out.fell_by = by_finger ? "fingers meet " + lengths.longest_by : "the palm meets " + lengths.shortest_by;
  } else if (!at_most(shortest, by.options.longest_finger)) {
    out.fell_by = "fingers of " + millimetres(shortest) + " or more are asked by " + lengths.shortest_by +
                  ", longest is " + millimetres(by.options.longest_finger);
    if (at_most(by.options.shortest_finger, longest)) out.longest_needed = shortest;
  } else if (!at_most(by.options.shortest_finger, longest)) {
    out.fell_by = "fingers of " + millimetres(longest) + " or less are asked by " + lengths.longest_by +
                  ", shortest is " + millimetres(by.options.shortest_finger);
    out.shortest_needed = longest;
  }
  return out;
}

bool held_by_another(const FreeGrasp& f, const FreeGrasp& other) {
  return std::abs(other.grasp.opening - f.grasp.opening) < kSameOpening &&
         other.lengths.shortest <= f.lengths.shortest && other.lengths.longest >= f.lengths.longest &&
         other.least_min_opening <= f.least_min_opening && other.rank <= f.rank && other.max_stroke >= f.max_stroke &&
         other.grasp.clearance <= f.grasp.clearance;
}

/// One segment of a part that an operation moves.
struct SegmentToHold {
  const PlacedMesh& part;
  const MeshSegment& segment;
  const FittedPrimitive& primitive;
  int fingers = 0;         // 2, 3, or 0: none suit it.
  SurfacePieces keep_off;  // Seen from the active subassembly.
};

SegmentToHold segment_to_hold(const Judgement& by, const PlacedMesh& part, int number) {
  const SegmentedPart& segmented = by.parts.at(part.name);
  const FittedPrimitive& primitive = segmented.primitives[number];
  SegmentToHold out{part, segmented.segmentation.segments[number], primitive, fingers_for(primitive.kind), {}};
  if (const auto found = by.keep_off.find(part.name); found != by.keep_off.end()) out.keep_off = found->second;
  for (auto& piece : out.keep_off)
    for (Eigen::Vector3d& p : piece) p = part.pose * p;
  return out;
}

/// What is wrong with a segment before any grasp is tried, or empty.
std::string unsuited(const Judgement& by, const SegmentToHold& segment, const std::string& part, int number) {
  if (by.untouchable.count({part, number}) > 0) return "not to be touched";
  if (segment.segment.threaded) return "a screw thread";
  if (segment.fingers == 0)
    return std::string("a ") + primitive_kind_name(segment.primitive.kind) +
           ": neither parallel jaws nor centric fingers suit it";
  return "";
}

std::vector<FreeGrasp> free_ones(const std::vector<Tried>& all) {
  std::vector<FreeGrasp> out;
  for (const Tried& t : all)
    if (t.fell_by.empty()) out.push_back(t.found);
  return out;
}

/// The most frequent cause, with how many grasps fell by it; of equals the first.
std::string main_cause(const std::vector<Tried>& all) {
  CountedTexts causes;
  for (const Tried& t : all)
    if (!t.fell_by.empty()) causes.add(t.fell_by);
  const auto& [cause, count] = causes.most();
  return cause + " (" + std::to_string(count) + " of " + std::to_string(all.size()) + " grasps)";
}

void note_remedies(const std::vector<Tried>& all, Remedy& remedy) {
  for (const Tried& t : all) {
    if (t.longest_needed >= 0 && (remedy.longest_finger < 0 || t.longest_needed < remedy.longest_finger))
      remedy.longest_finger = t.longest_needed;
    remedy.shortest_finger = std::max(remedy.shortest_finger, t.shortest_needed);
  }
}

/// Tries the grasps of a segment by drives of each stroke: how far fingers open and how wide the palm is hang on it,
/// and a drive must not be judged by what a longer one at hand would do. Returns nothing once stopped.
std::vector<Tried> try_all(const Judgement& by, const SegmentToHold& segment,
                           const std::vector<GripperActuator>& drives, const Monitor& monitor) {
  std::vector<Tried> out;
  Monitor silent;
  silent.stop = monitor.stop;
  for (const std::vector<GripperActuator>& alike : by_stroke(drives)) {
    const std::vector<AssemblyGrasp> grasps =
        assembly_grasps(segment.part, segment.segment, segment.primitive, alike, by.options);
    std::vector<Tried> tried(grasps.size());
    const auto work = [&](std::size_t i, int) {
      tried[i] = try_grasp(by, grasps[i], segment.keep_off);
      tried[i].found.max_stroke = alike.back().stroke;
    };
    if (!parallel_for(grasps.size(), by.options.threads, work, silent)) return {};
    out.insert(out.end(), std::make_move_iterator(tried.begin()), std::make_move_iterator(tried.end()));
  }
  return out;
}

double longest_stroke(const std::vector<GripperActuator>& drives) {
  double out = 0;
  for (const GripperActuator& a : drives) out = std::max(out, a.stroke);
  return out;
}

/// The narrowest drive of a stroke with which a grasp of a segment is free; none: no grasp is.
std::optional<GripperActuator> narrowest_drive(const Judgement& by, const SegmentToHold& segment, double stroke,
                                               const Monitor& monitor) {
  GripperActuator drive{"", segment.fingers, stroke};
  const std::vector<Tried> all = try_all(by, segment, {drive}, monitor);
  drive.max_opening = kInfinity;
  for (const Tried& t : all) {
    if (!t.fell_by.empty()) continue;
    const double above = kept_above(t.found.grasp.clearance, by.options.opening_margin);
    drive.max_opening = std::min(drive.max_opening, std::max(asked_opening(t.found.grasp) + above, stroke));
  }
  if (drive.max_opening == kInfinity) return std::nullopt;
  return drive;
}

/// Keeps the narrower one of drives with as many fingers.
void note_drive(const std::optional<GripperActuator>& drive, std::map<int, GripperActuator>& known) {
  if (!drive) return;
  const auto [place, is_new] = known.emplace(drive->fingers, *drive);
  if (!is_new && drive->max_opening < place->second.max_opening) place->second = *drive;
}

/// Drives, not at hand, by which a segment would be taken.
void note_drives(const Judgement& by, const SegmentToHold& segment, Remedy& remedy, const Monitor& monitor) {
  const double margin = by.options.opening_margin;
  const double whole = std::max(margin + kept_above(by.options.clearance, margin), kLeastStroke);
  note_drive(narrowest_drive(by, segment, whole, monitor), remedy.drives);
  if (margin > 0 && 2 * margin < whole)
    note_drive(narrowest_drive(by, segment, 2 * margin, monitor), remedy.short_drives);
}

/// Whether pads could be put at a segment if they need not overlap it by `min_contact`; by how much they then may is
/// noted where something goes through the operation.
bool too_thin(const Judgement& by, const SegmentToHold& segment, const std::vector<GripperActuator>& drives,
              Remedy& remedy, const Monitor& monitor) {
  PlanGrippersOptions thin = by.options;
  thin.min_contact = std::min(kLeastContact, by.options.min_contact);
  const Judgement judgement{by.operation, by.actuators, thin, by.load, by.parts, by.keep_off, by.untouchable};
  const std::vector<Tried> all = try_all(judgement, segment, drives, monitor);
  for (const Tried& t : all)
    if (t.fell_by.empty()) remedy.min_contact = std::max(remedy.min_contact, t.found.grasp.contact_length);
  return !all.empty();
}

/// Whether pads could be put at a segment by fingers that open no farther than it is wide.
bool is_as_wide_as_a_drive(const Judgement& by, const SegmentToHold& segment,
                           const std::vector<GripperActuator>& drives) {
  PlanGrippersOptions bare = by.options;
  bare.clearance = bare.opening_margin = 0;
  return !assembly_grasps(segment.part, segment.segment, segment.primitive, drives, bare).empty();
}

/// Why there is no grasp to try, and what would help.
std::string nothing_to_try(const Judgement& by, const SegmentToHold& segment,
                           const std::vector<GripperActuator>& drives, Remedy& remedy, const Monitor& monitor) {
  if (!drives.empty() && too_thin(by, segment, drives, remedy, monitor))
    return "too thin: pads would overlap it by less than min_contact = " + millimetres(by.options.min_contact);
  note_drives(by, segment, remedy, monitor);
  if (drives.empty()) return "no actuator has " + std::to_string(segment.fingers) + " fingers";
  if (is_as_wide_as_a_drive(by, segment, drives))
    return "an actuator opens as wide as it is, but not by what clearance and opening_margin ask beyond";
  return segment.fingers == 2 ? "no pair of opposite faces that an actuator opens wide enough for"
                              : "wider than any actuator opens";
}

}  // namespace

AssemblyGrasp with_real_pad(AssemblyGrasp grasp, const Gripper& gripper) {
  grasp.contact_width = std::min(grasp.contact_width, std::max(gripper.pad_width(), kLeastPad));
  return grasp;
}

double kept_clearance(const std::vector<GripperActuator>& drives, const PlanGrippersOptions& options) {
  return std::clamp((longest_stroke(drives) - options.opening_margin) / 2, 0.0, options.clearance);
}

int fingers_for(PrimitiveKind kind) {
  if (kind == PrimitiveKind::box) return 2;
  return kind == PrimitiveKind::cylinder ? 3 : 0;
}

double kept_above(double clearance, double opening_margin) {
  return std::max(opening_margin, 2 * clearance);
}

double asked_opening(const AssemblyGrasp& grasp) {
  return rounded(grasp.opening, kOpeningStep);
}

SegmentRequirement required_by(const FreeGrasp& found, const SegmentFate& fate) {
  return {fate.step,
          fate.part + "/" + fate.name,
          fate.fingers,
          asked_opening(found.grasp),
          found.lengths.shortest,
          found.lengths.longest,
          found.grasp.clearance,
          found.least_min_opening,
          found.max_stroke};
}

std::vector<FreeGrasp> undominated(std::vector<FreeGrasp> found) {
  const auto key = [](const FreeGrasp& f) {
    return std::make_tuple(asked_opening(f.grasp), f.lengths.shortest, -f.lengths.longest, f.rank, f.least_min_opening,
                           -f.max_stroke);
  };
  std::stable_sort(found.begin(), found.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  std::vector<FreeGrasp> kept;
  for (FreeGrasp& f : found) {
    const auto better =
        std::find_if(kept.begin(), kept.end(), [&](const FreeGrasp& k) { return held_by_another(f, k); });
    if (better == kept.end()) {
      kept.push_back(std::move(f));
    } else {
      better->in_reserve.push_back(std::move(f));
    }
  }
  return kept;
}

std::vector<FreeGrasp> judge_segment(const Judgement& by, const PlacedMesh& part, SegmentFate& fate, Remedy& remedy,
                                     const Monitor& monitor) {
  const SegmentToHold segment = segment_to_hold(by, part, fate.segment);
  fate.kind = primitive_kind_name(segment.primitive.kind);
  fate.fingers = segment.fingers;
  fate.refused = unsuited(by, segment, part.name, fate.segment);
  if (!fate.refused.empty()) return {};
  const std::vector<GripperActuator> drives = with_fingers(by.actuators, fate.fingers);
  const std::vector<Tried> all = try_all(by, segment, drives, monitor);
  fate.tried = static_cast<int>(all.size());
  std::vector<FreeGrasp> found = free_ones(all);
  fate.free = static_cast<int>(found.size());
  if (!found.empty()) return undominated(std::move(found));
  note_remedies(all, remedy);
  fate.refused = !all.empty() ? main_cause(all) : nothing_to_try(by, segment, drives, remedy, monitor);
  return {};
}

bool can_be_done(const Judgement& by, const Monitor& monitor) {
  const MinimalGrippersOptions asked = set_options(by.options);
  for (const PlacedMesh& part : by.operation.active) {
    const int count = static_cast<int>(by.parts.at(part.name).primitives.size());
    for (int s = 0; s < count && !monitor.stopped(); ++s) {
      const SegmentToHold segment = segment_to_hold(by, part, s);
      if (!unsuited(by, segment, part.name, s).empty()) continue;
      const std::vector<GripperActuator> drives = with_fingers(by.actuators, segment.fingers);
      SegmentFate fate;
      fate.step = by.operation.name;
      fate.fingers = segment.fingers;
      for (const FreeGrasp& f : free_ones(try_all(by, segment, drives, monitor))) {
        const RequiredRange range = required_range(required_by(f, fate), asked);
        if (std::any_of(drives.begin(), drives.end(), [&](const auto& d) { return range.can_be_met(d); })) return true;
      }
    }
  }
  return false;
}

}  // namespace mmgrasp::detail

namespace mmgrasp {

std::vector<AssemblyGrasp> assembly_grasps(const PlacedMesh& part, const MeshSegment& segment,
                                           const FittedPrimitive& primitive,
                                           const std::vector<GripperActuator>& actuators,
                                           const PlanGrippersOptions& options) {
  using namespace detail;
  options.check();
  const int fingers = fingers_for(primitive.kind);
  const std::vector<GripperActuator> drives = with_fingers(actuators, fingers);
  if (fingers == 0 || drives.empty()) return {};
  const double stroke = longest_stroke(drives);
  AssemblyGraspOptions choice;
  choice.directions = options.directions;
  choice.min_contact = options.min_contact;
  choice.tip_clearance = options.tip_clearance;
  choice.pad_length = std::max(kPad, options.min_contact);
  choice.finger_width = options.finger_width;
  choice.finger_thickness = options.finger_thickness;
  choice.clearance = kept_clearance(drives, options);
  const double above = kept_above(choice.clearance, options.opening_margin);
  choice.max_opening = std::max(widest(drives) - above + kOpeningStep, kOpeningStep);
  const double half = primitive.size.z() / 2;
  std::vector<AssemblyGrasp> grasps =
      fingers == 2 ? jaw_grasps(*part.mesh, segment.faces, choice)
                   : centric_grasps(*part.mesh, segment.faces,
                                    {primitive.T_mesh_primitive, primitive.size.x(), -half, half}, choice);
  const auto too_wide = [&](const AssemblyGrasp& g) { return !at_most(asked_opening(g) + above, widest(drives)); };
  grasps.erase(std::remove_if(grasps.begin(), grasps.end(), too_wide), grasps.end());
  for (AssemblyGrasp& grasp : grasps) {
    const double reach = (grasp.opening + stroke) / 2 + grasp.thickness;
    grasp.T_active_tool = part.pose * grasp.T_active_tool;
    grasp.palm_radius = std::hypot(reach, grasp.width / 2) + kPalmMargin;
  }
  return grasps;
}

}  // namespace mmgrasp
