#include "mmgrasp/task/drive_by.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <thread>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/fetchlike.hpp"
#include "support/fetchlike_drive.hpp"
#include "support/vec.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;
using test::grasp_at;
using test::vec;
constexpr double kInf = std::numeric_limits<double>::infinity();

const VectorXd &kStart = test::kDriveStart, &kGoal = test::kDriveGoal;

/// What a solved plan promises, looked at from outside.
void expect_sound(const DriveByResult& r, const std::vector<DriveByTask>& tasks) {
  ASSERT_EQ(r.outcome, Outcome::solved) << r.report;
  ASSERT_EQ(r.events.size(), tasks.size());
  for (const Violation& v : r.violations) EXPECT_TRUE(v.kept()) << v.kind << " " << v.value;
  const WholeBodyTrajectory& t = *r.trajectory;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const Pose T = t.group().fk(t.positions()[r.events[i].waypoint]);
    const Pose& target = tasks[i].candidates[r.events[i].candidate];
    EXPECT_LT((T.translation() - target.translation()).norm(), 1e-6);
    EXPECT_LT(rotation_distance(T, target), 1e-6);
    if (i > 0) {
      EXPECT_GT(r.events[i].time, r.events[i - 1].time);
    }
  }
  const std::vector<VectorXd> rolled = t.rolled_out(100);
  EXPECT_LT((rolled.back() - t.positions().back()).cwiseAbs().maxCoeff(), 1e-6);
}

}  // namespace

TEST(DriveBy, TakesThePartOfP1OnTheWay) {
  const JointGroup group = test::fetchlike_whole_body();
  for (const double y : {-2.0, 2.0}) {
    const std::vector<DriveByTask> tasks{grasp_at(pose_from_xyz_rpy({5.5, y, 0.5}, {1, 1, 0}))};
    const DriveByResult r = plan_drive_by(group, World(), kStart, tasks, {kGoal, kGoal});
    expect_sound(r, tasks);
    EXPECT_GT(r.events[0].base_speed, 0.1);
    // 10 m at 0.6 m/s, speeding up and slowing down at 0.5 m/s^2, is the least that limits allow.
    EXPECT_GT(r.duration(), 10 / 0.6 + 0.6 / 0.5);
    EXPECT_LT(r.duration(), 20.13);
  }
}

TEST(DriveBy, RepeatsItselfAtAnyNumberOfThreads) {
  const JointGroup group = test::fetchlike_whole_body();
  const std::vector<DriveByTask> tasks{grasp_at(pose_from_xyz_rpy({4, 1, 0.8}, {0, 0.3, 1}))};
  DriveByOptions options;
  const DriveByResult a = plan_drive_by(group, World(), kStart, tasks, {kGoal, kGoal}, options);
  options.threads = 3;
  const DriveByResult b = plan_drive_by(group, World(), kStart, tasks, {kGoal, kGoal}, options);
  ASSERT_EQ(a.outcome, Outcome::solved);
  EXPECT_EQ(a.trajectory->to_csv(), b.trajectory->to_csv());
}

TEST(DriveBy, PassesSeveralTasksInOneGo) {
  const JointGroup group = test::fetchlike_whole_body();
  std::vector<DriveByTask> tasks;
  for (int i = 0; i < 3; ++i)
    tasks.push_back(
        grasp_at(pose_from_xyz_rpy({2.5 + 2.5 * i, i % 2 ? 0.9 : -0.9, 0.7}, {0, 0.2, i % 2 ? 1.2 : -1.2})));
  DriveByOptions options;
  options.waypoints = 50;
  const DriveByResult r = plan_drive_by(group, World(), kStart, tasks, {kGoal, kGoal}, options);
  expect_sound(r, tasks);
}

TEST(DriveBy, KeepsToolSpeedAndDwell) {
  const JointGroup group = test::fetchlike_whole_body();
  std::vector<DriveByTask> tasks{grasp_at(pose_from_xyz_rpy({5, -1, 0.7}, {0, 0.2, -1}))};
  tasks[0].max_tool_speed = 0.05;
  const DriveByResult r = plan_drive_by(group, World(), kStart, tasks, {kGoal, kGoal});
  expect_sound(r, tasks);
  EXPECT_LE(r.events[0].tool_speed, 0.05 + 1e-6);
}

