#include "mmgrasp/structure/optimize_grasp.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mmgrasp/core/detail/numbers.hpp"
#include "structure/object_path/grasp_variables.hpp"

namespace mmgrasp {
namespace {

/// Neither other objective grows where one shrinks: indices of those that no other is at least as good as in all.
std::vector<int> pareto_front(const std::vector<FeasibleGrasp>& all) {
  std::vector<int> order(all.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return all[a].joint_motion < all[b].joint_motion; });
  const auto beats = [](const FeasibleGrasp& a, const FeasibleGrasp& b) {
    const bool no_worse = a.joint_motion <= b.joint_motion && a.deflection <= b.deflection &&
                          a.force_manipulability <= b.force_manipulability;
    return no_worse && (a.joint_motion < b.joint_motion || a.deflection < b.deflection ||
                        a.force_manipulability < b.force_manipulability);
  };
  std::vector<int> front;
  for (const int i : order) {
    if (std::none_of(all.begin(), all.end(), [&](const FeasibleGrasp& other) { return beats(other, all[i]); }))
      front.push_back(i);
  }
  return front;
}

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

void GraspSearchOptions::check() const {
  make_population_search(algorithm);
  population.check();
  grasp.check();
}

GraspOptimum optimize_grasp(const ObjectPathProblem& problem, const Pipe& pipe, const ObjectPathOptions& path_options,
                            const GraspSearchOptions& options, const Monitor& monitor) {
  options.check();
  const detail::GraspVariables grasps(pipe, options.grasp);
  ObjectPathEvaluator evaluator(problem, path_options);
  GraspOptimum out;
  out.unreachable.assign(problem.T_world_object.size(), 0);
  out.colliding = out.unreachable;
  PopulationProblem search;
  search.variables = grasps.variables();
  search.upper = [&](const Eigen::VectorXd& x, int i) {
    return i == 1 ? grasps.room(static_cast<int>(x(0))) : detail::kInfinity;
  };
  search.neighbour = [&](const Eigen::VectorXd& x, double size, Rng& rng) {
    return grasps.neighbour(x, size, options.neighbourhood, rng);
  };
  search.evaluate = [&](const Eigen::VectorXd& x) {
    Grasp grasp = grasps.grasp(x);
    const ObjectPathResult found = evaluator.evaluate(grasp);
    for (std::size_t i = 0; i < found.violations.size(); ++i) {
      out.unreachable[i] += found.violations[i] == 2;
      out.colliding[i] += found.violations[i] == 1;
    }
    if (found.outcome == Outcome::solved) {
      grasp.cost = found.cost;
      out.feasible.push_back({grasp, found.joint_motion, found.deflection, found.force_manipulability});
    }
    return ConstrainedValue{static_cast<double>(found.violation), found.cost};
  };
  const PopulationResult found = make_population_search(options.algorithm)->solve(search, options.population, monitor);
  out.evaluations = found.evaluations;
  out.history = found.history;
  std::stable_sort(out.feasible.begin(), out.feasible.end(),
                   [](const FeasibleGrasp& a, const FeasibleGrasp& b) { return a.grasp.cost < b.grasp.cost; });
  // What fails the finer check is no candidate for anyone; the cheapest that passes is the answer.
  while (!out.feasible.empty()) {
    ObjectPathResult path = follow_object_path(problem, out.feasible.front().grasp, path_options);
    if (path.outcome == Outcome::solved) {
      out.path = std::move(path);
      break;
    }
    out.feasible.erase(out.feasible.begin());
  }
  out.front = pareto_front(out.feasible);
  if (out.feasible.empty()) {
    out.outcome = found.outcome == Outcome::stopped ? Outcome::stopped : Outcome::not_found;
    return out;
  }
  out.grasp = out.feasible.front().grasp;
  out.outcome = out.path.cost <= options.population.target ? Outcome::solved : Outcome::approximate;
  if (found.outcome == Outcome::stopped) out.outcome = Outcome::stopped;
  return out;
}

}  // namespace mmgrasp
