#include "plan/manipulation/prm_star_mg/grasp_graph_checks.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "mmgrasp/core/parallel.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kSampleSpacing = 0.4;  // [rad or m] Of the few configurations an edge is first looked at.
constexpr std::size_t kCheap = 64;      // Configurations that are worth a thread.

/// One question an opening's robot is asked about a vertex or an edge of the roadmap, however many paths lead over it.
struct RobotItem {
  int opening, what, path, place;
};

/// Of equal questions the one for the first path is kept.

std::vector<RobotItem> asked_once(std::vector<RobotItem> items) {
  const auto key = [](const RobotItem& i) { return std::tie(i.opening, i.what, i.path, i.place); };
  std::sort(items.begin(), items.end(), [&](const RobotItem& a, const RobotItem& b) { return key(a) < key(b); });
  items.erase(
      std::unique(items.begin(), items.end(),
                  [](const RobotItem& a, const RobotItem& b) { return a.opening == b.opening && a.what == b.what; }),
      items.end());
  return items;
}

}  // namespace

GraspGraphChecks::GraspGraphChecks(const Roadmap& roadmap, TransferChecks& checks,
                                   std::vector<EdgeValidityCache>& knowledge, int threads, const Monitor& monitor,
                                   ManipulationStats& stats)
    : roadmap_(roadmap), checks_(checks), knowledge_(knowledge), threads_(threads), stats_(stats) {
  stop_.stop = monitor.stop;
}

std::vector<char> GraspGraphChecks::check(const std::vector<GraspGraph*>& paths) {
  paths_ = &paths;
  live_.assign(paths.size(), 1);
  vertices_for_robot();
  vertices_for_held();
  samples();
  edges_for_robot();
  edges_for_held();
  return live_;
}

void GraspGraphChecks::run(std::size_t count, std::size_t worth, const std::function<void(std::size_t, int)>& work) {
  parallel_for(count, count >= worth ? threads_ : 1, work, stop_);
}

// The ends were checked with their IK.
void GraspGraphChecks::vertices_for_robot() {
  std::vector<RobotItem> items;
  for (std::size_t p = 0; p < paths_->size(); ++p) {
    const GraspGraph& graph = *(*paths_)[p];
    for (const int node : graph.nodes)
      if (node < graph.vertex_count && robot_of(graph).vertex(node) == EdgeValidityCache::unknown)
        items.push_back({graph.candidate.opening, node, static_cast<int>(p), 0});
  }
  items = asked_once(std::move(items));
  run(items.size(), kCheap, [&](std::size_t i, int worker) {
    const RobotItem& item = items[i];
    knowledge_[item.opening].set_vertex(
        item.what, checks_.robot_is_free(worker, item.opening, roadmap_.vertices().col(item.what)));
  });
  for (std::size_t p = 0; p < paths_->size(); ++p) {
    const GraspGraph& graph = *(*paths_)[p];
    for (const int node : graph.nodes)
      if (node < graph.vertex_count && robot_of(graph).vertex(node) == EdgeValidityCache::blocked) live_[p] = 0;
  }
}

void GraspGraphChecks::vertices_for_held() {
  std::vector<Item> items;
  for (std::size_t p = 0; p < paths_->size(); ++p) {
    if (!live_[p]) continue;
    const GraspGraph& graph = *(*paths_)[p];
    for (const int node : graph.nodes)
      if (node < graph.vertex_count && graph.passed_vertices.count(node) == 0)
        items.push_back({static_cast<int>(p), node});
  }
  std::vector<char> answers(items.size());
  run(items.size(), kCheap, [&](std::size_t i, int worker) {
    answers[i] =
        checks_.held_is_free(worker, overlay_of(items[i]).candidate.grasp, roadmap_.vertices().col(items[i].what));
  });
  for (std::size_t i = 0; i < items.size(); ++i) {
    GraspGraph& graph = overlay_of(items[i]);
    if (answers[i]) {
      graph.passed_vertices.insert(items[i].what);
    } else {
      graph.blocked_vertices.push_back(items[i].what);
      live_[items[i].path] = 0;
    }
  }
}

std::vector<GraspGraphChecks::Item> GraspGraphChecks::open_steps() const {
  std::vector<Item> items;
  for (std::size_t p = 0; p < paths_->size(); ++p) {
    if (!live_[p]) continue;
    const GraspGraph& graph = *(*paths_)[p];
    for (std::size_t i = 0; i < graph.steps.size(); ++i)
      if (!graph.passed(graph.steps[i])) items.push_back({static_cast<int>(p), static_cast<int>(i)});
  }
  return items;
}

GraspGraph& GraspGraphChecks::overlay_of(const Item& item) const {
  return *(*paths_)[item.path];
}

