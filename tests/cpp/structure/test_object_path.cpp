#include "mmgrasp/structure/object_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "carried_pipe.hpp"
#include "enumerated_path.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/structure/pipe_grasps.hpp"
#include "support/puma_arm.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

ObjectPathProblem arc(int poses, bool posts = true) {
  ObjectPathProblem problem = posts ? arc_past_post(poses) : free_arc(poses);
  if (posts) problem.world.add("shelf", Box{{0.6, 1.2, 0.04}}, pose_from_xyz_rpy({0.4, 0, 1.02}, {0, 0, 0}));
  return problem;
}

Grasp grasp_at(int section, double length, double angle) {
  return place_pipe_grasp(figure_3_4(), section, length, angle, false, puma_tool());
}

TEST(ObjectPath, EqualsEnumeration) {
  int solved = 0, colliding = 0, refused = 0;
  for (const char* scene : {"empty", "posts", "bead", "strict"}) {
    ObjectPathProblem problem = arc(5, scene == std::string("posts"));
    ObjectPathOptions options;
    options.all_turns = false;
    if (scene == std::string("bead")) {  // the pipe passes through it between two poses, at neither of which it touches
      const Pose &a = problem.T_world_object[2], &b = problem.T_world_object[3];
      const Vector3d point(0.2, 0.4, 0.15);
      problem.world.add("bead", Sphere{0.002}, pose_from_xyz_rpy((a * point + b * point) / 2, {0, 0, 0}));
    }
    if (scene == std::string("strict")) options.position_tolerance = 8e-4;
    ObjectPathEvaluator evaluator(problem, options);
    for (const Grasp& grasp : some_grasps(60, 5)) {
      const ObjectPathResult found = evaluator.evaluate(grasp);
      const Enumerated truth(problem, grasp, options, all_branches(problem.group));
      EXPECT_EQ(found.violations, truth.violations);
      EXPECT_EQ(found.outcome == Outcome::solved, truth.sequences > 0);
      EXPECT_EQ(found.violation == 0, truth.sequences > 0);
      colliding += std::count(truth.violations.begin(), truth.violations.end(), 1) > 0;
      refused += found.refused_edges;
      if (found.outcome != Outcome::solved) continue;
      ++solved;
      EXPECT_NEAR(found.cost, truth.cost, 1e-9 * truth.cost);
      EXPECT_EQ(found.path.waypoints.size(), 5u);
      EXPECT_NEAR(found.joint_motion, found.path.length(), 1e-12);
    }
  }
  EXPECT_GT(solved, 20);
  EXPECT_GT(colliding, 5);
  EXPECT_GT(refused, 0);
}

TEST(ObjectPath, CostIsTheWeightedSumOverScales) {
  const ObjectPathProblem problem = arc(8, false);
  ObjectPathOptions options;
  options.motion_scale = 2;
  options.deflection_scale = 1e-4;
  options.manipulability_scale = 0.5;
  for (const Grasp& grasp : some_grasps(40, 5)) {
    const ObjectPathResult found = follow_object_path(problem, grasp, options);
    if (found.outcome != Outcome::solved) continue;
    EXPECT_NEAR(
        found.cost,
        0.587 * found.joint_motion / 2 + 0.089 * found.deflection / 1e-4 + 0.324 * found.force_manipulability / 0.5,
        1e-12 * found.cost);
    double sum = 0;
    for (std::size_t i = 1; i < found.sag.size(); ++i) sum += found.sag[i];
    EXPECT_NEAR(found.deflection, sum, 1e-15);
    for (std::size_t i = 0; i < 8; ++i) {
      const Pose T = problem.group.fk(found.path.waypoints[i]) * grasp.T_object_hand.inverse();
      EXPECT_LT((T.translation() - problem.T_world_object[i].translation()).norm(), 1e-5);
      EXPECT_LT(rotation_distance(T, problem.T_world_object[i]), 1e-4);
    }
    return;
  }
  FAIL() << "no grasp was feasible";
}

