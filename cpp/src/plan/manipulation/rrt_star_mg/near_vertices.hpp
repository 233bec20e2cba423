#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/plan/rrt_star_mg.hpp"
#include "plan/manipulation/common/informed_union.hpp"
#include "plan/manipulation/rrt_star_mg/grasp_trees.hpp"
#include "plan/manipulation/rrt_star_mg/tuning.hpp"

namespace mmgrasp::detail {

/// Near(V, x) of RRT* (P2 Algorithms 5.2 and 5.7, line 3): the vertices that one at x may be joined with, at most a
/// step away, by the volume of the set in which a better path can lie (docs/methods/plan.md, "Which vertices are
/// joined").
class MMGRASP_EXPORT NearVertices {
 public:
  NearVertices(const GraspTrees& trees, InformedUnion& informed, const RrtStarMgOptions& options,
               const RrtStarMgTuning& tuning);

  /// Vertices near `q`, of one tree or of all trees of a side. `nearest` is among them however far it is. `out` is
  /// overwritten.
  void in_tree(int tree, const double* q, int nearest, std::vector<GraspTrees::Near>& out) const;
  void on_side(int side, const double* q, int nearest, std::vector<GraspTrees::Near>& out) const;

 private:
  double radius(int vertices) const;
  /// Drops what n vertices, spread evenly in a set of this volume, need not be joined with; not with `gamma` given.
  void keep_nearest(int vertices, double volume, std::vector<GraspTrees::Near>& near) const;
  void include(int nearest, const double* q, std::vector<GraspTrees::Near>& near) const;

  const GraspTrees& trees_;
  InformedUnion& informed_;
  const RrtStarMgOptions& options_;
  const RrtStarMgTuning& tuning_;
};

/// Heap order (GetSortedLists, P2 Algorithm 5.3): puts the least key on top, then the vertex made first.
inline bool costlier(const GraspTrees::Near& a, const GraspTrees::Near& b) {
  return a.key != b.key ? a.key > b.key : a.vertex > b.vertex;
}

}  // namespace mmgrasp::detail
