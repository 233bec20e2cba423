#include "plan/prm_star_mg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "mmgrasp/core/parallel.hpp"
#include "plan/carry_shortening.hpp"
#include "plan/overlay_checks.hpp"
#include "plan/overlay_search.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr std::size_t kSplices = 16;       // Earlier paths from which bounds are spliced.
constexpr std::size_t kLargestRound = 32;  // Grasps looked at side by side; whatever the number of threads.
constexpr std::size_t kSearches = 4;       // Graph searches that are worth a thread.
constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();
// As long as there is no path and grasps are left to look at: what one that was found is worth before the next ones
// are, in searches and checks, and vertices a grasp's first search goes on from.
constexpr std::size_t kLooks = 4, kPatience = 100;
// With more openings than these, vertices are checked for the robot on paths only.
constexpr int kSharingOpenings = 8;

/// One search of one roadmap for all grasps (P2 Algorithm 4.3).
class RoadmapSearch {
 public:
  RoadmapSearch(CarryInput& input, const Roadmap& roadmap, ManipulationResult& result)
      : input_(input),
        roadmap_(roadmap),
        result_(result),
        threads_(resolve_threads(input.options.threads)),
        checks_(roadmap, input.checks, knowledge_, threads_, input.monitor, result.stats),
        best_(result.path ? result.cost : kInfinite) {
    for (int i = 0; i < input.checks.opening_count(); ++i) knowledge_.emplace_back(roadmap);
    for (int worker = 0; worker < threads_; ++worker) {
      searches_.emplace_back(roadmap);
      searches_.back().stopped = [this] { return input_.out_of_time(); };
    }
  }

  /// False when time ran out before all grasps were searched.
  bool run() {
    const bool heap_of_all = input_.options.prm.batch == 0 && input_.options.prm.lazy_grasps;
    do {
      const std::size_t before = overlays_.size();
      take_candidates();
      if (!heap_of_all) continue;
      for (std::size_t i = before; i < overlays_.size(); ++i) push_straight(static_cast<int>(i));
      look(kLooks * (overlays_.size() - before));
    } while (!input_.out_of_time() && input_.candidates.find_more(best_ < kInfinite));
    const bool whole = input_.candidates.complete() && (heap_of_all ? search_heap() : search_batches());
    result_.lower_bound = best_;
    if (!whole) {
      result_.lower_bound = std::min(result_.lower_bound, input_.candidates.least_cost_left());
      for (const Entry& open : heap_) result_.lower_bound = std::min(result_.lower_bound, open.key);
      // Grasps that were not begun are bounded by their straight lines.
      for (const GraspOverlay& overlay : overlays_)
        if (!overlay.connected) result_.lower_bound = std::min(result_.lower_bound, overlay.candidate.straight_cost());
    }
    for (const GraspOverlay& overlay : overlays_) result_.stats.grasps_searched += overlay.connected ? 1 : 0;
    return whole;
  }

 private:
  struct Entry {
    double key;
    int overlay;
    bool searched;  ///< The key is a path's cost, not only a bound.
  };
  static bool later(const Entry& a, const Entry& b) { return a.key != b.key ? a.key > b.key : a.overlay > b.overlay; }

  GraspOverlay& overlay(int index) { return overlays_[static_cast<std::size_t>(index)]; }

  void take_candidates() {
    const std::vector<CarryCandidate>& found = input_.candidates.found();
    for (std::size_t i = overlays_.size(); i < found.size(); ++i) {
      overlays_.emplace_back(roadmap_, found[i]);
      overlays_.back().patience = kPatience;
    }
  }

  void push(const Entry& entry) {
    heap_.push_back(entry);
    std::push_heap(heap_.begin(), heap_.end(), later);
  }
  void push_straight(int index) {
    const double straight = overlay(index).candidate.straight_cost();
    if (straight < best_) push({straight, index, false});
  }
  bool promising() const { return !heap_.empty() && heap_.front().key < best_; }

