#include "mmgrasp/plan/manipulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "plan/roadmap/roadmap_data.hpp"
#include "support/bar_transfer.hpp"
#include "support/exhaustive_transfer.hpp"
#include "support/planar_arm.hpp"
#include "support/temporary_folder.hpp"

namespace mmgrasp {
namespace {

ManipulationOptions bar_options() {
  ManipulationOptions options;
  options.prm.roadmap.vertices = 300;
  options.prm.roadmap.gamma = 5;
  options.ik_solutions = 2;
  options.time_limit = 100;
  options.prm.shorten = false;
  return options;
}

TEST(Roadmap, JoinsExactlyTheNearOnes) {
  const test::PlanarArm arm(3);
  RoadmapOptions options;
  options.vertices = 400;
  options.gamma = 5;
  const Roadmap roadmap = Roadmap::build(arm.group(), options);
  const double radius = 5 * std::pow(std::log(400.0) / 400, 1.0 / 3);
  EXPECT_NEAR(roadmap.statistics().radius, radius, 1e-12);
  int edges = 0;
  for (int a = 0; a < 400; ++a) {
    EXPECT_TRUE(arm.group().within_limits(roadmap.vertices().col(a)));
    std::vector<int> joined, expected;
    for (const Roadmap::Arc* arc = roadmap.begin(a); arc != roadmap.end(a); ++arc) {
      joined.push_back(arc->to);
      EXPECT_NEAR(arc->length, (roadmap.vertices().col(a) - roadmap.vertices().col(arc->to)).norm(), 1e-12);
      EXPECT_EQ(roadmap.ends(arc->edge), std::make_pair(std::min(a, arc->to), std::max(a, arc->to)));
    }
    for (int b = 0; b < 400; ++b)
      if (b != a && (roadmap.vertices().col(a) - roadmap.vertices().col(b)).norm() < radius) expected.push_back(b);
    std::sort(joined.begin(), joined.end());
    EXPECT_EQ(joined, expected);
    edges += static_cast<int>(expected.size());
  }
  EXPECT_EQ(2 * roadmap.edge_count(), edges);
  EXPECT_NEAR(roadmap.statistics().mean_degree, edges / 400.0, 1e-12);
  // gamma* = 2 (1 + 1/3)^(1/3) (5.6^3 / (4/3 pi))^(1/3)
  EXPECT_NEAR(roadmap.statistics().gamma_star, 2 * std::cbrt(4.0 / 3) * 5.6 / std::cbrt(4.0 / 3 * M_PI), 1e-9);
}

/// The setting of P2's experiments: sparse, of many components, and far below the gamma that PRM* needs.
TEST(Roadmap, SixJointsNeedMoreThanTheGammaOfThePaper) {
  const test::PlanarArm arm(6, 0.2, 0.02, false, M_PI);
  RoadmapOptions options;
  options.vertices = 5000;
  options.gamma = 4;
  const RoadmapStatistics statistics = Roadmap::build(arm.group(), options).statistics();
  // The unit ball in six dimensions holds pi^3 / 6.
  EXPECT_NEAR(statistics.gamma_star,
              2 * std::pow(7.0 / 6, 1.0 / 6) * 2 * M_PI / std::pow(M_PI * M_PI * M_PI / 6, 1.0 / 6),
              1e-4);  // limits are written with six digits
  EXPECT_GT(statistics.gamma_star, 2 * options.gamma);
  EXPECT_GT(statistics.mean_degree, 1.5);
  EXPECT_LT(statistics.mean_degree, 3);
  EXPECT_GT(statistics.components, 500);
  EXPECT_LT(statistics.largest_component, 4500);
}

TEST(Roadmap, LargerOneHoldsTheSmallerOnesVertices) {
  const test::PlanarArm arm(3);
  RoadmapOptions options;
  options.vertices = 50;
  const Roadmap small = Roadmap::build(arm.group(), options);
  options.vertices = 200;
  const Roadmap large = Roadmap::build(arm.group(), options);
  EXPECT_EQ(small.vertices(), large.vertices().leftCols(50));
}

TEST(Roadmap, BuildingEndsWhenItIsOver) {
  const test::PlanarArm arm(3);
  RoadmapOptions options;
  options.vertices = 200'000;
  options.neighbours = 8;
  // While vertices are drawn; while they are joined.
  for (const int last : {3, 400}) {
    std::atomic<int> checks{0};
    const Roadmap roadmap = detail::build_roadmap(arm.group(), options, {}, [&] { return ++checks >= last; });
    EXPECT_EQ(roadmap.size(), 0);
    EXPECT_EQ(roadmap.edge_count(), 0);
    EXPECT_LT(checks, last + 100);
  }
  Monitor monitor;
  monitor.stop.stop();
  EXPECT_EQ(Roadmap::build(arm.group(), options, monitor).size(), 0);
}

TEST(Roadmap, FileHoldsAllOfItAndNothingElseIsTaken) {
  const test::PlanarArm arm(3);
  RoadmapOptions options;
  options.vertices = 100;
  options.neighbours = 6;
  const Roadmap roadmap = Roadmap::build(arm.group(), options);
  const test::TemporaryFolder folder;
  const std::string path = folder.file("test.roadmap");
  roadmap.save(path);
  const Roadmap back = Roadmap::load(path, arm.group());
  EXPECT_EQ(back.vertices(), roadmap.vertices());
  ASSERT_EQ(back.edge_count(), roadmap.edge_count());
  for (int e = 0; e < roadmap.edge_count(); ++e) EXPECT_EQ(back.ends(e), roadmap.ends(e));
  for (int v = 0; v < roadmap.size(); ++v) EXPECT_GE(roadmap.end(v) - roadmap.begin(v), 6);
  EXPECT_THROW(Roadmap::load(path, test::PlanarArm(4).group()), IoError);
  EXPECT_THROW(Roadmap::load(path, test::PlanarArm(3, 0.4).group()), IoError);
  EXPECT_THROW(Roadmap::load(path, test::PlanarArm(3, 0.5, 0.02, false, 2.5).group()), IoError);
  // Shapes do not matter: nothing was checked for collisions.
  EXPECT_EQ(Roadmap::load(path, test::PlanarArm(3, 0.5, 0.03).group()).vertices(), roadmap.vertices());
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  for (const std::size_t at : {std::size_t{3}, std::size_t{40}, bytes.size() / 2, bytes.size() - 3}) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    std::ofstream(path, std::ios::binary) << damaged;
    EXPECT_THROW(Roadmap::load(path, arm.group()), IoError) << at;
    std::ofstream(path, std::ios::binary) << bytes.substr(0, at);
    EXPECT_THROW(Roadmap::load(path, arm.group()), IoError) << at;
  }
  EXPECT_THROW(Roadmap::load(path, arm.group()), IoError);
}

TEST(PrmStarMg, EveryVariantFindsTheExhaustiveOptimum) {
  const ManipulationProblem problem = test::bar_transfer();
  ManipulationOptions options = bar_options();
  const Roadmap roadmap = Roadmap::build(problem.group, options.prm.roadmap);
  double best = std::numeric_limits<double>::infinity();
  int feasible = 0;
  for (std::size_t g = 0; g < problem.grasps.size(); ++g) {
    const double cost = test::exhaustive_cost(problem, options, roadmap, static_cast<int>(g));
    feasible += std::isfinite(cost) ? 1 : 0;
    best = std::min(best, cost);
  }
  ASSERT_GT(feasible, 1);
  ASSERT_LT(feasible, 20);
  for (const int batch : {1, 4, 0})
    for (const bool lazy : {false, true})
      for (const int threads : {1, 2})
        for (const int first_grasps : {0, 1, 6}) {
          options.prm.batch = batch;
          options.prm.lazy_grasps = lazy;
          options.threads = threads;
          options.first_grasps = first_grasps;
          const ManipulationResult result = plan_manipulation(problem, options, &roadmap);
          ASSERT_EQ(result.outcome, Outcome::solved) << batch << lazy << first_grasps;
          EXPECT_NEAR(result.cost, best, 1e-9) << batch << lazy << first_grasps;
          EXPECT_NEAR(result.path->length(), best, 1e-9);
          EXPECT_NEAR(result.stats.roadmap_bound, best, 1e-9);
          EXPECT_LT(result.lower_bound, best);  // A path off the roadmap may cost less.
          EXPECT_EQ(result.stats.roadmap_cost, result.cost);
          // With everything in one batch the first solution is the best.
          EXPECT_TRUE(batch != 0 || first_grasps != 0 || result.improvements.size() == 1u);
        }
}

TEST(PrmStarMg, WithoutStraightEdgesTheRoadmapIsAllThereIs) {
  const ManipulationProblem problem = test::bar_transfer();
  ManipulationOptions options = bar_options();
  options.straight = false;
  const Roadmap roadmap = Roadmap::build(problem.group, options.prm.roadmap);
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t g = 0; g < problem.grasps.size(); ++g)
    best = std::min(best, test::exhaustive_cost(problem, options, roadmap, static_cast<int>(g)));
  ASSERT_TRUE(std::isfinite(best));
  for (const int batch : {1, 7, 0})
    for (const bool lazy : {false, true}) {
      options.prm.batch = batch;
      options.prm.lazy_grasps = lazy;
      EXPECT_NEAR(plan_manipulation(problem, options, &roadmap).cost, best, 1e-9) << batch << lazy;
    }
}