TEST(DriveBy, HoldsTheToolStillWhileTheBaseDrivesOn) {
  const JointGroup group = test::fetchlike_whole_body();
  std::vector<DriveByTask> tasks{grasp_at(pose_from_xyz_rpy({5, -1, 0.7}, {0, 0.2, -1}))};
  tasks[0].dwell = 0.8;
  const DriveByResult r = plan_drive_by(group, World(), kStart, tasks, {kGoal, kGoal});
  expect_sound(r, tasks);
  const std::size_t from = r.events[0].waypoint;
  std::size_t to = from;
  const auto& times = r.trajectory->times();
  while (to + 1 < times.size() && times[to] - times[from] < 0.8 - 1e-6) ++to;
  EXPECT_GT(to, from);
  for (std::size_t i = from; i <= to; ++i) {
    const Pose T = group.fk(r.trajectory->positions()[i]);
    EXPECT_LT((T.translation() - tasks[0].candidates[0].translation()).norm(), 1e-6);
    EXPECT_LT(rotation_distance(T, tasks[0].candidates[0]), 1e-6);
  }
  EXPECT_GT((r.trajectory->positions()[to] - r.trajectory->positions()[from]).head<2>().norm(), 0.05);
}

TEST(DriveBy, ChoosesAmongCandidates) {
  const JointGroup group = test::fetchlike_whole_body();
  DriveByTask task;
  task.candidates = {pose_from_xyz_rpy({5, -1, 9}, {0, 0, 0}), pose_from_xyz_rpy({5, -1, 0.7}, {0, 0.2, -1})};
  const DriveByResult r = plan_drive_by(group, World(), kStart, {task}, {kGoal, kGoal});
  expect_sound(r, {task});
  EXPECT_EQ(r.events[0].candidate, 1);
}

TEST(DriveBy, LeavesFreeAxesFree) {
  const JointGroup group = test::fetchlike_whole_body();
  DriveByTask task = grasp_at(pose_from_xyz_rpy({5, -1, 0.7}, {2.8, 0.2, -1}));
  const DriveByResult fixed = plan_drive_by(group, World(), kStart, {task}, {kGoal, kGoal});
  task.free_axes[3] = true;  // roll about the approach axis
  const DriveByResult r = plan_drive_by(group, World(), kStart, {task}, {kGoal, kGoal});
  ASSERT_EQ(fixed.outcome, Outcome::solved) << fixed.report;
  ASSERT_EQ(r.outcome, Outcome::solved) << r.report;
  const Pose T = group.fk(r.trajectory->positions()[r.events[0].waypoint]);
  EXPECT_LT((T.translation() - task.candidates[0].translation()).norm(), 1e-6);
  EXPECT_NEAR(T.linear().col(0).dot(task.candidates[0].linear().col(0)), 1, 1e-6);
}

TEST(DriveBy, GoalMayLeaveTheArmFree) {
  const JointGroup group = test::fetchlike_whole_body();
  DriveByGoal goal{kGoal, kGoal};
  goal.lower.tail(7).setConstant(-kInf);
  goal.upper.tail(7).setConstant(kInf);
  const std::vector<DriveByTask> tasks{grasp_at(pose_from_xyz_rpy({4, 1, 0.8}, {0, 0.3, 1}))};
  const DriveByResult r = plan_drive_by(group, World(), kStart, tasks, goal);
  expect_sound(r, tasks);
  EXPECT_LT((r.trajectory->positions().back().head(3) - kGoal.head(3)).norm(), 1e-6);
}