  /// What is left to do with a grasp that was searched, if anything.
  std::optional<Entry> find_path(int worker, int index, double bound) {
    GraspOverlay& o = overlay(index);
    o.connect(roadmap_, input_.options.prm.straight, best_);
    OverlaySearch& search = searches_[static_cast<std::size_t>(worker)];
    const int opening = o.candidate.opening;
    search.robot_is_free = {};
    if (input_.checks.opening_count() <= kSharingOpenings) {
      search.robot_is_free = [this, worker, opening](int v) {
        return input_.checks.robot_is_free(worker, opening, roadmap_.vertices().col(v));
      };
    }
    const RoadmapKnowledge& robot = knowledge_[static_cast<std::size_t>(opening)];
    const std::size_t patience = input_.candidates.complete() ? kNoLimit : o.patience;
    const OverlaySearch::End end = search.search(o, robot, bound, patience);
    if (end == OverlaySearch::End::none) return std::nullopt;
    if (end == OverlaySearch::End::found) return Entry{o.path_cost, index, true};
    o.patience *= 2;
    return Entry{search.reached(), index, false};
  }

  /// A first path over the grasps known so far, with no more than so many steps: others may be easier.
  void look(std::size_t steps) {
    for (std::size_t i = 0; i < steps && best_ == kInfinite && promising() && !input_.out_of_time(); ++i) round(1);
  }

  /// False when time ran out; what is open is then left in the heap.
  bool search_heap() {
    std::size_t size = 1;
    while (promising()) {
      if (input_.out_of_time()) return false;
      round(size);
      size = std::min(2 * size, kLargestRound);
    }
    return true;
  }

  bool search_batches() {
    const std::size_t count = overlays_.size();
    const std::size_t size = input_.options.prm.batch > 0 ? static_cast<std::size_t>(input_.options.prm.batch) : count;
    for (std::size_t first = 0; first < count; first += size) {
      input_.monitor.report("search", static_cast<double>(first) / static_cast<double>(count));
      if (!search_batch(static_cast<int>(first), static_cast<int>(std::min(count, first + size)))) return false;
    }
    return true;
  }

  bool search_batch(int first, int last) {
    heap_.clear();
    if (input_.options.prm.lazy_grasps) {
      for (int index = first; index < last; ++index) push_straight(index);
    } else if (!search_all(first, last)) {
      return false;
    }
    return search_heap();
  }

  /// Searches every grasp of the batch before anything is checked, each bounded by the best path and by what can be
  /// spliced from those found before it (P2 lines 6-15).
  bool search_all(int first, int last) {
    std::vector<int> found;
    for (int index = first; index < last; ++index) {
      if (overlay(index).candidate.straight_cost() >= best_) continue;
      if (input_.out_of_time()) return false;
      overlay(index).connect(roadmap_, input_.options.prm.straight, best_);
      double bound = best_;
      for (std::size_t i = found.size() > kSplices ? found.size() - kSplices : 0; i < found.size(); ++i)
        bound = std::min(bound, spliced_cost(roadmap_, overlay(index), overlay(found[i]).nodes));
      ++result_.stats.graph_searches;
      const std::optional<Entry> left = find_path(0, index, bound);
      if (!left) continue;
      push(*left);
      if (left->searched) found.push_back(index);
    }
    return true;
  }

