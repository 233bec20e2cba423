#include "plan/manipulation/prm_star_mg/grasp_graph_search.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

constexpr std::size_t kCancelCheckInterval = 256;  // Nodes expanded between two calls of stopped().

}  // namespace

GraspGraphSearch::GraspGraphSearch(const Roadmap& roadmap)
    : roadmap_(roadmap), edge_blocked_(roadmap.edge_count(), 0), first_goal_link_(roadmap.size(), -1) {}

double GraspGraphSearch::heuristic(int node) const {
  double least = kInfinity;
  const JointMetric& metric = graph_->candidate.metric;
  const auto nearest = [&](const auto& q) {
    for (const Eigen::VectorXd& goal : graph_->candidate.goals)
      least = std::min(least, metric.squared_distance(goal, q));
  };
  if (node < graph_->vertex_count)
    nearest(roadmap_.vertices().col(node));
  else
    nearest(graph_->configuration(roadmap_, node));
  return std::sqrt(least);
}

void GraspGraphSearch::begin(const GraspGraph& graph) {
  graph_ = &graph;
  ++round_;
  nodes_opened_ = 0;
  heap_.clear();
  const std::size_t count = graph.first_goal() + graph.goals();
  if (nodes_.size() < count) nodes_.resize(count);
  for (const int v : graph.blocked_vertices) nodes_[v].blocked = round_;
  for (const int e : graph.blocked_edges) edge_blocked_[e] = round_;
  for (std::size_t i = graph.into_goals.size(); i-- > 0;)
    first_goal_link_[graph.link(graph.into_goals[i]).from] = static_cast<int>(i);
}

void GraspGraphSearch::relax(int node, double cost, int parent, Step step) {
  Node& at = nodes_[node];
  if (at.blocked == round_) return;
  if (at.stamp != round_) {
    at.stamp = round_;
    at.cost = kInfinity;
    at.heuristic = heuristic(node);
  }
  const double key = cost + at.heuristic;
  if (cost >= at.cost || key > limit_) return;
  at.cost = cost;
  at.parent = parent;
  at.step = step;
  ++nodes_opened_;
  heap_.push_back({key, cost, node});
  std::push_heap(heap_.begin(), heap_.end(), later);
}

void GraspGraphSearch::relax_link(int from, double cost, int link) {
  const GraspGraph::Link& l = graph_->link(link);
  if (!l.blocked) relax(l.to, cost + l.length, from, Step::link(link));
}

void GraspGraphSearch::expand_vertex(const Entry& at, const EdgeValidityCache& robot) {
  for (const Roadmap::Arc* arc = roadmap_.begin(at.node); arc != roadmap_.end(at.node); ++arc) {
    if (robot.vertex(arc->to) == EdgeValidityCache::blocked || robot.edge(arc->edge) == EdgeValidityCache::blocked ||
        edge_blocked_[arc->edge] == round_)
      continue;
    relax(arc->to, at.cost + arc->length, at.node, Step::edge(arc->edge));
  }
  const int first = first_goal_link_[at.node];
  for (int i = first; i >= 0 && i < static_cast<int>(graph_->into_goals.size()); ++i) {
    const int link = graph_->into_goals[i];
    if (graph_->link(link).from != at.node) break;
    relax_link(at.node, at.cost, link);
  }
}

GraspGraphSearch::End GraspGraphSearch::search(GraspGraph& graph, const EdgeValidityCache& robot, double bound) {
  begin(graph);
  limit_ = (bound - graph.candidate.cost) * (1 + kSlack);
  for (int s = 0; s < graph.starts(); ++s) relax(graph.vertex_count + s, 0, -1, {});
  int reached = -1;
  bool cancelled = false;
  std::size_t expanded = 0;
  while (!heap_.empty()) {
    const Entry top = heap_.front();
    std::pop_heap(heap_.begin(), heap_.end(), later);
    heap_.pop_back();
    if (top.cost > nodes_[top.node].cost) continue;  // Reached on a shorter path since.
    if (top.node >= graph.first_goal()) {
      reached = top.node;
      break;
    }
    lower_bound_ = top.key + graph.candidate.cost;
    cancelled = ++expanded % kCancelCheckInterval == 0 && stopped && stopped();
    if (cancelled) break;
    if (top.node >= graph.vertex_count) {
      for (const int link : graph.from_start[top.node - graph.vertex_count]) relax_link(top.node, top.cost, link);
      continue;
    }
    EdgeValidityCache::State state = robot.vertex(top.node);
    if (state == EdgeValidityCache::unknown && robot_is_free) {
      const bool is_free = robot_is_free(top.node);
      robot.set_vertex(top.node, is_free);
      state = is_free ? EdgeValidityCache::free : EdgeValidityCache::blocked;
    }
    if (state == EdgeValidityCache::blocked) continue;
    expand_vertex(top, robot);
  }
  for (const int link : graph.into_goals) first_goal_link_[graph.link(link).from] = -1;
  if (cancelled) return End::cancelled;
  if (reached < 0) return End::none;
  take_path(graph, reached);
  return End::found;
}

void GraspGraphSearch::take_path(GraspGraph& graph, int goal) const {
  graph.nodes.clear();
  graph.steps.clear();
  for (int node = goal; node >= 0; node = nodes_[node].parent) {
    graph.nodes.push_back(node);
    const Node& at = nodes_[node];
    if (at.parent >= 0) graph.steps.push_back(at.step);
  }
  std::reverse(graph.nodes.begin(), graph.nodes.end());
  std::reverse(graph.steps.begin(), graph.steps.end());
  graph.path_cost = nodes_[goal].cost + graph.candidate.cost;
}

double spliced_cost(const Roadmap& roadmap, const GraspGraph& graph, const std::vector<int>& nodes) {
  std::unordered_map<int, double> along;  // Cost from the first roadmap vertex of the path.
  double sum = 0;
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
    if (i > 1)
      sum += graph.candidate.metric.distance(roadmap.vertices().col(nodes[i]), roadmap.vertices().col(nodes[i - 1]));
    along.emplace(nodes[i], sum);
  }
  // A detour leaves the path at an exit; of the entries before it only the best counts.
  std::vector<std::pair<double, double>> entries, exits;  // Position along the path, cost of the link.
  for (const GraspGraph::Link& link : graph.links) {
    if (link.blocked) continue;
    const auto in = along.find(link.to), out = along.find(link.from);
    if (link.from >= graph.vertex_count && in != along.end()) entries.emplace_back(in->second, link.length);
    if (link.to >= graph.vertex_count && out != along.end()) exits.emplace_back(out->second, link.length);
  }
  std::sort(entries.begin(), entries.end());
  std::sort(exits.begin(), exits.end());
  double best = kInfinity, entry = kInfinity;
  std::size_t next = 0;
  for (const auto& [position, length] : exits) {
    for (; next < entries.size() && entries[next].first <= position; ++next)
      entry = std::min(entry, entries[next].second - entries[next].first);
    best = std::min(best, entry + position + length);
  }
  return best + graph.candidate.cost;
}

}  // namespace mmgrasp::detail
