// Arms with more freedom than a pose takes, along paths: a seventh joint, or a base that glides.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carried_pipe.hpp"
#include "enumerated_path.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/structure/pipe_grasps.hpp"
#include "structure/object_path/configuration_graph.hpp"
#include "support/puma_arm.hpp"
#include "support/small_robots.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

ObjectPathProblem along(const JointGroup& group, const Poses& poses, const std::set<std::string>& touch) {
  return {group, {}, figure_3_4().shapes(), poses, {}, touch, figure_3_4_frame(), "pipe"};
}

/// Answers of the library and of the enumeration; how many of the grasps were feasible.
int expect_equal(const ObjectPathProblem& problem, const ObjectPathOptions& options,
                 const Configurations& configurations, int grasps, int& refused) {
  ObjectPathEvaluator evaluator(problem, options);
  int solved = 0;
  for (const Grasp& grasp : some_grasps(grasps, 7)) {
    const ObjectPathResult found = evaluator.evaluate(grasp);
    const Enumerated truth(problem, grasp, options, configurations);
    EXPECT_EQ(found.violations, truth.violations);
    EXPECT_EQ(found.outcome == Outcome::solved, truth.sequences > 0);
    refused += found.refused_edges;
    if (found.outcome != Outcome::solved || truth.sequences == 0) continue;
    ++solved;
    EXPECT_NEAR(found.cost, truth.cost, 1e-7 * truth.cost);
    const ObjectPathResult again = ObjectPathEvaluator(problem, options).evaluate(grasp);
    EXPECT_EQ(again.cost, found.cost);
    for (std::size_t i = 0; i < found.path.waypoints.size(); ++i)
      EXPECT_EQ(again.path.waypoints[i], found.path.waypoints[i]);
  }
  return solved;
}

TEST(SampledPaths, SevenJointsEqualEnumeration) {
  const JointGroup group = Robot::from_strings(test::seven_joint_urdf()).chain("column", "tool");
  Poses poses;
  for (int i = 0; i < 4; ++i)
    poses.push_back(pose_from_xyz_rpy({0.35 + 0.01 * i, 0.1 * i - 0.1, 0.8}, {0, 0.05 * i, 0.1 * i}));
  ObjectPathProblem problem = along(group, poses, {"tool"});
  problem.world.add("post", Cylinder{0.03, 1.5}, pose_from_xyz_rpy({0.25, 0.3, 0.75}, {0, 0, 0}));
  ObjectPathOptions options;
  options.all_turns = false;
  options.max_joint_step = 0.9;  // to the next sampled value, and not farther
  options.position_tolerance = 0.02;
  int refused = 0, solved = 0;
  for (const int values : {7, 12}) {
    options.redundant_values = values;
    solved += expect_equal(problem, options, all_branches(group, values), 30, refused);
  }
  EXPECT_GT(solved, 4);
  EXPECT_GT(refused, 0);
}

/// Everything the grid of the options has, made here: the arm solved by itself wherever the base may stand.
Configurations on_grid(const test::PumaArm& robot, const ObjectPathOptions& options) {
  const JointGroup arm = robot.robot().chain("l0", "l6");
  return [arm, options](const Pose& T) {
    std::vector<VectorXd> all;
    const int far = static_cast<int>(3 / options.base_spacing);
    for (int x = -far; x <= far; ++x) {
      for (int y = -far; y <= far; ++y) {
        for (int k = 0; k < options.base_headings; ++k) {
          const double turn = std::remainder(2 * M_PI * k / options.base_headings, 2 * M_PI);
          const Vector3d base(x * options.base_spacing, y * options.base_spacing, turn);
          const Pose stands = pose_from_xyz_rpy({base.x(), base.y(), 0}, {0, 0, turn});
          for (const VectorXd& q : solve_ik_branches(arm.at(stands), T).solutions) {
            all.emplace_back(9);
            all.back() << base, q;
          }
        }
      }
    }
    return all;
  };
}

TEST(SampledPaths, OmniBaseEqualsEnumeration) {
  const test::PumaArm robot(2.6, BaseKind::omni);
  Poses poses;
  for (int i = 0; i < 4; ++i) poses.push_back(pose_from_xyz_rpy({0.2 * i, 0, 0.6}, {0, 0, 0.02 * i}));
  ObjectPathProblem problem = along(robot.group(), poses, {"l5", "l6"});
  problem.world.add("post", Cylinder{0.1, 0.3}, pose_from_xyz_rpy({-0.45, 0, 0.15}, {0, 0, 0}));
  ObjectPathOptions options;
  options.all_turns = false;
  options.base_spacing = 0.45;
  options.base_headings = 2;
  options.position_tolerance = 0.04;
  int refused = 0;
  EXPECT_GT(expect_equal(problem, options, on_grid(robot, options), 8, refused), 2);
  EXPECT_GT(refused, 0);
}

