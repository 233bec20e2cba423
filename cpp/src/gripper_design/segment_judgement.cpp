// Which grasps of a segment go through an operation, with which finger lengths, and what the others fell by.
#include "gripper_design/segment_judgement.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

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
constexpr double kLeastContact = 5e-4;  // Thinner segments are not told to be held by less contact [m].

std::string millimetres(double length) {
  std::ostringstream out;
  out.precision(4);
  out << 1e3 * length << " mm";
  return out.str();
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

GraspRank rank_of(const AssemblyGrasp& grasp, const std::optional<OperationLoad>& load, const HeldLoad& held) {
  if (!load) return {0, 0, -rounded(grasp.contact_length * grasp.contact_width, 1e-8)};
  return {rounded(held.insertion_moment, 1e-4), -rounded(std::min(held.safety, 1e6), 1e-3),
          -rounded(held.contact_area, 1e-8)};
}

Tried try_grasp(const Judgement& by, const AssemblyGrasp& grasp, const SurfacePieces& keep_off) {
  Tried out;
  out.found.grasp = grasp;
  if (pads_touch(grasp, keep_off)) {
    out.fell_by = "pads lie on surface that is not to be touched";
    return out;
  }
  if (by.load) out.found.held = held_load(grasp, *by.load);
  if (by.load && out.found.held.safety < by.options.holding->least_safety) {
    out.fell_by = "pads slip: the grasp does not hold weight and insertion";
    return out;
  }
  out.found.rank = rank_of(grasp, by.load, out.found.held);
  const FingerLengthRange lengths = finger_length_range(grasp, by.operation);
  out.found.lengths = lengths;
  const double margin = by.options.length_margin;
  const double shortest = lengths.shortest + margin, longest = lengths.longest - margin;
  if (!lengths.free || shortest > longest) {
    const bool by_finger = !lengths.longest_by.empty();
    out.fell_by = by_finger ? "fingers meet " + lengths.longest_by : "the palm meets " + lengths.shortest_by;
  } else if (shortest > by.options.longest_finger) {
    out.fell_by = "fingers of " + millimetres(shortest) + " or more are asked by " + lengths.shortest_by +
                  ", longest is " + millimetres(by.options.longest_finger);
    if (longest >= by.options.shortest_finger) out.longest_needed = shortest;
  } else if (longest < by.options.shortest_finger) {
    out.fell_by = "fingers of " + millimetres(longest) + " or less are asked by " + lengths.longest_by +
                  ", shortest is " + millimetres(by.options.shortest_finger);
    out.shortest_needed = longest;
  }
  return out;
}

bool held_by_another(const FreeGrasp& f, const FreeGrasp& other) {
  return std::abs(other.grasp.opening - f.grasp.opening) < kSameOpening &&
         other.lengths.shortest <= f.lengths.shortest && other.lengths.longest >= f.lengths.longest &&
         other.rank <= f.rank;
}

std::vector<FreeGrasp> undominated(std::vector<FreeGrasp> found) {
  const auto key = [](const FreeGrasp& f) {
    return std::make_tuple(rounded(f.grasp.opening, 1e-6), f.lengths.shortest, -f.lengths.longest, f.rank);
  };
  std::stable_sort(found.begin(), found.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  std::vector<FreeGrasp> kept;
  for (FreeGrasp& f : found) {
    const auto better = [&](const FreeGrasp& k) { return held_by_another(f, k); };
    if (std::none_of(kept.begin(), kept.end(), better)) kept.push_back(std::move(f));
  }
  return kept;
}

/// What is wrong with a segment before any grasp is tried, or empty.
std::string unsuited(const SegmentedPart& segmented, const SegmentFate& fate) {
  if (segmented.segmentation.segments[fate.segment].threaded) return "a screw thread";
  if (fate.fingers == 0) return "a " + fate.kind + ": neither parallel jaws nor centric fingers suit it";
  return "";
}

/// The most frequent cause, with how many grasps fell by it; of equals the first.
std::string main_cause(const std::vector<Tried>& all) {
  std::vector<std::pair<std::string, int>> counts;
  for (const Tried& t : all) {
    if (t.fell_by.empty()) continue;
    const auto at = std::find_if(counts.begin(), counts.end(), [&](const auto& c) { return c.first == t.fell_by; });
    if (at == counts.end()) {
      counts.emplace_back(t.fell_by, 1);
    } else {
      ++at->second;
    }
  }
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most->first + " (" + std::to_string(most->second) + " of " + std::to_string(all.size()) + " grasps)";
}

void note_remedies(const std::vector<Tried>& all, Remedy& remedy) {
  for (const Tried& t : all) {
    if (t.longest_needed >= 0 && (remedy.longest_finger < 0 || t.longest_needed < remedy.longest_finger))
      remedy.longest_finger = t.longest_needed;
    remedy.shortest_finger = std::max(remedy.shortest_finger, t.shortest_needed);
  }
}

std::vector<Tried> try_all(const Judgement& by, const std::vector<AssemblyGrasp>& grasps, const SurfacePieces& keep_off,
                           const Monitor& monitor) {
  std::vector<Tried> out(grasps.size());
  Monitor silent;
  silent.stop = monitor.stop;
  const auto work = [&](std::size_t i, int) { out[i] = try_grasp(by, grasps[i], keep_off); };
  if (!parallel_for(grasps.size(), by.options.threads, work, silent)) out.clear();
  return out;
}

/// Stroke kept free above a part [m].
double kept_above(double clearance, const PlanGrippersOptions& options) {
  return std::max(options.opening_margin, 2 * clearance);
}

double longest_stroke(const std::vector<GripperActuator>& drives) {
  double out = 0;
  for (const GripperActuator& a : drives) out = std::max(out, a.stroke);
  return out;
}

/// The drive of least opening, not at hand, by which a segment would be taken.
void note_drive(const Judgement& by, const PlacedMesh& part, const MeshSegment& segment,
                const FittedPrimitive& primitive, const SurfacePieces& keep_off, int fingers, Remedy& remedy,
                const Monitor& monitor) {
  const double above = kept_above(by.options.clearance, by.options);
  GripperActuator drive{"", fingers, std::max(above + by.options.opening_margin, kLeastStroke)};
  for (const Tried& t :
       try_all(by, assembly_grasps(part, segment, primitive, {drive}, by.options), keep_off, monitor)) {
    if (!t.fell_by.empty()) continue;
    drive.max_opening = std::max(t.found.grasp.opening + above, drive.stroke);
    const auto [place, is_new] = remedy.drives.emplace(fingers, drive);
    if (!is_new && drive.max_opening < place->second.max_opening) place->second = drive;
  }
}

/// Whether pads could be put at a segment if they need not overlap it by `min_contact`; by how much they then may is
/// noted where something goes through the operation.
bool too_thin(const Judgement& by, const PlacedMesh& part, const MeshSegment& segment, const FittedPrimitive& primitive,
              const std::vector<GripperActuator>& drives, const SurfacePieces& keep_off, Remedy& remedy,
              const Monitor& monitor) {
  PlanGrippersOptions thin = by.options;
  thin.min_contact = std::min(kLeastContact, by.options.min_contact);
  const std::vector<AssemblyGrasp> grasps = assembly_grasps(part, segment, primitive, drives, thin);
  const Judgement judgement{by.operation, by.actuators, thin, by.load, by.keep_off};
  for (const Tried& t : try_all(judgement, grasps, keep_off, monitor))
    if (t.fell_by.empty()) remedy.min_contact = std::max(remedy.min_contact, t.found.grasp.contact_length);
  return !grasps.empty();
}

/// Why there is no grasp to try, and what would help.
std::string nothing_to_try(const Judgement& by, const PlacedMesh& part, const MeshSegment& segment,
                           const FittedPrimitive& primitive, const std::vector<GripperActuator>& drives,
                           const SurfacePieces& keep_off, int fingers, Remedy& remedy, const Monitor& monitor) {
  if (!drives.empty() && too_thin(by, part, segment, primitive, drives, keep_off, remedy, monitor))
    return "too thin: pads would overlap it by less than min_contact = " + millimetres(by.options.min_contact);
  note_drive(by, part, segment, primitive, keep_off, fingers, remedy, monitor);
  if (drives.empty()) return "no actuator has " + std::to_string(fingers) + " fingers";
  return fingers == 2 ? "no pair of opposite faces that an actuator opens wide enough for"
                      : "wider than any actuator opens";
}

}  // namespace

double kept_clearance(const std::vector<GripperActuator>& drives, const PlanGrippersOptions& options) {
  return std::clamp((longest_stroke(drives) - options.opening_margin) / 2, 0.0, options.clearance);
}

int fingers_for(PrimitiveKind kind) {
  if (kind == PrimitiveKind::box) return 2;
  return kind == PrimitiveKind::cylinder ? 3 : 0;
}

std::vector<FreeGrasp> judge_segment(const Judgement& by, const PlacedMesh& part, const SegmentedPart& segmented,
                                     SegmentFate& fate, Remedy& remedy, const Monitor& monitor) {
  const MeshSegment& segment = segmented.segmentation.segments[fate.segment];
  const FittedPrimitive& primitive = segmented.primitives[fate.segment];
  fate.kind = primitive_kind_name(primitive.kind);
  fate.fingers = fingers_for(primitive.kind);
  fate.refused = unsuited(segmented, fate);
  if (!fate.refused.empty()) return {};
  SurfacePieces keep_off;
  if (const auto found = by.keep_off.find(part.name); found != by.keep_off.end()) keep_off = found->second;
  for (auto& piece : keep_off)
    for (Eigen::Vector3d& p : piece) p = part.pose * p;
  const std::vector<GripperActuator> drives = with_fingers(by.actuators, fate.fingers);
  const std::vector<AssemblyGrasp> grasps = assembly_grasps(part, segment, primitive, drives, by.options);
  const std::vector<Tried> all = try_all(by, grasps, keep_off, monitor);
  fate.tried = static_cast<int>(all.size());
  std::vector<FreeGrasp> found;
  for (const Tried& t : all)
    if (t.fell_by.empty()) found.push_back(t.found);
  fate.free = static_cast<int>(found.size());
  if (!found.empty()) return undominated(std::move(found));
  note_remedies(all, remedy);
  fate.refused = !all.empty()
                     ? main_cause(all)
                     : nothing_to_try(by, part, segment, primitive, drives, keep_off, fate.fingers, remedy, monitor);
  return {};
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
  choice.max_opening = std::max(widest(drives) - kept_above(choice.clearance, options), 1e-6);
  const double half = primitive.size.z() / 2;
  std::vector<AssemblyGrasp> grasps =
      fingers == 2 ? jaw_grasps(*part.mesh, segment.faces, choice)
                   : centric_grasps(*part.mesh, segment.faces,
                                    {primitive.T_mesh_primitive, primitive.size.x(), -half, half}, choice);
  for (AssemblyGrasp& grasp : grasps) {
    const double reach = (grasp.opening + stroke) / 2 + grasp.thickness;
    grasp.T_active_tool = part.pose * grasp.T_active_tool;
    grasp.palm_radius = std::hypot(reach, grasp.width / 2) + kPalmMargin;
  }
  return grasps;
}

}  // namespace mmgrasp