TEST(ObjectPath, SingleConfigurationsNeverCostLess) {
  const ObjectPathProblem problem = arc(10, false);
  ObjectPathOptions single;
  single.single_configuration = true;
  ObjectPathEvaluator all(problem), one(problem, single);
  int dearer = 0, both = 0;
  for (const Grasp& grasp : some_grasps(60, 5)) {
    const ObjectPathResult a = all.evaluate(grasp), b = one.evaluate(grasp);
    if (b.outcome != Outcome::solved) continue;
    ASSERT_EQ(a.outcome, Outcome::solved);
    ++both;
    EXPECT_LE(a.cost, b.cost * (1 + 1e-12));
    dearer += b.cost > 1.001 * a.cost;
  }
  EXPECT_GT(both, 10);
  EXPECT_GT(dearer, 5);
}

/// Of the sequences that keep to the nearest configuration from where the arm stands: there is one.
TEST(ObjectPath, ASingleConfigurationBeginsWhereTheArmStands) {
  ObjectPathProblem problem = arc(6, false);
  ObjectPathOptions single;
  single.single_configuration = true;
  single.all_turns = false;
  Rng rng(4);
  int solved = 0, postures = 0;
  for (const Grasp& grasp : some_grasps(20, 5)) {
    double first_cost = 0;
    for (int home = 0; home < 6; ++home) {
      VectorXd stands(6);
      for (int j = 0; j < 6; ++j) stands[j] = rng.uniform(problem.group.lower()[j], problem.group.upper()[j]);
      problem.group = problem.group.with_reference(problem.group.full_values(stands));
      std::vector<VectorXd> nearest;
      VectorXd last = stands;
      double step = 0;
      for (const Pose& T : problem.T_world_object) {
        const std::vector<VectorXd> all = solve_ik_branches(problem.group, T * grasp.T_object_hand).solutions;
        if (all.empty()) break;
        const auto best = std::min_element(all.begin(), all.end(), [&](const VectorXd& a, const VectorXd& b) {
          return (a - last).norm() < (b - last).norm();
        });
        if (!nearest.empty()) step = std::max(step, (*best - last).cwiseAbs().maxCoeff());
        nearest.push_back(*best);
        last = *best;
      }
      const ObjectPathResult found = ObjectPathEvaluator(problem, single).evaluate(grasp);
      if (nearest.size() < problem.T_world_object.size() || step > single.max_joint_step) {
        EXPECT_EQ(found.outcome, Outcome::not_found);
        continue;
      }
      if (found.outcome != Outcome::solved) continue;  // collides with itself, or leaves the path
      ++solved;
      for (std::size_t i = 0; i < nearest.size(); ++i) EXPECT_LT((found.path.waypoints[i] - nearest[i]).norm(), 1e-6);
      if (first_cost == 0) first_cost = found.cost;
      postures += std::abs(found.cost - first_cost) > 1e-6;
    }
  }
  EXPECT_GT(solved, 20);
  EXPECT_GT(postures, 5);  // where it stands matters
}

TEST(ObjectPath, TellsJumpsFromReach) {
  ObjectPathProblem problem = arc(2, false);
  problem.T_world_object[1] = pose_from_xyz_rpy({-0.3, 0.4, 0.5}, {0, 0, 2.2});  // far away in one step
  int reached = 0;
  for (const Grasp& grasp : some_grasps(40, 5)) {
    const ObjectPathResult found = follow_object_path(problem, grasp);
    EXPECT_EQ(found.outcome, Outcome::not_found);
    if (found.violations == std::vector<int>{0, 0}) {
      ++reached;
      EXPECT_EQ(found.violation, 1);
    }
  }
  EXPECT_GT(reached, 0);
  problem.T_world_object[1].translation() = Vector3d(3, 0, 0);
  const ObjectPathResult far = follow_object_path(problem, grasp_at(2, 0.1, 0));
  EXPECT_EQ(far.violations[1], 2);
  EXPECT_GE(far.violation, 2);
}

TEST(ObjectPath, OneEvaluatorAnswersAsManyDo) {
  const ObjectPathProblem problem = arc(6);
  ObjectPathEvaluator shared(problem);
  std::vector<Grasp> grasps = some_grasps(30, 5);
  grasps.insert(grasps.end(), grasps.rbegin(), grasps.rend());
  for (const Grasp& grasp : grasps) {
    const ObjectPathResult a = shared.evaluate(grasp), b = ObjectPathEvaluator(problem).evaluate(grasp);
    EXPECT_EQ(a.cost, b.cost);
    EXPECT_EQ(a.violations, b.violations);
  }
}

