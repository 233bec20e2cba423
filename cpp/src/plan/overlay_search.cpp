#include "plan/overlay_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace mmgrasp::detail {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kSlack = 1e-9;  // Relative, for sums taken in another order (errata on Algorithm 4.2).

}  // namespace

GraspOverlay::GraspOverlay(const Roadmap& roadmap, CarryCandidate candidate_in)
    : candidate(std::move(candidate_in)), vertex_count(roadmap.size()) {}

Eigen::VectorXd GraspOverlay::configuration(const Roadmap& roadmap, int node) const {
  if (node < vertex_count) return roadmap.vertices().col(node);
  const int end = node - vertex_count, starts = static_cast<int>(candidate.starts.size());
  return end < starts ? start(end) : goal(end - starts);
}

void GraspOverlay::block(int step) {
  if (step >= 0) {
    passed_edges.erase(step);
    blocked_edges.insert(step);
  } else {
    Link& link = links[static_cast<std::size_t>(-1 - step)];
    link.passed = false;
    link.blocked = true;
  }
}

void GraspOverlay::connect(const Roadmap& roadmap) {
  if (connected) return;
  connected = true;
  std::vector<int> near;
  const int starts = static_cast<int>(candidate.starts.size()), goals = static_cast<int>(candidate.goals.size());
  from_start.resize(candidate.starts.size());
  const auto add = [&](int from, int to) {
    links.push_back({from, to, (configuration(roadmap, from) - configuration(roadmap, to)).norm()});
    return static_cast<int>(links.size()) - 1;
  };
  for (int s = 0; s < starts; ++s) {
    roadmap.near(start(s), near);
    for (const int v : near) from_start[static_cast<std::size_t>(s)].push_back(add(vertex_count + s, v));
    // The straight way is tried whatever its length: free, it is the best there is.
    for (int g = 0; g < goals; ++g)
      from_start[static_cast<std::size_t>(s)].push_back(add(vertex_count + s, vertex_count + starts + g));
  }
  for (int g = 0; g < goals; ++g) {
    roadmap.near(goal(g), near);
    for (const int v : near) into_goals.push_back(add(v, vertex_count + starts + g));
  }
  std::stable_sort(into_goals.begin(), into_goals.end(), [&](int a, int b) {
    return links[static_cast<std::size_t>(a)].from < links[static_cast<std::size_t>(b)].from;
  });
}

OverlaySearch::OverlaySearch(const Roadmap& roadmap)
    : roadmap_(roadmap), first_goal_link_(static_cast<std::size_t>(roadmap.size()), -1) {}

double OverlaySearch::to_goal(int node) {
  const auto at = static_cast<std::size_t>(node);
  if (heuristic_stamp_[at] == round_) return heuristic_[at];
  heuristic_stamp_[at] = round_;
  double least = kInfinite;
  if (node < overlay_->vertex_count) {
    const auto q = roadmap_.vertices().col(node);
    for (const Eigen::VectorXd& goal : overlay_->candidate.goals) least = std::min(least, (goal - q).squaredNorm());
  } else {
    const Eigen::VectorXd q = overlay_->configuration(roadmap_, node);
    for (const Eigen::VectorXd& goal : overlay_->candidate.goals) least = std::min(least, (goal - q).squaredNorm());
  }
  return heuristic_[at] = std::sqrt(least);
}

void OverlaySearch::relax(int node, double cost, int parent, int step, double limit) {
  const auto at = static_cast<std::size_t>(node);
  if (stamp_[at] == round_ && cost >= cost_[at]) return;
  const double key = cost + to_goal(node);
  if (key > limit) return;
  stamp_[at] = round_;
  cost_[at] = cost;
  parent_[at] = parent;
  step_[at] = step;
  heap_.push_back({key, cost, node});
  std::push_heap(heap_.begin(), heap_.end(),
                 [](const Entry& a, const Entry& b) { return a.key != b.key ? a.key > b.key : a.node > b.node; });
}

