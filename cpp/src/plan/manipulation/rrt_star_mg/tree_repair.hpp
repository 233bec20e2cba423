#pragma once

#include <utility>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "plan/manipulation/rrt_star_mg/grasp_trees.hpp"
#include "plan/manipulation/rrt_star_mg/near_vertices.hpp"
#include "plan/manipulation/rrt_star_mg/tree_checks.hpp"
#include "plan/manipulation/rrt_star_mg/tree_sampler.hpp"

namespace mmgrasp::detail {

/// Mends a tree of RRT*-MG after the final check found the edge above a vertex blocked.
class MMGRASP_EXPORT TreeRepair {
 public:
  TreeRepair(GraspTrees& trees, TreeChecks& checks, const NearVertices& near_vertices, TreeSampler& sampler)
      : trees_(trees), checks_(checks), near_vertices_(near_vertices), sampler_(sampler) {}

  /// Connects `v` and all vertices below it to the rest of their tree by edges that pass the final check. The edges
  /// among them stay, in either direction. Only when none of them has such an edge they are removed, and their
  /// configurations offered to other grasps.
  void reconnect(int v);

 private:
  /// The cheapest vertex near `v` that is not cut off and has a verified edge to it; -1: none.
  int verified_parent(int v);
  void collect_below(int v, std::vector<int>& out) const;
  /// Turns the branch from `v` down to `last` round and hangs it below `parent`, once a neighbour of `last`.
  void turn_branch(int v, int last, int parent);

  GraspTrees& trees_;
  TreeChecks& checks_;
  const NearVertices& near_vertices_;
  TreeSampler& sampler_;
  std::vector<char> cut_;               ///< Per vertex: it is cut off from its root.
  std::vector<int> members_, adopted_;  ///< Scratch.
  std::vector<GraspTrees::Near> near_;  ///< Scratch.
};

}  // namespace mmgrasp::detail