/// A straight carry of 3 m, out of reach of any standing base. An arm that keeps still on a base that goes along moves
/// 3 m in all; the places of the base allow just that.
TEST(SampledPaths, LongStraightCarryNeedsTheBase) {
  const test::PumaArm robot(2.6, BaseKind::omni);
  Poses poses;
  for (int i = 0; i <= 15; ++i) poses.push_back(pose_from_xyz_rpy({0.2 * i, 0, 0.6}, {0, 0, 0}));
  ObjectPathProblem problem = along(robot.group(), poses, {"l5", "l6"});
  problem.frame.reset();
  ObjectPathOptions options;
  options.deflection_weight = options.manipulability_weight = 0;
  options.motion_weight = 1;
  options.base_headings = 1;
  const Grasp grasp = some_grasps(1, 7).front();
  const ObjectPathResult found = follow_object_path(problem, grasp, options);
  ASSERT_EQ(found.outcome, Outcome::solved);
  EXPECT_LE(found.joint_motion, 3 + 1e-6);
  const VectorXd moved = found.path.waypoints.back() - found.path.waypoints.front();
  EXPECT_GT(moved.head<2>().norm(), 3 - 2 * (robot.reach() + 0.6));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose T = problem.group.fk(found.path.waypoints[i]) * grasp.T_object_hand.inverse();
    EXPECT_LT((T.translation() - poses[i].translation()).norm(), 1e-5);
    EXPECT_LT(rotation_distance(T, poses[i]), 1e-4);
  }
  // More headings are more choice.
  options.base_headings = 2;
  const ObjectPathResult more = follow_object_path(problem, grasp, options);
  ASSERT_EQ(more.outcome, Outcome::solved);
  EXPECT_LE(more.joint_motion, found.joint_motion * (1 + 1e-9));
  // The arm alone cannot.
  problem.group = robot.robot().chain("l0", "l6");
  EXPECT_EQ(follow_object_path(problem, grasp, options).outcome, Outcome::not_found);
}

TEST(SampledPaths, TooFineAGridIsRefused) {
  const test::PumaArm robot(2.6, BaseKind::omni);
  const Poses poses{pose_from_xyz_rpy({0, 0, 0.6}, {0, 0, 0}), pose_from_xyz_rpy({0.1, 0, 0.6}, {0, 0, 0})};
  ObjectPathOptions options;
  options.base_spacing = 0.001;
  EXPECT_THROW(follow_object_path(along(robot.group(), poses, {"l6"}), some_grasps(1, 7).front(), options),
               InvalidInput);
}

/// Random graphs, all paths walked; checks that refuse some vertices and edges.
TEST(ConfigurationGraph, EqualsAllPaths) {
  Rng rng(11);
  int found = 0, none = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<int> sizes(4);
    for (int& size : sizes) size = 1 + static_cast<int>(rng.uniform() * 5);
    std::vector<Eigen::MatrixXd> cost, refused;
    std::vector<VectorXd> bad;
    detail::ConfigurationGraph graph(sizes);
    for (std::size_t i = 0; i < sizes.size(); ++i)
      bad.push_back(VectorXd::NullaryExpr(sizes[i], [&] { return rng.uniform() < 0.2 ? 1.0 : 0.0; }));
    for (std::size_t i = 0; i + 1 < sizes.size(); ++i) {
      const auto draw = [&](double share, double other) {
        return Eigen::MatrixXd(Eigen::MatrixXd::NullaryExpr(
            sizes[i], sizes[i + 1], [&] { return rng.uniform() < share ? rng.uniform() : other; }));
      };
      cost.push_back(draw(0.6, std::numeric_limits<double>::infinity()));
      refused.push_back(draw(0.3, -1));
      for (int to = 0; to < sizes[i + 1]; ++to) {
        for (int from = 0; from < sizes[i]; ++from) {
          if (std::isfinite(cost[i](from, to))) graph.add_edge(i, from, to, cost[i](from, to));
        }
      }
    }
    double least = std::numeric_limits<double>::infinity();
    const std::function<void(std::size_t, int, double)> walk = [&](std::size_t i, int at, double so_far) {
      if (bad[i](at) > 0) return;
      if (i + 1 == sizes.size()) {
        least = std::min(least, so_far);
        return;
      }
      for (int to = 0; to < sizes[i + 1]; ++to) {
        if (std::isfinite(cost[i](at, to)) && refused[i](at, to) < 0) walk(i + 1, to, so_far + cost[i](at, to));
      }
    };
    for (int at = 0; at < sizes[0]; ++at) walk(0, at, 0);
    const detail::ConfigurationGraph::Check check{
        [&](std::size_t i, int vertex) { return bad[i](vertex) == 0; },
        [&](std::size_t i, int from, int to) { return refused[i](from, to) < 0; }};
    detail::ConfigurationGraph lazy = graph;
    const auto checked = graph.cheapest(&check);
    detail::ConfigurationGraph::Path path;
    for (bool stands = false; !stands;) {  // one path after the other, as evaluate() does for few configurations
      path = lazy.cheapest();
      stands = true;
      for (std::size_t i = 0; i < path.vertices.size(); ++i) {
        if (!check.vertex(i, path.vertices[i])) {
          lazy.remove_vertex(i, path.vertices[i]);
          stands = false;
        } else if (i > 0 && !check.edge(i - 1, path.vertices[i - 1], path.vertices[i])) {
          lazy.remove_edge(i - 1, path.vertices[i - 1], path.vertices[i]);
          stands = false;
        }
      }
    }
    EXPECT_EQ(checked.vertices.empty(), std::isinf(least));
    EXPECT_EQ(path.vertices.empty(), std::isinf(least));
    if (std::isinf(least)) {
      ++none;
      const std::vector<int> gaps = graph.gaps();
      EXPECT_LT(std::count(gaps.begin(), gaps.end(), 0), static_cast<long>(gaps.size()));
      continue;
    }
    ++found;
    EXPECT_NEAR(checked.cost, least, 1e-12);
    EXPECT_NEAR(path.cost, least, 1e-12);
    for (const int gap : lazy.gaps()) EXPECT_EQ(gap, 0);
  }
  EXPECT_GT(found, 50);
  EXPECT_GT(none, 50);
}

}  // namespace
}  // namespace mmgrasp
