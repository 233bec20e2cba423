// The least set of grippers of an assembly: segments, grasps under assembly constraints, the set, the rehearsal.
#include "mmgrasp/gripper_design/plan_grippers.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "gripper_design/advice.hpp"
#include "gripper_design/grasp_pool.hpp"
#include "gripper_design/gripper_candidates.hpp"
#include "gripper_design/millimetres.hpp"
#include "gripper_design/rehearsed_set.hpp"
#include "gripper_design/segment_judgement.hpp"
#include "gripper_design/set_options.hpp"
#include "mmgrasp/core/detail/lengths.hpp"
#include "mmgrasp/core/detail/near_name.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/geometry/detail/inside_out.hpp"
#include "mmgrasp/geometry/shape.hpp"
#include "mmgrasp/gripper_design/operation_overlap.hpp"

namespace mmgrasp {
namespace {

using namespace detail;

void check_passive(const AssemblyOperation& operation) {
  std::set<std::string> names;
  for (const PlacedMesh& part : operation.passive)
    if (!names.insert(part.name).second)
      throw InvalidInput("operation '" + operation.name + "': part '" + part.name + "' stays twice: names must differ");
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
    check_passive(o);
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

/// Tips that end short of everything hold nothing.
void check_tip_clearance(const std::vector<AssemblyOperation>& operations, const PlanGrippersOptions& options) {
  double largest = 0;
  for (const AssemblyOperation& o : operations)
    for (const PlacedMesh& part : o.active)
      largest = std::max(largest, shape_bounds(MeshShape{part.mesh}).diagonal().norm());
  require(at_most(options.tip_clearance, largest), "tip_clearance", options.tip_clearance,
          "must be no longer than the largest part that is moved, " + millimetres(largest) + " from corner to corner");
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

/// Whether meshes hold the same numbers: parts of one file are read once each.
bool is_same_mesh(const TriangleMesh& a, const TriangleMesh& b) {
  return &a == &b || (a.closed == b.closed && a.vertices == b.vertices && a.triangles == b.triangles);
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
        monitor_(monitor),
        pool_(result_, options.holding.has_value()) {}

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
    RehearsedSet({operations_, actuators_, options_, loads_}, pool_, result_, monitor_).find();
    if (result_.outcome == Outcome::infeasible) advise_on_drives();
    return std::move(result_);
  }

 private:
  void segment_parts() {
    std::vector<const PlacedMesh*> moved;
    for (const AssemblyOperation& o : operations_)
      for (const PlacedMesh& part : o.active) moved.push_back(&part);
    std::vector<std::pair<const TriangleMesh*, const SegmentedPart*>> known;
    for (std::size_t i = 0; i < moved.size() && !monitor_.stopped(); ++i) {
      monitor_.report("segments", static_cast<double>(i) / moved.size());
      SegmentedPart& out = result_.parts[moved[i]->name];
      const TriangleMesh& mesh = *moved[i]->mesh;
      const auto alike =
          std::find_if(known.begin(), known.end(), [&](const auto& k) { return is_same_mesh(*k.first, mesh); });
      if (alike != known.end()) {
        out = *alike->second;
        out.segmentation.turned = outward_.turned(&mesh);
        continue;
      }
      known.emplace_back(&mesh, &out);
      Monitor silent;
      silent.stop = monitor_.stop;
      MeshSegmentationOptions segmentation;
      segmentation.diameter.threads = options_.threads;
      out.segmentation = segment_mesh(mesh, segmentation, silent);
      out.segmentation.turned = outward_.turned(&mesh);
      if (monitor_.stopped()) return;
      const MeshSegmentation& cut = out.segmentation;
      out.primitives = fit_primitives(mesh, cut.labels, cut.threads, silent);
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
    if (options_.holding) loads_[operation.name] = operation_load(operation, *options_.holding);
    const Judgement by = judgement_of(operation);
    const std::size_t first = result_.fates.size(), before = result_.requirements.size();
    Remedy remedy;
    for (const PlacedMesh& part : operation.active) {
      const std::vector<std::string> names = segment_names(result_.parts.at(part.name).primitives);
      for (int s = 0; s < static_cast<int>(names.size()) && !monitor_.stopped(); ++s) {
        SegmentFate fate;
        fate.step = operation.name;
        fate.part = part.name;
        fate.segment = s;
        fate.name = names[s];
        std::vector<FreeGrasp> found = judge_segment(by, part, fate, remedy, monitor_);
        result_.fates.push_back(std::move(fate));
        pool_.add(std::move(found), result_.fates.size() - 1);
      }
    }
    if (result_.requirements.size() == before && !monitor_.stopped()) tell_missing(by, first, remedy);
  }

  Judgement judgement_of(const AssemblyOperation& operation) const {
    const auto load = loads_.find(operation.name);
    return {operation,     actuators_, options_,    load == loads_.end() ? nullptr : &load->second,
            result_.parts, keep_off_,  untouchable_};
  }

  /// Segments from that fate on by what they were refused for, in the order in which reasons come first.
  std::vector<std::pair<std::string, std::vector<std::string>>> by_reason(std::size_t first) const {
    std::vector<std::pair<std::string, std::vector<std::string>>> found;
    for (std::size_t i = first; i < result_.fates.size(); ++i) {
      const SegmentFate& f = result_.fates[i];
      const auto known = std::find_if(found.begin(), found.end(), [&](const auto& r) { return r.first == f.refused; });
      std::vector<std::string>& names =
          known == found.end() ? found.emplace_back(f.refused, std::vector<std::string>()).second : known->second;
      names.push_back(f.part + "/" + f.name);
    }
    return found;
  }

  static std::string some_of(const std::vector<std::string>& names) {
    constexpr std::size_t kTold = 3;
    std::string text = names.front();
    for (std::size_t i = 1; i < std::min(names.size(), kTold); ++i) text += ", " + names[i];
    if (names.size() > kTold) text += " and " + std::to_string(names.size() - kTold) + " more";
    return text;
  }

  void tell_missing(const Judgement& by, std::size_t first, const Remedy& remedy) {
    std::string why = by.operation.name + ": no segment can be held";
    // Grasps are tried in steps: only where there are none to try, it is proven that there is none.
    const auto tried = [](const SegmentFate& f) { return f.tried > 0; };
    if (std::none_of(result_.fates.begin() + static_cast<std::ptrdiff_t>(first), result_.fates.end(), tried))
      impossible_ = true;
    for (const auto& [refused, names] : by_reason(first)) why += "; " + some_of(names) + ": " + refused;
    result_.missing.push_back(why);
    monitor_.report("what would help", 0);
    tell_help(advice_without_grasp(by, remedy, monitor_));
  }

  /// What would help the operations whose grasps no drive takes.
  void advise_on_drives() {
    monitor_.report("what would help", 0);
    for (const AssemblyOperation& o : operations_) {
      const std::vector<std::string>& uncovered = result_.set->uncovered;
      if (std::find(uncovered.begin(), uncovered.end(), o.name) != uncovered.end())
        tell_help(advice_without_drive(judgement_of(o), monitor_));
    }
  }

  void tell_help(const std::vector<std::string>& help) {
    result_.help.insert(result_.help.end(), help.begin(), help.end());
  }

  const OutwardOperations& outward_;
  const std::vector<AssemblyOperation>& operations_;
  const std::vector<GripperActuator>& actuators_;
  const PlanGrippersOptions& options_;
  const Monitor& monitor_;
  std::map<std::string, SurfacePieces> keep_off_;
  std::set<std::pair<std::string, int>> untouchable_;
  std::map<std::string, OperationLoad> loads_;  // Keys are operations; only where holding is asked.
  bool impossible_ = false;                     // Some operation, whatever grasps are tried.
  PlanGrippersResult result_;
  GraspPool pool_;
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
  require_count(max_rehearsals, "max_rehearsals");
  resolve_threads(threads);  // refuses what is no number of threads
  if (holding) holding->check();
}

PlanGrippersResult plan_grippers(const std::vector<AssemblyOperation>& operations,
                                 const std::vector<GripperActuator>& actuators, const std::vector<KeepOff>& keep_off,
                                 const PlanGrippersOptions& options, const Monitor& monitor) {
  options.check();
  check_operations(operations);
  check_actuators(actuators);
  check_tip_clearance(operations, options);
  const OutwardOperations outward(operations);
  return Planning(outward, actuators, options, monitor).run(keep_off);
}

}  // namespace mmgrasp
