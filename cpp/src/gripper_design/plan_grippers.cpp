// The least set of grippers of an assembly: segments, grasps under assembly constraints, the set, the rehearsal.
#include "mmgrasp/gripper_design/plan_grippers.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "gripper_design/gripper_candidates.hpp"
#include "gripper_design/segment_judgement.hpp"
#include "mmgrasp/core/detail/near_name.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/geometry/detail/inside_out.hpp"
#include "mmgrasp/gripper_design/operation_overlap.hpp"
#include "mmgrasp/gripper_design/rehearse_operation.hpp"

namespace mmgrasp {
namespace {

using namespace detail;

constexpr double kLeastPad = 1e-6;  // Narrower ones are edges [m].

std::string millimetres(double length) {
  std::ostringstream out;
  out.precision(4);
  out << 1e3 * length << " mm";
  return out.str();
}

/// To 0.01 mm, up (`side` 1) or down (-1).
std::string rounded(double length, int side) {
  std::ostringstream out;
  out.precision(8);
  out << side * std::ceil(1e5 * side * length - 1e-6) / 100 << " mm";
  return out.str();
}

void check_operations(const std::vector<AssemblyOperation>& operations) {
  if (operations.empty()) throw InvalidInput("operations is empty: name at least one");
  std::set<std::string> names;
  std::map<std::string, const TriangleMesh*> moved;
  for (const AssemblyOperation& o : operations) {
    if (o.name.empty()) throw InvalidInput("name of an operation is empty: every operation must have one");
    if (!names.insert(o.name).second)
      throw InvalidInput("operation '" + o.name + "' is there twice: names must differ");
    o.check();
    for (const PlacedMesh& part : o.active) {
      if (part.name.empty()) throw InvalidInput("operation '" + o.name + "': a part has no name");
      if (!moved.emplace(part.name, part.mesh.get()).second)
        throw InvalidInput("operation '" + o.name + "': part '" + part.name +
                           "' was brought to its place before: an order names a part once");
      for (const PlacedMesh& other : o.passive)
        if (other.name == part.name)
          throw InvalidInput("operation '" + o.name + "': part '" + part.name + "' cannot be moved and stay");
    }
  }
}

/// What is wrong with surface to keep off is told with who asked for it.
template <typename Work>
void told_with_source(const KeepOff& k, const Work& work) {
  try {
    work();
  } catch (const InvalidInput& e) {
    if (k.source.empty()) throw;
    throw InvalidInput(k.source + ": " + e.what());
  }
}

/// The number of a part's segment by its name, which may have the part's before it.
int segment_called(const std::string& name, const std::string& part, const std::vector<std::string>& names) {
  const bool full = name.compare(0, part.size() + 1, part + "/") == 0;
  const std::string own = full ? name.substr(part.size() + 1) : name;
  const auto at = std::find(names.begin(), names.end(), own);
  std::string all;
  for (const std::string& n : names) all += (all.empty() ? "" : ", ") + n;
  require(at != names.end(), "keep_off of part '" + part + "'", name,
          "must be the name of one of its segments, " + all + near_miss(own, names));
  return static_cast<int>(at - names.begin());
}

MinimalGrippersOptions set_options(const PlanGrippersOptions& options) {
  MinimalGrippersOptions out;
  out.shortest_finger = options.shortest_finger;
  out.longest_finger = options.longest_finger;
  out.opening_margin = options.opening_margin;
  out.length_margin = options.length_margin;
  out.finger_width = options.finger_width;
  out.finger_thickness = options.finger_thickness;
  out.change_cost = options.change_cost;
  out.max_nodes = options.max_nodes;
  out.time_limit = options.time_limit;
  return out;
}

/// Higher where the rank is better; equal ranks are worth the same.
std::vector<double> values_of(const std::vector<GraspRank>& ranks) {
  std::vector<GraspRank> order = ranks;
  std::sort(order.begin(), order.end(), std::greater<>());
  order.erase(std::unique(order.begin(), order.end()), order.end());
  std::vector<double> out;
  for (const GraspRank& r : ranks)
    out.push_back(
        static_cast<double>(std::lower_bound(order.begin(), order.end(), r, std::greater<>()) - order.begin()));
  return out;
}

/// The operations, with open meshes that are inside out turned outwards: pads look for outward faces.
class OutwardOperations {
 public:
  explicit OutwardOperations(std::vector<AssemblyOperation> operations) : operations_(std::move(operations)) {
    for (AssemblyOperation& o : operations_) {
      turn(o.active);
      turn(o.passive);
    }
  }

