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

/// The algorithm that searches the grasps of a pipe, its budget, and which grasps it may take.
struct MMGRASP_EXPORT GraspSearchOptions {
  /// A name of population_search_names(), or "branch_and_bound": bees first, then boxes of grasps are divided until
  /// none can be cheaper by more than max_gap. For arms of six joints whose axes 2 and 3 are parallel and 4, 5 and 6
  /// meet, or 2, 3 and 4 are parallel and 5 and 6 meet.
  /// See default_grasp_search().
  std::string algorithm = "bees";
  GraspNeighbourhood neighbourhood = GraspNeighbourhood::connected_sections;
  PopulationOptions population;
  /// Further searches with as many evaluations, each for another mix of the three objectives, so that the Pareto front
  /// is searched and not only passed; >= 0.
  int front_searches = 0;
  double max_gap = 1e-3;    ///< branch_and_bound: as a share of the cost; in (0, 1).
  int max_boxes = 1000000;  ///< branch_and_bound: budget in boxes bounded; > 0.
  double time_limit = 600;  ///< Wall-clock cap of all searches together [s]; then the best so far, as proven. > 0.
  int threads = 0;          ///< branch_and_bound; 0: all. The answer does not depend on it.
  PipeGraspOptions grasp;   ///< Axes of the hand, widest opening, margin kept from nodes; its sampling is not used.
  void check() const;
};

/// "branch_and_bound" for arms that it takes, else "bees": what `mmgrasp pipe` searches with unless told otherwise.
MMGRASP_EXPORT std::string default_grasp_search(const JointGroup& group);

/// Names that GraspSearchOptions::algorithm takes.
MMGRASP_EXPORT std::vector<std::string> grasp_search_names();

/// A grasp with which the whole path can be followed.
struct MMGRASP_EXPORT FeasibleGrasp {
  Grasp grasp;                                                        ///< Its cost is that of the path.
  double joint_motion = 0, deflection = 0, force_manipulability = 0;  ///< O1 [rad or m], O2 [m], O3.
};

/// The cheapest grasp with which a pipe follows its path, what is proven of its cost, and the other feasible ones.
struct MMGRASP_EXPORT GraspOptimum {
  /// solved: no grasp is cheaper by more than max_gap, or it meets the target. approximate: the best of the search,
  /// proven only as far as `gap` says. infeasible: proven that no grasp can do it. not_found, stopped.
  Outcome outcome = Outcome::not_found;
  /// No grasp of the pipe costs less; 0 where nothing was proven, infinite when none can follow the path.
  double lower_bound = 0;
  double gap = 1;         ///< How much cheaper another grasp could be at most, as a share of the cost found.
  Grasp grasp;            ///< Only with a path.
  ObjectPathResult path;  ///< The best grasp's path by follow_object_path, checked more finely than the search does.
  /// Every grasp that the search found feasible, the cheapest first: candidates for other planners, which find their
  /// cost in them. The first has passed the finer check, too.
  std::vector<FeasibleGrasp> feasible;
  /// Which of them no other beats in one objective without losing in another (the Pareto front), each grasp with its
  /// cheapest motion; ascending in O1. Searched with GraspSearchOptions::front_searches, else what the search passed.
  std::vector<int> front;
  int evaluations = 0;          ///< Grasps tried, those in the middles of boxes among them.
  int boxes = 0;                ///< Bounded by branch_and_bound.
  std::vector<double> history;  ///< Best cost after each evaluation of the population; infinite: nothing feasible yet.
  /// Poses in order, each with how many of the grasps tried could not reach it and at how many all arm configurations
  /// collided.
  std::vector<int> unreachable, colliding;
  /// Poses in order, each with how many of the grasps tried bend the pipe further or load it more than it may be there.
  std::vector<int> overloaded;
  /// For each pose but the last: with how many grasps that reach every pose each motion from there to the next one
  /// jumps to another posture of the arm, and with how many each that does not collides or leaves the path.
  std::vector<int> jumping_after, colliding_after;
};

/// The feasible grasps, each with its mean sag after the first pose [m] as its cost: for plan_manipulation with
/// ManipulationOptions::max_length, which takes the one that sags least among those whose motion is short enough.
MMGRASP_EXPORT std::vector<Grasp> sag_candidates(const GraspOptimum& optimum);

/// Searches the grasps of a pipe (section, length, angle, flip) for the one with the least Cost(O) along the path, by
/// P2's rules of comparison (3.3.1, Algorithm 3.2). Throws InvalidInput when no section is narrow and long enough for
/// the hand.
MMGRASP_EXPORT GraspOptimum optimize_grasp(const ObjectPathProblem& problem, const Pipe& pipe,
                                           const ObjectPathOptions& path_options = {},
                                           const GraspSearchOptions& options = {}, const Monitor& monitor = {});

}  // namespace mmgrasp