Step GraspGraphChecks::step_of(const Item& item) const {
  return overlay_of(item).steps[item.what];
}

std::pair<Eigen::VectorXd, Eigen::VectorXd> GraspGraphChecks::ends(const Item& step) const {
  const GraspGraph& graph = overlay_of(step);
  const auto place = static_cast<std::size_t>(step.what);
  return {graph.configuration(roadmap_, graph.nodes[place]), graph.configuration(roadmap_, graph.nodes[place + 1])};
}

void GraspGraphChecks::take_steps(const std::vector<Item>& items, const std::vector<char>& answers, bool final) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (!answers[i]) live_[items[i].path] = 0;
    if (!answers[i] || final) overlay_of(items[i]).set_step(step_of(items[i]), answers[i] != 0);
  }
}

// What blocks an edge tends to block a good part of it: a few configurations find most of those that are blocked.
void GraspGraphChecks::samples() {
  const std::vector<Item> items = open_steps();
  std::vector<char> answers(items.size());
  run(items.size(), kCheap / 4, [&](std::size_t i, int worker) {
    const GraspCandidate& candidate = overlay_of(items[i]).candidate;
    const bool is_link = step_of(items[i]).is_link();
    const auto [a, b] = ends(items[i]);
    const auto is_free = [&](double t) {
      const Eigen::VectorXd q = a + t * (b - a);
      return checks_.held_is_free(worker, candidate.grasp, q) &&
             (!is_link || checks_.robot_is_free(worker, candidate.opening, q));
    };
    // The middles first: 1/2, 1/4, 3/4, 1/8, ...
    const int depth = static_cast<int>(std::ceil(std::log2(std::max(1.0, (b - a).norm() / kSampleSpacing))));
    bool all = true;
    for (int level = 1; level <= std::min(depth, 5) && all; ++level)
      for (int k = 1; k < (1 << level) && all; k += 2) all = is_free(std::ldexp(k, -level));
    answers[i] = all;
  });
  take_steps(items, answers, false);
}

std::vector<GraspGraphChecks::Item> GraspGraphChecks::open_steps_of_robot() const {
  std::vector<Item> items;
  std::vector<RobotItem> edges;
  for (const Item& item : open_steps()) {
    const GraspGraph& graph = overlay_of(item);
    const Step step = step_of(item);
    if (step.is_link()) {  // No other path has it.
      if (!graph.link(step.number()).robot_passed) items.push_back(item);
    } else if (robot_of(graph).edge(step.number()) == EdgeValidityCache::unknown) {
      edges.push_back({graph.candidate.opening, step.number(), item.path, item.what});
    }
  }
  for (const RobotItem& edge : asked_once(std::move(edges))) items.push_back({edge.path, edge.place});
  return items;
}

void GraspGraphChecks::take_step_of_robot(const Item& item, bool is_free) {
  GraspGraph& graph = overlay_of(item);
  const Step step = step_of(item);
  if (!step.is_link()) return robot_of(graph).set_edge(step.number(), is_free);
  GraspGraph::Link& link = graph.link(step.number());
  link.robot_passed = is_free;
  link.blocked = !is_free;
}

bool GraspGraphChecks::robot_blocks(const GraspGraph& graph) const {
  return std::any_of(graph.steps.begin(), graph.steps.end(), [&](Step step) {
    return step.is_link() ? graph.link(step.number()).blocked
                          : robot_of(graph).edge(step.number()) == EdgeValidityCache::blocked;
  });
}

void GraspGraphChecks::edges_for_robot() {
  const std::vector<Item> items = open_steps_of_robot();
  std::vector<char> answers(items.size());
  run(items.size(), 2, [&](std::size_t i, int worker) {
    const auto [a, b] = ends(items[i]);
    answers[i] = checks_.robot_edge_is_free(worker, overlay_of(items[i]).candidate.opening, a, b);
  });
  stats_.edges_checked_robot += items.size();
  for (std::size_t i = 0; i < items.size(); ++i) take_step_of_robot(items[i], answers[i] != 0);
  for (std::size_t p = 0; p < paths_->size(); ++p)
    if (robot_blocks(*(*paths_)[p])) live_[p] = 0;
}

void GraspGraphChecks::edges_for_held() {
  const std::vector<Item> items = open_steps();
  std::vector<char> answers(items.size());
  run(items.size(), 2, [&](std::size_t i, int worker) {
    const auto [a, b] = ends(items[i]);
    answers[i] = checks_.held_edge_is_free(worker, overlay_of(items[i]).candidate.grasp, a, b);
  });
  stats_.edges_checked_held += items.size();
  take_steps(items, answers, true);
}

}  // namespace mmgrasp::detail