  const std::vector<AssemblyOperation>& operations() const { return operations_; }
  bool turned(const TriangleMesh* mesh) const { return turned_.count(mesh) > 0; }

 private:
  void turn(std::vector<PlacedMesh>& parts) {
    for (PlacedMesh& part : parts) {
      std::shared_ptr<const TriangleMesh>& outward = outward_[part.mesh];
      if (!outward) outward = turned_outwards(part.mesh);
      if (outward != part.mesh) turned_.insert(outward.get());
      part.mesh = outward;
    }
  }

  std::vector<AssemblyOperation> operations_;
  std::map<std::shared_ptr<const TriangleMesh>, std::shared_ptr<const TriangleMesh>> outward_;
  std::set<const TriangleMesh*> turned_;
};

class Planning {
 public:
  Planning(const OutwardOperations& outward, const std::vector<GripperActuator>& actuators,
           const PlanGrippersOptions& options, const Monitor& monitor)
      : outward_(outward),
        operations_(outward.operations()),
        actuators_(actuators),
        options_(options),
        monitor_(monitor) {}

  PlanGrippersResult run(const std::vector<KeepOff>& keep_off) {
    find_boxes(keep_off);
    segment_parts();
    if (monitor_.stopped()) return std::move(result_);
    find_segments(keep_off);
    for (std::size_t i = 0; i < operations_.size() && !monitor_.stopped(); ++i) {
      monitor_.report("grasps", static_cast<double>(i) / operations_.size());
      judge(operations_[i]);
    }
    if (monitor_.stopped()) return std::move(result_);
    result_.outcome = impossible_ ? Outcome::infeasible : Outcome::not_found;
    if (!result_.missing.empty()) return std::move(result_);
    result_.set =
        preferred_grippers(result_.requirements, values_of(ranks_), actuators_, set_options(options_), monitor_);
    result_.outcome = result_.set->outcome;
    if (result_.set->grippers.empty()) return std::move(result_);
    if (options_.holding) judge_real_pads();
    rehearse();
    return std::move(result_);
  }

 private:
  void segment_parts() {
    std::vector<const PlacedMesh*> moved;
    for (const AssemblyOperation& o : operations_)
      for (const PlacedMesh& part : o.active) moved.push_back(&part);
    std::map<const TriangleMesh*, const SegmentedPart*> known;
    for (std::size_t i = 0; i < moved.size() && !monitor_.stopped(); ++i) {
      monitor_.report("segments", static_cast<double>(i) / moved.size());
      SegmentedPart& out = result_.parts[moved[i]->name];
      const auto [place, is_new] = known.emplace(moved[i]->mesh.get(), &out);
      if (!is_new) {
        out = *place->second;
        continue;
      }
      Monitor silent;
      silent.stop = monitor_.stop;
      MeshSegmentationOptions segmentation;
      segmentation.diameter.threads = options_.threads;
      out.segmentation = segment_mesh(*moved[i]->mesh, segmentation, silent);
      out.segmentation.turned = outward_.turned(moved[i]->mesh.get());
      if (monitor_.stopped()) return;
      const MeshSegmentation& cut = out.segmentation;
      out.primitives = fit_primitives(*moved[i]->mesh, cut.labels, cut.threads, silent);
    }
  }

  /// Before any work: parts that are known, boxes with surface in them.
  void find_boxes(const std::vector<KeepOff>& keep_off) {
    for (const KeepOff& k : keep_off) told_with_source(k, [&] { find_boxes_of(k); });
  }

