#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/task/drive_by.hpp"
#include "support/fetchlike.hpp"
#include "support/fetchlike_drive.hpp"

// Hands that close while they drive on.
namespace mmgrasp {
namespace {

using Eigen::VectorXd;
using test::grasp_at;

constexpr double kInf = std::numeric_limits<double>::infinity();
const VectorXd &kStart = test::kDriveStart, &kGoal = test::kDriveGoal;

}  // namespace

TEST(DriveByPush, ClosesWhileTheHandMovesOn) {
  const JointGroup group = test::fetchlike_whole_body();
  DriveByTask task = grasp_at(pose_from_xyz_rpy({5, -1, 0.75}, {0, 0, -0.8}));
  DriveByPush push;
  push.closing.opening = 0.08;
  push.closing.along_error = 0.02;
  push.closing.max_push = 0.02;
  push.free_length = 0.08;
  task.push = push;
  DriveByOptions options;
  options.waypoints = 45;
  const DriveByResult r = plan_drive_by(group, World(), kStart, {task}, {kGoal, kGoal}, options);
  ASSERT_EQ(r.outcome, Outcome::solved) << r.report;
  ASSERT_EQ(r.events.size(), 1u);
  const DriveByEvent& e = r.events[0];
  const PushGrasp closing = push_grasp(push.closing);
  EXPECT_NEAR(closing.closing_time, (0.08 - 0.05) / 0.1, 1e-12);
  EXPECT_GE(e.time - e.close_time, closing.closing_time - 1e-9);
  EXPECT_LE(e.time - e.close_time, 1.1 * closing.closing_time + 1e-9);
  EXPECT_GT(e.tool_speed, 0.1);
  EXPECT_LE(e.tool_speed, 1.05 * push.closing.tool_speed + 1e-6);
  EXPECT_GT(e.base_speed, 0.1);
  // Engagement along the approach: straight from before the object until both fingers touch.
  const auto tool = [&](double time) -> Eigen::Vector3d {
    return task.candidates[0].inverse() * group.fk(r.trajectory->at(time)).translation();
  };
  const double depth = push.closing.planned_depth;
  EXPECT_NEAR(tool(e.close_time).x() + depth, closing.push.start, 1e-5);
  EXPECT_NEAR(tool(e.time).x() + depth, closing.push.both_touch, 1e-5);
  double first = e.close_time;
  while (first > 0 && tool(first).x() + depth > -0.9 * push.free_length) first -= 0.01;
  double before = -kInf;
  for (double t = first; t < e.time; t += 0.01) {
    const Eigen::Vector3d at = tool(t);
    EXPECT_LT(at.tail<2>().norm(), 0.01) << t;
    EXPECT_GT(at.x(), before) << t;
    before = at.x();
  }
}

TEST(DriveByPush, TheObjectOfAPushLiesInTheHandWhereThePalmHasIt) {
  // An object of 5 cm whose near face the finger tips pass by 6 cm at the planned grasp: its middle lies this far from
  // the tip along the approach, until the palm, 12 cm behind the finger tips, or the fingers have it.
  const JointGroup group = test::fetchlike_whole_body();
  for (const bool slides : {false, true}) {
    DriveByTask task = grasp_at(pose_from_xyz_rpy({5, -1, 0.75}, {0, 0, -0.8}));
    const double middle = 0.01;
    const Pose T_world_object = task.candidates[0] * Eigen::Translation3d(middle, 0, 0);
    World world;
    world.add("can", Cylinder{0.025, 0.1}, T_world_object);
    task.object = "can";
    task.push.emplace();
    PushGraspProblem& closing = task.push->closing;
    closing.tool_speed = slides ? 0.4 : 0.1;
    closing.opening = 0.08;
    closing.along_error = 0.01;
    closing.max_push = slides ? 0.3 : 0.0;
    DriveByOptions options;
    options.waypoints = 45;
    options.collisions = false;
    const DriveByResult r = plan_drive_by(group, world, kStart, {task}, {kGoal, kGoal}, options);
    ASSERT_EQ(r.outcome, Outcome::solved) << r.report;
    const DriveByEvent& e = r.events[0];
    EXPECT_EQ(e.object, "can");
    const PushGrasp found = push_grasp(closing);
    EXPECT_EQ(found.push.pushed > 0, slides);
    const double engagement = std::min(found.push.both_touch, closing.finger_length);
    const Eigen::Vector3d expected(middle - (engagement - closing.planned_depth), 0, 0);
    EXPECT_LT((e.T_tip_object.translation() - expected).norm(), 1e-5) << slides;
    // Where it is put down in the room by then: pushed along the approach, and no farther.
    const Pose T_world_tip = group.fk(r.trajectory->at(e.time));
    const Eigen::Vector3d moved = task.candidates[0].linear().transpose() *
                                  ((T_world_tip * e.T_tip_object).translation() - T_world_object.translation());
    EXPECT_LT((moved - Eigen::Vector3d(found.push.pushed, 0, 0)).norm(), 1e-4) << slides;
  }
}

TEST(DriveByPush, RefusesPushesThatCannotHold) {
  const JointGroup group = test::fetchlike_whole_body();
  DriveByTask task = grasp_at(pose_from_xyz_rpy({5, -1, 0.75}, {0, 0, -0.8}));
  task.push.emplace();
  const auto refused = [&](const DriveByTask& t, const std::string& field) {
    try {
      plan_drive_by(group, World(), kStart, {t}, {kGoal, kGoal});
      ADD_FAILURE() << field;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
    }
  };
  DriveByTask wrong = task;
  wrong.push->approach = {0.6, 0.8, 0};
  refused(wrong, "approach");
  wrong = task;
  wrong.push->free_length = 0;
  refused(wrong, "free_length");
  wrong = task;
  wrong.push->closing.lateral_error = 0.02;
  wrong.push->closing.tool_speed = 0.6;  // 0.1 m/s * 0.22 m / 0.04 m is the most
  refused(wrong, "tool_speed");
  wrong = task;
  wrong.dwell = 0.3;
  refused(wrong, "dwell");
  wrong = task;
  wrong.max_tool_speed = 0.1;
  refused(wrong, "max_tool_speed");
}

}  // namespace mmgrasp
