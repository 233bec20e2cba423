#include "mmgrasp/task/pick.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "mmgrasp/core/error.hpp"
#include "support/small_storeroom.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp {
namespace {

const ReachDatabase& database() {
  static const ReachDatabase shared = test::small_database(test::small_storeroom());
  return shared;
}

constexpr double kTableTop = 0.44;

/// A pin on the table, in no tray, to be moved aside by 0.15 m; the robot stands in front of it.
PickProblem pin_on_table() {
  const PartSupplyProblem room = test::small_storeroom();
  PickProblem problem{room.arm.at(pose_from_planar(Eigen::Vector3d(0.35, -0.1, 0))),
                      room.gripper,
                      room.world,
                      "pin",
                      test::grasps_from_above(0.03),
                      room.home,
                      {test::at(0.88, 0.05, 0.475)},
                      {}};
  problem.world.add("pin", Cylinder{0.015, 0.06}, test::at(0.88, -0.1, 0.471));
  problem.options.approach_distance = 0.05;
  problem.options.lift_height = 0.08;
  return problem;
}

double distance(const Pose& a, const Pose& b) {
  return (a.translation() - b.translation()).norm() + rotation_distance(a, b);
}

TEST(Pick, AnObjectInNoTrayIsGraspedLiftedAndPutDown) {
  const PickProblem problem = pin_on_table();
  const Pick pick = plan_object_pick(problem, database());
  ASSERT_EQ(pick.outcome, Outcome::solved) << pick.failed_at << ", " << pick.rejections.summary();
  EXPECT_EQ(pick.part, PartRef{});
  EXPECT_EQ(pick.stop, -1);
  ASSERT_EQ(pick.motions.size(), 5u);
  const Pose T_world_pin = problem.world.objects().at("pin").T_world_object;
  const auto& approach = pick.motions[1].trajectory.positions;
  const auto& lift = pick.motions[2].trajectory.positions;
  const auto& transfer = pick.motions[3].trajectory.positions;
  EXPECT_EQ(pick.motions[0].trajectory.positions.front(), problem.home);
  EXPECT_LT(distance(problem.arm.fk(approach.back()), T_world_pin * problem.grasps[pick.grasp].T_object_hand), 2e-3);
  const Pose T_hand_pin = problem.arm.fk(lift.front()).inverse() * T_world_pin;
  const Pose T_world_lifted = problem.arm.fk(lift.back()) * T_hand_pin;
  EXPECT_LT(distance(T_world_lifted, Pose(Eigen::Translation3d(0, 0, 0.08) * T_world_pin)), 2e-3);
  EXPECT_LT(distance(problem.arm.fk(transfer.back()) * T_hand_pin, problem.places[0]), 2e-3);
  const Eigen::VectorXd turned = pick.motions[4].trajectory.positions.back() - problem.home;
  EXPECT_LT(turned.head<5>().norm(), 1e-6);  // the last joint turns without limits
  for (std::size_t i = 0; i < pick.motions.size(); ++i) EXPECT_EQ(pick.motions[i].attached, i == 2 || i == 3);
}

TEST(Pick, WithoutAPlaceTheObjectStaysInTheHand) {
  PickProblem problem = pin_on_table();
  const Pick whole = plan_object_pick(problem, database());
  problem.places.clear();
  const Pick pick = plan_object_pick(problem, database());
  ASSERT_EQ(pick.outcome, Outcome::solved);
  ASSERT_EQ(pick.motions.size(), 3u);
  EXPECT_TRUE(pick.motions.back().attached);
  EXPECT_EQ(pick.motions[2].kind, MotionKind::lift);
  EXPECT_LE(pick.grasp, whole.grasp);  // less is asked of a grasp
}

/// What rests on something may leave it; what touches a wall beside it would slide along the wall.
TEST(Pick, WhatRestsMayLeaveButNotAlongAWall) {
  PickProblem problem = pin_on_table();
  problem.world.move("pin", test::at(0.88, -0.1, kTableTop + 0.03));
  const Pick resting = plan_object_pick(problem, database());
  EXPECT_EQ(resting.outcome, Outcome::solved) << resting.failed_at << ", " << resting.rejections.summary();
  problem.world.add("slat", Box{{0.1, 0.03, 0.02}}, test::at(0.88 + 0.015 + 0.05, -0.1, kTableTop + 0.01));
  const Pick beside = plan_object_pick(problem, database());
  EXPECT_EQ(beside.outcome, Outcome::not_found);
  EXPECT_EQ(beside.failed_at, "close");
  problem.world.move("slat", test::at(0.88 + 0.015 + 0.05 + 1e-5, -0.1, kTableTop + 0.01));
  EXPECT_EQ(plan_object_pick(problem, database()).outcome, Outcome::solved);
}

/// Whenever the stop comes, at the last grasp or amid the timing of the motions, too: never "not found".
TEST(Pick, AStopIsToldFromASearchThatFails) {
  PickProblem problem = pin_on_table();
  const auto begun = std::chrono::steady_clock::now();
  const Pick whole = plan_object_pick(problem, database());
  const auto duration = std::chrono::steady_clock::now() - begun;
  ASSERT_EQ(whole.outcome, Outcome::solved);
  problem.grasps = {problem.grasps[whole.grasp]};
  constexpr int kMoments = 40;
  for (int i = 0; i < kMoments; ++i) {
    Monitor monitor;
    std::thread other([&] {
      std::this_thread::sleep_for(duration * i / kMoments);
      monitor.stop.stop();
    });
    const Pick pick = plan_object_pick(problem, database(), monitor);
    other.join();
    EXPECT_TRUE(pick.outcome == Outcome::solved || pick.outcome == Outcome::stopped) << pick.failed_at;
    EXPECT_EQ(pick.motions.empty(), pick.outcome == Outcome::stopped);
  }
}

TEST(Pick, AnUnreachablePlaceIsNamed) {
  PickProblem problem = pin_on_table();
  problem.places = {test::at(3, 3, 0.5)};
  const Pick pick = plan_object_pick(problem, database());
  EXPECT_EQ(pick.outcome, Outcome::not_found);
  EXPECT_EQ(pick.failed_at, "release");
  EXPECT_TRUE(pick.motions.empty());
}

TEST(Pick, BadInputIsRefused) {
  PickProblem problem = pin_on_table();
  problem.object = "mug";
  EXPECT_THROW(plan_object_pick(problem, database()), InvalidInput);
  problem = pin_on_table();
  problem.grasps[1].opening = 0.2;
  EXPECT_THROW(plan_object_pick(problem, database()), InvalidInput);
  problem = pin_on_table();
  problem.options.lift_height = 0;
  EXPECT_THROW(plan_object_pick(problem, database()), InvalidInput);
  EXPECT_THROW(plan_pick(test::small_storeroom(), database(), {0.35, -0.1, 0}, {TrayId(2), 0}, {}), InvalidInput);
}

TEST(Pick, PartsWithFewGraspsAreTriedInAsManyPostures) {
  PartSupplyProblem room = test::small_storeroom();
  const auto with_grasps = [&](std::size_t count) {
    for (Tray& tray : room.trays)
      for (Part& part : tray.parts) part.grasps.assign(40, part.grasps.front());
    room.trays[1].parts[0].grasps.resize(count);
    return detail::ik_seeds_of_a_grasp(room);
  };
  EXPECT_EQ(with_grasps(1), 128);
  EXPECT_EQ(with_grasps(3), 43);
  EXPECT_EQ(with_grasps(40), 8);
  EXPECT_EQ(with_grasps(0), 8);  // nothing to try there
  room.options.grid.ik_seeds = 50;
  EXPECT_EQ(with_grasps(3), 50);
  EXPECT_EQ(with_grasps(1), 128);
  room.trays[1].parts[0].target = false;
  EXPECT_EQ(detail::ik_seeds_of_a_grasp(room), 50);
}

/// Trays are one caller: their picks are those of the part as an object of the scene.
TEST(Pick, APartOfATrayIsAnObjectLikeAnother) {
  const PartSupplyProblem room = test::small_storeroom(1);
  const PartRef wanted{TrayId(0), 0}, other{TrayId(1), 0};
  const Eigen::Vector3d base(0.35, -0.1, 0);
  const Pick from_tray = plan_pick(room, database(), base, wanted, {wanted, other});
  ASSERT_EQ(from_tray.outcome, Outcome::solved) << from_tray.failed_at;
  EXPECT_EQ(from_tray.part, wanted);
  const Part& part = room.trays[0].parts[0];
  PickProblem alone{
      room.arm.at(pose_from_planar(base)), room.gripper, room.world, part.name, part.grasps, room.home, {}, {}};
  for (const Tray& tray : room.trays)
    alone.world.add(tray.parts[0].name, WorldObject{tray.parts[0].shapes, tray.parts[0].T_world_part});
  alone.options = {room.options.approach_distance, room.options.lift_height, room.options.motion_time_limit,
                   detail::ik_seeds_of_a_grasp(room), room.options.seed * 1000003u};
  const Pick kept = plan_object_pick(alone, database());
  ASSERT_EQ(kept.outcome, Outcome::solved);
  ASSERT_EQ(kept.grasp, from_tray.grasp);
  EXPECT_EQ(kept.motions[1].trajectory.positions.back(), from_tray.motions[1].trajectory.positions.back());
}

}  // namespace
}  // namespace mmgrasp
