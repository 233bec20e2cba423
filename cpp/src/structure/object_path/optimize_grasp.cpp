#include "mmgrasp/structure/optimize_grasp.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "structure/bound/ik_enclosure.hpp"
#include "structure/object_path/branch_and_bound.hpp"
#include "structure/object_path/grasp_front.hpp"
#include "structure/object_path/grasp_variables.hpp"

namespace mmgrasp {
namespace {

constexpr const char* kBranchAndBound = "branch_and_bound";

}  // namespace

const char* to_string(GraspNeighbourhood neighbourhood) {
  switch (neighbourhood) {
    case GraspNeighbourhood::independent:
      return "independent";
    case GraspNeighbourhood::same_section:
      return "same_section";
    default:
      return "connected_sections";
  }
}

std::string default_grasp_search(const JointGroup& group) {
  return detail::IkEnclosure::takes(group) ? kBranchAndBound : "bees";
}

std::vector<std::string> grasp_search_names() {
  std::vector<std::string> names = population_search_names();
  names.emplace_back(kBranchAndBound);
  return names;
}

void GraspSearchOptions::check() const {
  const std::vector<std::string> names = grasp_search_names();
  std::string known;
  for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
  require(std::find(names.begin(), names.end(), algorithm) != names.end(), "algorithm", algorithm,
          "must be one of " + known);
  require(max_gap > 0 && max_gap < 1, "max_gap", max_gap, "must be in (0, 1)");
  require_count(max_boxes, "max_boxes");
  require(time_limit > 0, "time_limit", time_limit, "must be positive [s]");
  require_count(front_searches, "front_searches", 0, 1'000'000);
  resolve_threads(threads);  // says what is wrong
  population.check();
  grasp.check();
}

std::vector<Grasp> sag_candidates(const GraspOptimum& optimum) {
  std::vector<Grasp> grasps;
  const double poses = std::max(1.0, static_cast<double>(optimum.unreachable.size()) - 1);
  for (const FeasibleGrasp& found : optimum.feasible) {
    grasps.push_back(found.grasp);
    grasps.back().cost = found.deflection / poses;
  }
  return grasps;
}

GraspOptimum optimize_grasp(const ObjectPathProblem& problem, const Pipe& pipe, const ObjectPathOptions& path_options,
                            const GraspSearchOptions& options, const Monitor& monitor) {
  options.check();
  const detail::GraspVariables grasps(pipe, options.grasp);
  ObjectPathEvaluator evaluator(problem, path_options);
  const detail::TimeLimit time_limit(options.time_limit);
  const Monitor timed{CancelToken(), monitor.progress};  // ends by time, too
  GraspOptimum out;
  out.unreachable.assign(problem.T_world_object.size(), 0);
  out.overloaded = out.colliding = out.unreachable;
  out.jumping_after.assign(problem.T_world_object.size() - 1, 0);
  out.colliding_after = out.jumping_after;
  PopulationProblem search;
  search.variables = grasps.variables();
  search.upper = [&](const Eigen::VectorXd& x, int i) {
    return i == 1 ? grasps.room(static_cast<int>(x(0))) : detail::kInfinity;
  };
  search.neighbour = [&](const Eigen::VectorXd& x, double size, Rng& rng) {
    return grasps.neighbour(x, size, options.neighbourhood, rng);
  };
  const auto count = [&](Grasp grasp, const ObjectPathResult& found) {
    ++out.evaluations;
    for (std::size_t i = 0; i < found.violations.size(); ++i) {
      out.unreachable[i] += found.violations[i] == 2;
      out.colliding[i] += found.violations[i] == 1;
    }
    for (const int pose : found.overloaded) ++out.overloaded[pose];
    for (std::size_t i = 0; i < found.gaps.size(); ++i) {
      out.jumping_after[i] += found.gaps[i] == 1;
      out.colliding_after[i] += found.gaps[i] == 2;
    }
    if (found.outcome != Outcome::solved) return;
    grasp.cost = found.cost;
    out.feasible.push_back({grasp, found.joint_motion, found.deflection, found.force_manipulability});
  };
  std::function<double(const ObjectPathResult&)> value = [](const ObjectPathResult& found) { return found.cost; };
  search.evaluate = [&, stop = timed.stop](const Eigen::VectorXd& x) mutable {
    if (monitor.stopped() || time_limit.expired()) stop.stop();
    const Grasp grasp = grasps.grasp(x);
    const ObjectPathResult found = evaluator.evaluate(grasp);
    count(grasp, found);
    return ConstrainedValue{static_cast<double>(found.violation), found.violation > 0 ? 0 : value(found)};
  };
  const bool prove = options.algorithm == kBranchAndBound;
  const auto population = make_population_search(prove ? "bees" : options.algorithm);
  const PopulationResult found = population->solve(search, options.population, timed);
  out.history = found.history;
  // What fails the finer check is no candidate for anyone; the cheapest that passes is the answer.
  const auto check_first = [&] {
    std::stable_sort(out.feasible.begin(), out.feasible.end(),
                     [](const FeasibleGrasp& a, const FeasibleGrasp& b) { return a.grasp.cost < b.grasp.cost; });
    while (!out.feasible.empty()) {
      out.path = follow_object_path(problem, out.feasible.front().grasp, path_options);
      if (out.path.outcome == Outcome::solved) return;
      out.feasible.erase(out.feasible.begin());
    }
  };
  if (!out.feasible.empty()) {
    PopulationOptions further = options.population;
    further.target = PopulationOptions().target;
    for (const auto& objective : detail::front_objectives(out.feasible, options.front_searches)) {
      if (timed.stopped()) break;
      value = objective;
      ++further.seed;
      population->solve(search, further, timed);
    }
  }
  check_first();
  if (prove && !timed.stopped()) {
    const double cost = out.feasible.empty() ? detail::kInfinity : out.path.cost;
    const detail::BoxSearch boxes =
        detail::divide_boxes(problem, pipe, path_options, options, cost, count, time_limit, monitor);
    check_first();
    out.lower_bound = boxes.lower_bound;
    out.boxes = boxes.boxes;
  }
  const bool stopped = monitor.stopped();
  out.front = detail::pareto_front(out.feasible);
  if (out.feasible.empty()) {
    out.gap = 1;
    const bool proven = out.lower_bound == detail::kInfinity;
    out.outcome = stopped ? Outcome::stopped : proven ? Outcome::infeasible : Outcome::not_found;
    return out;
  }
  out.grasp = out.feasible.front().grasp;
  out.gap = out.path.cost > 0 ? std::max(0.0, 1 - out.lower_bound / out.path.cost) : 0;
  const bool good = out.gap <= options.max_gap || out.path.cost <= options.population.target;
  out.outcome = stopped ? Outcome::stopped : good ? Outcome::solved : Outcome::approximate;
  return out;
}

}  // namespace mmgrasp
