// plan_manipulation() with a prepared checker.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "support/bar_transfer.hpp"

namespace mmgrasp {
namespace {

ManipulationOptions options_of(const std::string& planner) {
  ManipulationOptions options;
  options.planner = planner;
  options.time_limit = 1000;
  options.prm.roadmap.vertices = 400;
  options.rrt.max_iterations = 300;
  return options;
}

TEST(PreparedChecker, GivesTheSameAnswer) {
  ManipulationProblem problem = test::bar_transfer();
  problem.world.allow("post", "l1");
  problem.world.allow("corner", problem.object_name);  // A rule about what no checker without the object knows.
  World without_rule = problem.world;
  without_rule.forget(problem.object_name);
  for (const double padding : {0.0, 0.01}) {
    Padding all;
    all.links = padding;
    problem.world.set_padding(all);
    without_rule.set_padding(all);
    // Another load of the same robot will do.
    const CollisionChecker checker(test::bar_transfer().group, without_rule);
    for (const char* planner : {"prm_star_mg", "rrt_star_mg"})
      for (const double max_length : {0.0, 6.0}) {
        ManipulationOptions options = options_of(planner);
        options.max_length = max_length;
        const ManipulationResult made = plan_manipulation(problem, options);
        const ManipulationResult prepared = plan_manipulation(problem, options, nullptr, {}, {}, &checker);
        ASSERT_EQ(made.outcome, Outcome::solved) << planner;
        ASSERT_EQ(prepared.outcome, Outcome::solved) << planner;
        EXPECT_EQ(prepared.path->waypoints, made.path->waypoints);
        EXPECT_EQ(prepared.cost, made.cost);
        EXPECT_EQ(prepared.lower_bound, made.lower_bound);
        EXPECT_EQ(prepared.improvements.size(), made.improvements.size());
        EXPECT_EQ(prepared.stats.edges_checked_robot, made.stats.edges_checked_robot);
        EXPECT_EQ(prepared.stats.edges_checked_attached, made.stats.edges_checked_attached);
      }
  }
}

/// Its options hold for all checks: padding as that of the world does.
TEST(PreparedChecker, BringsItsOptions) {
  ManipulationProblem problem = test::bar_transfer();
  CheckerOptions padded;
  padded.padding = 0.01;
  const CollisionChecker checker(problem.group, problem.world, padded);
  const ManipulationOptions options = options_of("prm_star_mg");
  const ManipulationResult prepared = plan_manipulation(problem, options, nullptr, {}, {}, &checker);
  Padding links;
  links.links = 0.01;
  problem.world.set_padding(links);
  const ManipulationResult made = plan_manipulation(problem, options);
  ASSERT_EQ(prepared.outcome, Outcome::solved);
  EXPECT_EQ(prepared.path->waypoints, made.path->waypoints);
}

std::string refusal(const ManipulationProblem& problem, const CollisionChecker& checker) {
  try {
    plan_manipulation(problem, {}, nullptr, {}, {}, &checker);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

TEST(PreparedChecker, OfAnotherGroupOrWorldIsRefused) {
  const ManipulationProblem problem = test::bar_transfer();
  const std::string start = "checker: is not of the problem's group and world: ";
  const auto changed = [&](const auto& change) {
    World world = problem.world;
    change(world);
    return refusal(problem, CollisionChecker(problem.group, world));
  };
  EXPECT_EQ(changed([](World&) {}), "accepted");
  EXPECT_EQ(changed([](World& world) { world.remove("post"); }), start + "its world lacks 'post'");
  EXPECT_EQ(changed([](World& world) { world.add("more", Sphere{0.01}, test::flat_pose(3, 0, 0)); }),
            start + "its world holds 'more' as well");
  EXPECT_EQ(changed([](World& world) { world.move("post", test::flat_pose(0.85, 1e-12, 0)); }),
            start + "in its world 'post' stands elsewhere");
  EXPECT_EQ(changed([](World& world) {
              world.remove("post");
              world.add("post", Shape(Box{{0.1, 0.1, 0.2001}}), test::flat_pose(0.85, 0.0, 0));
            }),
            start + "in its world 'post' has other shapes");
  EXPECT_EQ(changed([](World& world) { world.allow("post", "l1"); }), start + "in its world other pairs may touch");
  EXPECT_EQ(changed([](World& world) {
              Padding padding;
              padding.objects = 0.01;
              world.set_padding(padding);
            }),
            start + "its world has another padding");
  EXPECT_EQ(changed([](World& world) {
              world.add("bag", Sphere{0.01}, Pose::Identity());
              world.attach("bag", "tip", Pose::Identity());
            }),
            start + "its world holds 'bag' as well");
  const test::PlanarArm longer(3, 0.41);
  EXPECT_EQ(refusal(problem, CollisionChecker(longer.group(), problem.world)),
            start + "it is of another robot ('planar', or other pairs of its links count)");
  const JointGroup part = problem.group.robot().chain("l0", "l2");
  EXPECT_EQ(refusal(problem, CollisionChecker(part, problem.world)),
            start + "it is of another group ('" + part.name() + "')");
  EXPECT_EQ(refusal(problem, CollisionChecker(problem.group.at(test::flat_pose(0, 0, 1e-9)), problem.world)),
            start + "its robot stands elsewhere");
  CheckerOptions attached_only;
  attached_only.attached_only = true;
  EXPECT_EQ(refusal(problem, CollisionChecker(problem.group, problem.world, attached_only)),
            "checker: attached_only = true: must check the robot itself, too");
}

}  // namespace
}  // namespace mmgrasp
