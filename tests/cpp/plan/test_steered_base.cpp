// Planners that join configurations by straight lines refuse bases that cannot drive these.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/plan/cartesian.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "support/bar_transfer.hpp"
#include "support/vec.hpp"

namespace mmgrasp {
namespace {

using test::flat_pose;
using test::vec;

/// Three links in the plane on a platform.
Robot on_a_platform(BaseKind kind) {
  RobotOptions options;
  options.base = kind;
  std::string urdf = "<robot name='p'><link name='l0'/>";
  for (int i = 1; i <= 3; ++i) {
    const std::string own = std::to_string(i), parent = std::to_string(i - 1), origin = i == 1 ? "0" : "0.4";
    urdf += "<link name='l" + own + "'/><joint name='j" + own + "' type='revolute'><parent link='l" + parent +
            "'/><child link='l" + own + "'/><origin xyz='" + origin +
            " 0 0'/><axis xyz='0 0 1'/><limit lower='-2' upper='2' velocity='1' effort='1'/></joint>";
  }
  urdf +=
      "<link name='tip'/><joint name='t' type='fixed'><parent link='l3'/><child link='tip'/>"
      "<origin xyz='0.4 0 0'/></joint></robot>";
  return Robot::from_strings(urdf, "", options);
}

struct Case {
  const char* function;
  std::function<Outcome(const JointGroup&)> plan;
};

Eigen::VectorXd bent(const JointGroup& group) {
  return group.has_base() ? vec({0, 0, 0, -0.6, 0.9, 0.4}) : vec({-0.6, 0.9, 0.4});
}

/// The tool's pose there, 5 cm aside.
Pose beside(const JointGroup& group) {
  Pose T = group.fk(bent(group));
  T.translation().y() += 0.05;
  return T;
}

Outcome plan_transfer(const JointGroup& group, const std::string& planner) {
  LinkShape ball;
  ball.shape = Sphere{0.02};
  const ManipulationProblem problem{
      group, {}, {ball}, flat_pose(0.9, 0.2, 0.3), flat_pose(0.8, 0.4, 0.9), {{flat_pose(0, 0, 0), 0, 0}}};
  ManipulationOptions options;
  options.planner = planner;
  options.prm.roadmap.vertices = 200;
  options.rrt.max_iterations = 100;
  return plan_manipulation(problem, options).outcome;
}

const Case kCases[] = {
    {"plan_straight_line",
     [](const JointGroup& group) {
       CollisionChecker checker(group, World{});
       return plan_straight_line(checker, bent(group), beside(group)).outcome;
     }},
    {"plan_cartesian",
     [](const JointGroup& group) {
       CollisionChecker checker(group, World{});
       return plan_cartesian(checker, {group.fk(bent(group)), beside(group)}, bent(group)).outcome;
     }},
    {"plan_manipulation", [](const JointGroup& group) { return plan_transfer(group, "prm_star_mg"); }},
    {"plan_manipulation", [](const JointGroup& group) { return plan_transfer(group, "rrt_star_mg"); }},
};

TEST(SteeredBase, PathsThatItCouldNotDriveAreRefusedByName) {
  const Robot robot = on_a_platform(BaseKind::diff_drive);
  const JointGroup whole = robot.chain("l0", "tip", true);
  for (const Case& c : kCases) {
    try {
      c.plan(whole);
      ADD_FAILURE() << c.function << " took a diff-drive base";
    } catch (const InvalidInput& error) {
      const std::string text = error.what();
      for (const std::string& word : {std::string("group = " + whole.name()), std::string("diff_drive"),
                                      std::string("omni"), std::string("plan_motion"), std::string(c.function)})
        EXPECT_NE(text.find(word), std::string::npos) << text;
    }
  }
}

TEST(SteeredBase, AnOmniBaseIsTaken) {
  const Robot robot = on_a_platform(BaseKind::omni);
  for (const Case& c : kCases) EXPECT_EQ(c.plan(robot.chain("l0", "tip", true)), Outcome::solved) << c.function;
}

/// The base stands still: its wheels have nothing to do.
TEST(SteeredBase, TheArmAloneIsTaken) {
  const Robot robot = on_a_platform(BaseKind::diff_drive);
  const JointGroup arm = robot.chain("l0", "tip");
  for (const Case& c : kCases) EXPECT_EQ(c.plan(arm), Outcome::solved) << c.function;
}

}  // namespace
}  // namespace mmgrasp
