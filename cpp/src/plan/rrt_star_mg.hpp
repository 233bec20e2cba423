#pragma once

#include <vector>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "plan/carry_planner.hpp"
#include "plan/forest.hpp"
#include "plan/informed_union.hpp"
#include "plan/robot_memory.hpp"

namespace mmgrasp::detail {

/// RRT*-MG (P2 chapter 5, Algorithm 5.13 with its errata: line 17 goes on with the next sample, lines 14 and 20 return
/// the new vertex). One thread, so that the samples alone decide what is found.
class RrtStarMg {
 public:
  RrtStarMg(CarryInput& input, ManipulationResult& result);

  void run();
  const Forest& forest() const { return forest_; }
  double best() const { return best_; }

 private:
  using Near = Forest::Near;

  /// A free edge between the two trees of a grasp; with the ways to their roots it is a path.
  struct Bridge {
    int a, b;  ///< Vertices, of the start's and of the goal's tree.
    double length;
    int next;  ///< Of the same grasp, or -1.
  };

  bool solved() const { return result_.path.has_value(); }
  double radius(int vertices) const;

  // Growing (rrt_star_mg.cpp). Those that grow return the new vertex, or -1.
  void try_straight_lines();
  void sample(int side);
  int extend_tree(int tree, int configuration);
  int extend_forest(int side, int configuration);
  /// A configuration towards `target`, at most one step from vertex `from`; -1 when there is no way to go.
  int steer(int from, int target);
  void include_nearest(int nearest, int configuration);
  /// Adds `configuration` below the one of near_ that is cheapest by equation (5.1) and has a free edge to it.
  int add_best(int configuration, double bound);
  /// Grows the tree of `from` towards a configuration that cannot be reached in one edge.
  int advance(int from, int target);
  void rewire(int made);
  void duplicate_into(int made);
  int take_reassigned(int side, int& tree);

  // Collisions and paths (rrt_star_mg_paths.cpp).
  bool robot_is_free(int grasp, int configuration);
  bool configuration_is_free(int grasp, int configuration);
  bool edge_is_free(int grasp, int a, int b);
  /// True when a path better than the best goes through this vertex now.
  bool connect(int vertex);
  double cost_of(const Bridge& bridge) const;
  /// Looks at all bridges of a grasp again and takes the cheapest if it beats the best path.
  void refresh(int grasp);
  bool accept(int bridge);
  void unbridge(int grasp, int bridge);
  void prune();
  void leaving(int v);

  CarryInput& input_;
  ManipulationResult& result_;
  const RrtStarMgOptions& options_;
  GraspEnds ends_;
  InformedUnion informed_;
  Forest forest_;
  RobotMemory memory_;
  Rng rng_;
  double gamma_;
  double best_;
  std::vector<Bridge> bridges_;
  std::vector<int> bridge_of_;  ///< Per grasp: its last one, or -1.
  std::vector<int> reassign_;   ///< Configurations that left their tree and may serve another (X_reassign).
  std::vector<Near> near_;
  std::vector<int> nodes_;
  std::vector<double> to_go_;       ///< Per grasp: distance from the new configuration to its other end ...
  std::vector<int> to_go_stamp_;    ///< ... valid for this configuration.
  std::vector<int> blocked_stamp_;  ///< Per grasp: the object in hand collides at this configuration.
  Eigen::VectorXd q_, q_a_, q_b_;   ///< Scratch.
};

void run_rrt_star_mg(CarryInput& input, ManipulationResult& result);

}  // namespace mmgrasp::detail