// A pillar leaves one way round, which ends a full turn from the goal's number.
TEST(DriveBy, AnIntervalOfTheGoalIsReachedAsItStands) {
  const Robot robot = Robot::from_strings(
      "<robot name='turntable'><link name='root'/><link name='arm'><collision><origin xyz='0.35 0 0'/><geometry>"
      "<box size='0.5 0.05 0.05'/></geometry></collision></link><link name='tip'/>"
      "<joint name='turn' type='continuous'><parent link='root'/><child link='arm'/><axis xyz='0 0 1'/>"
      "<limit velocity='1' effort='1'/></joint>"
      "<joint name='end' type='fixed'><parent link='arm'/><child link='tip'/><origin xyz='0.6 0 0'/></joint></robot>");
  World world;
  world.add("pillar", Box{{0.1, 0.1, 0.5}}, pose_from_xyz_rpy({-0.45, 0, 0}, {0, 0, 0}));
  const std::vector<DriveByTask> tasks{grasp_at(pose_from_xyz_rpy({0.6, 0, 0}, {0, 0, 0}))};
  const double from = 2.5, to = 2 * 3.14159265358979 - 2.5;
  const auto planned = [&](double slack) {
    return plan_drive_by(robot.chain("root", "tip"), world, vec({from}), tasks, {vec({to - slack}), vec({to + slack})});
  };
  const DriveByResult fixed = planned(0);
  ASSERT_EQ(fixed.outcome, Outcome::solved) << fixed.report;
  EXPECT_NEAR(fixed.trajectory->positions().back()[0], -2.5, 1e-6);
  EXPECT_FALSE(planned(1e-7).usable());  // there is no such motion
}

TEST(DriveBy, KeepsClearOfWhatStandsInTheWayOfTheArm) {
  const JointGroup group = test::fetchlike_whole_body();
  std::vector<DriveByTask> tasks{grasp_at(pose_from_xyz_rpy({5, -1, 0.75}, {0, 0.2, -1}))};
  const DriveByResult blind = plan_drive_by(group, World(), kStart, tasks, {kGoal, kGoal});
  ASSERT_EQ(blind.outcome, Outcome::solved) << blind.report;
  // A ball right where the hand was 1.5 s before the grasp.
  World world;
  Pose T = Pose::Identity();
  T.translation() = group.fk(blind.trajectory->at(blind.events[0].time - 1.5)).translation();
  world.add("ball", Sphere{0.06}, T);
  CollisionChecker checker(group, world);
  const auto hits = [&](const WholeBodyTrajectory& t) {
    int count = 0;
    for (const VectorXd& q : t.sampled(39).positions) count += checker.first_contact(q).has_value();
    return count;
  };
  EXPECT_GT(hits(*blind.trajectory), 0);
  const DriveByResult r = plan_drive_by(group, world, kStart, tasks, {kGoal, kGoal});
  expect_sound(r, tasks);
  EXPECT_EQ(hits(*r.trajectory), 0);
}

TEST(DriveBy, DrivesAroundAWall) {
  const JointGroup group = test::fetchlike_whole_body();
  World world;
  world.add("wall", Box{{0.1, 1.0, 1.5}}, pose_from_xyz_rpy({7.5, 0.4, 0.75}, {0, 0, 0}));
  std::vector<DriveByTask> tasks{grasp_at(pose_from_xyz_rpy({5, -1, 0.75}, {0, 0.2, -1}))};
  const DriveByResult r = plan_drive_by(group, world, kStart, tasks, {kGoal, kGoal});
  expect_sound(r, tasks);
  CollisionChecker checker(group, world);
  for (const VectorXd& q : r.trajectory->sampled(39).positions) EXPECT_FALSE(checker.first_contact(q).has_value());
}

TEST(DriveBy, PassesThroughAFurnishedRoom) {
  // Walls from either side beyond the middle of the lane, walls along it, a table below the grasp or a board above it.
  const JointGroup group = test::fetchlike_whole_body();
  for (const double pitch : {0.4, -0.5}) {
    World world;
    const auto block = [&](const char* name, const Eigen::Vector3d& size, const Eigen::Vector3d& centre) {
      world.add(name, Box{size}, pose_from_xyz_rpy(centre, {0, 0, 0}));
    };
    block("wall 0", {0.1, 2.8, 1.5}, {2.4, -1.1, 0.75});
    block("wall 1", {0.1, 2.8, 1.5}, {7.6, 1.1, 0.75});
    block("side wall 0", {13, 0.1, 1.5}, {5, -4, 0.75});
    block("side wall 1", {13, 0.1, 1.5}, {5, 4, 0.75});
    if (pitch > 0)
      block("table", {0.6, 0.5, 0.6}, {5, -1.2, 0.3});
    else
      block("board", {0.6, 0.5, 0.04}, {5, -1.2, 0.86});
    const std::vector<DriveByTask> tasks{grasp_at(pose_from_xyz_rpy({5, -1.2, 0.72}, {0, pitch, -0.8}))};
    const DriveByResult r = plan_drive_by(group, world, kStart, tasks, {kGoal, kGoal});
    expect_sound(r, tasks);
    CollisionChecker checker(group, world);
    for (const VectorXd& q : r.trajectory->sampled(39).positions) EXPECT_FALSE(checker.first_contact(q).has_value());
  }
}

