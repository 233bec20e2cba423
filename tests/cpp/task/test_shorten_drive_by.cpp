#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/task/drive_by.hpp"
#include "support/fetchlike.hpp"
#include "support/vec.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;

const double kFastest = 4 / 0.6 + 0.6 / 0.5;  // 4 m at 0.6 m/s with ramps of 0.5 m/s^2 [s]

VectorXd at(VectorXd q, double x, double y = 0, double theta = 0) {
  q.head<3>() += Eigen::Vector3d(x, y, theta);
  return q;
}

/// A stop-and-go motion of 4 m: drive ahead, stop, reach, wait, reach back, drive on. The table stands to the right of
/// the way.
struct StopAndGo {
  JointGroup group = test::fetchlike_whole_body();
  World world;
  std::vector<DriveByTask> tasks;
  KnownMotion known;
  VectorXd home, up, out;

  explicit StopAndGo(double turns = 0) {
    home = up = out = VectorXd::Zero(group.size());
    home.tail(7) = test::vec({1.32, 1.40, -0.2, 1.72, 0.0, 1.66, 0.0});
    up.tail(7) = test::vec({0.2, 0.5, -1.0, 0.5, 0.0, 0.6, 0.0});
    out.tail(7) = test::vec({-1.2, 0.3, 0.0, 0.6, 0.0, 0.6, 0.0});
    // Numbers whole turns away, as earlier motions may leave them.
    for (VectorXd* q : {&home, &up, &out}) {
      (*q)[group.size() - 1] += 2 * M_PI * turns;
      (*q)[2] = 2 * M_PI * turns;
    }
    known.times = {0};
    known.positions = {home};
    then(6, at(home, 2));
    reach_and_drive_on();
    Pose T = Pose::Identity();
    T.translation() << 2, -1.3, 0.2;
    world.add("table", Box{{1.0, 0.4, 0.4}}, T);
  }

  void then(double seconds, const VectorXd& q) {
    known.times.push_back(known.times.back() + seconds);
    known.positions.push_back(q);
  }

  void reach_and_drive_on() {
    then(1.5, at(up, 2));
    then(1.5, at(out, 2));
    DriveByTask task;
    task.candidates = {group.fk(known.positions.back())};
    task.dwell = 0.5;
    tasks = {task};
    known.task_times = {known.times.back()};
    then(task.dwell, at(out, 2));
    then(1.5, at(up, 2));
    then(1.5, at(home, 2));
    then(5.5, at(home, 4));
  }

  bool known_is_free() const {
    CollisionChecker checker(group, world);
    for (std::size_t i = 0; i + 1 < known.positions.size(); ++i)
      if (!checker.edge_is_free(known.positions[i], known.positions[i + 1])) return false;
    return true;
  }
};

/// On its way the motion waits, then goes 0.4 m round a pillar that reaches into the straight way.
StopAndGo round_a_pillar(double x, double waits, StopAndGo c = StopAndGo()) {
  const double round = 0.4;
  Pose T = Pose::Identity();
  T.translation() << x, round - 0.5, 0.5;
  c.world.add("pillar", Box{{0.2, 0.2, 1.0}}, T);
  c.known.times = {0};
  c.known.positions = {c.home};
  const double from = 0.3, turn = std::atan2(round, x - 0.3 - from);
  c.then(1, at(c.home, from));
  c.then(waits, at(c.home, from));
  c.then(1, at(c.home, from, 0, turn));
  c.then(2, at(c.home, x - 0.3, round, turn));
  c.then(0.5, at(c.home, x - 0.3, round));
  c.then(1, at(c.home, x + 0.2, round));
  c.then(0.5, at(c.home, x + 0.2, round, -turn));
  c.then(2, at(c.home, 2, 0, -turn));
  c.then(1, at(c.home, 2));
  c.reach_and_drive_on();
  return c;
}

