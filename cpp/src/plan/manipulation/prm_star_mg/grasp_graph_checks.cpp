#include "plan/manipulation/prm_star_mg/grasp_graph_checks.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "mmgrasp/core/parallel.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kSampleSpacing = 0.4;               // Spacing of the configurations that stand for an edge [rad or m].
constexpr int kMaxSampleDepth = 5;                   // Halvings of an edge for these.
constexpr std::size_t kMinParallelVertices = 64;     // Fewer vertices are checked in one thread,
constexpr std::size_t kMinParallelEdgeSamples = 16;  // ... fewer edges by their samples,
constexpr std::size_t kMinParallelEdges = 2;         // ... and fewer edges as a whole.

/// A vertex or edge of the roadmap to be checked for the robot at an opening, and the path that needs it.
struct RobotQuery {
  int opening, number, path, index;
};

/// Removes duplicate queries, keeping the first path's.
std::vector<RobotQuery> without_duplicates(std::vector<RobotQuery> queries) {
  const auto key = [](const RobotQuery& q) { return std::tie(q.opening, q.number, q.path, q.index); };
  std::sort(queries.begin(), queries.end(), [&](const RobotQuery& a, const RobotQuery& b) { return key(a) < key(b); });
  const auto same = [](const RobotQuery& a, const RobotQuery& b) {
    return a.opening == b.opening && a.number == b.number;
  };
  queries.erase(std::unique(queries.begin(), queries.end(), same), queries.end());
  return queries;
}

}  // namespace

GraspGraphChecks::GraspGraphChecks(const Roadmap& roadmap, TransferChecks& checks,
                                   std::vector<EdgeValidityCache>& robot_caches, int threads, const Monitor& monitor,
                                   ManipulationStats& stats)
    : roadmap_(roadmap), checks_(checks), robot_caches_(robot_caches), threads_(threads), stats_(stats) {
  cancel_.stop = monitor.stop;
}

std::vector<char> GraspGraphChecks::check(const std::vector<GraspGraph*>& paths) {
  paths_ = &paths;
  free_.assign(paths.size(), 1);
  check_vertices_for_robot();
  check_vertices_for_attached();
  check_edge_samples();
  check_edges_for_robot();
  check_edges_for_attached();
  return free_;
}

void GraspGraphChecks::run(std::size_t count, std::size_t min_parallel,
                           const std::function<void(std::size_t, int)>& work) {
  parallel_for(count, count >= min_parallel ? threads_ : 1, work, cancel_);
}

// Starts and goals were checked with their inverse kinematics.
void GraspGraphChecks::check_vertices_for_robot() {
  std::vector<RobotQuery> queries;
  for (std::size_t p = 0; p < paths_->size(); ++p) {
    const GraspGraph& graph = *(*paths_)[p];
    for (const int node : graph.nodes)
      if (node < graph.vertex_count && robot_of(graph).vertex(node) == EdgeValidityCache::unknown)
        queries.push_back({graph.candidate.opening, node, static_cast<int>(p), 0});
  }
  queries = without_duplicates(std::move(queries));
  run(queries.size(), kMinParallelVertices, [&](std::size_t i, int worker) {
    const auto& [opening, vertex, path, index] = queries[i];
    robot_caches_[opening].set_vertex(vertex, checks_.robot_is_free(worker, opening, roadmap_.vertices().col(vertex)));
  });
  for (std::size_t p = 0; p < paths_->size(); ++p) {
    const GraspGraph& graph = *(*paths_)[p];
    for (const int node : graph.nodes)
      if (node < graph.vertex_count && robot_of(graph).vertex(node) == EdgeValidityCache::blocked) free_[p] = 0;
  }
}

void GraspGraphChecks::check_vertices_for_attached() {
  std::vector<Item> items;
  for (std::size_t p = 0; p < paths_->size(); ++p) {
    if (!free_[p]) continue;
    const GraspGraph& graph = *(*paths_)[p];
    for (const int node : graph.nodes)
      if (node < graph.vertex_count && graph.free_vertices.count(node) == 0)
        items.push_back({static_cast<int>(p), node});
  }
  std::vector<char> answers(items.size());
  run(items.size(), kMinParallelVertices, [&](std::size_t i, int worker) {
    const Item& item = items[i];
    answers[i] = checks_.attached_is_free(worker, graph_of(item).candidate.grasp, roadmap_.vertices().col(item.index));
  });
  for (std::size_t i = 0; i < items.size(); ++i) {
    GraspGraph& graph = graph_of(items[i]);
    if (answers[i]) {
      graph.free_vertices.insert(items[i].index);
    } else {
      graph.blocked_vertices.push_back(items[i].index);
      free_[items[i].path] = 0;
    }
  }
}

