#pragma once

#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/optim/population_search.hpp"
#include "mmgrasp/structure/object_path.hpp"
#include "mmgrasp/structure/pipe.hpp"
#include "mmgrasp/structure/pipe_grasps.hpp"

namespace mmgrasp {

/// Where "bees" looks near a grasp (P2 3.4.2, figure 3.9).
enum class GraspNeighbourhood {
  independent,         ///< Str1: section and length each for itself.
  same_section,        ///< Str2: the section stays.
  connected_sections,  ///< Str3: a length beyond an end goes on along a section that meets there.
};
MMGRASP_EXPORT const char* to_string(GraspNeighbourhood neighbourhood);

struct MMGRASP_EXPORT GraspSearchOptions {
  std::string algorithm = "bees";  ///< A name of population_search_names().
  GraspNeighbourhood neighbourhood = GraspNeighbourhood::connected_sections;
  PopulationOptions population;
  PipeGraspOptions grasp;  ///< Axes of the hand, widest opening, margin kept from nodes; its sampling is not used.
  void check() const;
};

/// A grasp with which the whole path can be followed.
struct MMGRASP_EXPORT FeasibleGrasp {
  Grasp grasp;                                                        ///< Its cost is that of the path.
  double joint_motion = 0, deflection = 0, force_manipulability = 0;  ///< O1 [rad or m], O2 [m], O3.
};

struct MMGRASP_EXPORT GraspOptimum {
  /// approximate: the best of the search, without a proof that none is better. solved: it meets the target. not_found,
  /// stopped.
  Outcome outcome = Outcome::not_found;
  Grasp grasp;            ///< Only with a path.
  ObjectPathResult path;  ///< By follow_object_path: checked more finely than the search does.
  /// Every grasp that the search found feasible, the cheapest first: candidates for other planners, which find their
  /// cost in them. The first has passed the finer check, too.
  std::vector<FeasibleGrasp> feasible;
  /// Which of them no other beats in one objective without losing in another (the Pareto front), ascending in O1.
  std::vector<int> front;
  int evaluations = 0;
  std::vector<double> history;  ///< Best cost after each evaluation; infinite while nothing was feasible.
  /// Poses in order, each with how many of the grasps tried could not reach it and at how many all arm configurations
  /// collided.
  std::vector<int> unreachable, colliding;
};

/// Searches the grasps of a pipe (section, length, angle, flip) for the one with the least Cost(O) along the path, by
/// P2's rules of comparison (3.3.1, Algorithm 3.2). Throws InvalidInput when no section is narrow and long enough for
/// the hand.
MMGRASP_EXPORT GraspOptimum optimize_grasp(const ObjectPathProblem& problem, const Pipe& pipe,
                                           const ObjectPathOptions& path_options = {},
                                           const GraspSearchOptions& options = {}, const Monitor& monitor = {});

}  // namespace mmgrasp