TEST(DriveBy, CarriesThePartItTook) {
  const JointGroup group = test::fetchlike_whole_body();
  World world;
  const Pose T_grasp = pose_from_xyz_rpy({5, -1, 0.75}, {0, 0.2, -1});
  world.add("part", Box{{0.04, 0.04, 0.3}}, T_grasp * pose_from_xyz_rpy({0.16, 0, 0}, {0, 0, 0}));
  std::vector<DriveByTask> tasks{grasp_at(T_grasp)};
  tasks[0].object = "part";
  const DriveByResult r = plan_drive_by(group, world, kStart, tasks, {kGoal, kGoal});
  expect_sound(r, tasks);
  World held = world;
  held.attach("part", "gripper_link", T_grasp.inverse() * world.objects().at("part").T_world_object);
  CollisionChecker checker(group, held);
  const auto& t = *r.trajectory;
  const double from = t.times()[r.events[0].waypoint];
  for (int i = 0; i <= 400; ++i)
    EXPECT_FALSE(checker.first_contact(t.at(from + (t.duration() - from) * i / 400)).has_value()) << i;
}

/// A can on a table, at rest on it or a millimetre above: neither arm nor open hand meets it before it is taken, and
/// table, can and hand keep clear of each other afterwards, at times between all waypoints.
TEST(DriveBy, NeverGoesThroughThePartItTakes) {
  const JointGroup closed = test::fetchlike_whole_body();
  const Robot& robot = closed.robot();
  const JointGroup group = closed.with_reference(robot.values(
      {{"torso_lift_joint", 0.2}, {"left_gripper_finger_joint", 0.05}, {"right_gripper_finger_joint", 0.05}}));
  Rng rng(5);
  int solved = 0;
  for (int i = 0; i < 4; ++i) {
    const double side = i % 2 ? -1 : 1, height = 0.14, gap = i < 2 ? 0 : 1e-3;
    const double x = rng.uniform(2, 8), y = side * rng.uniform(0.7, 1.3), z = rng.uniform(0.6, 0.9);
    const Pose T_can = pose_from_xyz_rpy({x, y, z}, {0, 0, side * rng.uniform(0.2, 1.3)});
    World world;
    world.add("table", Box{{0.5, 0.5, z - height / 2}}, pose_from_xyz_rpy({x, y, (z - height / 2) / 2}, {0, 0, 0}));
    world.add("can", Cylinder{0.025, height}, Eigen::Translation3d(0, 0, gap) * T_can);
    DriveByTask task = grasp_at(T_can * Eigen::Translation3d(-0.05, 0, 0));
    task.object = "can";
    task.dwell = i % 2 ? 0 : 0.5;
    const DriveByResult r = plan_drive_by(group, world, kStart, {task}, {kGoal, kGoal});
    if (r.outcome != Outcome::solved) continue;
    ++solved;
    expect_sound(r, {task});
    const WholeBodyTrajectory& t = *r.trajectory;
    const double taken = r.events[0].time, held = r.events[0].attach_time;
    CollisionChecker before(group, world);
    World carried = world;
    const VectorXd q = t.at(held);
    carried.attach("can", "gripper_link",
                   group.fk(q).inverse() * (Eigen::Translation3d(0, 0, std::max(gap, 1e-3)) * T_can));
    CollisionChecker after(group, carried);
    for (int k = 0; k <= 1000; ++k) {
      const VectorXd ahead = t.at(taken * k / 1000), later = t.at(held + (t.duration() - held) * k / 1000);
      EXPECT_FALSE(before.first_contact(ahead).has_value()) << i << ": " << describe(*before.first_contact(ahead));
      EXPECT_FALSE(after.first_contact(later).has_value())
          << i << " " << k << " " << after.distance(later).value << ": " << describe(*after.first_contact(later));
    }
  }
  EXPECT_GE(solved, 3);
}

