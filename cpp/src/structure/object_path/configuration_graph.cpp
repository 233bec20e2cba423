#include "structure/object_path/configuration_graph.hpp"

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

constexpr double kNone = kInfinity;

ConfigurationGraph::ConfigurationGraph(const std::vector<int>& sizes) {
  for (const int size : sizes) alive_.emplace_back(size, 1);
  for (std::size_t i = 0; i + 1 < sizes.size(); ++i) {
    edges_.push_back(Eigen::MatrixXd::Constant(sizes[i + 1], sizes[i], kNone));
  }
}

ConfigurationGraph::Path ConfigurationGraph::cheapest() const {
  std::vector<double> cost;
  for (const char alive : alive_[0]) cost.push_back(alive ? 0 : kNone);
  std::vector<std::vector<int>> before;
  for (std::size_t layer = 0; layer < edges_.size(); ++layer) {
    std::vector<double> next(alive_[layer + 1].size(), kNone);
    before.emplace_back(next.size(), -1);
    for (std::size_t from = 0; from < cost.size(); ++from) {
      if (cost[from] == kNone) continue;
      const double* way = edges_[layer].col(static_cast<long>(from)).data();
      for (std::size_t to = 0; to < next.size(); ++to) {
        const double through = cost[from] + way[to];
        if (through >= next[to] || !alive_[layer + 1][to]) continue;
        next[to] = through;
        before[layer][to] = static_cast<int>(from);
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

int ConfigurationGraph::gaps() const {
  int count = 0;
  std::vector<char> reached = alive_[0];
  for (std::size_t layer = 0; layer < edges_.size(); ++layer) {
    std::vector<char> next(alive_[layer + 1].size(), 0);
    bool any = false;
    for (std::size_t to = 0; to < next.size(); ++to) {
      for (std::size_t from = 0; from < reached.size() && !next[to]; ++from) {
        next[to] = reached[from] && alive_[layer + 1][to] &&
                   edges_[layer](static_cast<long>(to), static_cast<long>(from)) < kNone;
      }
      any = any || next[to];
    }
    if (!any) {
      next = alive_[layer + 1];
      ++count;
    }
    reached.swap(next);
  }
  return count;
}

}  // namespace mmgrasp::detail
