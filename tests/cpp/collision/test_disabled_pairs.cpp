#include "mmgrasp/collision/disabled_pairs.hpp"

#include <gtest/gtest.h>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/fcl_reference.hpp"
#include "support/robot_support.hpp"

using namespace mmgrasp;
using testing_support::shared;

namespace {

// a - b - c - d in a row: c always overlaps a, d can fold back onto a and b, "far" never meets anything.
const char* kChain = R"(<robot name="chain">
  <link name="a"><collision><geometry><box size="0.5 0.5 0.5"/></geometry></collision></link>
  <link name="b"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <link name="c"><collision><geometry><sphere radius="0.2"/></geometry></collision></link>
  <link name="bare"/>
  <link name="d"><collision><origin xyz="0.4 0 0"/><geometry><box size="0.8 0.05 0.05"/></geometry></collision></link>
  <link name="far"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="j1" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
  <joint name="j2" type="revolute"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
  <joint name="fix" type="fixed"><parent link="c"/><child link="bare"/><origin xyz="0.3 0 0"/></joint>
  <joint name="j3" type="revolute"><parent link="bare"/><child link="d"/><axis xyz="0 0 1"/><limit lower="-3.1" upper="3.1" velocity="1" effort="1"/></joint>
  <joint name="jf" type="fixed"><parent link="a"/><child link="far"/><origin xyz="0 0 9"/></joint>
</robot>)";

}  // namespace

TEST(DisabledPairs, ReasonsOfASmallChain) {
  const Robot robot = compute_disabled_pairs(Robot::from_strings(kChain));
  const auto reason = [&](const char* x, const char* y) {
    const int i = robot.link_index(x), j = robot.link_index(y);
    const auto it = robot.disabled_pairs().find({std::min(i, j), std::max(i, j)});
    return it == robot.disabled_pairs().end() ? DisabledReason::user : it->second;
  };
  EXPECT_EQ(reason("a", "b"), DisabledReason::adjacent);
  EXPECT_EQ(reason("c", "d"), DisabledReason::adjacent) << "through the shapeless link";
  EXPECT_EQ(reason("a", "far"), DisabledReason::adjacent) << "rigidly joined";
  EXPECT_EQ(reason("a", "c"), DisabledReason::always);
  EXPECT_EQ(reason("d", "far"), DisabledReason::never);
  EXPECT_FALSE(robot.pair_disabled(robot.link_index("a"), robot.link_index("d")));
  EXPECT_FALSE(robot.pair_disabled(robot.link_index("b"), robot.link_index("d")));
}

TEST(DisabledPairs, PandaAgreesWithCountingByFcl) {
  MMGRASP_NEEDS_SHARED_DATA();
  RobotOptions load;
  load.package_dirs["moveit_resources_panda_description"] = shared("robots/panda/moveit_resources_panda_description");
  const Robot bare = Robot::load(shared("robots/panda/expanded/panda.urdf"), "", load);
  DisabledPairsOptions options;
  options.samples = 300;
  const Robot proven = compute_disabled_pairs(bare, options);
  options.trust_samples = true;
  const Robot robot = compute_disabled_pairs(bare, options);
  const auto kept = bare.disabled_pairs();
  std::map<std::pair<int, int>, int> hits;
  std::vector<fcl_reference::Body> bodies;
  for (const Link& link : bare.links()) {
    bodies.push_back(link.collisions.empty() ? fcl_reference::Body()
                                             : fcl_reference::make_body(link.collisions[0].shape));
  }
  for (int s = 0; s < options.samples; ++s) {
    // The same draws as the function makes: stream s of the seed, joints in order.
    Rng rng(options.seed, s);
    Eigen::VectorXd values = bare.default_values();
    for (const Joint& joint : bare.joints()) {
      if (joint.value_index >= 0) values[joint.value_index] = rng.uniform(joint.lower, joint.upper);
    }
    const Poses poses = bare.link_poses(values);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      for (std::size_t j = i + 1; j < bodies.size(); ++j) {
        if (bare.links()[i].collisions.empty() || bare.links()[j].collisions.empty()) continue;
        const Pose A = poses[i] * bare.links()[i].collisions[0].T_link_shape;
        const Pose B = poses[j] * bare.links()[j].collisions[0].T_link_shape;
        hits[{static_cast<int>(i), static_cast<int>(j)}] += fcl_reference::touch(bodies[i], A, bodies[j], B);
      }
    }
  }
  int never = 0, never_proven = 0, open = 0;
  for (const auto& [pair, count] : hits) {
    const auto it = robot.disabled_pairs().find(pair);
    if (it != robot.disabled_pairs().end() && it->second == DisabledReason::adjacent) continue;
    const std::string names = bare.links()[pair.first].name + " " + bare.links()[pair.second].name;
    EXPECT_EQ(robot.pair_disabled(pair.first, pair.second), count == 0 || count >= 0.95 * options.samples) << names;
    // What no sample met is dropped only where that is proven.
    if (proven.pair_disabled(pair.first, pair.second)) EXPECT_TRUE(count == 0 || count >= 0.95 * options.samples);
    never += count == 0;
    never_proven += count == 0 && proven.pair_disabled(pair.first, pair.second);
    open += count > 0;
  }
  EXPECT_GT(never, 5);
  EXPECT_GT(never_proven, 3);
  EXPECT_GT(open, 5);
}

TEST(DisabledPairs, TheSameAtAnyThreadCount) {
  DisabledPairsOptions one, many;
  one.threads = 1;
  many.threads = 4;
  const Robot robot = Robot::from_strings(kChain);
  EXPECT_EQ(compute_disabled_pairs(robot, one).disabled_pairs(), compute_disabled_pairs(robot, many).disabled_pairs());
}

TEST(DisabledPairs, KeepsWhatTheSrdfSaysAndRefusesBadOptions) {
  const Robot robot = Robot::from_strings(
      kChain, "<robot name='chain'><disable_collisions link1='a' link2='d' reason='User'/></robot>");
  ASSERT_TRUE(robot.pair_disabled(robot.link_index("a"), robot.link_index("d")));
  const Robot computed = compute_disabled_pairs(robot);
  EXPECT_TRUE(computed.pair_disabled(robot.link_index("a"), robot.link_index("d")));
  DisabledPairsOptions options;
  options.samples = 0;
  EXPECT_THROW(compute_disabled_pairs(robot, options), InvalidInput);
  options = {};
  options.always_fraction = 1.5;
  EXPECT_THROW(compute_disabled_pairs(robot, options), InvalidInput);
}