TEST(DriveBy, SaysWhenTheHandTouchesThePartAtTheTask) {
  const JointGroup closed = test::fetchlike_whole_body();  // Fingers together: they would have to be inside the can.
  const Pose T_can = pose_from_xyz_rpy({5, -1, 0.75}, {0, 0, -1});
  World world;
  world.add("can", Cylinder{0.025, 0.14}, T_can);
  DriveByTask task = grasp_at(T_can);
  task.object = "can";
  const DriveByResult r = plan_drive_by(closed, world, kStart, {task}, {kGoal, kGoal});
  EXPECT_FALSE(r.usable());
  // Whatever else touches in some of them, this does in all.
  EXPECT_TRUE(std::regex_search(r.report, std::regex("; in (\\d+) of \\1 that do '\\w+' touches 'can'"))) << r.report;
}

/// The base drives on while the tool's pose is kept: also between waypoints, for as long as it dwells.
TEST(DriveBy, ADwellingToolStaysWhereItIs) {
  const JointGroup group = test::fetchlike_whole_body();
  for (const double dwell : {0.6, 1.5, 2.5}) {
    DriveByTask task = grasp_at(pose_from_xyz_rpy({5, -1, 0.75}, {0, 0.2, -1}));
    task.dwell = dwell;
    DriveByOptions options;
    options.waypoints = 45;
    const DriveByResult r = plan_drive_by(group, World(), kStart, {task}, {kGoal, kGoal}, options);
    expect_sound(r, {task});
    const WholeBodyTrajectory& t = *r.trajectory;
    const double from = r.events[0].time, to = from + dwell;
    for (int k = 0; k <= 500; ++k) {
      const Pose off = task.candidates[0].inverse() * group.fk(t.at(from + (to - from) * k / 500));
      EXPECT_LT(off.translation().norm(), 2e-3) << dwell;
      EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), 0.02) << dwell;
    }
  }
}

TEST(DriveBy, ReturnsTheFastestOfThePlansOfEachCandidate) {
  const JointGroup group = test::fetchlike_whole_body();
  const std::vector<Pose> poses{pose_from_xyz_rpy({5, -1.6, 0.5}, {0, 0.2, -2.8}),
                                pose_from_xyz_rpy({5, -1.6, 0.5}, {0, 0.2, 2.4}),
                                pose_from_xyz_rpy({5, -1.6, 0.5}, {0, 0.2, -1})};
  double best = kInf;
  int fastest = -1, solved = 0;
  for (int c = 0; c < 3; ++c) {
    const DriveByResult alone = plan_drive_by(group, World(), kStart, {grasp_at(poses[c])}, {kGoal, kGoal});
    if (!alone.usable()) continue;
    ++solved;
    if (alone.duration() >= best) continue;
    best = alone.duration();
    fastest = c;
  }
  ASSERT_GE(solved, 2);
  DriveByTask any;
  any.candidates = poses;
  const DriveByResult r = plan_drive_by(group, World(), kStart, {any}, {kGoal, kGoal});
  expect_sound(r, {any});
  EXPECT_EQ(r.duration(), best);
  EXPECT_EQ(r.events[0].candidate, fastest);
  EXPECT_EQ(r.grasp_assignments, 3);
}

TEST(DriveBy, LeavesOutCandidatesThatCannotBeFaster) {
  const JointGroup group = test::fetchlike_whole_body();
  DriveByTask task;
  // 12 m aside and back takes at least (24 - two reaches) / 0.6 m/s.
  task.candidates = {pose_from_xyz_rpy({5, -12, 0.7}, {0, 0.2, -1}), pose_from_xyz_rpy({5, -1, 0.7}, {0, 0.2, -1})};
  const DriveByResult r = plan_drive_by(group, World(), kStart, {task}, {kGoal, kGoal});
  expect_sound(r, {task});
  EXPECT_EQ(r.events[0].candidate, 1);
  EXPECT_EQ(r.grasp_assignments, 1);
  EXPECT_NE(r.report.find("left out"), std::string::npos) << r.report;
  const DriveByResult aside = plan_drive_by(group, World(), kStart, {grasp_at(task.candidates[0])}, {kGoal, kGoal});
  ASSERT_TRUE(aside.usable()) << aside.report;
  EXPECT_GT(aside.duration(), r.duration());
}

