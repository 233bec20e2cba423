#include "mmgrasp/robot/named_configuration.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

// A lift that must stand above 0.1 and two turning joints; a finger that no group moves.
const char* kUrdf =
    R"(<robot name="r"><link name="base"/><link name="mast"/><link name="arm"/><link name="hand"/><link name="tip"/>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="mast"/><axis xyz="0 0 1"/><limit lower="0.1" upper="1" velocity="1"/></joint>
  <joint name="shoulder" type="revolute"><parent link="mast"/><child link="arm"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" velocity="1"/></joint>
  <joint name="wrist" type="continuous"><parent link="arm"/><child link="hand"/><axis xyz="0 0 1"/><limit velocity="1"/></joint>
  <joint name="finger" type="prismatic"><parent link="hand"/><child link="tip"/><axis xyz="0 1 0"/><limit lower="0" upper="0.05" velocity="1"/></joint>
</robot>)";
const char* kSrdf = R"(<robot name="r">
  <group name="arm"><joint name="shoulder"/><joint name="wrist"/></group>
  <group name="whole"><joint name="lift"/><joint name="shoulder"/><joint name="wrist"/></group>
  <group_state name="ready" group="arm"><joint name="shoulder" value="0.5"/><joint name="wrist" value="-1"/></group_state>
  <group_state name="tucked" group="whole"><joint name="lift" value="0.2"/><joint name="shoulder" value="-1.5"/><joint name="wrist" value="2"/></group_state>
  <group_state name="ready" group="whole"><joint name="shoulder" value="0.7"/></group_state>
</robot>)";

Robot robot() {
  RobotOptions options;
  options.base = BaseKind::omni;
  return Robot::from_strings(kUrdf, kSrdf, options);
}

template <typename Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(NamedConfiguration, WhatIsNotNamedStaysAsItIs) {
  const JointGroup whole = robot().group("whole");
  EXPECT_EQ(named_configuration(whole, {}), Eigen::VectorXd(Eigen::Vector3d(0.1, 0, 0)));  // zero lies outside
  EXPECT_EQ(named_configuration(whole, {{"wrist", 7}, {"lift", 0.3}}), Eigen::VectorXd(Eigen::Vector3d(0.3, 0, 7)));
  const Eigen::VectorXd base = Eigen::Vector3d(0.4, 1, 2);
  EXPECT_EQ(named_configuration(whole, {{"shoulder", -1}}, base), Eigen::VectorXd(Eigen::Vector3d(0.4, -1, 2)));
  const JointGroup held = whole.with_reference(robot().values({{"shoulder", 0.25}}));
  EXPECT_EQ(named_configuration(held, {}), Eigen::VectorXd(Eigen::Vector3d(0.1, 0.25, 0)));
  Eigen::VectorXd moving(6);
  moving << 1, 0, 0.5, 0.1, 0, 0;
  EXPECT_EQ(named_configuration(robot().group("whole", "", true), {{"x", 1}, {"theta", 0.5}}), moving);
  const std::string wrong = refusal([&] { named_configuration(whole, {{"writs", 1}}); });
  EXPECT_NE(wrong.find("did you mean \"wrist\""), std::string::npos) << wrong;
  EXPECT_NE(refusal([&] { named_configuration(whole, {{"finger", 0.01}}); }), "");
  EXPECT_NE(refusal([&] { named_configuration(whole, {{"wrist", NAN}}); }), "");
  EXPECT_NE(refusal([&] { named_configuration(whole, {}, Eigen::VectorXd(2)); }), "");
}

TEST(NamedConfiguration, StatesOfTheSrdf) {
  const Robot r = robot();
  EXPECT_EQ(state_configuration(r.group("arm"), "ready"), Eigen::VectorXd(Eigen::Vector2d(0.5, -1)));
  EXPECT_EQ(state_configuration(r.group("whole"), "ready"), Eigen::VectorXd(Eigen::Vector3d(0.1, 0.7, 0)));
  EXPECT_EQ(state_configuration(r.group("whole"), "ready", Eigen::Vector3d(0.4, 1, 2)),
            Eigen::VectorXd(Eigen::Vector3d(0.4, 0.7, 2)));
  // Of a group that has all its joints, when its own has no such state; a chain has no group of its own.
  EXPECT_EQ(state_configuration(r.group("arm"), "tucked"), Eigen::VectorXd(Eigen::Vector2d(-1.5, 2)));
  EXPECT_EQ(state_configuration(r.chain("mast", "hand"), "ready"), Eigen::VectorXd(Eigen::Vector2d(0.5, -1)));
  const std::string wrong = refusal([&] { state_configuration(r.group("arm"), "home"); });
  EXPECT_NE(wrong.find("known are ready, tucked"), std::string::npos) << wrong;
}

TEST(NamedConfiguration, GroupsKnowTheirLinks) {
  const Robot twice = robot().mount(robot(), "tip", Pose::Identity(), "b_");
  for (const GroupDescription& group : twice.groups()) {
    if (group.name == "arm") {
      EXPECT_EQ(group.links, (std::vector<std::string>{"arm", "hand"}));
    }
    if (group.name == "b_whole") {
      EXPECT_EQ(group.links, (std::vector<std::string>{"b_mast", "b_arm", "b_hand"}));
    }
  }
}

}  // namespace
}  // namespace mmgrasp
