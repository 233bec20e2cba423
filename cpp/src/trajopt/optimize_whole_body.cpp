#include "mmgrasp/trajopt/optimize_whole_body.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "trajopt/collision_terms.hpp"
#include "trajopt/whole_body_nlp.hpp"

namespace mmgrasp {
namespace {

constexpr double kBarrier = 1e-2;  // the first; durations are of the order of 10 s
constexpr double kRepair = 1e-2;   // barrier with which a solution is repaired

}  // namespace

void WholeBodyOptions::check() const {
  make_nlp_solver(solver);
  require(tolerance > 0 && tolerance < 1, "tolerance", tolerance, "must be in (0, 1)");
  require_count(max_iterations, "max_iterations");
  require(time_limit > 0, "time_limit", time_limit, "must be positive");
  require_not_negative(smoothing, "smoothing");
  require_not_negative(warm_start, "warm_start");
  require_not_negative(margin, "margin");
  require_number(constraint_distance, "constraint_distance");
  require(constraint_distance > margin, "constraint_distance", constraint_distance, "must exceed margin");
  require_count(refinements, "refinements", 0, 1000);
}

WholeBodyResult optimize_whole_body(const WholeBodyProblem& problem, const WholeBodyGuess& guess,
                                    const WholeBodyOptions& options, const std::vector<CollisionChecker*>& checkers,
                                    const Monitor& monitor) {
  const detail::Stopwatch stopwatch;
  options.check();
  problem.check();
  require(checkers.empty() || static_cast<int>(checkers.size()) == problem.intervals(), "checkers",
          static_cast<double>(checkers.size()), "must be empty or hold one per interval");
  const auto solver = make_nlp_solver(options.solver);
  const bool diff_drive = moving_base(problem.group) == BaseKind::diff_drive;
  NlpOptions nlp_options;
  nlp_options.tolerance = options.tolerance;
  nlp_options.constraint_tolerance = 5e-9;
  nlp_options.max_iterations = options.max_iterations;
  nlp_options.barrier = kBarrier;
  nlp_options.warm_start = options.warm_start;

  WholeBodyResult result;
  std::vector<int> pinned{0, problem.intervals()};
  for (const ToolConstraint& tool : problem.tool) pinned.push_back(tool.waypoint);
  detail::CollisionRows rows(checkers, pinned, options.margin, options.constraint_distance);
  Eigen::VectorXd x;
  for (int round = 0;; ++round) {
    detail::WholeBodyNlp nlp(problem, options.smoothing);
    if (round == 0) {
      x = nlp.pack(guess);
      if (!checkers.empty() && guess.collision_free) rows.keep_clear(guess.positions, guess.keeps_sides);
    }
    rows.add_to(nlp, diff_drive);
    nlp_options.time_limit = std::max(1e-3, options.time_limit - stopwatch.seconds());
    const NlpResult answer = solver->solve(nlp, x, nlp_options, monitor);
    result.iterations += answer.iterations;
    result.message = answer.message;
    result.outcome = answer.outcome;
    result.trajectory = std::make_shared<const WholeBodyTrajectory>(nlp.trajectory(answer.x));
    x = answer.x;
    if (checkers.empty() || !result.usable() || round == options.refinements) break;
    if (!rows.look_along(*result.trajectory)) break;
    nlp_options.warm_start = kRepair;
  }
  result.violations = check_whole_body(problem, *result.trajectory, checkers);
  const bool kept =
      std::all_of(result.violations.begin(), result.violations.end(), [](const Violation& v) { return v.kept(); });
  if (result.usable() && !kept) result.outcome = Outcome::not_found;
  result.seconds = stopwatch.seconds();
  return result;
}

}  // namespace mmgrasp