  /// Takes the most promising grasps, checks the paths of those that have one, and searches the others and those whose
  /// path is blocked. A free path becomes the best even while others could still be better.
  void round(std::size_t size) {
    std::vector<Entry> taken;
    std::vector<int> to_search, checked;
    std::vector<GraspOverlay*> to_check;
    while (promising() && taken.size() < size) {
      std::pop_heap(heap_.begin(), heap_.end(), later);
      taken.push_back(heap_.back());
      heap_.pop_back();
      const Entry& top = taken.back();
      (top.searched ? checked : to_search).push_back(top.overlay);
      if (top.searched) to_check.push_back(&overlay(top.overlay));
    }
    const std::vector<char> free = checks_.check(to_check);
    if (input_.monitor.stopped()) {
      for (const Entry& entry : taken) push(entry);
      return;
    }
    for (std::size_t i = 0; i < checked.size(); ++i)
      if (!free[i] || !accept(checked[i])) to_search.push_back(checked[i]);
    std::vector<std::optional<Entry>> left(to_search.size());
    // Not min(bound, spliced): a spliced path may be blocked (errata on Algorithm 4.3).
    parallel_for(to_search.size(), to_search.size() >= kSearches ? threads_ : 1,
                 [&](std::size_t i, int worker) { left[i] = find_path(worker, to_search[i], best_); });
    result_.stats.graph_searches += to_search.size();
    for (const std::optional<Entry>& entry : left)
      if (entry) push(*entry);
  }

  /// Checks a free path once more, finely and with everything at once, and takes it when it is the best. False (and the
  /// step at fault is blocked) when it fails: a thin obstacle was stepped over.
  bool accept(int index) {
    GraspOverlay& o = overlay(index);
    if (o.path_cost >= best_) return true;
    JointPath path;
    for (const int node : o.nodes) path.waypoints.push_back(o.configuration(roadmap_, node));
    const int blocked = input_.checks.blocked_edge(o.candidate.grasp, path);
    if (blocked >= 0) {
      o.set_step(o.steps[static_cast<std::size_t>(blocked)], false);
      return false;
    }
    best_ = o.path_cost;
    take_path(input_, o.candidate.grasp, best_, std::move(path), result_);
    return true;
  }

  CarryInput& input_;
  const Roadmap& roadmap_;
  ManipulationResult& result_;
  int threads_;
  std::vector<RoadmapKnowledge> knowledge_;
  OverlayChecks checks_;
  std::vector<OverlaySearch> searches_;  ///< One per worker.
  std::vector<GraspOverlay> overlays_;
  std::vector<Entry> heap_;
  double best_;
};

/// The roadmap to begin with, built unless given; nothing when stopped.
std::optional<Roadmap> first_roadmap(CarryInput& input, ManipulationResult& result) {
  if (input.roadmap) return *input.roadmap;
  const CarryClock clock;
  const Roadmap own = Roadmap::build(input.problem.group, input.options.prm.roadmap, input.monitor);
  result.stats.roadmap_seconds = clock.seconds();
  input.clock.leave_out(result.stats.roadmap_seconds);
  if (input.monitor.stopped()) return std::nullopt;
  return own;
}

}  // namespace

void run_prm_star_mg(CarryInput& input, ManipulationResult& result) {
  while (input.candidates.found().empty() && input.candidates.find_more(false)) {
  }
  std::optional<Roadmap> roadmap;
  if (!input.candidates.found().empty()) roadmap = first_roadmap(input, result);
  bool whole = false;
  while (roadmap) {
    whole = RoadmapSearch(input, *roadmap, result).run();
    if (!whole || 2.0 * roadmap->size() > input.options.prm.max_vertices) break;
    // The same seed gives the same vertices, and more of them.
    RoadmapOptions denser = roadmap->options();
    denser.vertices = 2 * roadmap->size();
    roadmap = Roadmap::build(input.problem.group, denser, input.monitor);
    if (input.out_of_time()) break;
  }
  if (result.path) {
    result.outcome = Outcome::solved;
    result.stats.roadmap_cost = result.cost;
    if (input.options.prm.shorten) shorten_carry(input, result);
    result.lower_bound = std::min(result.lower_bound, result.cost);
  } else {
    result.outcome = input.monitor.stopped() ? Outcome::stopped : whole ? Outcome::infeasible : Outcome::timeout;
  }
}

}  // namespace mmgrasp::detail
