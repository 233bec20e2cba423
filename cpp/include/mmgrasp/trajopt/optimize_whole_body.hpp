#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/optim/nlp_solver.hpp"
#include "mmgrasp/trajopt/whole_body_problem.hpp"
#include "mmgrasp/trajopt/whole_body_trajectory.hpp"

namespace mmgrasp {

/// The initial guess: a configuration per waypoint and a time step per segment.
struct MMGRASP_EXPORT WholeBodyGuess {
  std::vector<Eigen::VectorXd> positions;  ///< Configuration at each waypoint.
  std::vector<Eigen::VectorXd> drive;      ///< Drive velocity at each; empty: from differences of the positions.
  std::vector<double> steps;               ///< Time step of each segment [s]; > 0.
  /// The guess is known to be free of collisions: the search starts with collision constraints along it.
  bool collision_free = false;
  /// With `collision_free`: two bodies that come into collision during the search are pushed apart to the sides on
  /// which they lie in the guess. Off for motions that will move far from it.
  bool keeps_sides = true;
};

/// When optimize_whole_body() ends, how smooth its motion is, and how far it keeps from obstacles.
struct MMGRASP_EXPORT WholeBodyOptions {
  std::string solver = "ipopt";       ///< A name of nlp_solver_names().
  double tolerance = 1e-4;            ///< Relative optimality, in (0, 1).
  int max_iterations = 150;           ///< Iterations of one solve, of which there are at most 1 + refinements; > 0.
  double time_limit = 600.0;          ///< Wall-clock cap [s], for runs that are not to end by their iterations; > 0.
  double smoothing = 1e-2;            ///< Weight of the mean square of accelerations over their limits [s]; >= 0.
  double warm_start = 0;              ///< See NlpOptions.
  double margin = 0.005;              ///< Distance to keep from obstacles and from oneself [m]; >= 0.
  double constraint_distance = 0.15;  ///< Pairs of bodies nearer than this are constrained [m]; > margin.
  int refinements = 6;                ///< Times that collision constraints may be added and the solve repeated; >= 0.
  void check() const;
};

/// The largest violation of one kind of constraint.
struct MMGRASP_EXPORT Violation {
  std::string kind;      ///< "dynamics", "nonholonomic", "position", ...
  double value = 0;      ///< How far beyond its bound, in `unit`; 0 when kept.
  double tolerance = 0;  ///< Up to where it counts as kept.
  std::string unit;
  double time = 0;   ///< When it is largest [s].
  int waypoint = 0;  ///< The last waypoint before that time.
  std::string what;  ///< Which joint, axis or pair.
  bool kept() const { return value <= tolerance; }
};

/// A trajectory, whether it is proven optimal, and which constraints it breaks by how much.
struct MMGRASP_EXPORT WholeBodyResult {
  /// solved only after check_whole_body found every constraint kept; approximate: kept, optimality not shown.
  Outcome outcome = Outcome::not_found;
  std::shared_ptr<const WholeBodyTrajectory> trajectory;  ///< The answer or, not solved, the best iterate.
  std::vector<Violation> violations;                      ///< The trajectory's, one per kind.
  int iterations = 0;
  double seconds = 0;
  std::string message;

  bool usable() const { return outcome == Outcome::solved || outcome == Outcome::approximate; }
};

/// Judges a trajectory on its own roll-out `resolution_factor` times finer than its waypoints, by other means than the
/// optimiser's: forward kinematics of the group, Runge-Kutta integration of the base, the collision checker. `checkers`
/// is empty or holds one pointer per interval (the part held changes on the way); null: nothing can collide there.
/// Between samples collisions are looked for by conservative advancement.
MMGRASP_EXPORT std::vector<Violation> check_whole_body(const WholeBodyProblem& problem,
                                                       const WholeBodyTrajectory& trajectory,
                                                       const std::vector<CollisionChecker*>& checkers = {},
                                                       int resolution_factor = 10);

/// Finds a locally time-optimal trajectory of base and arm near the guess (P1 4.4): the problem as a sparse nonlinear
/// program, solved again with separating planes wherever the answer collides, and checked by check_whole_body() before
/// it is returned. `checkers`: see there. Throws InvalidInput for what problem.check() refuses and for guesses of wrong
/// length or not finite; no solution is a value, with the violations of the best iterate.
/// @code
///   WholeBodyProblem problem(group);
///   problem.start = start;
///   problem.goal_lower = problem.goal_upper = goal;
///   problem.segments = {{17}};
///   WholeBodyGuess guess;
///   for (int i = 0; i <= 17; ++i) guess.positions.push_back(start + (goal - start) * i / 17.0);
///   guess.steps = {0.2};
///   const WholeBodyResult result = optimize_whole_body(problem, guess);
/// @endcode
MMGRASP_EXPORT WholeBodyResult optimize_whole_body(const WholeBodyProblem& problem, const WholeBodyGuess& guess,
                                                   const WholeBodyOptions& options = {},
                                                   const std::vector<CollisionChecker*>& checkers = {},
                                                   const Monitor& monitor = {});

}  // namespace mmgrasp