TEST(PrmStarMg, DensifyingEndsWithTheBestOfAllRoadmaps) {
  const ManipulationProblem problem = test::bar_transfer();
  ManipulationOptions options = bar_options();
  options.straight = false;
  double best = std::numeric_limits<double>::infinity();
  std::vector<double> costs;
  for (const int vertices : {300, 600, 1200}) {
    options.prm.roadmap.vertices = vertices;
    const ManipulationResult one = plan_manipulation(problem, options);
    if (one.path) best = std::min(best, one.cost);
    costs.push_back(one.path ? one.cost : std::numeric_limits<double>::infinity());
  }
  ASSERT_LT(best, costs.front());  // more vertices help
  options.prm.roadmap.vertices = 300;
  options.prm.max_vertices = 2399;
  std::vector<double> reported;
  const ManipulationResult result = plan_manipulation(
      problem, options, nullptr, {}, [&](const Improvement& better) { reported.push_back(better.cost); });
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_NEAR(result.cost, best, 1e-9);
  EXPECT_EQ(reported.back(), result.cost);
  EXPECT_TRUE(std::is_sorted(reported.rbegin(), reported.rend()));
  options.prm.max_vertices = 0;
  EXPECT_NEAR(plan_manipulation(problem, options).cost, costs.front(), 1e-9);
}

