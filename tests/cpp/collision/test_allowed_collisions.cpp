#include <gtest/gtest.h>

#include <set>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/detail/attached_checker.hpp"
#include "mmgrasp/collision/edge.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

// An arm of two links with a gripper of two fingers, the second of which mimics the first.
const char* kUrdf = R"(<robot name="r">
  <link name="base"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="arm"><collision><origin xyz="0.3 0 0"/><geometry><box size="0.3 0.05 0.05"/></geometry></collision></link>
  <link name="hand"><collision><geometry><box size="0.05 0.2 0.05"/></geometry></collision></link>
  <link name="left"><collision><origin xyz="0.05 0 0"/><geometry><box size="0.1 0.02 0.02"/></geometry></collision></link>
  <link name="right"><collision><origin xyz="0.05 0 0"/><geometry><box size="0.1 0.02 0.02"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
  <joint name="wrist" type="revolute"><parent link="arm"/><child link="hand"/><origin xyz="0.5 0 0"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
  <joint name="l" type="prismatic"><parent link="hand"/><child link="left"/><axis xyz="0 1 0"/><origin xyz="0.03 0.04 0"/><limit lower="0" upper="0.05" velocity="1" effort="1"/></joint>
  <joint name="r" type="prismatic"><parent link="hand"/><child link="right"/><axis xyz="0 -1 0"/><origin xyz="0.03 -0.04 0"/><limit lower="0" upper="0.05" velocity="1" effort="1"/><mimic joint="l"/></joint>
</robot>)";
const char* kSrdf = R"(<robot name="r">
  <group name="arm_group"><chain base_link="base" tip_link="hand"/></group>
  <group name="fingers"><joint name="l"/></group>
  <group name="all_of_hand"><link name="hand"/><group name="fingers"/></group>
  <disable_collisions link1="base" link2="arm" reason="Adjacent"/><disable_collisions link1="arm" link2="hand" reason="Adjacent"/>
  <disable_collisions link1="hand" link2="left" reason="Adjacent"/><disable_collisions link1="hand" link2="right" reason="Adjacent"/>
</robot>)";

Robot robot() {
  return Robot::from_strings(kUrdf, kSrdf);
}

Eigen::VectorXd vec(double a, double b) {
  return Eigen::Vector2d(a, b);
}

Pose shifted(double x, double y, double z) {
  return pose_from_xyz_rpy({x, y, z}, {0, 0, 0});
}

