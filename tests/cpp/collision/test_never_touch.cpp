#include <gtest/gtest.h>

#include <string>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/disabled_pairs.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/fcl_reference.hpp"
#include "support/robot_support.hpp"

using namespace mmgrasp;
using testing_support::shared;

namespace {

// A planar arm of two joints over a post beside its base: the tip of "hand" reaches the distance 1 from the first axis
// when the elbow is straight, and the post's near side stands at `post`.
std::string arm_beside_post(double post, double elbow_lower) {
  const double middle = post + 0.05;
  return R"(<robot name="arm">
  <link name="base"><collision><geometry><sphere radius="0.05"/></geometry></collision></link>
  <link name="post"><collision><geometry><sphere radius="0.05"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.3 0.02 0.02"/></geometry></collision></link>
  <link name="middle"><collision><origin xyz="0.05 0 0"/><geometry><sphere radius="0.01"/></geometry></collision></link>
  <link name="hand"><collision><origin xyz="0.47 0 0"/><geometry><sphere radius="0.03"/></geometry></collision></link>
  <joint name="stand" type="fixed"><parent link="base"/><child link="post"/><origin xyz=")" +
         std::to_string(middle) + R"( 0 0"/></joint>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="middle"/><origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>
    <limit lower=")" +
         std::to_string(elbow_lower) + R"(" upper="3" velocity="1" effort="1"/></joint>
  <joint name="wrist" type="continuous"><parent link="middle"/><child link="hand"/><axis xyz="1 0 0"/></joint>
</robot>)";
}

bool never(const Robot& robot, const char* x, const char* y) {
  const int i = robot.link_index(x), j = robot.link_index(y);
  const auto it = robot.disabled_pairs().find({std::min(i, j), std::max(i, j)});
  return it != robot.disabled_pairs().end() && it->second == DisabledReason::never;
}

}  // namespace

// The straight arm's tip, and no other configuration's, is 1 m away from the shoulder.
TEST(NeverTouch, AGapOfAMillimetreIsProvenAndAnOverlapIsNot) {
  for (const double gap : {0.1, 0.01, 0.001}) {
    EXPECT_TRUE(never(compute_disabled_pairs(Robot::from_strings(arm_beside_post(1 + gap, -3))), "post", "hand"))
        << gap;
  }
  for (const double overlap : {1e-4, 1e-3}) {
    const Robot robot = compute_disabled_pairs(Robot::from_strings(arm_beside_post(1 - overlap, -3)));
    EXPECT_FALSE(never(robot, "post", "hand")) << overlap;
  }
}

// Touching takes both joints within some 0.01 rad of zero, about one configuration in a hundred thousand: no sample of
// ten thousand meets it, the checker does.
TEST(NeverTouch, WhatNoSampleMeetsIsStillChecked) {
  const Robot bare = Robot::from_strings(arm_beside_post(1 - 1e-4, -3));
  DisabledPairsOptions by_samples;
  by_samples.trust_samples = true;
  EXPECT_TRUE(never(compute_disabled_pairs(bare, by_samples), "post", "hand")) << "the samples are no test";
  const Robot robot = compute_disabled_pairs(bare);
  CollisionChecker checker(robot.chain("base", "hand"), World());
  EXPECT_FALSE(checker.is_free(Eigen::Vector3d::Zero()));
  EXPECT_TRUE(checker.is_free(Eigen::Vector3d(0.3, 0, 0)));
}

// With the elbow bent by a tenth or more the hand comes no farther than 0.9988 m.
TEST(NeverTouch, LimitsCount) {
  const double reach = std::sqrt(0.5 * 0.5 + 0.47 * 0.47 + 2 * 0.5 * 0.47 * std::cos(0.1)) + 0.03;
  ASSERT_NEAR(reach, 0.9988, 1e-4);
  EXPECT_TRUE(never(compute_disabled_pairs(Robot::from_strings(arm_beside_post(0.9995, 0.1))), "post", "hand"));
  EXPECT_FALSE(never(compute_disabled_pairs(Robot::from_strings(arm_beside_post(0.9995, -0.1))), "post", "hand"));
}

// Robots of many joints: nothing called "never" touches in configurations of other draws, counted by FCL.
TEST(NeverTouch, NoPairOfRealRobotsIsDroppedThatTouches) {
  MMGRASP_NEEDS_SHARED_DATA();
  RobotOptions load;
  load.package_dirs["moveit_resources_panda_description"] = shared("robots/panda/moveit_resources_panda_description");
  const Robot robot = compute_disabled_pairs(Robot::load(shared("robots/panda/expanded/panda.urdf"), "", load));
  int dropped = 0;
  for (const auto& [pair, reason] : robot.disabled_pairs()) {
    if (reason != DisabledReason::never) continue;
    ++dropped;
    const Link &a = robot.links()[pair.first], &b = robot.links()[pair.second];
    const auto body_a = fcl_reference::make_body(a.collisions[0].shape);
    const auto body_b = fcl_reference::make_body(b.collisions[0].shape);
    for (int s = 0; s < 3000; ++s) {
      Rng rng(71, s);
      Eigen::VectorXd values = robot.default_values();
      // Half of the draws at the ends of the joints' ranges, where links come nearest to each other.
      for (const Joint& joint : robot.joints()) {
        if (joint.value_index < 0) continue;
        const double share = rng.uniform(0, 1);
        values[joint.value_index] =
            s % 2 ? rng.uniform(joint.lower, joint.upper) : (share < 0.5 ? joint.lower : joint.upper);
      }
      const Poses poses = robot.link_poses(values);
      ASSERT_FALSE(fcl_reference::touch(body_a, poses[pair.first] * a.collisions[0].T_link_shape, body_b,
                                        poses[pair.second] * b.collisions[0].T_link_shape))
          << a.name << " " << b.name;
    }
  }
  EXPECT_GT(dropped, 3);
}