TEST(PrmStarMg, ARoadmapInPiecesIsAWarning) {
  ManipulationOptions options = bar_options();
  EXPECT_TRUE(plan_manipulation(test::bar_transfer(), options).warnings.empty());
  options.prm.roadmap.gamma = 0.5;
  const Roadmap roadmap = Roadmap::build(test::bar_transfer().group, options.prm.roadmap);
  EXPECT_EQ(plan_manipulation(test::bar_transfer(), options).warnings, std::vector<std::string>{roadmap.warning()});
}

/// The stages of each planner, in turn: each better path says which of them found it, and the statistics sum it up.
/// Held against each grasp planned by itself on the same roadmap.
TEST(ManipulationLength, TheCheapestGraspAmongTheShortEnoughIsTaken) {
  ManipulationProblem problem = test::bar_transfer();
  for (std::size_t i = 0; i < problem.grasps.size(); ++i) problem.grasps[i].cost = 0.1 * ((7 * i + 3) % 20);
  const ManipulationOptions options = bar_options();
  const Roadmap roadmap = Roadmap::build(problem.group, options.prm.roadmap);
  std::vector<double> lengths;
  for (const Grasp& grasp : problem.grasps) {
    ManipulationProblem alone = problem;
    alone.grasps = {grasp};
    alone.grasps[0].cost = 0;
    const ManipulationResult found = plan_manipulation(alone, options, &roadmap);
    lengths.push_back(found.path ? found.cost : std::numeric_limits<double>::infinity());
  }
  std::vector<double> sorted = lengths;
  std::sort(sorted.begin(), sorted.end());
  // Inverse kinematics of this arm is iterative: lengths repeat to its tolerance.
  for (const double most : {sorted[0] + 1e-3, (sorted[2] + sorted[3]) / 2, (sorted[5] + sorted[6]) / 2, 100.0}) {
    ManipulationOptions within = options;
    within.max_length = most;
    int best = -1;
    for (int i = 0; i < 20; ++i) {
      if (lengths[i] <= most && (best < 0 || problem.grasps[i].cost < problem.grasps[best].cost)) best = i;
    }
    const ManipulationResult found = plan_manipulation(problem, within, &roadmap);
    ASSERT_EQ(found.outcome, Outcome::solved) << most << " of " << sorted[0];
    EXPECT_EQ(found.grasp_index, best) << most;
    EXPECT_NEAR(found.cost, lengths[best] + problem.grasps[best].cost, 1e-3);
    EXPECT_NEAR(found.path->length() + problem.grasps[best].cost, found.cost, 1e-9);
    EXPECT_LE(found.lower_bound, found.cost);
    EXPECT_EQ(found.improvements.back().grasp, best);
    const ManipulationResult without = plan_manipulation(problem, within);
    EXPECT_EQ(without.grasp_index, best) << most;
  }
  ManipulationOptions none = options;
  none.max_length = 0.9 * sorted[0];
  const ManipulationResult found = plan_manipulation(problem, none, &roadmap);
  EXPECT_EQ(found.outcome, Outcome::not_found);
  EXPECT_FALSE(found.path);
  EXPECT_EQ(found.grasp_index, -1);
  ASSERT_FALSE(found.warnings.empty());
  none.max_length = -1;
  EXPECT_THROW(plan_manipulation(problem, none, &roadmap), InvalidInput);
}