std::string refusal(const World& world) {
  try {
    CollisionChecker checker(robot().group("arm_group"), world);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

using Pairs = std::set<std::pair<std::string, std::string>>;

Pairs pairs_of(const std::vector<Contact>& contacts) {
  Pairs pairs;
  for (const Contact& c : contacts) pairs.emplace(c.a, c.b);
  return pairs;
}

World random_world(Rng& rng) {
  World world;
  const auto at = [&](double z) {
    return pose_from_xyz_rpy({rng.uniform(-1.1, 1.1), rng.uniform(-1.1, 1.1), z},
                             {rng.uniform(-3, 3), rng.uniform(-3, 3), rng.uniform(-3, 3)});
  };
  world.add("floor", Plane{Eigen::Vector3d::UnitZ(), 0}, shifted(0, 0, rng.uniform(-0.3, -0.05)));
  world.add("box", Box{{0.4, 0.2, 0.3}}, at(0));
  world.add("ball", Sphere{0.15}, at(0.1));
  world.add("mesh", MeshShape{shape_mesh(Cylinder{0.1, 0.4})}, at(0));
  auto cells = std::make_shared<std::vector<Eigen::Vector3d>>();
  for (int i = 0; i < 6; ++i) cells->push_back({0.05 * i, 0, 0});
  world.add("cells", Voxels{cells, 0.05}, at(0));
  world.add("can", Cylinder{0.03, 0.1}, shifted(5, 5, 5));
  world.attach("can", "hand", shifted(0.1, 0, 0));
  return world;
}

TEST(AllowedCollisions, ARobotStandsOnItsTable) {
  World world;
  world.add("table", Box{{2, 2, 0.2}}, shifted(0, 0, -0.199));  // its top is a millimetre above the base's bottom
  CollisionChecker touching(robot().group("arm_group"), world);
  ASSERT_EQ(touching.rejection(vec(0, 0)), Rejection::scene);
  world.allow("table", "base");
  EXPECT_EQ(world.allowed(), (std::set<World::NamePair>{{"base", "table"}}));
  CollisionChecker checker(robot().group("arm_group"), world);
  EXPECT_EQ(checker.rejection(vec(0, 0)), Rejection::none);
  EXPECT_TRUE(checker.contacts(vec(0, 0)).empty());
  world.disallow("base", "table");
  EXPECT_TRUE(world.allowed().empty());
  EXPECT_THROW(world.disallow("base", "table"), InvalidInput);
}

/// All answers are those of a checker without the pairs, its contacts and distances with the allowed pairs taken out.
TEST(AllowedCollisions, EveryQueryLeavesThemOut) {
  const JointGroup group = robot().group("arm_group");
  Rng rng(5);
  int left_out = 0, colliding = 0, free = 0;
  for (int scene = 0; scene < 40; ++scene) {
    World world = random_world(rng);
    CollisionChecker all(group, world);
    const std::vector<std::string> bodies{"base", "arm", "hand", "left", "right", "can"};
    std::vector<std::string> objects{"floor", "box", "ball", "mesh", "cells"};
    objects.insert(objects.end(), bodies.begin(), bodies.end());
    for (int i = 0; i < 12; ++i) world.allow(bodies[rng.index(bodies.size())], objects[rng.index(objects.size())]);
    CollisionChecker checker(group, world);
    const auto allowed = [&](const std::string& a, const std::string& b) {
      return world.allowed().count(std::minmax(a, b)) > 0;
    };
    for (int i = 0; i < 60; ++i) {
      const Eigen::VectorXd q = rng.uniform(group.lower(), group.upper());
      Pairs expected;
      for (const Contact& c : all.contacts(q)) {
        if (allowed(c.a, c.b))
          ++left_out;
        else
          expected.emplace(c.a, c.b);
      }
      EXPECT_EQ(pairs_of(checker.contacts(q)), expected);
      EXPECT_EQ(checker.is_free(q), expected.empty());
      EXPECT_EQ(checker.rejection(q) == Rejection::none, expected.empty());
      const auto first = checker.first_contact(q);
      ASSERT_EQ(first.has_value(), !expected.empty());
      if (first) {
        EXPECT_EQ(expected.count({first->a, first->b}), 1u);
      }
      (expected.empty() ? free : colliding)++;
      double nearest = 0.5;
      for (const DistanceResult& d : all.distances(q, 0.5)) {
        if (!allowed(d.a, d.b)) nearest = std::min(nearest, d.value);
      }
      if (nearest < 0.5) {
        EXPECT_NEAR(checker.distance(q).value, nearest, 1e-9);
      }
      const Eigen::VectorXd to = q + rng.uniform(vec(-0.3, -0.3), vec(0.3, 0.3));
      bool edge_free = true;
      for (int k = 0; k <= 40; ++k) edge_free = edge_free && checker.is_free(q + k / 40.0 * (to - q));
      EdgeOptions options;
      options.joint_step = (to - q).cwiseAbs().maxCoeff() / 40;
      if (edge_free && group.within_limits(to, 0)) {
        EXPECT_TRUE(check_edge(checker, q, to, options).free);
      }
      options.continuous = true;
      if (!edge_free) {
        EXPECT_FALSE(check_edge(checker, q, to, options).free);
      }
    }
  }
  EXPECT_GT(left_out, 200);
  EXPECT_GT(colliding, 200);
  EXPECT_GT(free, 100);
}

TEST(AllowedCollisions, AGroupIsAllItsLinks) {
  World world;
  world.add("can", Sphere{0.5}, shifted(0.65, 0, 0));
  const auto touching = [&] {
    Pairs pairs;
    for (const auto& [a, b] : pairs_of(CollisionChecker(robot().group("arm_group"), world).contacts(vec(0, 0))))
      pairs.emplace(a, b);
    return pairs;
  };
  EXPECT_EQ(touching(), (Pairs{{"arm", "can"}, {"hand", "can"}, {"left", "can"}, {"right", "can"}}));
  world.allow("fingers", "can");
  EXPECT_EQ(touching(), (Pairs{{"arm", "can"}, {"hand", "can"}}));
  world.allow("all_of_hand", "can");
  EXPECT_EQ(touching(), (Pairs{{"arm", "can"}}));
  world.disallow("fingers", "can");
  world.disallow("all_of_hand", "can");
  world.allow("arm_group", "can");
  EXPECT_EQ(touching(), (Pairs{{"left", "can"}, {"right", "can"}}));
}

TEST(AllowedCollisions, NamesAreCheckedByTheChecker) {
  World world;
  world.allow("base", "table");  // before the object
  EXPECT_NE(refusal(world).find("'table'"), std::string::npos) << refusal(world);
  world.add("table", Box{{2, 2, 0.2}}, shifted(0, 0, -0.2));
  EXPECT_EQ(refusal(world), "");
  world.allow("table", "bse");
  EXPECT_NE(refusal(world).find("did you mean \"base\""), std::string::npos) << refusal(world);
  world.forget("bse");
  world.allow("tabel", "base");
  EXPECT_NE(refusal(world).find("did you mean \"table\""), std::string::npos) << refusal(world);
  world.forget("tabel");
  world.remove("table");
  EXPECT_TRUE(world.allowed().empty());
  EXPECT_EQ(refusal(world), "");
  EXPECT_THROW(world.allow("", "base"), InvalidInput);
}

TEST(AllowedCollisions, HoldForAnObjectInTheHandToo) {
  World world;
  world.add("part", Box{{0.05, 0.05, 0.05}}, shifted(0.6, 0, 0));
  world.add("tray", Box{{2, 2, 0.02}}, shifted(0, 0, -0.034));  // the part goes into it, and the base through it
  world.allow("part", "tray");
  world.allow("base", "tray");
  world.attach("part", "hand", shifted(0.1, 0, 0));
  CollisionChecker checker(robot().group("arm_group"), world);
  EXPECT_EQ(pairs_of(checker.contacts(vec(0.3, 0.2))), (Pairs{{"arm", "tray"}, {"hand", "tray"}}));
  world.move("tray", shifted(0, 0, -0.0351));
  detail::AttachedChecker placed(robot().group("arm_group"), world);
  EXPECT_TRUE(placed.is_free(vec(0.3, 0.2)));
  placed.place_attached(shifted(0.1, 0, -0.01));
  EXPECT_TRUE(placed.is_free(vec(0.3, 0.2)));
  world.disallow("part", "tray");
  detail::AttachedChecker strict(robot().group("arm_group"), world);
  strict.place_attached(shifted(0.1, 0, -0.01));
  EXPECT_FALSE(strict.is_free(vec(0.3, 0.2)));
}

}  // namespace
}  // namespace mmgrasp
