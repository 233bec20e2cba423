#include "mmgrasp/task/fingers_meet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/verify/plan_check.hpp"

namespace mmgrasp {
namespace {

constexpr double kWidest = 0.1;  // [m]

/// A hand on a slider that approaches along z and closes along y, with fingers of 10 x 10 x 40 mm whose faces stand
/// `back` [m] behind the pads. The tool frame is 20 mm above their tips.
JointGroup hand_with_faces(double back) {
  std::ostringstream urdf;
  const auto link = [&](const std::string& name, const std::string& origin, const std::string& size) {
    urdf << "<link name='" << name << "'><collision><origin xyz='" << origin << "'/><geometry><box size='" << size
         << "'/></geometry></collision></link>";
  };
  const auto joint = [&](const std::string& name, const std::string& parent, const std::string& child,
                         const std::string& axis) {
    urdf << "<joint name='" << name << "' type='prismatic'><parent link='" << parent << "'/><child link='" << child
         << "'/><axis xyz='" << axis << "'/><limit lower='0' upper='1' effort='10' velocity='1'/></joint>";
  };
  urdf << "<robot name='slider'>";
  link("rail", "3 0 0", "0.1 0.1 0.1");
  link("palm", "0 0 -0.1", "0.05 0.12 0.02");
  const std::string y = std::to_string(back + 0.005);
  link("left", "0 " + y + " 0", "0.01 0.01 0.04");
  link("right", "0 -" + y + " 0", "0.01 0.01 0.04");
  joint("slide", "rail", "palm", "0 0 1");
  joint("open_left", "palm", "left", "0 1 0");
  joint("open_right", "palm", "right", "0 -1 0");
  urdf << "<link name='tool'/><joint name='at' type='fixed'><parent link='palm'/><child link='tool'/></joint></robot>";
  return Robot::from_strings(urdf.str()).chain("rail", "tool");
}

Hand hand() {
  Hand made;
  made.tool_link = "tool";
  made.approach = Eigen::Vector3d::UnitZ();
  made.closing = Eigen::Vector3d::UnitY();
  made.max_opening = kWidest;
  made.joints = {{"open_left", 0, kWidest / 2}, {"open_right", 0, kWidest / 2}};
  made.finger_links = {"left", "right"};
  return made;
}

std::vector<LinkShape> box(double width, double beside = 0) {
  LinkShape shape;
  shape.shape = Box{Eigen::Vector3d(0.02, width, 0.02)};
  shape.T_link_shape.translation().y() = beside;
  return {shape};
}

bool meets(double back, double width, double beside = 0) {
  Grasp grasp;
  grasp.opening = width;
  return fingers_meet(hand_with_faces(back), hand(), box(width, beside), {grasp}).front();
}

TEST(FingersMeet, WhatIsThinnerThanTheirGapIsNotHeld) {
  constexpr double kBack = 0.5e-3, kLeast = 2 * (kBack + kGraspSlack);  // A gap of 1 mm.
  EXPECT_FALSE(meets(kBack, 0.5e-3));
  EXPECT_FALSE(meets(kBack, kLeast - 1e-5));
  EXPECT_TRUE(meets(kBack, kLeast + 1e-5));
  EXPECT_TRUE(meets(kBack, 0.05));
  EXPECT_TRUE(meets(0, 2 * kGraspSlack + 1e-5));
}

TEST(FingersMeet, FacesMayStandBackAsFarAsFingersMayClose) {
  for (const double width : {0.004, 0.02, 0.04, 0.06, 0.09}) {
    const double most = (width - verify::narrowest_grip(width)) / 2 - kGraspSlack;
    EXPECT_TRUE(meets(most - 1e-5, width)) << width;
    EXPECT_FALSE(meets(most + 1e-5, width)) << width;
  }
}

TEST(FingersMeet, WhatMeshesStickOutIsTakenOff) {
  constexpr double kTolerance = 1e-3, kLeast = 2 * (kGraspSlack + kTolerance);
  for (const double width : {kLeast - 1e-5, kLeast + 1e-5}) {
    Grasp grasp;
    grasp.opening = width;
    EXPECT_EQ(fingers_meet(hand_with_faces(0), hand(), box(width), {grasp}, kTolerance).front(), width > kLeast);
    EXPECT_TRUE(meets(0, width));
  }
}

/// Faces at +-(opening / 2 + back), each 10 mm thick, against [beside - width / 2, beside + width / 2].
bool by_intervals(double back, double width, double beside) {
  for (int i = 0; i <= 20; ++i) {
    const double opening = width - (width - verify::narrowest_grip(width)) * i / 20;
    const double near = opening / 2 + back, far = near + 0.01;
    const double low = beside - width / 2, high = beside + width / 2;
    if (high >= near && low <= far && low <= -near && high >= -far) return true;
  }
  return false;
}

TEST(FingersMeet, PartsBesideTheMiddleAsIntervalsSay) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  int held = 0;
  for (int i = 0; i < 300; ++i) {
    const double back = 0.008 * unit(random), width = 0.03 * unit(random), beside = 0.01 * (unit(random) - 0.5);
    const bool expected =
        by_intervals(back, width, beside - kGraspSlack) && by_intervals(back, width, beside + kGraspSlack);
    EXPECT_EQ(meets(back, width, beside), expected) << back << " " << width << " " << beside;
    held += expected;
  }
  EXPECT_GT(held, 50);
  EXPECT_LT(held, 250);
}

TEST(FingersMeet, TheHandStandsWhereTheGraspSays) {
  Grasp turned, away;
  turned.opening = away.opening = 0.02;
  turned.T_object_hand = Pose(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitX()));
  turned.T_object_hand.pretranslate(Eigen::Vector3d(0, 0, 0.5));
  away.T_object_hand = Pose(Eigen::Translation3d(0, 0, 0.5));
  LinkShape bar;  // Thin along z, where the turned hand closes.
  bar.shape = Box{Eigen::Vector3d(0.02, 0.03, 0.02)};
  bar.T_link_shape.translation().z() = 0.5;
  const Hand gripper = hand();
  EXPECT_EQ(fingers_meet(hand_with_faces(0), gripper, {bar}, {turned}), std::vector<bool>{true});
  bar.T_link_shape.translation().z() = 0;
  EXPECT_EQ(fingers_meet(hand_with_faces(0), gripper, {bar}, {turned, away}), (std::vector<bool>{false, false}));
}

