#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "plan/manipulation/prm_star_mg/grasp_graph.hpp"

namespace mmgrasp::detail {

/// Shortest paths over the roadmap and one graph: A* with the straight line to the nearest goal as heuristic and an
/// upper bound (P2 Algorithm 4.2). Scratch is reused: one object per thread.
class MMGRASP_EXPORT GraspGraphSearch {
 public:
  enum class End { found, none, gave_up };

  explicit GraspGraphSearch(const Roadmap& roadmap);

  /// Asked of a vertex the robot is not yet known to pass or not, when the search would go on from it; empty: such
  /// vertices count as free. Must answer the same whenever it is asked.
  std::function<bool(int vertex)> robot_is_free;
  /// Asked now and then whether to give up; empty: never.
  std::function<bool()> stopped;

  /// Finds the cheapest path not known to be blocked that costs at most `bound` (with a relative slack of 1e-9, since
  /// the bound may be this very path, summed in another order).
  End search(GraspGraph& graph, const EdgeValidityCache& robot, double bound);
  /// After giving up: no path costs less.
  double reached() const { return reached_; }
  /// Ways to nodes put into the queue by the last search, and those left there: what an upper bound keeps small.
  std::size_t opened() const { return opened_; }
  std::size_t open() const { return heap_.size(); }

 private:
  struct Node {
    double cost, to_goal;
    int parent;
    Step step;                             ///< From the parent.
    std::uint32_t stamp = 0, blocked = 0;  ///< Rounds in which it was reached, and in which it is blocked.
  };
  struct Entry {
    double key, cost;
    int node;
  };
  static bool later(const Entry& a, const Entry& b) { return a.key != b.key ? a.key > b.key : a.node > b.node; }

  void begin(const GraspGraph& graph);
  void expand_vertex(const Entry& at, const EdgeValidityCache& robot);
  void follow(int from, double cost, int link);
  void relax(int node, double cost, int parent, Step step);
  double to_goal(int node) const;
  void take_path(GraspGraph& graph, int goal) const;

  const Roadmap& roadmap_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> edge_blocked_;
  std::vector<int> first_goal_link_;
  std::vector<Entry> heap_;
  std::uint32_t round_ = 0;
  std::size_t opened_ = 0;
  const GraspGraph* graph_ = nullptr;
  double limit_ = 0, reached_ = 0;
};

/// Cost of the best path that leaves one of the graph's starts for a node of an earlier path and a later node of that
/// path for one of its goals (P2 4.3.2.5): an upper bound as long as nothing of it is known to be blocked. Infinite
/// when there is none.
MMGRASP_EXPORT double spliced_cost(const Roadmap& roadmap, const GraspGraph& graph, const std::vector<int>& nodes);

}  // namespace mmgrasp::detail
