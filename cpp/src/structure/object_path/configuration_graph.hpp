#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// Configurations in layers, one a waypoint, joined from layer to layer (P2 figure 3.8). Vertices and edges can be
/// taken out; the cheapest path from any vertex of the first layer to any of the last is found by dynamic programming.
/// Only edges that exist take room.
class MMGRASP_EXPORT ConfigurationGraph {
 public:
  /// A graph without edges, with so many vertices in each layer.
  explicit ConfigurationGraph(const std::vector<int>& sizes);

  /// Joins a vertex of `layer` to one of the next. Edges of a layer must come with `to` ascending.
  void add_edge(std::size_t layer, int from, int to, double cost);
  void remove_edge(std::size_t layer, int from, int to);
  void remove_vertex(std::size_t layer, int vertex) { alive_[layer][vertex] = false; }
  bool alive(std::size_t layer, int vertex) const { return alive_[layer][vertex] != 0; }
  std::size_t layers() const { return alive_.size(); }

  struct Path {
    double cost = kInfinity;
    std::vector<int> vertices;  ///< One a layer; empty when there is none.
  };
  /// Says whether a vertex or an edge may stay. Asked once of each that could be part of the cheapest path to some
  /// vertex; what may not stay is taken out.
  struct Check {
    std::function<bool(std::size_t layer, int vertex)> vertex;
    std::function<bool(std::size_t layer, int from, int to)> edge;
  };
  Path cheapest(const Check* check = nullptr);
  /// For each layer but the last whether some vertex reached so far is joined to the next layer (0), whether none ever
  /// was (1), or whether all such edges were taken out (2). After a gap all vertices of the next layer count as
  /// reached.
  std::vector<int> gaps() const;

 private:
  struct Edge {
    int from;
    bool checked;
    double cost;  ///< Infinite once taken out.
  };
  /// Edges to the next layer's vertices in order: vertex v has those from first[v] to first[v + 1].
  struct Layer {
    std::vector<int> first;
    std::vector<Edge> edges;
  };
  std::pair<std::size_t, std::size_t> range(const Layer& layer, std::size_t to) const;

  std::vector<std::vector<char>> alive_, vertex_checked_;
  std::vector<Layer> joins_;
};

}  // namespace mmgrasp::detail
