#pragma once

namespace mmgrasp::detail {

/// Constants of RRT*-MG that were found by trial and that no user sets; all are beyond P2.
/// benchmarks/planners/bench_rrt_star_mg_tuning.cpp changes them one by one and measures what each is worth.
struct RrtStarMgTuning {
  // Until there is a path.
  int straight_line_grasps = 32;       ///< Grasps, cheapest first, whose straight lines are checked before any sample.
  int trees_per_sample = 8;            ///< Trees of single grasps that each sample is offered to.
  double near_line_probability = 0.8;  ///< Chance to sample near a grasp's straight line, not within the joint limits.
  /// Samples near a straight line lie on paths that are at least this many times as long as it ...
  double min_detour = 1.1;
  /// ... and longer by up to this many times its length, short detours being the more likely ones.
  double detour_range = 2.5;

  // Growth.
  int min_near_vertices = 4;  ///< Vertices joined in addition to k(n), which is too few in small trees.
  int max_duplicates = 4;     ///< Vertices of other trees that one new vertex takes over (P2 5.3.2).

  // Connections.
  int max_connections = 8;  ///< Edges from a new vertex to the other tree that are checked.
  /// A grasp whose trees were not connected yet may begin with a path this many times as long as the best one:
  /// shortcutting makes it shorter.
  double first_connection_bound = 1.5;

  // Shortcutting.
  double shortcut_probability = 1;          ///< Chance of one random shortcut after each informed sample.
  double other_grasp_probability = 0.5;     ///< Chance that it is tried on another grasp's path than the best one.
  double joint_shortcut_probability = 0.5;  ///< Chance that some joints alone are shortcut, not a corner cut.
};

constexpr double kSameConfiguration = 1e-9;  ///< Configurations nearer than this are the same [rad or m].
constexpr double kLeastImprovement = 1e-6;   ///< Paths shorter by less than this share do not count as better.

}  // namespace mmgrasp::detail
