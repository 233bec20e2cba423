#pragma once

#include <Eigen/Core>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/random.hpp"
#include "plan/manipulation/rrt_star_mg/grasp_trees.hpp"
#include "plan/manipulation/rrt_star_mg/incumbent.hpp"
#include "plan/manipulation/rrt_star_mg/tree_checks.hpp"
#include "plan/manipulation/rrt_star_mg/tree_connections.hpp"
#include "plan/manipulation/rrt_star_mg/tuning.hpp"

namespace mmgrasp::detail {

/// Makes the paths through the trees of RRT*-MG shorter by shortcutting; beyond the paper. What is found becomes part
/// of the trees, so that later samples build on it.
class MMGRASP_EXPORT PathShortcutting {
 public:
  PathShortcutting(GraspTrees& trees, TreeChecks& checks, TreeConnections& connections, const Incumbent& incumbent,
                   const RrtStarMgTuning& tuning);

  /// Edges that skip vertices of the grasp's best path: rewiring along it, each vertex below the earliest one before it
  /// with a free edge to it, then one connection between vertices nearer to the roots. TreeConnections::update() must
  /// follow.
  void skip_vertices(int grasp);

  /// Replaces a random corner of the best path, or of another grasp's (only of the first `grasps`, which can still
  /// win), by an edge between points on both of its sides, when that edge is free. Returns the grasp whose connections
  /// must be updated, or -1.
  int cut_random_corner(Rng& rng, int grasps);

 private:
  /// A corner of a path and its neighbours there; the connection may be between it and the one after it.
  struct Corner {
    int before, corner, after;  ///< Vertices.
    bool at_connection;
  };

  /// The best path's grasp or another one with a path; -1 when that one has lost it.
  int pick_grasp(Rng& rng, int grasps);
  /// False when the path is a straight line.
  static bool pick_corner(Rng& rng, const TreeConnections::Branches& path, Corner& out);

  GraspTrees& trees_;
  TreeChecks& checks_;
  TreeConnections& connections_;
  const Incumbent& incumbent_;
  const RrtStarMgTuning& tuning_;
  TreeConnections::Branches path_;  ///< Scratch.
  Eigen::VectorXd q_;               ///< Scratch.
};

}  // namespace mmgrasp::detail