TEST(ShortenDriveBy, DrivesOnWhereItStopped) {
  const StopAndGo c;
  ASSERT_TRUE(c.known_is_free());
  const DriveByResult r = shorten_drive_by(c.group, c.world, c.tasks, c.known);
  ASSERT_EQ(r.outcome, Outcome::solved) << r.report;
  EXPECT_GE(r.duration(), kFastest - 1e-6);
  EXPECT_LE(r.duration(), 1.05 * kFastest);
  EXPECT_GT(r.events[0].base_speed, 0.3);
  const Pose T = c.group.fk(r.trajectory->at(r.events[0].time));
  EXPECT_LT((T.translation() - c.tasks[0].candidates[0].translation()).norm(), 1e-6);
  for (const Violation& v : r.violations) EXPECT_TRUE(v.kept()) << v.kind;
}

/// Bodies parted as they lie where the known motion waits would leave it at 8.5 s.
TEST(ShortenDriveBy, IsNotHeldBackToWhereItWaited) {
  const StopAndGo c = round_a_pillar(1.3, 3);
  ASSERT_TRUE(c.known_is_free());
  const DriveByResult r = shorten_drive_by(c.group, c.world, c.tasks, c.known);
  ASSERT_EQ(r.outcome, Outcome::solved) << r.report;
  EXPECT_GE(r.duration(), kFastest - 1e-6);
  EXPECT_LE(r.duration(), 1.04 * kFastest) << r.report;
}

/// Nothing is found where bodies are parted the shortest way out.
TEST(ShortenDriveBy, TriesToPartBodiesAsTheyWere) {
  StopAndGo plain;
  plain.up.tail(7) = test::vec({-0.4, -0.6, -0.9, 1.5, 0.0, 0.4, 0.0});
  const StopAndGo c = round_a_pillar(1.0, 7, plain);
  ASSERT_TRUE(c.known_is_free());
  const DriveByResult r = shorten_drive_by(c.group, c.world, c.tasks, c.known);
  ASSERT_EQ(r.outcome, Outcome::solved) << r.report;
  EXPECT_EQ(r.solves, 2);
  EXPECT_LE(r.duration(), 1.2 * kFastest) << r.report;
}

TEST(ShortenDriveBy, KeepsTheNumbersAsTheyStand) {
  const StopAndGo plain, turned(3);
  const DriveByResult a = shorten_drive_by(plain.group, plain.world, plain.tasks, plain.known);
  const DriveByResult b = shorten_drive_by(turned.group, turned.world, turned.tasks, turned.known);
  ASSERT_EQ(b.outcome, Outcome::solved) << b.report;
  EXPECT_LT((b.trajectory->positions().front() - turned.known.positions.front()).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((b.trajectory->positions().back() - turned.known.positions.back()).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_NEAR(a.duration(), b.duration(), 1e-3 * a.duration());
}

TEST(ShortenDriveBy, StopsWhenTold) {
  const StopAndGo c;
  Monitor monitor;
  monitor.stop.stop();
  EXPECT_EQ(shorten_drive_by(c.group, c.world, c.tasks, c.known, {}, monitor).outcome, Outcome::stopped);
}

TEST(ShortenDriveBy, RefusesWhatMakesNoSense) {
  const StopAndGo good;
  const auto refused = [&](const StopAndGo& c, const std::string& field, DriveByOptions options = {}) {
    try {
      shorten_drive_by(c.group, c.world, c.tasks, c.known, options);
      ADD_FAILURE() << field;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
    }
  };
  StopAndGo c = good;
  c.known.times[1] = 0;
  refused(c, "times");
  c = good;
  c.known.positions.pop_back();
  refused(c, "positions");
  c = good;
  c.known.positions[2].conservativeResize(5);
  refused(c, "positions");
  c = good;
  c.known.positions[2][4] = std::nan("");
  refused(c, "positions");
  c = good;
  c.known.task_times = {};
  refused(c, "task_times");
  c = good;
  c.known.task_times = {17.9};  // its dwell ends after the motion
  refused(c, "task_times");
  c = good;
  c.tasks[0].candidates.push_back(Pose::Identity());
  refused(c, "candidates");
  c = good;
  c.tasks[0].dwell = 0;
  c.tasks[0].push.emplace();
  refused(c, "push");
  DriveByOptions few;
  few.waypoints = 3;
  refused(good, "waypoints", few);
}

}  // namespace
}  // namespace mmgrasp
