#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "plan/manipulation/common/transfer_checks.hpp"
#include "plan/manipulation/rrt_star_mg/grasp_trees.hpp"
#include "plan/motion/collision_cache.hpp"

namespace mmgrasp::detail {

/// Collision checks of the trees' configurations and of edges between them. What is found out about the robot alone is
/// kept for all grasps with the same opening; final checks of a grasp's edges are not repeated, and an edge that failed
/// one is blocked from then on.
class MMGRASP_EXPORT TreeChecks {
 public:
  /// Counts edges in `stats`.
  TreeChecks(const GraspTrees& trees, TransferChecks& checks, ManipulationStats& stats);

  /// The robot alone, its fingers at the grasp's opening.
  bool robot_is_free(int grasp, int configuration);
  /// Robot and object in hand.
  bool configuration_is_free(int grasp, int configuration);
  /// Robot and object in hand, in the steps of the search. Both configurations are known to be free.
  bool edge_is_free(int grasp, int a, int b);
  /// As edge_is_free(), for shortcuts: the same ones are tried again and again, and those found blocked are cached.
  bool shortcut_is_free(int grasp, int a, int b);
  /// The final check of an edge.
  bool edge_is_verified(int grasp, int a, int b);
  /// The first edge of a path through these vertices that does not pass the final check; -1: all do.
  int blocked_edge(int grasp, const std::vector<int>& vertices);
  /// All grasps open the fingers as far: what blocks the robot with one grasp blocks it with all.
  bool one_opening() const { return checks_.opening_count() == 1; }

 private:
  Eigen::Map<const Eigen::VectorXd> values(int configuration) const;

  const GraspTrees& trees_;
  TransferChecks& checks_;
  ManipulationStats& stats_;
  CollisionCache robot_;     ///< Configurations and edges of the robot alone, by opening.
  CollisionCache verified_;  ///< Edges that passed the final check, by grasp.
  CollisionCache blocked_;   ///< Shortcuts that are blocked and edges that failed the final check, by grasp.
};

}  // namespace mmgrasp::detail
