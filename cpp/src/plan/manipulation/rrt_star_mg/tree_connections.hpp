#pragma once

#include <array>
#include <vector>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/random.hpp"
#include "plan/manipulation/rrt_star_mg/grasp_trees.hpp"

namespace mmgrasp::detail {

/// Free edges between the two trees of each grasp (the set of solutions of P2's Algorithm 5.13). With the branches from
/// its vertices to their roots each is a path, whose cost follows the trees as they are rewired.
class MMGRASP_EXPORT TreeConnections {
 public:
  struct Connection {
    int start_vertex, goal_vertex;  ///< Vertices in the start's tree and in the goal's tree.
    double length;
    int next;  ///< Another connection of the same grasp, or -1.
  };
  /// The cheapest path of a grasp when update() was last called.
  struct BestPath {
    double cost = kInfinity;  ///< Includes the grasp's own cost.
    int connection = -1;
  };
  /// Vertices of a path from its connection to the roots, in the start's and in the goal's tree.
  using Branches = std::array<std::vector<int>, 2>;

  explicit TreeConnections(const GraspTrees& trees);

  const Connection& connection(int index) const { return connections_[index]; }
  const BestPath& best(int grasp) const { return best_[grasp]; }
  bool any(int grasp) const { return last_[grasp] >= 0; }
  /// Cost of the path through this connection as the trees are now.
  double cost(int connection) const;

  /// Connects two vertices, one of each tree of a grasp, in either order. best() changes with the next update().
  void add(int a, int b);
  void remove(int grasp, int connection);
  /// Drops the grasp's connections whose vertices were removed and finds its cheapest path.
  const BestPath& update(int grasp);
  /// Fills `out` with the vertices of the grasp's best path; false (and `out` empty) when it has none any more.
  bool trace_path(int grasp, Branches& out) const;
  /// The vertices of the path through a connection from root to root. `crossing`: how many are in the start's tree.
  std::vector<int> vertices(int connection, std::size_t& crossing) const;

  /// Lists a grasp for draw_grasp(): to be called when its first connection was added.
  void list_grasp(int grasp) { listed_.push_back(grasp); }
  bool any_listed() const { return !listed_.empty(); }
  /// A random listed grasp (one must be listed). Those not among the first `grasps` or without a path leave the list
  /// and give -1.
  int draw_grasp(Rng& rng, int grasps);

 private:
  bool alive(const Connection& connection) const;

  const GraspTrees& trees_;
  std::vector<Connection> connections_;
  std::vector<int> last_;       ///< Per grasp: its connection added last, or -1.
  std::vector<BestPath> best_;  ///< Per grasp.
  std::vector<int> listed_;
};

}  // namespace mmgrasp::detail
