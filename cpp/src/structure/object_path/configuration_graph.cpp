#include "structure/object_path/configuration_graph.hpp"

#include <utility>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

constexpr double kNone = kInfinity;

ConfigurationGraph::ConfigurationGraph(const std::vector<int>& sizes) {
  for (const int size : sizes) alive_.emplace_back(size, 1);
  vertex_checked_.resize(sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) vertex_checked_[i].assign(sizes[i], 0);
  if (!sizes.empty()) joins_.resize(sizes.size() - 1);
}

void ConfigurationGraph::add_edge(std::size_t layer, int from, int to, double cost) {
  Layer& joins = joins_[layer];
  while (static_cast<int>(joins.first.size()) <= to) joins.first.push_back(static_cast<int>(joins.edges.size()));
  joins.edges.push_back({from, false, cost});
}

std::pair<std::size_t, std::size_t> ConfigurationGraph::range(const Layer& layer, std::size_t to) const {
  const std::size_t end = layer.edges.size();
  if (to >= layer.first.size()) return {end, end};
  return {layer.first[to], to + 1 < layer.first.size() ? layer.first[to + 1] : end};
}

void ConfigurationGraph::remove_edge(std::size_t layer, int from, int to) {
  const auto [first, last] = range(joins_[layer], to);
  for (std::size_t k = first; k < last; ++k) {
    if (joins_[layer].edges[k].from == from) joins_[layer].edges[k].cost = kNone;
  }
}

ConfigurationGraph::Path ConfigurationGraph::cheapest(const Check* check) {
  const auto stays = [&](std::size_t layer, std::size_t vertex) {
    if (!alive_[layer][vertex]) return false;
    if (check == nullptr || vertex_checked_[layer][vertex]) return true;
    vertex_checked_[layer][vertex] = 1;
    alive_[layer][vertex] = check->vertex(layer, static_cast<int>(vertex));
    return alive_[layer][vertex] != 0;
  };
  std::vector<double> cost(alive_[0].size()), next;
  for (std::size_t i = 0; i < cost.size(); ++i) cost[i] = stays(0, i) ? 0 : kNone;
  std::vector<std::vector<int>> before;
  for (std::size_t layer = 0; layer < joins_.size(); ++layer) {
    Layer& joins = joins_[layer];
    next.assign(alive_[layer + 1].size(), kNone);
    before.emplace_back(next.size(), -1);
    for (std::size_t to = 0; to < next.size(); ++to) {
      if (!alive_[layer + 1][to]) continue;
      const auto [first, last] = range(joins, to);
      for (;;) {
        double least = kNone;
        std::size_t best = last;
        for (std::size_t k = first; k < last; ++k) {
          const double through = cost[joins.edges[k].from] + joins.edges[k].cost;
          if (through >= least) continue;
          least = through;
          best = k;
        }
        if (best == last || !stays(layer + 1, to)) break;
        Edge& edge = joins.edges[best];
        if (check != nullptr && !edge.checked && !check->edge(layer, edge.from, static_cast<int>(to))) {
          edge.cost = kNone;
          continue;
        }
        edge.checked = check != nullptr || edge.checked;
        next[to] = least;
        before[layer][to] = edge.from;
        break;
      }
    }
    cost.swap(next);
  }
  Path path;
  int last = -1;
  for (std::size_t i = 0; i < cost.size(); ++i) {
    if (cost[i] >= path.cost) continue;
    path.cost = cost[i];
    last = static_cast<int>(i);
  }
  if (last < 0) return path;
  path.vertices.assign(layers(), last);
  for (std::size_t layer = layers() - 1; layer > 0; --layer) {
    path.vertices[layer - 1] = before[layer - 1][path.vertices[layer]];
  }
  return path;
}

std::vector<int> ConfigurationGraph::gaps() const {
  std::vector<int> out;
  std::vector<char> reached = alive_[0];
  for (std::size_t layer = 0; layer < joins_.size(); ++layer) {
    std::vector<char> next(alive_[layer + 1].size(), 0);
    bool any = false, was_joined = false;
    for (std::size_t to = 0; to < next.size(); ++to) {
      if (!alive_[layer + 1][to]) continue;
      const auto [first, last] = range(joins_[layer], to);
      for (std::size_t k = first; k < last && !next[to]; ++k) {
        const Edge& edge = joins_[layer].edges[k];
        was_joined = was_joined || reached[edge.from];
        next[to] = reached[edge.from] && edge.cost < kNone;
      }
      any = any || next[to];
    }
    out.push_back(any ? 0 : was_joined ? 2 : 1);
    if (!any) next = alive_[layer + 1];
    reached.swap(next);
  }
  return out;
}

}  // namespace mmgrasp::detail
