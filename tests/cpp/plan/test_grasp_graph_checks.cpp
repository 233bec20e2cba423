// What is shared between grasps, and what is not: the robot's contacts are all grasps', the attached object's one
// grasp's.
#include "plan/manipulation/prm_star_mg/grasp_graph_checks.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "plan/roadmap/roadmap_data.hpp"
#include "support/bar_transfer.hpp"

namespace mmgrasp {
namespace {

/// A configuration that is free with one grasp, while with another one the bar, and it alone, collides.
struct Gate {
  Eigen::VectorXd q;
  Grasp passing, blocked;
};

class OneVertex : public ::testing::Test {
 protected:
  /// Both ends of a grasp, by the checker of everything.
  bool has_ends(const Grasp& grasp) const { return !ends(grasp, false).empty() && !ends(grasp, true).empty(); }

  std::vector<Eigen::VectorXd> ends(const Grasp& grasp, bool at_goal) const {
    CollisionChecker checker(problem_.group, test::carrying(problem_, grasp));
    return solve_ik_all(problem_.group,
                        (at_goal ? problem_.T_world_goal : problem_.T_world_start) * grasp.T_object_hand, 2, {},
                        [&](const Eigen::VectorXd& q) { return checker.rejection(q); });
  }

  bool passes(const Grasp& grasp, const Eigen::VectorXd& q) const {
    CollisionChecker checker(problem_.group, test::carrying(problem_, grasp));
    for (const bool at_goal : {false, true}) {
      bool joined = false;
      for (const Eigen::VectorXd& end : ends(grasp, at_goal)) joined |= checker.edge_is_free(end, q, 0.002);
      if (!joined) return false;
    }
    return true;
  }

  Gate find_gate() const {
    CollisionChecker alone(problem_.group, problem_.world);
    std::vector<Grasp> grasps;
    for (const Grasp& grasp : problem_.grasps)
      if (has_ends(grasp)) grasps.push_back(grasp);
    Rng rng(1, 0);
    while (true) {
      Gate gate;
      gate.q = rng.uniform(problem_.group.sample_lower(), problem_.group.sample_upper());
      if (!alone.is_free(gate.q)) continue;
      bool blocked = false;
      for (const Grasp& grasp : grasps) {
        if (CollisionChecker(problem_.group, test::carrying(problem_, grasp)).is_free(gate.q)) continue;
        gate.blocked = grasp;
        blocked = true;
      }
      for (const Grasp& grasp : grasps) {
        if (!blocked || !passes(grasp, gate.q)) continue;
        gate.passing = grasp;
        return gate;
      }
    }
  }

  ManipulationProblem problem_ = test::bar_transfer();
};

TEST_F(OneVertex, IsNotClosedToAllGraspsByWhatOneOfThemHolds) {
  const Gate gate = find_gate();
  const Roadmap roadmap = detail::roadmap_over(problem_.group, 1, gate.q);
  ManipulationOptions options;
  options.straight = false;
  options.prm.shorten = false;
  options.ik_solutions = 2;
  options.time_limit = 100;
  problem_.grasps = {gate.blocked};
  EXPECT_EQ(plan_manipulation(problem_, options, &roadmap).outcome, Outcome::not_found);
  // The other grasp costs more than any path, so that it is searched last.
  Grasp passing = gate.passing;
  passing.cost = 100;
  for (const int batch : {0, 1})
    for (const bool lazy : {true, false})
      for (const bool first : {true, false}) {
        problem_.grasps = {gate.blocked, gate.blocked, gate.blocked};
        problem_.grasps.insert(first ? problem_.grasps.begin() : problem_.grasps.end(), passing);
        options.prm.batch = batch;
        options.prm.lazy_grasps = lazy;
        const ManipulationResult result = plan_manipulation(problem_, options, &roadmap);
        ASSERT_EQ(result.outcome, Outcome::solved) << batch << lazy << first;
        EXPECT_EQ(result.grasp_index, first ? 0 : 3);
        ASSERT_EQ(result.path->waypoints.size(), 3u);
        EXPECT_EQ(result.path->waypoints[1], gate.q);
      }
}

/// Conversely: no edge through it is checked for any of them.
TEST_F(OneVertex, IsClosedToAllGraspsByTheRobotItself) {
  const Gate gate = find_gate();
  ManipulationOptions options;
  options.straight = false;
  options.prm.shorten = false;
  options.ik_solutions = 2;
  options.time_limit = 100;
  // The stretched arm lies in the post.
  const Roadmap roadmap = detail::roadmap_over(problem_.group, 1, Eigen::VectorXd(Eigen::Vector3d::Zero()));
  CollisionChecker alone(problem_.group, problem_.world);
  ASSERT_EQ(alone.rejection(Eigen::Vector3d::Zero()), Rejection::scene);
  for (const int count : {1, 20}) {
    problem_.grasps.assign(count, gate.passing);
    const ManipulationResult result = plan_manipulation(problem_, options, &roadmap);
    EXPECT_EQ(result.outcome, Outcome::not_found);
    EXPECT_EQ(result.stats.grasps_searched, count);
    EXPECT_EQ(result.stats.edges_checked_robot + result.stats.edges_checked_attached, 0u);
  }
}

}  // namespace
}  // namespace mmgrasp