TEST(ManipulationStages, SayWhatTheyFoundAndWhen) {
  ManipulationOptions options = bar_options();
  ManipulationProblem problem = test::bar_transfer();
  const auto stages_of = [&] {
    const ManipulationResult result = plan_manipulation(problem, options);
    std::vector<PlanStage> stages;
    std::size_t counted = 0;
    for (const StageReport& report : result.stats.stages) {
      stages.push_back(report.stage);
      counted += report.improvements;
      const auto own = [&](const Improvement& better) { return better.stage == report.stage; };
      const auto first = std::find_if(result.improvements.begin(), result.improvements.end(), own);
      const auto last = std::find_if(result.improvements.rbegin(), result.improvements.rend(), own);
      EXPECT_EQ(report.first_seconds, first->seconds);
      EXPECT_EQ(report.last_seconds, last->seconds);
      EXPECT_EQ(report.cost, last->cost);
    }
    EXPECT_EQ(counted, result.improvements.size());
    return stages;
  };
  options.straight = false;
  EXPECT_EQ(stages_of(), std::vector<PlanStage>{PlanStage::roadmap});
  options.prm.shorten = true;
  options.prm.refinements = 0;
  EXPECT_EQ(stages_of(), (std::vector<PlanStage>{PlanStage::roadmap, PlanStage::shortening}));
  options.prm.refinements = 8;
  const std::vector<PlanStage> refined = stages_of();
  EXPECT_EQ(std::count(refined.begin(), refined.end(), PlanStage::refinement), 1);
  options.straight = true;
  EXPECT_EQ(stages_of().front(), PlanStage::first_grasps);
  options.planner = "rrt_star_mg";
  options.first_grasps = 0;
  options.seed = 2;
  // The last pass over the trees' path removes a waypoint, which makes it a little shorter.
  EXPECT_EQ(stages_of(), (std::vector<PlanStage>{PlanStage::trees, PlanStage::shortening}));
  problem.world = World{};
  for (const std::string& planner : manipulation_planner_names()) {
    options.planner = planner;
    EXPECT_EQ(stages_of().front(), PlanStage::straight_lines) << planner;
  }
}

TEST(PrmStarMg, DensifyingHeedsTheClock) {
  ManipulationOptions options = bar_options();
  options.prm.max_vertices = 10'000'000;  // Would take minutes.
  options.time_limit = 0.5;
  const ManipulationResult result = plan_manipulation(test::bar_transfer(), options);
  EXPECT_EQ(result.outcome, Outcome::solved);
  EXPECT_LE(result.lower_bound, result.cost);
}

TEST(PrmStarMg, PathMovesTheObjectAndIsFree) {
  const ManipulationProblem problem = test::bar_transfer();
  ManipulationOptions options = bar_options();
  options.straight = false;
  const ManipulationResult over_roadmap = plan_manipulation(problem, options);
  options.prm.shorten = true;
  options.prm.refinements = 0;
  const ManipulationResult result = plan_manipulation(problem, options);
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_LT(result.cost, 0.95 * over_roadmap.cost);
  EXPECT_NEAR(result.cost, result.path->length(), 1e-9);
  EXPECT_EQ(result.stats.roadmap_cost, over_roadmap.cost);
  EXPECT_EQ(result.improvements.size(), over_roadmap.improvements.size() + 1);
  const Grasp& grasp = problem.grasps[result.grasp_index];
  CollisionChecker checker(problem.group, test::carrying(problem, grasp));
  const auto& waypoints = result.path->waypoints;
  for (std::size_t i = 0; i + 1 < waypoints.size(); ++i)
    EXPECT_TRUE(checker.edge_is_free(waypoints[i], waypoints[i + 1], 0.001));
  const auto object_at = [&](const Eigen::VectorXd& q) { return problem.group.fk(q) * grasp.T_object_hand.inverse(); };
  EXPECT_LT((object_at(waypoints.front()).matrix() - problem.T_world_start.matrix()).norm(), 3e-4);
  EXPECT_LT((object_at(waypoints.back()).matrix() - problem.T_world_goal.matrix()).norm(), 3e-4);
}