// What blocks an edge tends to block a good part of it: a few configurations find most of those that are blocked.
void GraspGraphChecks::check_edge_samples() {
  const std::vector<Item> items = unknown_steps();
  std::vector<char> answers(items.size());
  run(items.size(), kMinParallelEdgeSamples, [&](std::size_t i, int worker) {
    const GraspCandidate& candidate = graph_of(items[i]).candidate;
    const bool is_link = step_of(items[i]).is_link();
    const auto [a, b] = ends_of(items[i]);
    const auto is_free = [&, &a = a, &b = b](double t) {
      const Eigen::VectorXd q = a + t * (b - a);
      return checks_.attached_is_free(worker, candidate.grasp, q) &&
             (!is_link || checks_.robot_is_free(worker, candidate.opening, q));
    };
    // The middles first: 1/2, 1/4, 3/4, 1/8, ...
    const int depth = static_cast<int>(std::ceil(std::log2(std::max(1.0, (b - a).norm() / kSampleSpacing))));
    bool all = true;
    for (int level = 1; level <= std::min(depth, kMaxSampleDepth) && all; ++level)
      for (int k = 1; k < (1 << level) && all; k += 2) all = is_free(std::ldexp(k, -level));
    answers[i] = all;
  });
  record_steps(items, answers, false);
}

void GraspGraphChecks::check_edges_for_robot() {
  const std::vector<Item> items = unknown_steps_for_robot();
  std::vector<char> answers(items.size());
  run(items.size(), kMinParallelEdges, [&](std::size_t i, int worker) {
    const auto [a, b] = ends_of(items[i]);
    answers[i] = checks_.robot_edge_is_free(worker, graph_of(items[i]).candidate.opening, a, b);
  });
  stats_.edges_checked_robot += items.size();
  for (std::size_t i = 0; i < items.size(); ++i) record_step_for_robot(items[i], answers[i] != 0);
  for (std::size_t p = 0; p < paths_->size(); ++p)
    if (robot_blocks(*(*paths_)[p])) free_[p] = 0;
}

void GraspGraphChecks::check_edges_for_attached() {
  const std::vector<Item> items = unknown_steps();
  std::vector<char> answers(items.size());
  run(items.size(), kMinParallelEdges, [&](std::size_t i, int worker) {
    const auto [a, b] = ends_of(items[i]);
    answers[i] = checks_.attached_edge_is_free(worker, graph_of(items[i]).candidate.grasp, a, b);
  });
  stats_.edges_checked_attached += items.size();
  record_steps(items, answers, true);
}

std::vector<GraspGraphChecks::Item> GraspGraphChecks::unknown_steps() const {
  std::vector<Item> items;
  for (std::size_t p = 0; p < paths_->size(); ++p) {
    if (!free_[p]) continue;
    const GraspGraph& graph = *(*paths_)[p];
    for (std::size_t i = 0; i < graph.steps.size(); ++i)
      if (!graph.is_free(graph.steps[i])) items.push_back({static_cast<int>(p), static_cast<int>(i)});
  }
  return items;
}

std::vector<GraspGraphChecks::Item> GraspGraphChecks::unknown_steps_for_robot() const {
  std::vector<Item> items;
  std::vector<RobotQuery> edges;
  for (const Item& item : unknown_steps()) {
    const GraspGraph& graph = graph_of(item);
    const Step step = step_of(item);
    if (step.is_link()) {  // A link belongs to one path only.
      if (!graph.link(step.number()).robot_is_free) items.push_back(item);
    } else if (robot_of(graph).edge(step.number()) == EdgeValidityCache::unknown) {
      edges.push_back({graph.candidate.opening, step.number(), item.path, item.index});
    }
  }
  for (const RobotQuery& edge : without_duplicates(std::move(edges))) items.push_back({edge.path, edge.index});
  return items;
}

bool GraspGraphChecks::robot_blocks(const GraspGraph& graph) const {
  return std::any_of(graph.steps.begin(), graph.steps.end(), [&](Step step) {
    return step.is_link() ? graph.link(step.number()).blocked
                          : robot_of(graph).edge(step.number()) == EdgeValidityCache::blocked;
  });
}

void GraspGraphChecks::record_step_for_robot(const Item& item, bool is_free) {
  GraspGraph& graph = graph_of(item);
  const Step step = step_of(item);
  if (!step.is_link()) return robot_of(graph).set_edge(step.number(), is_free);
  GraspGraph::Link& link = graph.link(step.number());
  link.robot_is_free = is_free;
  link.blocked = !is_free;
}

void GraspGraphChecks::record_steps(const std::vector<Item>& items, const std::vector<char>& answers, bool complete) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (!answers[i]) free_[items[i].path] = 0;
    if (!answers[i] || complete) graph_of(items[i]).set_step(step_of(items[i]), answers[i] != 0);
  }
}

std::pair<Eigen::VectorXd, Eigen::VectorXd> GraspGraphChecks::ends_of(const Item& step) const {
  const GraspGraph& graph = graph_of(step);
  const Eigen::VectorXd from = graph.configuration(roadmap_, graph.nodes[step.index]);
  const Eigen::VectorXd to = graph.configuration(roadmap_, graph.nodes[step.index + 1]);
  return {from, graph.candidate.metric.nearest(from, to)};
}

}  // namespace mmgrasp::detail