  void find_boxes_of(const KeepOff& k) {
    const TriangleMesh* mesh = mesh_of(k.part);
    if (mesh == nullptr) require_known(k.part);
    for (const KeepOffBox& box : k.boxes) {
      box.check();
      if (mesh == nullptr) continue;  // It stays: no finger takes it.
      const SurfacePieces in_box = surface_in_box(*mesh, box);
      if (in_box.empty())
        throw InvalidInput("keep_off of part '" + k.part + "': a box has nothing of its surface in it");
      add_pieces(k.part, in_box);
    }
  }

  void find_segments(const std::vector<KeepOff>& keep_off) {
    for (const KeepOff& k : keep_off) told_with_source(k, [&] { find_segments_of(k); });
  }

  void find_segments_of(const KeepOff& k) {
    const auto found = result_.parts.find(k.part);
    if (found == result_.parts.end()) return;
    const std::vector<MeshSegment>& all = found->second.segmentation.segments;
    const std::vector<std::string> names = segment_names(found->second.primitives);
    std::vector<int> chosen = k.segments;
    for (const std::string& name : k.names) chosen.push_back(segment_called(name, k.part, names));
    for (const int s : chosen) {
      require(s >= 0 && s < static_cast<int>(all.size()), "keep_off of part '" + k.part + "'", s,
              "must be the number of one of its " + std::to_string(all.size()) + " segments");
      add_pieces(k.part, surface_of_faces(*mesh_of(k.part), all[s].faces));
      untouchable_.emplace(k.part, s);
    }
  }

  void add_pieces(const std::string& part, const SurfacePieces& more) {
    SurfacePieces& pieces = keep_off_[part];
    pieces.insert(pieces.end(), more.begin(), more.end());
  }

  void require_known(const std::string& name) const {
    for (const AssemblyOperation& o : operations_)
      for (const PlacedMesh& part : o.passive)
        if (part.name == name) return;
    throw InvalidInput("keep_off: '" + name + "' is no part of an operation");
  }

  const TriangleMesh* mesh_of(const std::string& name) const {
    for (const AssemblyOperation& o : operations_)
      for (const PlacedMesh& part : o.active)
        if (part.name == name) return part.mesh.get();
    return nullptr;
  }

  void judge(const AssemblyOperation& operation) {
    const OperationOverlap overlap = operation_overlap(operation, options_.max_overlap, monitor_);
    if (overlap.depth > options_.max_overlap) {
      const std::string when =
          overlap.before_end == 0 ? "at its end" : millimetres(overlap.before_end) + " before its end";
      result_.missing.push_back(operation.name + ": " + overlap.active + " stands " + millimetres(overlap.depth) +
                                " deep in " + overlap.passive + " " + when + " (max_overlap is " +
                                millimetres(options_.max_overlap) + ")");
      impossible_ = true;
      return;
    }
    std::optional<OperationLoad> load;
    if (options_.holding) load = loads_[operation.name] = operation_load(operation, *options_.holding);
    const Judgement by{operation, actuators_, options_, load, keep_off_};
    const std::size_t first = result_.fates.size(), before = result_.requirements.size();
    Remedy remedy;
    for (const PlacedMesh& part : operation.active) {
      const SegmentedPart& segmented = result_.parts.at(part.name);
      const std::vector<std::string> names = segment_names(segmented.primitives);
      for (int s = 0; s < static_cast<int>(segmented.primitives.size()) && !monitor_.stopped(); ++s) {
        SegmentFate fate;
        fate.step = operation.name;
        fate.part = part.name;
        fate.segment = s;
        fate.name = names[s];
        keep(judge_or_refuse(by, part, segmented, fate, remedy), fate);
        result_.fates.push_back(std::move(fate));
      }
    }
    if (result_.requirements.size() == before && !monitor_.stopped()) tell_missing(operation, first, remedy);
  }

