#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_set>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "plan/manipulation/common/grasp_candidates.hpp"

namespace mmgrasp::detail {

/// Relative slack of bounds that may be a path's own cost, summed in another order (errata).
constexpr double kSlack = 1e-9;

/// Which vertices and edges of the roadmap are free for the robot alone with its fingers at one opening; shared by all
/// grasps with that opening. Each answer depends on the vertex or edge alone, so threads may write the same one at the
/// same time.
class EdgeValidityCache {
 public:
  enum State : std::uint8_t { unknown, free, blocked };
  explicit EdgeValidityCache(const Roadmap& roadmap)
      : vertices_(new std::atomic<std::uint8_t>[roadmap.size()]()),
        edges_(new std::atomic<std::uint8_t>[roadmap.edge_count()]()) {}

  State vertex(int v) const { return get(vertices_, v); }
  State edge(int e) const { return get(edges_, e); }
  void set_vertex(int v, bool is_free) const { set(vertices_, v, is_free); }
  void set_edge(int e, bool is_free) const { set(edges_, e, is_free); }

 private:
  using Array = std::unique_ptr<std::atomic<std::uint8_t>[]>;
  static State get(const Array& array, int i) { return static_cast<State>(array[i].load(std::memory_order_relaxed)); }
  static void set(const Array& array, int i, bool is_free) {
    array[i].store(is_free ? free : blocked, std::memory_order_relaxed);
  }
  Array vertices_, edges_;
};

/// What joins two successive nodes of a path: an edge of the roadmap or a link of the grasp's graph, by its number.
class Step {
 public:
  Step() = default;
  static Step edge(int number) { return Step(number); }
  static Step link(int number) { return Step(-1 - number); }
  bool is_link() const { return code_ < 0; }
  int number() const { return is_link() ? -1 - code_ : code_; }

 private:
  explicit Step(int code) : code_(code) {}
  int code_ = 0;
};

/// The lazy graph of one grasp over the shared roadmap (P2's privateGraph, 4.3.2.2): the grasp's ends, their links to
/// the roadmap, and which vertices and edges are known to be free or blocked for the object in hand. Everything else is
/// read from the roadmap, so that a grasp costs kilobytes and no copy. Nodes are numbered: roadmap vertices, then
/// starts, then goals.
struct MMGRASP_EXPORT GraspGraph {
  /// An edge between an end of the grasp and the roadmap, or between two ends.
  struct Link {
    int from, to;  ///< Nodes.
    double length;
    bool blocked = false;        ///< Known to be blocked, for the robot or the object in hand.
    bool robot_is_free = false;  ///< Known to be free for the robot alone.
    bool free = false;           ///< Known to be free for both.
  };

  GraspGraph(const Roadmap& roadmap, GraspCandidate candidate_in);
  const Eigen::VectorXd& start(int i) const { return candidate.starts[i]; }
  const Eigen::VectorXd& goal(int i) const { return candidate.goals[i]; }
  int starts() const { return static_cast<int>(candidate.starts.size()); }
  int goals() const { return static_cast<int>(candidate.goals.size()); }
  int first_goal() const { return vertex_count + starts(); }
  /// Makes the links, once: of the ends with the roadmap, and with each other, whatever their distance when `straight`,
  /// otherwise within the roadmap's radius. Skips starts and goals that cannot lie on a path cheaper than `bound`; safe
  /// because the bound only decreases.
  void connect(const Roadmap& roadmap, bool straight, double bound);
  Eigen::VectorXd configuration(const Roadmap& roadmap, int node) const;
  Link& link(int number) { return links[number]; }
  const Link& link(int number) const { return links[number]; }
  bool is_free(Step step) const {
    return step.is_link() ? link(step.number()).free : free_edges.count(step.number()) > 0;
  }
  /// Records whether a step is free for the object in hand (a link: for the robot, too).
  void set_step(Step step, bool is_free);

  GraspCandidate candidate;
  int vertex_count;
  bool connected = false;
  std::vector<Link> links;
  std::vector<std::vector<int>> from_start;          ///< Links of each start.
  std::vector<int> into_goals;                       ///< Links from roadmap vertices to goals, ascending by vertex.
  std::vector<int> blocked_vertices, blocked_edges;  ///< Parts of the roadmap that the object in hand blocks.
  std::unordered_set<int> free_vertices, free_edges;

  /// The path found last: its nodes, and the steps between them.
  std::vector<int> nodes;
  std::vector<Step> steps;
  double path_cost = 0;  ///< Includes the grasp's cost.
};

}  // namespace mmgrasp::detail
