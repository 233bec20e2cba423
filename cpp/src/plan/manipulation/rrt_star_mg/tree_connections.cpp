#include "plan/manipulation/rrt_star_mg/tree_connections.hpp"

#include <algorithm>

namespace mmgrasp::detail {

TreeConnections::TreeConnections(const GraspTrees& trees)
    : trees_(trees), last_(trees.ends().size(), -1), best_(last_.size()) {}

double TreeConnections::cost(int connection) const {
  const Connection& own = connections_[connection];
  const GraspTrees::Vertex& start = trees_.vertex(own.start_vertex);
  return trees_.ends().cost(GraspTrees::grasp_of(start.tree)) + start.cost + own.length +
         trees_.vertex(own.goal_vertex).cost;
}

bool TreeConnections::alive(const Connection& connection) const {
  return trees_.vertex(connection.start_vertex).alive && trees_.vertex(connection.goal_vertex).alive;
}

void TreeConnections::add(int a, int b) {
  if (GraspTrees::side_of(trees_.vertex(a).tree) == GraspEnds::kGoal) std::swap(a, b);
  int& last = last_[GraspTrees::grasp_of(trees_.vertex(a).tree)];
  connections_.push_back({a, b, trees_.vertex_distance(a, b), last});
  last = static_cast<int>(connections_.size()) - 1;
}

void TreeConnections::remove(int grasp, int connection) {
  int* link = &last_[grasp];
  while (*link != connection) link = &connections_[*link].next;
  *link = connections_[connection].next;
}

const TreeConnections::BestPath& TreeConnections::update(int grasp) {
  BestPath& best = best_[grasp];
  best = {};
  for (int* link = &last_[grasp]; *link >= 0;) {
    const int index = *link;
    Connection& own = connections_[index];
    if (!alive(own)) {
      *link = own.next;
      continue;
    }
    const double through = cost(index);
    if (through < best.cost) best = {through, index};
    link = &own.next;
  }
  return best;
}

bool TreeConnections::trace_path(int grasp, Branches& out) const {
  for (auto& branch : out) branch.clear();
  const int index = best_[grasp].connection;
  if (index < 0 || !alive(connections_[index])) return false;
  for (int v = connections_[index].start_vertex; v >= 0; v = trees_.vertex(v).parent) out[0].push_back(v);
  for (int v = connections_[index].goal_vertex; v >= 0; v = trees_.vertex(v).parent) out[1].push_back(v);
  return true;
}

std::vector<int> TreeConnections::vertices(int connection, std::size_t& crossing) const {
  const Connection& own = connections_[connection];
  std::vector<int> out;
  for (int v = own.start_vertex; v >= 0; v = trees_.vertex(v).parent) out.push_back(v);
  std::reverse(out.begin(), out.end());
  crossing = out.size();
  for (int v = own.goal_vertex; v >= 0; v = trees_.vertex(v).parent) out.push_back(v);
  return out;
}

int TreeConnections::draw_grasp(Rng& rng, int grasps) {
  const std::size_t at = rng.index(listed_.size());
  const int grasp = listed_[at];
  if (grasp < grasps && best_[grasp].connection >= 0) return grasp;
  listed_[at] = listed_.back();
  listed_.pop_back();
  best_[grasp] = {};
  return -1;
}

}  // namespace mmgrasp::detail
