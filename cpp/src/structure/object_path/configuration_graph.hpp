#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace mmgrasp::detail {

/// Configurations in layers, one a waypoint, joined from layer to layer (P2 figure 3.8). Vertices and edges can be
/// taken out; the cheapest path from any vertex of the first layer to any of the last is found by dynamic programming.
class ConfigurationGraph {
 public:
  /// An empty graph with so many vertices in each layer; edges cost infinity until set.
  explicit ConfigurationGraph(const std::vector<int>& sizes);

  double& edge(std::size_t layer, int from, int to) { return edges_[layer](to, from); }
  void remove_vertex(std::size_t layer, int vertex) { alive_[layer][vertex] = false; }
  bool alive(std::size_t layer, int vertex) const { return alive_[layer][vertex] != 0; }
  std::size_t layers() const { return alive_.size(); }
  int size(std::size_t layer) const { return static_cast<int>(alive_[layer].size()); }

  struct Path {
    double cost = std::numeric_limits<double>::infinity();
    std::vector<int> vertices;  ///< One a layer; empty when there is none.
  };
  Path cheapest() const;
  /// Layers that no vertex reached so far is joined to; from each such layer on, all of its vertices count as reached.
  int gaps() const;

 private:
  std::vector<std::vector<char>> alive_;
  std::vector<Eigen::MatrixXd> edges_;  ///< Into a layer's vertex (row) from one of the layer before (column).
};

}  // namespace mmgrasp::detail
