#include "plan/prm_star_mg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/core/random.hpp"
#include "plan/overlay_search.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr std::size_t kSplices = 16;  // Earlier paths from which bounds are spliced.

class RoadmapSearch {
 public:
  RoadmapSearch(CarryInput& input, const Roadmap& roadmap, ManipulationResult& result)
      : input_(input), roadmap_(roadmap), result_(result), search_(roadmap) {
    knowledge_.resize(static_cast<std::size_t>(input.checks.opening_count()));
    for (RoadmapKnowledge& known : knowledge_) {
      known.vertices.assign(static_cast<std::size_t>(roadmap.size()), RoadmapKnowledge::unknown);
      known.edges.assign(static_cast<std::size_t>(roadmap.edge_count()), RoadmapKnowledge::unknown);
    }
    for (CarryCandidate& candidate : input.candidates) overlays_.emplace_back(roadmap, std::move(candidate));
  }

  void run() {
    const std::vector<int> order = shuffled();
    const int size =
        input_.options.prm.batch > 0 ? input_.options.prm.batch : std::max<int>(1, static_cast<int>(order.size()));
    bool whole = true;
    for (std::size_t first = 0; first < order.size() && whole; first += static_cast<std::size_t>(size)) {
      input_.monitor.report("search", static_cast<double>(first) / static_cast<double>(order.size()));
      const std::size_t last = std::min(order.size(), first + static_cast<std::size_t>(size));
      whole = search_batch({order.begin() + static_cast<long>(first), order.begin() + static_cast<long>(last)});
    }
    for (const GraspOverlay& overlay : overlays_) result_.stats.grasps_searched += overlay.connected ? 1 : 0;
    result_.lower_bound = whole ? best_ : std::min(best_, open_bound_);
    if (!whole) {
      // Grasps of batches that were not begun are bounded by their straight lines.
      for (const GraspOverlay& overlay : overlays_)
        if (!overlay.connected) result_.lower_bound = std::min(result_.lower_bound, overlay.candidate.straight_cost());
    }
    if (result_.path) {
      result_.outcome = Outcome::solved;
    } else {
      result_.outcome = input_.monitor.stopped() ? Outcome::stopped : whole ? Outcome::infeasible : Outcome::timeout;
    }
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

  void push(double key, int overlay, bool searched) {
    heap_.push_back({key, overlay, searched});
    std::push_heap(heap_.begin(), heap_.end(), later);
  }

  bool find_path(int index, double bound) {
    ++result_.stats.graph_searches;
    GraspOverlay& overlay = overlays_[static_cast<std::size_t>(index)];
    return search_.search(overlay, knowledge_[static_cast<std::size_t>(overlay.candidate.opening)], bound);
  }

  /// False when time ran out.
  bool search_batch(const std::vector<int>& batch) {
    heap_.clear();
    std::vector<int> found;
    for (const int index : batch) {
      GraspOverlay& overlay = overlays_[static_cast<std::size_t>(index)];
      const double straight = overlay.candidate.straight_cost();
      if (straight >= best_) continue;
      if (input_.options.prm.lazy_grasps) {
        push(straight, index, false);
        continue;
      }
      if (input_.out_of_time()) return ended(straight);
      overlay.connect(roadmap_);
      double bound = best_;
      for (std::size_t i = found.size() > kSplices ? found.size() - kSplices : 0; i < found.size(); ++i)
        bound = std::min(bound, spliced_cost(roadmap_, overlay, overlays_[static_cast<std::size_t>(found[i])].nodes));
      if (!find_path(index, bound)) continue;
      found.push_back(index);
      push(overlay.path_cost, index, true);
    }
    while (!heap_.empty() && heap_.front().key < best_) {
      const Entry top = heap_.front();
      if (input_.out_of_time()) return ended(top.key);
      std::pop_heap(heap_.begin(), heap_.end(), later);
      heap_.pop_back();
      if (top.searched && path_is_free(top.overlay)) {
        if (accept(top.overlay)) return true;  // All others of the batch cost more.
      }
      // Not min(bound, spliced): a spliced path may be blocked (errata on Algorithm 4.3).
      if (find_path(top.overlay, best_))
        push(overlays_[static_cast<std::size_t>(top.overlay)].path_cost, top.overlay, true);
    }
    return true;
  }

  bool ended(double bound) {
    open_bound_ = std::min(open_bound_, bound);
    return false;
  }

  /// Work on the path's items that nobody has looked at yet: all of them, side by side, so that what is known
  /// afterwards does not depend on the number of threads.
  template <class Item, class Check>
  bool check_all(const std::vector<Item>& items, std::vector<char>& free, const Check& check) {
    free.assign(items.size(), 0);
    const int threads = items.size() > 1 ? input_.options.threads : 1;
    parallel_for(items.size(), threads, [&](std::size_t i, int worker) { free[i] = check(worker, items[i]) ? 1 : 0; });
    return std::all_of(free.begin(), free.end(), [](char f) { return f != 0; });
  }

  bool path_is_free(int index) {
    GraspOverlay& overlay = overlays_[static_cast<std::size_t>(index)];
    return vertices_free_for_robot(overlay) && vertices_free_for_held(overlay) && edges_free_for_robot(overlay) &&
           edges_free_for_held(overlay);
  }

  // The ends were checked with their IK.
  bool vertices_free_for_robot(GraspOverlay& overlay) {
    RoadmapKnowledge& known = knowledge_[static_cast<std::size_t>(overlay.candidate.opening)];
    std::vector<int> items;
    for (const int node : overlay.nodes)
      if (node < overlay.vertex_count && known.vertices[static_cast<std::size_t>(node)] == RoadmapKnowledge::unknown)
        items.push_back(node);
    std::vector<char> free;
    const bool all = check_all(items, free, [&](int worker, int node) {
      return input_.checks.robot_is_free(worker, overlay.candidate.opening, roadmap_.vertices().col(node));
    });
    for (std::size_t i = 0; i < items.size(); ++i)
      known.vertices[static_cast<std::size_t>(items[i])] = free[i] ? RoadmapKnowledge::free : RoadmapKnowledge::blocked;
    return all;
  }

  bool vertices_free_for_held(GraspOverlay& overlay) {
    std::vector<int> items;
    for (const int node : overlay.nodes)
      if (node < overlay.vertex_count && overlay.passed_vertices.count(node) == 0) items.push_back(node);
    std::vector<char> free;
    const bool all = check_all(items, free, [&](int worker, int node) {
      return input_.checks.held_is_free(worker, overlay.candidate.grasp, roadmap_.vertices().col(node));
    });
    for (std::size_t i = 0; i < items.size(); ++i)
      (free[i] ? overlay.passed_vertices : overlay.blocked_vertices).insert(items[i]);
    return all;
  }

  bool edges_free_for_robot(GraspOverlay& overlay) {
    RoadmapKnowledge& known = knowledge_[static_cast<std::size_t>(overlay.candidate.opening)];
    std::vector<std::size_t> items;
    for (std::size_t i = 0; i < overlay.steps.size(); ++i) {
      const int step = overlay.steps[i];
      const bool open = step >= 0 ? known.edges[static_cast<std::size_t>(step)] == RoadmapKnowledge::unknown
                                  : !overlay.links[static_cast<std::size_t>(-1 - step)].passed;
      if (open) items.push_back(i);
    }
    std::vector<char> free;
    const bool all = check_all(items, free, [&](int worker, std::size_t i) {
      return input_.checks.robot_edge_is_free(worker, overlay.candidate.opening,
                                              overlay.configuration(roadmap_, overlay.nodes[i]),
                                              overlay.configuration(roadmap_, overlay.nodes[i + 1]));
    });
    result_.stats.edges_checked_robot += items.size();
    for (std::size_t i = 0; i < items.size(); ++i) {
      const int step = overlay.steps[items[i]];
      if (step >= 0) {
        known.edges[static_cast<std::size_t>(step)] = free[i] ? RoadmapKnowledge::free : RoadmapKnowledge::blocked;
      } else if (!free[i]) {
        overlay.links[static_cast<std::size_t>(-1 - step)].blocked = true;
      }
    }
    return all;
  }

  bool edges_free_for_held(GraspOverlay& overlay) {
    std::vector<std::size_t> items;
    for (std::size_t i = 0; i < overlay.steps.size(); ++i) {
      const int step = overlay.steps[i];
      const bool open = step >= 0 ? overlay.passed_edges.count(step) == 0
                                  : !overlay.links[static_cast<std::size_t>(-1 - step)].passed;
      if (open) items.push_back(i);
    }
    std::vector<char> free;
    const bool all = check_all(items, free, [&](int worker, std::size_t i) {
      return input_.checks.held_edge_is_free(worker, overlay.candidate.grasp,
                                             overlay.configuration(roadmap_, overlay.nodes[i]),
                                             overlay.configuration(roadmap_, overlay.nodes[i + 1]));
    });
    result_.stats.edges_checked_held += items.size();
    for (std::size_t i = 0; i < items.size(); ++i) {
      const int step = overlay.steps[items[i]];
      if (step >= 0) {
        (free[i] ? overlay.passed_edges : overlay.blocked_edges).insert(step);
      } else {
        GraspOverlay::Link& link = overlay.links[static_cast<std::size_t>(-1 - step)];
        (free[i] ? link.passed : link.blocked) = true;
      }
    }
    return all;
  }

  /// Checks the path once more, finely and with everything at once, and takes it as the best. False (and the edge at
  /// fault is blocked) when it fails: a thin obstacle was stepped over.
  bool accept(int index) {
    GraspOverlay& overlay = overlays_[static_cast<std::size_t>(index)];
    JointPath path;
    for (const int node : overlay.nodes) path.waypoints.push_back(overlay.configuration(roadmap_, node));
    const int blocked = input_.checks.blocked_edge(overlay.candidate.grasp, path);
    if (blocked >= 0) {
      overlay.block(overlay.steps[static_cast<std::size_t>(blocked)]);
      return false;
    }
    best_ = overlay.path_cost;
    take_path(input_, overlay.candidate.grasp, best_, std::move(path), result_);
    return true;
  }

  CarryInput& input_;
  const Roadmap& roadmap_;
  ManipulationResult& result_;
  OverlaySearch search_;
  std::vector<RoadmapKnowledge> knowledge_;
  std::vector<GraspOverlay> overlays_;
  std::vector<Entry> heap_;
  double best_ = kInfinite, open_bound_ = kInfinite;
};

}  // namespace

void run_prm_star_mg(CarryInput& input, ManipulationResult& result) {
  std::optional<Roadmap> own;
  if (!input.roadmap) {
    own = Roadmap::build(input.problem.group, input.options.prm.roadmap, input.monitor);
    result.stats.roadmap_seconds = input.clock.seconds();
    input.clock.start();
    if (input.monitor.stopped()) {
      result.outcome = Outcome::stopped;
      return;
    }
  }
  RoadmapSearch(input, own ? *own : *input.roadmap, result).run();
}

}  // namespace mmgrasp::detail
