#include <gtest/gtest.h>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/edge.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/small_robots.hpp"

// A checker of what is attached alone must say what the whole checker says about it.
namespace mmgrasp {
namespace {

struct AttachedBox {
  Robot robot = Robot::from_strings(test::seven_joint_urdf(), "");
  JointGroup group = robot.chain(robot.links().front().name, robot.links().back().name);
  World world;
  AttachedBox() {
    Pose T = Pose::Identity();
    T.translation() = Eigen::Vector3d(0.5, 0.1, 0.4);
    world.add("table", Shape(Box{{0.5, 0.8, 0.05}}), T);
    T.translation() = Eigen::Vector3d(-0.4, 0.3, 0.8);
    world.add("ball", Shape(Sphere{0.2}), T);
    T.translation() = Eigen::Vector3d(0, 0, -0.3);
    world.add("floor", Shape(Plane{}), T);
    world.add("part", Shape(Box{{0.05, 0.4, 0.05}}), Pose::Identity());
    T.translation() = Eigen::Vector3d(0, 0, 0.08);
    world.attach("part", robot.links().back().name, T);
  }
};

CheckerOptions attached_only() {
  CheckerOptions options;
  options.attached_only = true;
  return options;
}

TEST(AttachedOnly, ContactsAreThoseOfTheAttachedObject) {
  const AttachedBox scene;
  CollisionChecker whole(scene.group, scene.world), attached(scene.group, scene.world, attached_only());
  Rng rng(3);
  int touching = 0, robot_alone = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::VectorXd q = rng.uniform(scene.group.sample_lower(), scene.group.sample_upper());
    std::vector<std::string> expected, found;
    for (const Contact& c : whole.contacts(q))
      if (c.a == "part" || c.b == "part") expected.push_back(c.a + "/" + c.b);
    for (const Contact& c : attached.contacts(q)) found.push_back(c.a + "/" + c.b);
    EXPECT_EQ(found, expected);
    EXPECT_EQ(attached.is_free(q), expected.empty());
    EXPECT_EQ(attached.rejection(q) == Rejection::none, expected.empty());
    EXPECT_EQ(attached.first_contact(q).has_value(), !expected.empty());
    touching += expected.empty() ? 0 : 1;
    robot_alone += expected.empty() && !whole.is_free(q) ? 1 : 0;
  }
  EXPECT_GT(touching, 200);
  EXPECT_GT(robot_alone, 200);  // the robot collides, but what it holds does not
}

TEST(AttachedOnly, DistanceIsThatOfTheAttachedObject) {
  const AttachedBox scene;
  CollisionChecker whole(scene.group, scene.world), attached(scene.group, scene.world, attached_only());
  Rng rng(4);
  for (int i = 0; i < 200; ++i) {
    const Eigen::VectorXd q = rng.uniform(scene.group.sample_lower(), scene.group.sample_upper());
    double expected = 1e9;
    for (const DistanceResult& d : whole.distances(q, 10))
      if (d.a == "part" || d.b == "part") expected = std::min(expected, d.value);
    EXPECT_NEAR(attached.distance(q).value, expected, 1e-9);
  }
}

TEST(AttachedOnly, EdgesAreStoppedByTheAttachedObjectAlone) {
  const AttachedBox scene;
  CollisionChecker whole(scene.group, scene.world), attached(scene.group, scene.world, attached_only());
  Rng rng(5);
  int blocked = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::VectorXd a = rng.uniform(scene.group.sample_lower(), scene.group.sample_upper());
    const Eigen::VectorXd b = a + 0.2 * (rng.uniform(scene.group.sample_lower(), scene.group.sample_upper()) - a);
    bool expected = true;
    const int pieces = static_cast<int>(std::ceil((b - a).cwiseAbs().maxCoeff() / 0.02 - 1e-9));
    for (int k = 0; k <= pieces && expected; ++k) expected = attached.contacts(a + (b - a) * k / pieces).empty();
    EXPECT_EQ(attached.edge_is_free(a, b, 0.02), expected);
    EdgeOptions continuous;
    continuous.continuous = true;
    const bool proven = check_edge(attached, a, b, continuous).free;
    EXPECT_TRUE(expected || !proven);
    blocked += expected ? 0 : 1;
  }
  EXPECT_GT(blocked, 30);
}

}  // namespace
}  // namespace mmgrasp