TEST(PrmStarMg, CostsOfGraspsCount) {
  ManipulationProblem problem = test::bar_transfer();
  const ManipulationOptions options = bar_options();
  const ManipulationResult cheap = plan_manipulation(problem, options);
  ASSERT_EQ(cheap.outcome, Outcome::solved);
  problem.grasps[cheap.grasp_index].cost = 100;
  const ManipulationResult other = plan_manipulation(problem, options);
  ASSERT_EQ(other.outcome, Outcome::solved);
  EXPECT_NE(other.grasp_index, cheap.grasp_index);
  EXPECT_GE(other.cost, cheap.cost);
  EXPECT_LT(other.cost, 100);
}

TEST(PrmStarMg, SaysWhyThereIsNoPlan) {
  ManipulationProblem problem = test::bar_transfer();
  ManipulationOptions options = bar_options();
  options.ik.restarts = 5;
  problem.T_world_start = test::flat_pose(5, 0, 0);
  ManipulationResult result = plan_manipulation(problem, options);
  EXPECT_EQ(result.outcome, Outcome::invalid_start);
  EXPECT_EQ(result.rejections.unreachable, 20u);
  problem = test::bar_transfer();
  problem.T_world_goal = test::flat_pose(0.85, 0, 0);  // within the post
  result = plan_manipulation(problem, options);
  EXPECT_EQ(result.outcome, Outcome::invalid_goal);
  EXPECT_GT(result.rejections.scene, 0u);
  ASSERT_EQ(result.grasps.size(), 20u);
  for (const GraspReport& report : result.grasps) EXPECT_EQ(report.goal_solutions, 0);
  // Walls all around the start: reachable, but no way out.
  problem = test::bar_transfer();
  options.prm.roadmap.vertices = 20;
  options.prm.roadmap.gamma = 0.01;
  problem.world.add("wall", Shape(Box{{1.6, 0.02, 0.2}}), test::flat_pose(1.0, 0.05, 0));
  result = plan_manipulation(problem, options);
  EXPECT_EQ(result.outcome, Outcome::not_found);
  EXPECT_FALSE(result.path.has_value());
}

TEST(PrmStarMg, RefusesNonsense) {
  const ManipulationProblem good = test::bar_transfer();
  const auto refused = [](const ManipulationProblem& problem, const char* what) {
    try {
      plan_manipulation(problem, bar_options());
      ADD_FAILURE() << what;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  ManipulationProblem problem = good;
  problem.grasps.clear();
  refused(problem, "grasps");
  problem = good;
  problem.grasps[3].T_object_hand.linear() *= 1.1;
  refused(problem, "grasps[3].T_object_hand");
  problem = good;
  problem.T_world_goal.translation().x() = std::nan("");
  refused(problem, "T_world_goal");
  problem = good;
  problem.object.clear();
  refused(problem, "object");
  problem = good;
  problem.grasps[1].cost = -1;
  refused(problem, "grasps[1].cost");
  problem = good;
  problem.world.add("bar", Shape(Box{{0.1, 0.1, 0.1}}), test::flat_pose(0, 0, 0));
  problem.world.attach("bar", "tip", test::flat_pose(0, 0, 0));
  refused(problem, "world: holds 'bar'");
  const Roadmap foreign = Roadmap::build(test::PlanarArm(4).group(), bar_options().prm.roadmap);
  EXPECT_THROW(plan_manipulation(good, bar_options(), &foreign), InvalidInput);
}

TEST(PrmStarMg, StopsOnRequest) {
  Monitor monitor;
  monitor.stop.stop();
  EXPECT_EQ(plan_manipulation(test::bar_transfer(), bar_options(), nullptr, monitor).outcome, Outcome::stopped);
}

}  // namespace
}  // namespace mmgrasp
