#pragma once

#include <vector>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "plan/manipulation/common/informed_union.hpp"
#include "plan/manipulation/common/manipulation_planner.hpp"
#include "plan/manipulation/rrt_star_mg/grasp_trees.hpp"
#include "plan/motion/collision_cache.hpp"

namespace mmgrasp::detail {

constexpr double kSame = 1e-9;    ///< Configurations nearer than this are the same [rad or m].
constexpr double kBetter = 1e-6;  ///< Paths shorter by less than this share are not news.

/// Puts the cheapest on top of a heap.
inline bool costlier(const GraspTrees::Near& a, const GraspTrees::Near& b) {
  return a.key != b.key ? a.key > b.key : a.vertex > b.vertex;
}

/// RRT*-MG (P2 chapter 5, Algorithm 5.13 with its errata: line 17 goes on with the next sample, lines 14 and 20 return
/// the new vertex). One thread, so that the samples alone decide what is found.
class RrtStarMg {
 public:
  /// Over the grasps known now; goes on from the result's path when it has one.
  RrtStarMg(ManipulationInput& input, const RrtStarMgOptions& options, ManipulationResult& result);

  void run();

 private:
  using Near = GraspTrees::Near;

  /// A free edge between the two trees of a grasp; with the ways to their roots it is a path.
  struct Bridge {
    int a, b;  ///< Vertices, of the start's and of the goal's tree.
    double length;
    int next;  ///< Of the same grasp, or -1.
  };

  /// The cheapest path of a grasp; not checked finely unless it was the best once.
  struct Own {
    double cost = kInfinity;
    int bridge = -1;
  };

  /// There is a path in the trees.
  bool solved() const { return best_grasp_ >= 0; }
  void keep_trees();
  /// Puts the path that the result had beforehand into the trees of its grasp.
  void plant();

  // Sampling (rrt_star_mg.cpp). Returns the new vertex, or -1.
  void try_straight_lines();
  void sample(int side);
  int sample_informed(int side);
  void sample_early(int side);
  /// A grasp to grow before there is a path.
  int pick_early();
  int take_reassigned(int side, int& tree);

  // Growing (rrt_star_mg_growth.cpp). Those that grow return the new vertex, or -1.
  int extend_tree(int tree, int configuration);
  int extend_forest(int side, int configuration);
  /// A configuration towards `target`, at most one step from vertex `from`; -1 when there is no way to go.
  int steer(int from, int target);
  /// Fill near_ with the vertices that one at `q` may be joined with.
  void look_near_in_tree(int tree, const double* q);
  void look_near_on_side(int side, const double* q);
  double radius(int vertices) const;
  /// Drops of near_ what n vertices in an informed set of this volume need not be joined with, unless `gamma` is given.
  void keep_near(int vertices, double volume);
  void include_nearest(int nearest, int target);
  /// Adds `configuration` below the one of near_ that is cheapest by equation (5.1) and has a free edge to it.
  int add_best(int configuration, double bound);
  /// Grows the tree of `from` half the way along a blocked edge to a configuration, when that half is free.
  int advance(int from, int target);
  void rewire(int made);
  void duplicate_into(int made);

  // Collisions and paths (rrt_star_mg_paths.cpp).
  bool robot_is_free(int grasp, int configuration);
  bool configuration_is_free(int grasp, int configuration);
  bool edge_is_free(int grasp, int a, int b);
  /// True when a path better than the best goes through this vertex now.
  bool connect(int vertex);
  double cost_of(const Bridge& bridge) const;
  /// Looks at all bridges of a grasp again: its own path is over the cheapest, the best path too if that beats it.
  void refresh(int grasp);
  bool accept(int bridge);
  /// Of nodes_, whose configurations are the path's: the first edge that does not pass the final check; -1: all do.
  int blocked_edge(int grasp, const JointPath& path);
  void add_bridge(int a, int b);
  void unbridge(int grasp, int bridge);
  double apart(int a, int b) const;   ///< Two vertices.
  double length(int a, int b) const;  ///< Between two configurations.
  void prune();
  void leaving(int v);

  // Pulling paths taut (rrt_star_mg_shortcut.cpp).
  /// A corner of a path and its neighbours there; the bridge may be between it and the one after it.
  struct Corner {
    int before, corner, after;  ///< Vertices.
    bool at_bridge;
  };
  /// Edges that skip vertices of the grasp's path.
  void straighten(int grasp);
  /// Replaces a random corner of the best path, or of another grasp's, by an edge between points on both its sides,
  /// when that is free.
  void cut_corner();
  /// The best path's grasp or, as often, another one with a path of its own; -1 when that one has lost it.
  int pick_path();
  /// Of the path in chain_; false when that is a straight line.
  bool pick_corner(Corner& out);
  /// Fills chain_ with the grasp's own path; false when there is none.
  bool follow(int grasp);

  ManipulationInput& input_;
  ManipulationResult& result_;
  const RrtStarMgOptions options_;
  GraspEnds ends_;
  InformedUnion informed_;
  GraspTrees trees_;
  CollisionCache robot_;     ///< By opening.
  CollisionCache verified_;  ///< By grasp: edges that were on a path and looked at finely.
  CollisionCache blocked_;   ///< By grasp: edges that would have straightened a path.
  Rng rng_;
  double best_;
  int best_grasp_ = -1;
  std::vector<Own> own_;         ///< Per grasp.
  std::vector<int> contenders_;  ///< Grasps with a path of their own, and some that lost it.
  std::vector<Bridge> bridges_;
  std::vector<int> bridge_of_;  ///< Per grasp: its last one, or -1.
  std::vector<int> reassign_;   ///< Configurations that left their tree and may serve another (X_reassign).
  std::vector<Near> near_;
  std::vector<int> nodes_;
  std::vector<int> chain_[2];       ///< Of the best path: from its bridge to the roots, per side.
  std::vector<double> to_go_;       ///< Per grasp: distance from the new configuration to its other end ...
  std::vector<int> to_go_stamp_;    ///< ... valid for this configuration.
  std::vector<int> blocked_stamp_;  ///< Per grasp: the object in hand collides at this configuration.
  Eigen::VectorXd q_, q_a_, q_b_;   ///< Scratch.
};

bool run_rrt_star_mg(ManipulationInput& input, ManipulationResult& result);

}  // namespace mmgrasp::detail
