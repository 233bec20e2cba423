#include "plan/prm_star_mg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/core/random.hpp"
#include "plan/overlay_checks.hpp"
#include "plan/overlay_search.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr std::size_t kSplices = 16;       // Earlier paths from which bounds are spliced.
constexpr std::size_t kLargestRound = 32;  // Grasps looked at side by side; whatever the number of threads.
constexpr std::size_t kSearches = 4;       // Graph searches that are worth a thread.
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
        checks_(roadmap, input.checks, knowledge_, threads_, result.stats),
        best_(result.path ? result.cost : kInfinite) {
    for (int i = 0; i < input.checks.opening_count(); ++i) knowledge_.emplace_back(roadmap);
    for (const CarryCandidate& candidate : input.candidates) overlays_.emplace_back(roadmap, candidate);
    for (int worker = 0; worker < threads_; ++worker) searches_.emplace_back(roadmap);
  }

  /// False when time ran out before all grasps were searched.
  bool run() {
    const std::vector<int> order = shuffled();
    const std::size_t all = std::max<std::size_t>(1, order.size());
    const std::size_t size = input_.options.prm.batch > 0 ? static_cast<std::size_t>(input_.options.prm.batch) : all;
    bool whole = true;
    for (std::size_t first = 0; first < order.size() && whole; first += size) {
      input_.monitor.report("search", static_cast<double>(first) / static_cast<double>(order.size()));
      const std::size_t last = std::min(order.size(), first + size);
      whole = search_batch({order.begin() + static_cast<long>(first), order.begin() + static_cast<long>(last)});
    }
    result_.lower_bound = best_;
    if (!whole) {
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

  std::vector<int> shuffled() const {
    std::vector<int> order(overlays_.size());
    std::iota(order.begin(), order.end(), 0);
    Rng rng(input_.options.seed, 0x6d67);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[rng.index(i)]);
    return order;
  }

  GraspOverlay& overlay(int index) { return overlays_[static_cast<std::size_t>(index)]; }

  void push(double key, int index, bool searched) {
    heap_.push_back({key, index, searched});
    std::push_heap(heap_.begin(), heap_.end(), later);
  }

  bool find_path(int worker, int index, double bound) {
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
    return search.search(o, knowledge_[static_cast<std::size_t>(opening)], bound);
  }

  /// False when time ran out; what is open is then left in the heap.
  bool search_batch(const std::vector<int>& batch) {
    heap_.clear();
    if (input_.options.prm.lazy_grasps) {
      for (const int index : batch) {
        const double straight = overlay(index).candidate.straight_cost();
        if (straight < best_) push(straight, index, false);
      }
    } else if (!search_all(batch)) {
      return false;
    }
    std::size_t size = 1;
    while (!heap_.empty() && heap_.front().key < best_) {
      if (input_.out_of_time()) return false;
      round(size);
      size = std::min(2 * size, kLargestRound);
    }
    return true;
  }

  /// Searches every grasp of the batch before anything is checked, each bounded by the best path and by what can be
  /// spliced from those found before it (P2 lines 6-15).
  bool search_all(const std::vector<int>& batch) {
    std::vector<int> found;
    for (const int index : batch) {
      if (overlay(index).candidate.straight_cost() >= best_) continue;
      if (input_.out_of_time()) return false;
      overlay(index).connect(roadmap_, input_.options.prm.straight, best_);
      double bound = best_;
      for (std::size_t i = found.size() > kSplices ? found.size() - kSplices : 0; i < found.size(); ++i)
        bound = std::min(bound, spliced_cost(roadmap_, overlay(index), overlay(found[i]).nodes));
      ++result_.stats.graph_searches;
      if (!find_path(0, index, bound)) continue;
      found.push_back(index);
      push(overlay(index).path_cost, index, true);
    }
    return true;
  }

  /// Takes the most promising grasps, checks the paths of those that have one, and searches the others and those whose
  /// path is blocked. A free path becomes the best even while others could still be better.
  void round(std::size_t size) {
    std::vector<int> to_search;
    std::vector<GraspOverlay*> to_check;
    std::vector<int> checked;
    while (!heap_.empty() && heap_.front().key < best_ && to_search.size() + checked.size() < size) {
      std::pop_heap(heap_.begin(), heap_.end(), later);
      const Entry top = heap_.back();
      heap_.pop_back();
      if (top.searched) {
        checked.push_back(top.overlay);
        to_check.push_back(&overlay(top.overlay));
      } else {
        to_search.push_back(top.overlay);
      }
    }
    const std::vector<char> free = checks_.check(to_check);
    for (std::size_t i = 0; i < checked.size(); ++i)
      if (!free[i] || !accept(checked[i])) to_search.push_back(checked[i]);
    std::vector<char> found(to_search.size());
    // Not min(bound, spliced): a spliced path may be blocked (errata on Algorithm 4.3).
    parallel_for(to_search.size(), to_search.size() >= kSearches ? threads_ : 1,
                 [&](std::size_t i, int worker) { found[i] = find_path(worker, to_search[i], best_); });
    result_.stats.graph_searches += to_search.size();
    for (std::size_t i = 0; i < to_search.size(); ++i)
      if (found[i]) push(overlay(to_search[i]).path_cost, to_search[i], true);
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
  const Roadmap own = Roadmap::build(input.problem.group, input.options.prm.roadmap, input.monitor);
  result.stats.roadmap_seconds = input.clock.seconds();
  input.clock.start();
  if (input.monitor.stopped()) return std::nullopt;
  return own;
}

}  // namespace

void run_prm_star_mg(CarryInput& input, ManipulationResult& result) {
  std::optional<Roadmap> roadmap = first_roadmap(input, result);
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
  if (result.path)
    result.outcome = Outcome::solved;
  else
    result.outcome = input.monitor.stopped() ? Outcome::stopped : whole ? Outcome::infeasible : Outcome::timeout;
}

}  // namespace mmgrasp::detail