bool OverlaySearch::search(GraspOverlay& overlay, const RoadmapKnowledge& robot, double bound) {
  overlay.connect(roadmap_);
  overlay_ = &overlay;
  ++round_;
  heap_.clear();
  const int starts = static_cast<int>(overlay.candidate.starts.size());
  const int first_goal = overlay.vertex_count + starts;
  const auto nodes = static_cast<std::size_t>(first_goal) + overlay.candidate.goals.size();
  if (cost_.size() < nodes) {
    cost_.resize(nodes);
    heuristic_.resize(nodes);
    parent_.resize(nodes);
    step_.resize(nodes);
    stamp_.resize(nodes, 0);
    heuristic_stamp_.resize(nodes, 0);
  }
  const auto& links = overlay.links;
  for (std::size_t i = overlay.into_goals.size(); i-- > 0;)
    first_goal_link_[static_cast<std::size_t>(links[static_cast<std::size_t>(overlay.into_goals[i])].from)] =
        static_cast<int>(i);
  const double limit = (bound - overlay.candidate.cost) * (1 + kSlack);
  const auto vertex_blocked = [&](int v) {
    return robot.vertices[static_cast<std::size_t>(v)] == RoadmapKnowledge::blocked ||
           (!overlay.blocked_vertices.empty() && overlay.blocked_vertices.count(v) > 0);
  };
  const auto follow = [&](int from, double cost, int link) {
    const GraspOverlay::Link& l = links[static_cast<std::size_t>(link)];
    if (l.blocked || (l.to < overlay.vertex_count && vertex_blocked(l.to))) return;
    relax(l.to, cost + l.length, from, -1 - link, limit);
  };
  for (int s = 0; s < starts; ++s) relax(overlay.vertex_count + s, 0, -1, 0, limit);

  int reached = -1;
  while (!heap_.empty()) {
    const Entry top = heap_.front();
    std::pop_heap(heap_.begin(), heap_.end(),
                  [](const Entry& a, const Entry& b) { return a.key != b.key ? a.key > b.key : a.node > b.node; });
    heap_.pop_back();
    const auto at = static_cast<std::size_t>(top.node);
    if (top.cost > cost_[at]) continue;  // An older, longer way.
    if (top.node >= first_goal) {
      reached = top.node;
      break;
    }
    if (top.node >= overlay.vertex_count) {
      for (const int link : overlay.from_start[at - static_cast<std::size_t>(overlay.vertex_count)])
        follow(top.node, top.cost, link);
      continue;
    }
    for (const Roadmap::Arc* arc = roadmap_.begin(top.node); arc != roadmap_.end(top.node); ++arc) {
      if (robot.edges[static_cast<std::size_t>(arc->edge)] == RoadmapKnowledge::blocked || vertex_blocked(arc->to))
        continue;
      if (!overlay.blocked_edges.empty() && overlay.blocked_edges.count(arc->edge) > 0) continue;
      relax(arc->to, top.cost + arc->length, top.node, arc->edge, limit);
    }
    for (int i = first_goal_link_[at]; i >= 0 && i < static_cast<int>(overlay.into_goals.size()); ++i) {
      const int link = overlay.into_goals[static_cast<std::size_t>(i)];
      if (links[static_cast<std::size_t>(link)].from != top.node) break;
      follow(top.node, top.cost, link);
    }
  }
  for (const int link : overlay.into_goals)
    first_goal_link_[static_cast<std::size_t>(links[static_cast<std::size_t>(link)].from)] = -1;
  if (reached < 0) return false;
  overlay.nodes.clear();
  overlay.steps.clear();
  for (int node = reached; node >= 0; node = parent_[static_cast<std::size_t>(node)]) {
    overlay.nodes.push_back(node);
    if (parent_[static_cast<std::size_t>(node)] >= 0) overlay.steps.push_back(step_[static_cast<std::size_t>(node)]);
  }
  std::reverse(overlay.nodes.begin(), overlay.nodes.end());
  std::reverse(overlay.steps.begin(), overlay.steps.end());
  overlay.path_cost = cost_[static_cast<std::size_t>(reached)] + overlay.candidate.cost;
  return true;
}

double spliced_cost(const Roadmap& roadmap, const GraspOverlay& overlay, const std::vector<int>& nodes) {
  std::unordered_map<int, double> along;  // Cost so far at each roadmap vertex of the path.
  double sum = 0;
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
    if (i > 1) sum += (roadmap.vertices().col(nodes[i]) - roadmap.vertices().col(nodes[i - 1])).norm();
    along.emplace(nodes[i], sum);
  }
  // Leaving the path later saves nothing but the way between: keep the best entry before each exit.
  std::vector<std::pair<double, double>> entries, exits;  // Position along the path, cost of the link.
  for (const GraspOverlay::Link& link : overlay.links) {
    if (link.blocked) continue;
    const auto in = along.find(link.to), out = along.find(link.from);
    if (link.from >= overlay.vertex_count && in != along.end()) entries.emplace_back(in->second, link.length);
    if (link.to >= overlay.vertex_count && out != along.end()) exits.emplace_back(out->second, link.length);
  }
  std::sort(entries.begin(), entries.end());
  std::sort(exits.begin(), exits.end());
  double best = kInfinite, entry = kInfinite;
  std::size_t next = 0;
  for (const auto& [position, length] : exits) {
    for (; next < entries.size() && entries[next].first <= position; ++next)
      entry = std::min(entry, entries[next].second - entries[next].first);
    best = std::min(best, entry + position + length);
  }
  return best + overlay.candidate.cost;
}

}  // namespace mmgrasp::detail