TEST(DriveBy, ClockDoesNotDecideWhenItDoesNotEndThePlan) {
  const JointGroup group = test::fetchlike_whole_body();
  const std::vector<DriveByTask> tasks{grasp_at(pose_from_xyz_rpy({4, 1, 0.8}, {0, 0.3, 1}))};
  DriveByOptions few;
  few.trajectory.max_iterations = 3;
  few.iterations = 10;
  const DriveByResult r = plan_drive_by(group, World(), kStart, tasks, {kGoal, kGoal}, few);
  EXPECT_EQ(r.outcome, Outcome::timeout) << r.report;
  EXPECT_EQ(r.iterations, 12);  // no attempt begins after ten
  EXPECT_EQ(r.solves, 4);
}

TEST(DriveBy, ReportsWhatCannotBe) {
  const JointGroup group = test::fetchlike_whole_body();
  const std::vector<DriveByTask> tasks{grasp_at(pose_from_xyz_rpy({5, 0, 4}, {0, 0, 0}))};
  const DriveByResult r = plan_drive_by(group, World(), kStart, tasks, {kGoal, kGoal});
  EXPECT_EQ(r.outcome, Outcome::not_found);
  EXPECT_NE(r.report.find("task 0"), std::string::npos) << r.report;
  EXPECT_FALSE(r.trajectory);
}

TEST(DriveBy, RefusesWhatMakesNoSense) {
  const JointGroup group = test::fetchlike_whole_body();
  const std::vector<DriveByTask> tasks{grasp_at(pose_from_xyz_rpy({4, 1, 0.8}, {0, 0.3, 1}))};
  const auto plan = [&](const VectorXd& start, const std::vector<DriveByTask>& t, const DriveByGoal& goal,
                        const DriveByOptions& o = {}) { plan_drive_by(group, World(), start, t, goal, o); };
  VectorXd outside = kStart;
  outside[4] = 3;  // shoulder lift ends at 1.518
  EXPECT_THROW(plan(outside, tasks, {kGoal, kGoal}), InvalidInput);
  EXPECT_THROW(plan(kStart.head(9), tasks, {kGoal, kGoal}), InvalidInput);
  VectorXd nan = kStart;
  nan[0] = std::nan("");
  EXPECT_THROW(plan(nan, tasks, {kGoal, kGoal}), InvalidInput);
  VectorXd above = kGoal;
  above[0] += 1;
  EXPECT_THROW(plan(kStart, tasks, {above, kGoal}), InvalidInput);
  EXPECT_THROW(plan(kStart, {DriveByTask()}, {kGoal, kGoal}), InvalidInput);
  DriveByOptions few;
  few.waypoints = 3;
  EXPECT_THROW(plan(kStart, tasks, {kGoal, kGoal}, few), InvalidInput);
}

TEST(DriveBy, IsHeardWhileItSolves) {
  const JointGroup group = test::fetchlike_whole_body();
  std::vector<double> heard;
  Monitor monitor;
  monitor.progress = [&](const std::string& stage, double fraction) {
    if (stage == "grasp_assignments") heard.push_back(fraction);
  };
  DriveByOptions options;
  options.waypoints = 45;
  options.collisions = false;
  const std::vector<DriveByTask> tasks{grasp_at(pose_from_xyz_rpy({5, -1, 0.75}, {0, 0, -0.8}))};
  const DriveByResult r = plan_drive_by(group, World(), kStart, tasks, {kGoal, kGoal}, options, monitor);
  ASSERT_EQ(r.outcome, Outcome::solved) << r.report;
  EXPECT_GE(static_cast<int>(heard.size()), r.iterations) << "once an iteration";
  EXPECT_TRUE(std::is_sorted(heard.begin(), heard.end()));
  EXPECT_LE(heard.back(), 1);
}

TEST(DriveBy, EndsWhenTold) {
  const JointGroup group = test::fetchlike_whole_body();
  const std::vector<DriveByTask> tasks{grasp_at(pose_from_xyz_rpy({4, 1, 0.8}, {0, 0.3, 1}))};
  Monitor monitor;
  monitor.stop.stop();
  EXPECT_EQ(plan_drive_by(group, World(), kStart, tasks, {kGoal, kGoal}, {}, monitor).outcome, Outcome::stopped);
}

}  // namespace mmgrasp
