#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "mmgrasp/core/random.hpp"
#include "plan/manipulation/rrt_star_mg/incumbent.hpp"
#include "plan/manipulation/rrt_star_mg/near_vertices.hpp"
#include "plan/manipulation/rrt_star_mg/tree_checks.hpp"
#include "support/bar_transfer.hpp"

namespace mmgrasp::test {

/// The parts of RRT*-MG over three grasps of the bar with arm configurations made up for the purpose. Nothing collides
/// unless boxes are added: the world is empty, and the bar may touch the arm.
struct TreeSetting {
  explicit TreeSetting(const std::vector<detail::GraspCandidate>& candidates, World world = {})
      : problem(problem_in(std::move(world))),
        ends(candidates),
        informed(ends, problem.group.sample_lower(), problem.group.sample_upper()),
        trees(ends),
        transfer_checks(problem, EdgeOptions{0.02, 0.005, false, 1e-4}, 1),
        checks(trees, transfer_checks, stats),
        near(trees, informed, options, tuning) {}

  static ManipulationProblem problem_in(World world) {
    ManipulationProblem problem = bar_transfer();
    problem.world = std::move(world);
    problem.touch_links = {"l1", "l2", "l3", "tip"};
    return problem;
  }

  static detail::GraspCandidate candidate(int grasp, const Eigen::Vector3d& start, const Eigen::Vector3d& goal,
                                          double cost = 0) {
    detail::GraspCandidate out;
    out.grasp = grasp;
    out.cost = cost;
    out.starts = {start};
    out.goals = {goal};
    return out;
  }

  /// The root of a grasp's tree.
  int root(int grasp, int side) const {
    int found = -1;
    trees.each_in_tree(detail::GraspTrees::tree(grasp, side), [&](int v) {
      if (trees.vertex(v).parent < 0) found = v;
    });
    return found;
  }

  /// Adds a vertex at q below another one.
  int add(int parent, const Eigen::Vector3d& q) {
    const int configuration = trees.add_configuration(q.data());
    return trees.add(parent, configuration, trees.distance(trees.vertex(parent).configuration, configuration));
  }

  ManipulationProblem problem;
  RrtStarMgOptions options;
  detail::RrtStarMgTuning tuning;
  detail::Incumbent incumbent;
  ManipulationStats stats;
  detail::GraspEnds ends;
  detail::InformedUnion informed;
  detail::GraspTrees trees;
  detail::TransferChecks transfer_checks;
  detail::TreeChecks checks;
  detail::NearVertices near;
};

/// Three grasps whose straight lines have lengths 2, 2.2 and 2.4.
inline std::vector<detail::GraspCandidate> three_grasps() {
  return {TreeSetting::candidate(0, {-1, 0, 0}, {1, 0, 0}), TreeSetting::candidate(1, {-1.1, 0.3, 0}, {1.1, 0.3, 0}),
          TreeSetting::candidate(2, {-1.2, -0.3, 0}, {1.2, -0.3, 0})};
}

}  // namespace mmgrasp::test
