#include "plan/manipulation/prm_star_mg/grasp_graph.hpp"

#include <algorithm>

namespace mmgrasp::detail {

GraspGraph::GraspGraph(const Roadmap& roadmap, GraspCandidate candidate_in)
    : candidate(std::move(candidate_in)), vertex_count(roadmap.size()) {}

Eigen::VectorXd GraspGraph::configuration(const Roadmap& roadmap, int node) const {
  if (node < vertex_count) return roadmap.vertices().col(node);
  return node < first_goal() ? start(node - vertex_count) : goal(node - first_goal());
}

void GraspGraph::set_step(Step step, bool is_free) {
  const int number = step.number();
  if (step.is_link()) {
    link(number).free = is_free;
    link(number).blocked = !is_free;
  } else if (is_free) {
    free_edges.insert(number);
  } else {
    free_edges.erase(number);
    blocked_edges.push_back(number);
  }
}

void GraspGraph::connect(const Roadmap& roadmap, bool straight, double bound) {
  if (connected) return;
  connected = true;
  from_start.resize(candidate.starts.size());
  const auto add = [&](int from, int to, double length) {
    links.push_back({from, to, length});
    return static_cast<int>(links.size()) - 1;
  };
  const double limit = (bound - candidate.cost) * (1 + kSlack);
  std::vector<char> goal_used(candidate.goals.size(), 0);
  std::vector<int> near;
  for (int s = 0; s < starts(); ++s) {
    std::vector<int>& own = from_start[s];
    bool used = false;
    for (int g = 0; g < goals(); ++g) {
      const double length = candidate.metric.distance(goal(g), start(s));
      if (length > limit) continue;
      used = true;
      goal_used[g] = 1;
      if (straight || length <= roadmap.radius()) own.push_back(add(vertex_count + s, first_goal() + g, length));
    }
    if (!used) continue;
    roadmap.near(start(s), near);
    for (const int v : near)
      own.push_back(add(vertex_count + s, v, candidate.metric.distance(roadmap.vertices().col(v), start(s))));
  }
  for (int g = 0; g < goals(); ++g) {
    if (!goal_used[g]) continue;
    roadmap.near(goal(g), near);
    for (const int v : near)
      into_goals.push_back(add(v, first_goal() + g, candidate.metric.distance(roadmap.vertices().col(v), goal(g))));
  }
  std::stable_sort(into_goals.begin(), into_goals.end(), [&](int a, int b) { return links[a].from < links[b].from; });
}

}  // namespace mmgrasp::detail