  std::vector<FreeGrasp> judge_or_refuse(const Judgement& by, const PlacedMesh& part, const SegmentedPart& segmented,
                                         SegmentFate& fate, Remedy& remedy) {
    if (untouchable_.count({part.name, fate.segment}) == 0)
      return judge_segment(by, part, segmented, fate, remedy, monitor_);
    fate.kind = primitive_kind_name(segmented.primitives[fate.segment].kind);
    fate.fingers = fingers_for(segmented.primitives[fate.segment].kind);
    fate.refused = "not to be touched";
    return {};
  }

  void keep(std::vector<FreeGrasp> found, SegmentFate& fate) {
    for (FreeGrasp& f : found) {
      fate.requirements.push_back(static_cast<int>(result_.requirements.size()));
      result_.requirements.push_back({fate.step, fate.part + "/" + fate.name, fate.fingers,
                                      1e-6 * std::round(1e6 * f.grasp.opening), f.lengths.shortest, f.lengths.longest,
                                      f.grasp.clearance});
      result_.grasps.push_back(std::move(f.grasp));
      if (options_.holding) result_.holdings.push_back(f.held);
      ranks_.push_back(f.rank);
    }
  }

  void tell_missing(const AssemblyOperation& operation, std::size_t first, const Remedy& remedy) {
    std::string why = operation.name + ": no segment can be held";
    // Grasps are tried in steps: only where there are none to try, it is proven that there is none.
    const auto tried = [](const SegmentFate& f) { return f.tried > 0; };
    if (std::none_of(result_.fates.begin() + static_cast<std::ptrdiff_t>(first), result_.fates.end(), tried))
      impossible_ = true;
    for (std::size_t i = first; i < result_.fates.size(); ++i) {
      const SegmentFate& f = result_.fates[i];
      why += "; " + f.part + "/" + f.name + ": " + f.refused;
    }
    result_.missing.push_back(why);
    const auto help = [&](const std::string& what) { result_.help.push_back(operation.name + ": " + what); };
    if (remedy.longest_finger >= 0) help("fingers of " + rounded(remedy.longest_finger, 1) + " would do");
    if (remedy.shortest_finger > 0) help("fingers as short as " + rounded(remedy.shortest_finger, -1) + " would do");
    if (remedy.min_contact > 0) help("a min_contact of " + rounded(remedy.min_contact, -1) + " would do");
    for (const auto& [fingers, drive] : remedy.drives)
      help("a drive with " + std::to_string(fingers) + " fingers, a stroke of " + rounded(drive.stroke, 1) +
           " and an opening of up to " + rounded(drive.max_opening, 1) + " would do");
  }

  /// Grasps were judged with pads as wide as fingers may be: now with those of the grippers that were chosen. Pads of
  /// centric fingers are the wider the less these close, which is made use of where a part would slip.
  void judge_real_pads() {
    MinimalGrippersResult& set = *result_.set;
    for (std::size_t g = 0; g < set.grippers.size(); ++g) {
      if (slipping(g)) close_less(g);
    }
    for (std::size_t i = 0; i < operations_.size(); ++i) {
      const std::size_t taken = set.requirement_of_part[i];
      result_.grasps[taken] = with_real_pad(i);
      result_.holdings[taken] = held_load(result_.grasps[taken], loads_.at(operations_[i].name));
    }
  }

  AssemblyGrasp with_real_pad(std::size_t operation) const {
    const MinimalGrippersResult& set = *result_.set;
    AssemblyGrasp grasp = result_.grasps[set.requirement_of_part[operation]];
    const double width = set.grippers[set.gripper_of_part[operation]].pad_width();
    grasp.contact_width = std::min(grasp.contact_width, std::max(width, kLeastPad));
    return grasp;
  }

  bool slips(std::size_t operation) const {
    const HeldLoad held = held_load(with_real_pad(operation), loads_.at(operations_[operation].name));
    return held.safety < options_.holding->least_safety;
  }

