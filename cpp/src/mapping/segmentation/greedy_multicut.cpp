#include "mapping/segmentation/greedy_multicut.hpp"
#include "mmgrasp/core/detail/interruption.hpp"

#include <map>
#include <queue>
#include <utility>

namespace mmgrasp::detail {
namespace {

struct Contraction {
  double weight;
  int a, b;
  bool operator<(const Contraction& other) const {
    if (weight != other.weight) return weight < other.weight;
    return std::make_pair(a, b) > std::make_pair(other.a, other.b);
  }
};

/// Contracts the edge of the largest positive weight, again and again; weights of parallel edges add up.
class Contractor {
 public:
  Contractor(int nodes, const std::vector<SignedEdge>& edges) : around_(nodes), parent_(nodes) {
    for (int i = 0; i < nodes; ++i) parent_[i] = i;
    for (const SignedEdge& e : edges) {
      if (e.a == e.b) continue;
      around_[e.a][e.b] += e.weight;
      around_[e.b][e.a] += e.weight;
    }
    for (int i = 0; i < nodes; ++i) {
      for (const auto& [j, weight] : around_[i]) {
        if (i < j) offer(i, j, weight);
      }
    }
  }

  std::vector<int> parts() {
    InterruptionPoll poll(64);
    while (!queue_.empty()) {
      poll();
      const Contraction next = queue_.top();
      queue_.pop();
      const auto edge = around_[next.a].find(next.b);
      if (edge != around_[next.a].end() && edge->second == next.weight) join(next.a, next.b);
    }
    std::vector<int> part(parent_.size(), -1);
    int parts = 0;
    for (std::size_t i = 0; i < parent_.size(); ++i) {
      int root = static_cast<int>(i);
      while (parent_[root] != root) root = parent_[root];
      if (part[root] < 0) part[root] = parts++;
      part[i] = part[root];
    }
    return part;
  }

 private:
  void offer(int a, int b, double weight) {
    if (weight > 0) queue_.push({weight, std::min(a, b), std::max(a, b)});
  }

  /// The one with fewer edges joins the other; an edge that has changed is offered anew, the old offer does not fit it.
  void join(int a, int b) {
    if (around_[a].size() < around_[b].size()) std::swap(a, b);
    parent_[b] = a;
    around_[a].erase(b);
    for (const auto& [other, weight] : around_[b]) {
      around_[other].erase(b);
      if (other == a) continue;
      const double sum = around_[a][other] += weight;
      around_[other][a] = sum;
      offer(a, other, sum);
    }
    around_[b].clear();
  }

  std::vector<std::map<int, double>> around_;
  std::vector<int> parent_;
  std::priority_queue<Contraction> queue_;
};

}  // namespace

std::vector<int> greedy_multicut(int nodes, const std::vector<SignedEdge>& edges) {
  return Contractor(nodes, edges).parts();
}

}  // namespace mmgrasp::detail
