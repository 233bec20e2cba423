#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "plan/manipulation/prm_star_mg/grasp_graph.hpp"

namespace mmgrasp::detail {

/// Shortest paths over the roadmap and the lazy graph of one grasp: A* with the straight line to the nearest goal as
/// heuristic and an upper bound (P2 Algorithm 4.2). Scratch is reused: one object per thread.
class MMGRASP_EXPORT GraspGraphSearch {
 public:
  enum class End { found, none, cancelled };

  explicit GraspGraphSearch(const Roadmap& roadmap);

  /// Checks a vertex for the robot alone when the search expands it and the answer is not known; empty: such vertices
  /// count as free. Must always give the same answer for a vertex.
  std::function<bool(int vertex)> robot_is_free;
  /// Called now and then: true ends the search; empty: nothing does.
  std::function<bool()> stopped;

  /// Finds the cheapest path not known to be blocked that costs at most `bound` (with a relative slack of 1e-9, since
  /// the bound may be this very path, summed in another order).
  End search(GraspGraph& graph, const EdgeValidityCache& robot, double bound);
  /// What a cancelled search had proven: no path costs less.
  double lower_bound() const { return lower_bound_; }
  /// How often the last search pushed a node to the open list, and how many are left there: an upper bound keeps both
  /// small.
  std::size_t nodes_opened() const { return nodes_opened_; }
  std::size_t nodes_left_open() const { return heap_.size(); }

 private:
  struct Node {
    double cost, heuristic;
    int parent;
    Step step;                             ///< The step that led here from the parent.
    std::uint32_t stamp = 0, blocked = 0;  ///< The searches in which it was reached, and in which it is blocked.
  };
  struct Entry {
    double key, cost;
    int node;
  };
  static bool later(const Entry& a, const Entry& b) { return a.key != b.key ? a.key > b.key : a.node > b.node; }

  void begin(const GraspGraph& graph);
  void expand_vertex(const Entry& at, const EdgeValidityCache& robot);
  void relax_link(int from, double cost, int link);
  void relax(int node, double cost, int parent, Step step);
  double heuristic(int node) const;
  void take_path(GraspGraph& graph, int goal) const;

  const Roadmap& roadmap_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> edge_blocked_;  ///< Per edge: the last search in which it is blocked.
  std::vector<int> first_goal_link_;         ///< Per vertex: its first link in GraspGraph::into_goals, or -1.
  std::vector<Entry> heap_;                  ///< The open list.
  std::uint32_t round_ = 0;                  ///< Number of the search: what has another stamp is not of this one.
  std::size_t nodes_opened_ = 0;
  const GraspGraph* graph_ = nullptr;
  double limit_ = 0, lower_bound_ = 0;
};

/// Cost of the best path that leaves one of the graph's starts for a node of an earlier path and a later node of that
/// path for one of its goals (P2 4.3.2.5): an upper bound as long as nothing of it is known to be blocked. Infinite
/// when there is none.
MMGRASP_EXPORT double spliced_cost(const Roadmap& roadmap, const GraspGraph& graph, const std::vector<int>& nodes);

}  // namespace mmgrasp::detail