/// Of each grasp the pose that bends it most, by itself; a limit between two of those tells them apart.
TEST(ObjectPath, LimitsOfSagAndStressAreThoseOfTheFrame) {
  ObjectPathProblem problem = arc(6, false);
  const ObjectPathProblem free = problem;
  ObjectPathEvaluator plain(free);
  for (BeamMember& member : problem.frame->members) member.material.stress_limit = 8e6;
  ObjectPathOptions options;
  options.max_sag = 1.5e-3;
  ObjectPathEvaluator limited(problem, options);
  int good = 0, bent = 0, stressed = 0;
  for (const Grasp& grasp : some_grasps(60, 5)) {
    const ObjectPathResult before = plain.evaluate(grasp), after = limited.evaluate(grasp);
    const SupportedFrame held(*problem.frame, {beam_support(grasp)});
    std::vector<int> over;
    for (int i = 0; i < 6; ++i) {
      const BeamState state = held.state(gravity_in_object(problem.T_world_object[i]));
      const bool sags = state.displacement.value > options.max_sag, yields = state.stress->value > 8e6;
      if (sags || yields) over.push_back(i);
      bent += sags;
      stressed += yields;
    }
    EXPECT_EQ(after.overloaded, over);
    EXPECT_EQ(after.violations, before.violations);
    EXPECT_EQ(after.outcome == Outcome::solved, before.outcome == Outcome::solved && over.empty());
    if (!over.empty()) {
      EXPECT_GE(after.violation, static_cast<int>(over.size()));
    } else if (after.outcome == Outcome::solved) {
      EXPECT_NEAR(after.cost, before.cost, 1e-12 * before.cost);
      ++good;
    }
  }
  EXPECT_GT(good, 0);
  EXPECT_GT(bent, 0);
  EXPECT_GT(stressed, 0);
}

TEST(ObjectPath, RefusesBasesThatCannotGoSideways) {
  const test::PumaArm driving(2.6, BaseKind::diff_drive), gliding(2.6, BaseKind::omni);
  ObjectPathProblem problem = arc(3, false);
  problem.group = driving.group();
  try {
    follow_object_path(problem, grasp_at(0, 0.1, 0));
    FAIL() << "a diff_drive base was taken";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("diff_drive"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("group"), std::string::npos) << error.what();
  }
  problem.group = driving.robot().chain("l0", "l6");  // the arm alone stands still
  EXPECT_NO_THROW(follow_object_path(problem, grasp_at(0, 0.1, 0)));
  problem.group = gliding.group();
  EXPECT_NO_THROW(follow_object_path(problem, grasp_at(0, 0.1, 0)));
}

TEST(ObjectPath, RefusesBadProblems) {
  ObjectPathProblem problem = arc(3);
  problem.T_world_object.resize(1);
  EXPECT_THROW(follow_object_path(problem, grasp_at(0, 0.1, 0)), InvalidInput);
  problem = arc(3);
  problem.object.clear();
  EXPECT_THROW(follow_object_path(problem, grasp_at(0, 0.1, 0)), InvalidInput);
  problem = arc(3);
  problem.world.add("pipe", Sphere{0.1}, Pose::Identity());
  EXPECT_THROW(follow_object_path(problem, grasp_at(0, 0.1, 0)), InvalidInput);
  problem = arc(3);
  EXPECT_THROW(follow_object_path(problem, Grasp{}), InvalidInput);  // it bends, but where is it held?
  problem.frame.reset();
  EXPECT_NO_THROW(follow_object_path(problem, Grasp{}));
  ObjectPathOptions options;
  options.motion_weight = -1;
  EXPECT_THROW(follow_object_path(problem, grasp_at(0, 0.1, 0), options), InvalidInput);
  options = {};
  options.max_sag = -1e-3;
  EXPECT_THROW(follow_object_path(problem, grasp_at(0, 0.1, 0), options), InvalidInput);
  options.max_sag = 1e-3;  // and the problem says nothing of how it bends
  EXPECT_THROW(follow_object_path(problem, grasp_at(0, 0.1, 0), options), InvalidInput);
  options = {};
  options.base_spacing = 0;
  EXPECT_THROW(follow_object_path(problem, grasp_at(0, 0.1, 0), options), InvalidInput);
  options = {};
  options.base_headings = 0;
  EXPECT_THROW(follow_object_path(problem, grasp_at(0, 0.1, 0), options), InvalidInput);
  options = {};
  options.deflection_scale = 0;
  EXPECT_THROW(follow_object_path(problem, grasp_at(0, 0.1, 0), options), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