TEST(FingersMeet, OtherJointsStandAsTheArmHasThem) {
  Hand one_sided = hand();
  one_sided.joints = {{"open_left", 0, kWidest / 2}};
  Grasp grasp;
  grasp.opening = 0.03;
  const JointGroup arm = hand_with_faces(0);
  EXPECT_EQ(fingers_meet(arm, one_sided, box(0.03), {grasp}), std::vector<bool>{true});  // The right one is closed.
  Eigen::VectorXd values = arm.reference();
  const Robot& robot = arm.robot();
  values[robot.joints()[robot.joint_index("open_right")].value_index] = 0.045;
  EXPECT_EQ(fingers_meet(arm.with_reference(values), one_sided, box(0.03), {grasp}), std::vector<bool>{false});
}

TEST(FingersMeet, CupsHaveNoFingers) {
  Suction suction;
  suction.cups = {{Eigen::Vector3d::Zero(), 0.01}};
  const Hand cups = Hand::of_cups("tool", Eigen::Vector3d::UnitZ(), suction, {"palm"});
  EXPECT_EQ(fingers_meet(hand_with_faces(0.04), cups, box(0.02), {Grasp{}, Grasp{}}), (std::vector<bool>{true, true}));
}

TEST(FingersMeet, WhatIsNotThereIsNamed) {
  const auto refused = [](const Hand& asked, double opening) -> std::string {
    Grasp grasp;
    grasp.opening = opening;
    try {
      fingers_meet(hand_with_faces(0), asked, box(0.02), {Grasp{}, grasp});
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  Hand no_joint = hand(), no_finger = hand(), elsewhere = hand();
  no_joint.joints[0].name = "no_such_joint";
  no_finger.finger_links[1] = "no_such_link";
  elsewhere.tool_link = "palm";
  EXPECT_NE(refused(no_joint, 0.02).find("no_such_joint"), std::string::npos);
  EXPECT_NE(refused(no_finger, 0.02).find("no_such_link"), std::string::npos);
  EXPECT_NE(refused(elsewhere, 0.02).find("must be the arm's tip"), std::string::npos);
  EXPECT_NE(refused(hand(), 0.2).find("grasps[1].opening = 0.2"), std::string::npos);
  EXPECT_NE(refused(hand(), -0.2).find("grasps[1].opening = -0.2"), std::string::npos);
  EXPECT_EQ(refused(hand(), 0.02), "");
  EXPECT_TRUE(fingers_meet(hand_with_faces(0), hand(), box(0.02), {}).empty());
}

}  // namespace
}  // namespace mmgrasp
