#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

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

  /// One random shortcut on the best path, or on another grasp's (only of the first `grasps`, which can still win),
  /// when that is free and makes the path shorter. Returns the grasp whose connections must be updated, or -1.
  int improve_randomly(Rng& rng, int grasps);

 private:
  /// The best path's grasp or another one with a path; -1 when that one has lost it.
  int pick_grasp(Rng& rng, int grasps);
  // All of these work on vertices_.
  /// Replaces a corner by an edge between points on both of its sides.
  bool shortcut_corner(Rng& rng, int grasp);
  /// Moves the vertices between two others towards the straight line between those, in a random choice of joints alone
  /// (as partial shortcuts, Geraerts and Overmars 2007).
  bool shortcut_some_joints(Rng& rng, int grasp);
  enum class Replaced { yes, blocked, not_shorter };
  /// Puts the configurations `made_` between two vertices in place of those there, when that is free and shorter.
  Replaced replace(int grasp, std::size_t first, std::size_t last);
  /// How far a shortcut goes, in (0, 1].
  static double draw_share(Rng& rng);
  /// Moves q_, which was made of a corner, out of it by `length` along its bisector.
  void lift_out(std::size_t corner, double length);
  /// A new configuration on the edge from a corner to a neighbour, `share` of its length away from the corner, moved
  /// out of the corner along its bisector by about `lift` of that length.
  int point_beside_edge(std::size_t corner, std::size_t neighbour, double share, double lift);

  GraspTrees& trees_;
  TreeChecks& checks_;
  TreeConnections& connections_;
  const Incumbent& incumbent_;
  const RrtStarMgTuning& tuning_;
  TreeConnections::Branches path_;  ///< Scratch.
  std::vector<int> vertices_;       ///< The path to be improved, from root to root ...
  std::size_t crossing_ = 0;        ///< ... so many of them in the start's tree.
  std::vector<int> made_;           ///< Scratch: configurations.
  Eigen::VectorXd moves_, q_;       ///< Scratch.
};

}  // namespace mmgrasp::detail
