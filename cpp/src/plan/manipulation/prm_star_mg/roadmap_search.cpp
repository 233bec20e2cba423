#include "plan/manipulation/prm_star_mg/roadmap_search.hpp"

#include <algorithm>
#include <utility>

#include "mmgrasp/core/parallel.hpp"

namespace mmgrasp::detail {
namespace {

constexpr std::size_t kMaxSplicedPaths = 16;     // Earlier paths from which upper bounds are spliced.
constexpr std::size_t kMaxRoundSize = 32;        // Grasps handled together, whatever the number of threads.
constexpr std::size_t kMinParallelSearches = 4;  // Fewer graph searches run in one thread.
// Where grasps have more openings than this, vertices are checked for the robot on paths only.
constexpr int kMaxSharingOpenings = 8;

/// No path between ends farther apart than this can win, shortened or not.
double max_end_distance(const TransferPath& best, const ManipulationResult& result) {
  return result.path ? std::min(best.cost, result.cost) : best.cost;
}

}  // namespace

RoadmapSearch::RoadmapSearch(const ManipulationInput& input, const Roadmap& roadmap, bool straight, int threads,
                             TransferPath& best, ManipulationResult& result, PlanStage stage)
    : input_(input),
      roadmap_(roadmap),
      straight_(straight),
      best_(best),
      result_(result),
      stage_(stage),
      threads_(resolve_threads(threads)),
      checks_(roadmap, input.checks, robot_caches_, threads_, input.monitor, result.stats) {
  for (const GraspCandidate& candidate : input.candidates.found()) graphs_.emplace_back(roadmap_, candidate);
  for (int i = 0; i < input.checks.opening_count(); ++i) robot_caches_.emplace_back(roadmap);
  for (int worker = 0; worker < threads_; ++worker) {
    searches_.emplace_back(roadmap);
    searches_.back().stopped = [this] { return input_.out_of_time(); };
  }
}

bool RoadmapSearch::run() {
  const bool whole = input_.candidates.complete() && search_batches();
  double& bound = result_.stats.roadmap_bound;
  bound = best_.cost;
  if (!whole) {
    bound = std::min(bound, input_.candidates.least_cost_left());
    for (const Entry& open : heap_) bound = std::min(bound, open.key);
    // Grasps whose search has not begun are bounded by their straight lines.
    for (const GraspGraph& graph : graphs_)
      if (!graph.connected) bound = std::min(bound, graph.candidate.straight_cost());
  }
  for (const GraspGraph& graph : graphs_) {
    bool& searched = result_.grasps[graph.candidate.grasp].searched;
    result_.stats.grasps_searched += graph.connected && !searched ? 1 : 0;
    searched |= graph.connected;
  }
  return whole;
}

void RoadmapSearch::push(const Entry& entry) {
  heap_.push_back(entry);
  std::push_heap(heap_.begin(), heap_.end(), later);
}

void RoadmapSearch::push_straight(int index) {
  const double straight = graph(index).candidate.straight_cost();
  if (straight < max_end_distance(best_, result_)) push({straight, index, false});
}

std::optional<RoadmapSearch::Entry> RoadmapSearch::find_path(int worker, int index, double bound) {
  GraspGraph& own = graph(index);
  own.connect(roadmap_, straight_, max_end_distance(best_, result_));
  GraspGraphSearch& search = searches_[worker];
  const int opening = own.candidate.opening;
  search.robot_is_free = {};
  if (input_.checks.opening_count() <= kMaxSharingOpenings) {
    search.robot_is_free = [this, worker, opening](int v) {
      return input_.checks.robot_is_free(worker, opening, roadmap_.vertices().col(v));
    };
  }
  const EdgeValidityCache& robot = robot_caches_[opening];
  const GraspGraphSearch::End end = search.search(own, robot, bound);
  if (end == GraspGraphSearch::End::none) return std::nullopt;
  if (end == GraspGraphSearch::End::found) return Entry{own.path_cost, index, true};
  return Entry{search.lower_bound(), index, false};  // Out of time.
}

bool RoadmapSearch::search_heap() {
  std::size_t size = 1;
  while (any_promising()) {
    if (input_.out_of_time()) return false;
    round(size);
    size = std::min(2 * size, kMaxRoundSize);
  }
  return true;
}

bool RoadmapSearch::search_batches() {
  const std::size_t count = graphs_.size();
  const std::size_t size = input_.options.prm.batch > 0 ? input_.options.prm.batch : count;
  for (std::size_t first = 0; first < count; first += size) {
    input_.monitor.report("search", static_cast<double>(first) / static_cast<double>(count));
    if (!search_batch(static_cast<int>(first), static_cast<int>(std::min(count, first + size)))) return false;
  }
  return true;
}

bool RoadmapSearch::search_batch(int first, int last) {
  heap_.clear();
  if (input_.options.prm.lazy_grasps) {
    for (int index = first; index < last; ++index) push_straight(index);
  } else if (!search_all(first, last)) {
    return false;
  }
  return search_heap();
}

bool RoadmapSearch::search_all(int first, int last) {
  std::vector<int> found;
  for (int index = first; index < last; ++index) {
    if (graph(index).candidate.straight_cost() >= max_end_distance(best_, result_)) continue;
    if (input_.out_of_time()) return false;
    graph(index).connect(roadmap_, straight_, max_end_distance(best_, result_));
    double bound = best_.cost;
    for (std::size_t i = found.size() > kMaxSplicedPaths ? found.size() - kMaxSplicedPaths : 0; i < found.size(); ++i)
      bound = std::min(bound, spliced_cost(roadmap_, graph(index), graph(found[i]).nodes));
    ++result_.stats.graph_searches;
    const std::optional<Entry> left = find_path(0, index, bound);
    result_.stats.nodes_opened += searches_.front().nodes_opened();
    if (!left) continue;
    push(*left);
    if (left->searched) found.push_back(index);
  }
  return true;
}

void RoadmapSearch::round(std::size_t size) {
  std::vector<Entry> taken;
  std::vector<int> to_search, checked;
  std::vector<GraspGraph*> to_check;
  while (any_promising() && taken.size() < size) {
    std::pop_heap(heap_.begin(), heap_.end(), later);
    taken.push_back(heap_.back());
    heap_.pop_back();
    const Entry& top = taken.back();
    (top.searched ? checked : to_search).push_back(top.graph);
    if (top.searched) to_check.push_back(&graph(top.graph));
  }
  const std::vector<char> free = checks_.check(to_check);
  if (input_.monitor.stopped()) {
    for (const Entry& entry : taken) push(entry);
    return;
  }
  for (std::size_t i = 0; i < checked.size(); ++i)
    if (!free[i] || !accept(checked[i])) to_search.push_back(checked[i]);
  std::vector<std::optional<Entry>> left(to_search.size());
  // Not bounded by spliced paths: these may be blocked (errata on Algorithm 4.3).
  parallel_for(to_search.size(), to_search.size() >= kMinParallelSearches ? threads_ : 1,
               [&](std::size_t i, int worker) { left[i] = find_path(worker, to_search[i], best_.cost); });
  result_.stats.graph_searches += to_search.size();
  for (const std::optional<Entry>& entry : left)
    if (entry) push(*entry);
}

bool RoadmapSearch::accept(int index) {
  GraspGraph& own = graph(index);
  if (own.path_cost >= best_.cost) return true;
  JointPath path;
  for (const int node : own.nodes) path.waypoints.push_back(own.configuration(roadmap_, node));
  own.candidate.metric.unroll(path.waypoints);
  const int blocked = input_.checks.blocked_edge(own.candidate.grasp, path);
  if (blocked >= 0) {
    own.set_step(own.steps[blocked], false);
    return false;
  }
  const PlanStage stage = path.waypoints.size() == 2 ? PlanStage::straight_lines : stage_;
  best_ = {own.candidate.grasp, own.path_cost, std::move(path), stage};
  take_path(input_, best_, result_);
  return true;
}

}  // namespace mmgrasp::detail