  bool slipping(std::size_t gripper) const {
    for (std::size_t i = 0; i < operations_.size(); ++i)
      if (result_.set->gripper_of_part[i] == static_cast<int>(gripper) && slips(i)) return true;
    return false;
  }

  /// Mounts a gripper's fingers as wide apart as the margins of what it takes let it.
  void close_less(std::size_t gripper) {
    MinimalGrippersResult& set = *result_.set;
    Gripper& g = set.grippers[gripper];
    const double stroke = g.max_opening - g.min_opening;
    double lowest = kInfinity;
    for (std::size_t i = 0; i < operations_.size(); ++i) {
      if (set.gripper_of_part[i] != static_cast<int>(gripper)) continue;
      const SegmentRequirement& r = result_.requirements[set.requirement_of_part[i]];
      lowest = std::min(lowest, required_range(r, set_options(options_)).lowest);
    }
    for (const GripperActuator& a : actuators_)
      if (a.name == g.actuator) lowest = std::min(lowest, a.max_opening - a.stroke);
    g.min_opening = std::max(g.min_opening, lowest);
    g.max_opening = g.min_opening + stroke;
  }

  /// What became of an operation with the gripper chosen for it.
  std::string gone_through(std::size_t operation) const {
    const MinimalGrippersResult& set = *result_.set;
    const Gripper& gripper = set.grippers[set.gripper_of_part[operation]];
    if (options_.holding && slips(operation))
      return "pads slip: those of " + gripper.name + ", " + millimetres(gripper.pad_width()) +
             " wide, do not hold weight and insertion";
    return rehearse_operation(gripper, result_.grasps[set.requirement_of_part[operation]], operations_[operation]);
  }

  void rehearse() {
    result_.met.resize(operations_.size());
    Monitor silent;
    silent.stop = monitor_.stop;
    const auto work = [&](std::size_t i, int) { result_.met[i] = gone_through(i); };
    if (!parallel_for(operations_.size(), options_.threads, work, monitor_, "rehearsal")) {
      result_.outcome = Outcome::stopped;
      result_.met.clear();  // What was not gone through has not met nothing.
      return;
    }
    const bool met = std::any_of(result_.met.begin(), result_.met.end(), [](const auto& m) { return !m.empty(); });
    if (met) result_.outcome = Outcome::not_found;
  }

  const OutwardOperations& outward_;
  const std::vector<AssemblyOperation>& operations_;
  const std::vector<GripperActuator>& actuators_;
  const PlanGrippersOptions& options_;
  const Monitor& monitor_;
  std::map<std::string, SurfacePieces> keep_off_;
  std::set<std::pair<std::string, int>> untouchable_;
  std::vector<GraspRank> ranks_;
  std::map<std::string, OperationLoad> loads_;  // Keys are operations; only where holding is asked.
  bool impossible_ = false;                     // Some operation, whatever grasps are tried.
  PlanGrippersResult result_;
};

}  // namespace

void PlanGrippersOptions::check() const {
  set_options(*this).check();
  const auto positive = [](const char* field, double value) { require_positive(value, field, "m"); };
  positive("min_contact", min_contact);
  require_not_negative(clearance, "clearance", "m");
  require_not_negative(tip_clearance, "tip_clearance", "m");
  require_not_negative(max_overlap, "max_overlap", "m");
  require(directions >= 1 && directions <= 360, "directions", directions, "must be from 1 to 360");
  resolve_threads(threads);  // refuses what is no number of threads
  if (holding) holding->check();
}

PlanGrippersResult plan_grippers(const std::vector<AssemblyOperation>& operations,
                                 const std::vector<GripperActuator>& actuators, const std::vector<KeepOff>& keep_off,
                                 const PlanGrippersOptions& options, const Monitor& monitor) {
  options.check();
  check_operations(operations);
  check_actuators(actuators);
  const OutwardOperations outward(operations);
  return Planning(outward, actuators, options, monitor).run(keep_off);
}

}  // namespace mmgrasp
