#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/task/drive_by.hpp"
#include "support/fetchlike.hpp"
#include "support/vec.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;

/// A stop-and-go motion: drive ahead, stop, reach, wait, reach back, drive on. The table stands to the right of the
/// way.
struct StopAndGo {
  JointGroup group = test::fetchlike_whole_body();
  World world;
  std::vector<DriveByTask> tasks;
  KnownMotion known;

  explicit StopAndGo(double turns = 0) {
    VectorXd home = VectorXd::Zero(group.size()), out = VectorXd::Zero(group.size());
    home.tail(7) = test::vec({1.32, 1.40, -0.2, 1.72, 0.0, 1.66, 0.0});
    out.tail(7) = test::vec({-1.2, 0.3, 0.0, 0.6, 0.0, 0.6, 0.0});
    // Numbers whole turns away, as earlier motions may leave them.
    for (VectorXd* q : {&home, &out}) (*q)[group.size() - 1] += 2 * M_PI * turns;
    home[2] = out[2] = 2 * M_PI * turns;
    const auto at = [](VectorXd q, double x) {
      q[0] = x;
      return q;
    };
    known.times = {0, 6, 9, 9.5, 12.5, 18};
    known.positions = {at(home, 0), at(home, 2), at(out, 2), at(out, 2), at(home, 2), at(home, 4)};
    known.task_times = {9};
    DriveByTask task;
    task.candidates = {group.fk(known.positions[2])};
    task.dwell = 0.5;
    tasks = {task};
    Pose T = Pose::Identity();
    T.translation() << 2, -1.3, 0.2;
    world.add("table", Box{{1.0, 0.4, 0.4}}, T);
  }
};

TEST(ShortenDriveBy, DrivesOnWhereItStopped) {
  const StopAndGo c;
  const DriveByResult r = shorten_drive_by(c.group, c.world, c.tasks, c.known);
  ASSERT_EQ(r.outcome, Outcome::solved) << r.report;
  // 4 m at 0.6 m/s with ramps of 0.5 m/s^2 take 7.87 s: no motion is faster, and little more is needed.
  const double least = 4 / 0.6 + 0.6 / 0.5;
  EXPECT_GE(r.duration(), least - 1e-6);
  EXPECT_LE(r.duration(), 1.05 * least);
  EXPECT_GT(r.events[0].base_speed, 0.3);
  const Pose T = c.group.fk(r.trajectory->at(r.events[0].time));
  EXPECT_LT((T.translation() - c.tasks[0].candidates[0].translation()).norm(), 1e-6);
  for (const Violation& v : r.violations) EXPECT_TRUE(v.kept()) << v.kind;
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
