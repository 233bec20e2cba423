#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/plan/rrt_star_mg.hpp"
#include "plan/manipulation/rrt_star_mg/grasp_trees.hpp"
#include "plan/manipulation/rrt_star_mg/incumbent.hpp"
#include "plan/manipulation/rrt_star_mg/near_vertices.hpp"
#include "plan/manipulation/rrt_star_mg/tree_checks.hpp"
#include "plan/manipulation/rrt_star_mg/tuning.hpp"

namespace mmgrasp::detail {

/// Grows the trees of RRT*-MG towards given configurations: nearest vertex, steer, cheapest parent, rewire.
class MMGRASP_EXPORT TreeGrowth {
 public:
  struct Extension {
    int vertex = -1;      ///< The new vertex; -1: none.
    bool pruned = false;  ///< No tree nearby can have a better path through the new configuration.
  };

  TreeGrowth(GraspTrees& trees, TreeChecks& checks, const NearVertices& near_vertices, const Incumbent& incumbent,
             const RrtStarMgOptions& options, const RrtStarMgTuning& tuning);

  /// Called when rewiring made paths in the trees of this grasp shorter. May improve the incumbent and remove vertices.
  std::function<void(int grasp)> on_rewired = [](int) {};

  /// ExtendAndRewire (P2 Algorithm 5.2) on the tree of one grasp: exploration. Returns the new vertex, or -1.
  int extend_tree(int tree, int configuration);
  /// ExtendAndRewire-MG (P2 5.3.1): the cheapest tree by equation (5.1) among those near. Exploitation.
  Extension extend_cheapest_tree(int side, int configuration);
  /// Beyond the paper, until there is a path: grows the tree of vertex `from` along the first half of a blocked edge to
  /// a configuration, when that half is free. Returns the new vertex, or -1.
  int extend_half(int from, int target);

 private:
  using Near = GraspTrees::Near;

  /// Steer: `target` itself, or a new configuration one step from the vertex towards it; -1 when they are the same.
  int steer(int from, int target);
  /// GetBestParent (Algorithms 5.3, 5.4, 5.13 with equation (5.1)): adds the configuration below the cheapest vertex of
  /// `near` that has a free edge to it and with which a path may cost less than `bound`.
  Extension add_below_best_parent(int configuration, double bound, std::vector<Near>& near);
  /// RewireVertices (Algorithm 5.5), within the tree only (P2 5.3.2), of what could make the best path better.
  void rewire(int made, const std::vector<Near>& near);
  /// Vertex duplicating (P2 5.3.2): configurations of other trees nearby that could serve this one.
  void duplicate(int made, const std::vector<Near>& near);
  /// Least cost of the rest of a path with this grasp, the grasp's own cost included: h(x) of equation (5.1).
  double cost_to_go(int grasp, int side, const double* q) const;

  GraspTrees& trees_;
  TreeChecks& checks_;
  const NearVertices& near_vertices_;
  const Incumbent& incumbent_;
  const RrtStarMgOptions& options_;
  const RrtStarMgTuning& tuning_;
  // What add_below_best_parent() found out about a configuration; new ones are drawn all the time, old ones never
  // change.
  struct PerGrasp {
    double cost_to_go = 0;
    int cost_to_go_of = -1;  ///< The configuration it is for.
    int blocked_at = -1;     ///< A configuration at which the grasp's robot or object collides.
  };
  std::vector<PerGrasp> per_grasp_;
  std::vector<Near> near_;  ///< Scratch of one extension.
  Eigen::VectorXd q_;       ///< Scratch.
};

}  // namespace mmgrasp::detail
