#pragma once

#include <cstdint>
#include <unordered_set>
#include <vector>

#include "plan/carry_candidates.hpp"

namespace mmgrasp::detail {

/// What is known of vertices and edges for the robot alone with its fingers at one opening; shared by all its grasps.
struct RoadmapKnowledge {
  enum State : std::uint8_t { unknown, free, blocked };
  std::vector<std::uint8_t> vertices, edges;
};

/// The least that is kept for one grasp in place of a copy of the roadmap (P2's privateGraph, 4.3.2.2): its ends, how
/// they join the roadmap, and what the object in hand was found to block or to pass. Nodes are numbered: roadmap
/// vertices, then starts, then goals.
struct GraspOverlay {
  struct Link {
    int from, to;  ///< Nodes; one end at least is a start or a goal.
    double length;
    bool blocked = false, passed = false;
  };

  GraspOverlay(const Roadmap& roadmap, CarryCandidate candidate_in);
  const Eigen::VectorXd& start(int i) const { return candidate.starts[static_cast<std::size_t>(i)]; }
  const Eigen::VectorXd& goal(int i) const { return candidate.goals[static_cast<std::size_t>(i)]; }
  /// Joins the ends with the roadmap, and with each other when near.
  void connect(const Roadmap& roadmap);
  Eigen::VectorXd configuration(const Roadmap& roadmap, int node) const;
  /// A step of a path that passed before turns out to be blocked.
  void block(int step);

  CarryCandidate candidate;
  int vertex_count;
  bool connected = false;
  std::vector<Link> links;
  std::vector<std::vector<int>> from_start;  ///< Links of each start.
  std::vector<int> into_goals;               ///< Links from roadmap vertices to goals, ascending by vertex.
  std::unordered_set<int> blocked_vertices, blocked_edges, passed_vertices, passed_edges;  ///< By the held object.

  /// The path found last: nodes, and between them edges of the roadmap (>= 0) or links (-1 - link).
  std::vector<int> nodes, steps;
  double path_cost = 0;  ///< With the grasp's cost.
};

/// Shortest paths over the roadmap and one overlay: A* with the straight line to the nearest goal as heuristic and an
/// upper bound (P2 Algorithm 4.2). Scratch is reused: one object per thread.
class OverlaySearch {
 public:
  explicit OverlaySearch(const Roadmap& roadmap);
  /// Finds the cheapest path not known to be blocked that costs at most `bound` (with a relative slack of 1e-9, since
  /// the bound may be this very path, summed in another order). False when there is none.
  bool search(GraspOverlay& overlay, const RoadmapKnowledge& robot, double bound);

 private:
  struct Entry {
    double key, cost;
    int node;
  };
  void relax(int node, double cost, int parent, int step, double limit);
  double to_goal(int node);

  const Roadmap& roadmap_;
  std::vector<double> cost_, heuristic_;
  std::vector<int> parent_, step_;
  std::vector<std::uint32_t> stamp_, heuristic_stamp_;
  std::vector<int> first_goal_link_;
  std::vector<Entry> heap_;
  std::uint32_t round_ = 0;
  const GraspOverlay* overlay_ = nullptr;
};

/// Cost of the best path that leaves one of the overlay's starts for a node of an earlier path and a later node of that
/// path for one of its goals (P2 4.3.2.5): an upper bound as long as nothing of it is known to be blocked. Infinite
/// when there is none.
double spliced_cost(const Roadmap& roadmap, const GraspOverlay& overlay, const std::vector<int>& nodes);

}  // namespace mmgrasp::detail
