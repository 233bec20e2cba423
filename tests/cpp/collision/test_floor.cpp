#include "mmgrasp/collision/floor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

// Wheels that reach 1 cm under the root's z = 0, a shoulder at z = 0.3 that turns down a bar of 0.5 m, two fingers at
// its end of which the second follows the first, and a flap that no group moves.
const char* kUrdf = R"(<robot name="r">
  <link name="base"><collision><origin xyz="0 0 0.15"/><geometry><box size="0.3 0.3 0.2"/></geometry></collision></link>
  <link name="wheel"><collision><geometry><sphere radius="0.06"/></geometry></collision></link>
  <link name="flap"><collision><origin xyz="0 0 -0.1"/><geometry><box size="0.02 0.02 0.2"/></geometry></collision></link>
  <link name="bar"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.5 0.04 0.04"/></geometry></collision></link>
  <link name="left"><collision><origin xyz="0.04 0 0"/><geometry><box size="0.08 0.01 0.01"/></geometry></collision></link>
  <link name="right"><collision><origin xyz="0.04 0 0"/><geometry><box size="0.08 0.01 0.01"/></geometry></collision></link>
  <joint name="axle" type="continuous"><parent link="base"/><child link="wheel"/><origin xyz="-0.1 0.2 0.05"/><axis xyz="0 1 0"/><limit velocity="1" effort="1"/></joint>
  <joint name="hinge" type="revolute"><parent link="base"/><child link="flap"/><origin xyz="-0.2 0 0.15"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="bar"/><origin xyz="0.2 0 0.3"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
  <joint name="l" type="prismatic"><parent link="bar"/><child link="left"/><origin xyz="0.5 0.01 0"/><axis xyz="0 1 0"/><limit lower="0" upper="0.05" velocity="1" effort="1"/></joint>
  <joint name="r" type="prismatic"><parent link="bar"/><child link="right"/><origin xyz="0.5 -0.01 0"/><axis xyz="0 -1 0"/><limit lower="0" upper="0.05" velocity="1" effort="1"/><mimic joint="l"/></joint>
</robot>)";

Robot robot(BaseKind base = BaseKind::fixed) {
  RobotOptions options;
  options.base = base;
  return Robot::from_strings(kUrdf, "", options);
}

JointGroup arm(BaseKind base = BaseKind::fixed) {
  return robot(base).chain("base", "bar", base != BaseKind::fixed);
}

World with_floor(const JointGroup& group, double height = 0) {
  World world;
  add_floor(world, group, height);
  return world;
}

/// How far the bar is turned down when a finger's lower edge reaches z = `height`: 0.3 - 0.58 sin a - 0.005 cos a.
double angle_at(double height) {
  const double length = std::hypot(0.58, 0.005);
  return std::asin((0.3 - height) / length) - std::atan2(0.005, 0.58);
}

Eigen::VectorXd turned(double angle) {
  return Eigen::VectorXd::Constant(1, angle);
}

TEST(Floor, StopsTheArmWhereItsFingersMeetIt) {
  for (const double height : {0.0, -0.2, 0.1}) {
    CollisionChecker checker(arm(), with_floor(arm(), height));
    EXPECT_TRUE(checker.is_free(turned(angle_at(height) - 1e-5))) << height;
    EXPECT_FALSE(checker.is_free(turned(angle_at(height) + 1e-5))) << height;
    std::set<std::string> touching;
    for (const Contact& contact : checker.contacts(turned(angle_at(height) + 1e-3))) touching.insert(contact.a);
    EXPECT_EQ(touching, (std::set<std::string>{"left", "right"})) << height;
  }
}

TEST(Floor, LetsWheelsAndWhateverElseTheArmDoesNotMoveTouchIt) {
  const World world = with_floor(arm());
  std::set<std::string> may;
  for (const auto& [a, b] : world.allowed()) may.insert(a == kFloor ? b : a);
  EXPECT_EQ(may, (std::set<std::string>{"base", "wheel", "flap"}));
  EXPECT_TRUE(CollisionChecker(arm(), world).is_free(turned(0)));
}

TEST(Floor, IsThereWhereverTheBaseDrives) {
  const JointGroup group = arm(BaseKind::omni);
  CollisionChecker checker(group, with_floor(group));
  for (const Eigen::Vector3d& base : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(-70, 40, 2)}) {
    Eigen::VectorXd q(4);
    q << base, angle_at(0) - 1e-5;
    EXPECT_TRUE(checker.is_free(q));
    q[3] = angle_at(0) + 1e-5;
    EXPECT_FALSE(checker.is_free(q));
  }
}

TEST(Floor, StopsAHeldPart) {
  World world = with_floor(arm());
  world.add("ball", Sphere{0.02}, Pose::Identity());
  world.attach("ball", "bar", pose_from_xyz_rpy({0.7, 0, 0}, {0, 0, 0}));
  CollisionChecker checker(arm(), world);
  const double angle = std::asin((0.3 - 0.02) / 0.7);
  EXPECT_TRUE(checker.is_free(turned(angle - 1e-5)));
  EXPECT_FALSE(checker.is_free(turned(angle + 1e-5)));
}

TEST(Floor, RefusesAHeightThatIsNoneAndASecondFloor) {
  World world;
  EXPECT_THROW(add_floor(world, arm(), std::nan("")), InvalidInput);
  add_floor(world, arm());
  EXPECT_THROW(add_floor(world, arm()), InvalidInput);
  world.remove(kFloor);
  EXPECT_TRUE(world.allowed().empty());
  EXPECT_NO_THROW(add_floor(world, arm(), 0.5));
}

}  // namespace
}  // namespace mmgrasp
