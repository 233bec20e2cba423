#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// Options of "rrt_star_mg" alone (P2 chapter 5).
struct MMGRASP_EXPORT RrtStarMgOptions {
  /// Budget in samples, drawn or reassigned to another grasp; in [1, 10 million].
  int max_iterations = 1000;
  /// Longest edge grown towards a sample (P2's eta), and longest connection radius [rad or m, times the root mean
  /// square of the joints' weights]; > 0.
  double range = 1.5;
  /// > 0: vertices nearer than gamma (log n / n)^(1/(d+1)) are joined, at most `range`, in the same
  /// unit. 0: all within the radius that
  /// would hold k = (d + 1) / 2 n^(1/(d+1)) log n of n vertices spread evenly in the informed set, and the k nearest at
  /// least.
  double gamma = 0;
  /// Once a path is known: chance to grow the tree of the grasp that was drawn with the sample (exploration) and not
  /// the cheapest-looking one nearby (exploitation): P2's p_blt, in [0, 1]. Above 0 every grasp's tree keeps growing.
  double exploration = 0.5;
  bool bidirectional = true;  ///< Trees from both ends; off: from the start only.
  bool informed =
      true;  ///< Once a path is known: draw only where a better one can pass; off: within all sampling bounds.
  double goal_cost = 0;     ///< The first path that costs no more ends the run; >= 0, infinite: the first one at all.
  bool keep_trees = false;  ///< Return the trees with the result, for pictures and tests.
  void check() const;
};

/// One tree of RRT*-MG at the end of the run: of one grasp, from its starts or from its goals.
struct MMGRASP_EXPORT SearchTree {
  int grasp = -1;
  bool from_goal = false;
  Eigen::MatrixXd vertices;  ///< One column each.
  std::vector<int> parents;  ///< Parent of each vertex, or -1 for the grasp's arm configurations.
  Eigen::VectorXd costs;     ///< Length of the branch from the root to each vertex.
};

}  // namespace mmgrasp
