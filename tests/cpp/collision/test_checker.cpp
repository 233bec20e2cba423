#include "mmgrasp/collision/checker.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/concave_box.hpp"
#include "support/fcl_reference.hpp"
#include "support/free_body.hpp"

using namespace mmgrasp;

namespace {

Eigen::VectorXd at(double x, double y, double z, double yaw = 0) {
  Eigen::VectorXd q(6);
  q << x, y, z, yaw, 0, 0;
  return q;
}

Pose shifted(double x, double y, double z) {
  return pose_from_xyz_rpy({x, y, z}, {0, 0, 0});
}

MeshShape opened(const MeshShape& shape) {
  auto triangles = shape.mesh->triangles;
  triangles.pop_back();
  return {make_mesh(shape.mesh->vertices, triangles)};
}

CollisionChecker make_checker(const Shape& body, const Shape& object, const Pose& T,
                              const CheckerOptions& options = {}) {
  World world;
  world.add("object", object, T);
  return CollisionChecker(free_body::group({free_body::link_shape(body)}), world, options);
}

// A base with a two-link arm and a two-finger gripper declared as an end effector.
const char* kGripperUrdf = R"(<robot name="r">
  <link name="base"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <link name="arm"><collision><origin xyz="0.3 0 0"/><geometry><box size="0.3 0.05 0.05"/></geometry></collision></link>
  <link name="hand"><collision><geometry><box size="0.05 0.2 0.05"/></geometry></collision></link>
  <link name="left"><collision><origin xyz="0.05 0 0"/><geometry><box size="0.1 0.02 0.02"/></geometry></collision></link>
  <link name="right"><collision><origin xyz="0.05 0 0"/><geometry><box size="0.1 0.02 0.02"/></geometry></collision></link>
  <link name="tcp"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
  <joint name="wrist" type="revolute"><parent link="arm"/><child link="hand"/><origin xyz="0.5 0 0"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
  <joint name="l" type="prismatic"><parent link="hand"/><child link="left"/><axis xyz="0 1 0"/><origin xyz="0.03 0.04 0"/><limit lower="0" upper="0.05" velocity="1" effort="1"/></joint>
  <joint name="r" type="prismatic"><parent link="hand"/><child link="right"/><axis xyz="0 -1 0"/><origin xyz="0.03 -0.04 0"/><limit lower="0" upper="0.05" velocity="1" effort="1"/><mimic joint="l"/></joint>
  <joint name="tcp_joint" type="fixed"><parent link="hand"/><child link="tcp"/><origin xyz="0.08 0 0"/></joint>
</robot>)";
const char* kGripperSrdf = R"(<robot name="r">
  <group name="arm"><chain base_link="base" tip_link="hand"/></group>
  <group name="gripper"><joint name="l"/></group>
  <end_effector name="gripper" parent_link="hand" group="gripper"/>
  <disable_collisions link1="base" link2="arm" reason="Adjacent"/><disable_collisions link1="arm" link2="hand" reason="Adjacent"/>
  <disable_collisions link1="hand" link2="left" reason="Adjacent"/><disable_collisions link1="hand" link2="right" reason="Adjacent"/>
</robot>)";

}  // namespace

TEST(Checker, ClosedMeshesAreSolids) {
  const MeshShape big = test::concave_box({2, 2, 2}), small = test::concave_box({0.1, 0.1, 0.1});
  ASSERT_TRUE(big.mesh->closed);
  ASSERT_FALSE(big.mesh->convex);
  const Shape inner[] = {Box{{0.1, 0.1, 0.1}}, Sphere{0.1}, Cylinder{0.1, 0.1},
                         Capsule{0.1, 0.1},    small,       opened(small)};
  for (const Shape& body : inner) {
    CollisionChecker inside = make_checker(body, big, shifted(0, 0, 0));
    EXPECT_EQ(inside.rejection(at(0.3, 0.2, -0.5)), Rejection::scene) << shape_kind(body);
    EXPECT_EQ(inside.rejection(at(0.3, 0.2, 5)), Rejection::none) << shape_kind(body);
    EXPECT_EQ(inside.rejection(at(0, 0, 0.9)), Rejection::none) << "in the concavity, " << shape_kind(body);
    // And the other way round: the robot's link is the big one.
    CollisionChecker around = make_checker(big, body, shifted(0, 0, 0));
    EXPECT_EQ(around.rejection(at(-0.3, -0.2, 0.5)), Rejection::scene) << shape_kind(body);
    // An open mesh is a surface: what is within does not touch it.
    CollisionChecker open = make_checker(body, opened(big), shifted(0, 0, 0));
    EXPECT_EQ(open.rejection(at(0.3, 0.2, -0.5)), Rejection::none) << shape_kind(body);
  }
  // Convex bodies hold each other without any of it.
  EXPECT_FALSE(
      make_checker(Box{{0.1, 0.1, 0.1}}, MeshShape{shape_mesh(Box{{2, 2, 2}})}, shifted(0, 0, 0)).is_free(at(0, 0, 0)));
}

TEST(Checker, BoxesTouchWhereTheirFacesMeet) {
  CollisionChecker checker = make_checker(Box{{1, 1, 1}}, Box{{1, 1, 1}}, shifted(0, 0, 0));
  CollisionChecker sphere = make_checker(Sphere{0.5}, Box{{1, 1, 1}}, shifted(0, 0, 0));
  CollisionChecker plane = make_checker(Cylinder{0.5, 1}, Plane{Eigen::Vector3d::UnitZ(), 0.25}, shifted(0, 0, 0));
  for (const double clearance : {1e-6, 1e-8}) {
    EXPECT_TRUE(checker.is_free(at(1 + clearance, 0, 0)));
    EXPECT_FALSE(checker.is_free(at(1 - clearance, 0, 0)));
    const double corner = 0.5 + 0.5 / std::sqrt(3.0);
    EXPECT_TRUE(sphere.is_free(at(corner + clearance, corner + clearance, corner + clearance)));
    EXPECT_FALSE(sphere.is_free(at(corner - clearance, corner - clearance, corner - clearance)));
    EXPECT_TRUE(plane.is_free(at(3, 4, 0.75 + clearance)));
    EXPECT_FALSE(plane.is_free(at(3, 4, 0.75 - clearance)));
    // Edge against edge: the box turned by 45 degrees about z.
    EXPECT_TRUE(checker.is_free(at(0.5 + std::sqrt(0.5) + clearance, 0, 0, M_PI / 4)));
    EXPECT_FALSE(checker.is_free(at(0.5 + std::sqrt(0.5) - clearance, 0, 0, M_PI / 4)));
  }
}

TEST(Checker, FclAgreesJustBeforeAndAfterContact) {
  // Bisects to where the answer changes and asks FCL on both sides of it, well outside the band.
  const Shape shapes[] = {Box{{0.3, 0.2, 0.5}}, Sphere{0.2}, Cylinder{0.15, 0.4}, Capsule{0.1, 0.4},
                          test::concave_box({0.4, 0.3, 0.5})};
  Rng rng(3);
  int judged = 0;
  for (const Shape& body : shapes) {
    for (const Shape& object : shapes) {
      CollisionChecker checker = make_checker(body, object, shifted(0, 0, 0));
      const auto a = fcl_reference::make_body(body), b = fcl_reference::make_body(object);
      for (int i = 0; i < 20; ++i) {
        Eigen::VectorXd q(6);
        const Eigen::Vector3d direction = Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
        q << Eigen::Vector3d::Zero(), rng.uniform(-3, 3), rng.uniform(-3, 3), rng.uniform(-3, 3);
        double near = 0, far = 2;
        while (far - near > 1e-10) {
          q.head<3>() = 0.5 * (near + far) * direction;
          (checker.is_free(q) ? far : near) = 0.5 * (near + far);
        }
        // Moving by 2e-5 along the direction opens the clearance by 2e-5 times the cosine to the contact's normal.
        q.head<3>() = (far + 2e-5) * direction;
        const bool out = fcl_reference::touch(a, free_body::pose(q), b, Pose::Identity());
        const double clearance = checker.distance(q).value;
        q.head<3>() = (near - 2e-5) * direction;
        const bool in = fcl_reference::touch(a, free_body::pose(q), b, Pose::Identity());
        if (clearance < 4e-6) continue;  // grazing
        EXPECT_FALSE(out) << shape_kind(body) << " " << shape_kind(object);
        EXPECT_TRUE(in) << shape_kind(body) << " " << shape_kind(object);
        ++judged;
      }
    }
  }
  EXPECT_GT(judged, 400);
}

TEST(Checker, PaddingGrowsTheRobotOnly) {
  CheckerOptions options;
  options.padding = 0.1;
  const Shape bodies[] = {Box{{1, 1, 1}}, Cylinder{0.5, 1}, MeshShape{shape_mesh(Box{{1, 1, 1}})},
                          test::concave_box({1, 1, 1})};
  for (const Shape& body : bodies) {
    CollisionChecker checker = make_checker(body, Box{{1, 1, 1}}, shifted(0, 0, 0), options);
    EXPECT_TRUE(checker.is_free(at(0, 0, -1.1 - 1e-6))) << shape_kind(body);
    EXPECT_FALSE(checker.is_free(at(0, 0, -1.1 + 1e-6))) << shape_kind(body);
    EXPECT_NEAR(checker.distance(at(0, 0, -1.2)).value, 0.2, 1e-9) << shape_kind(body);
  }
  CollisionChecker sphere = make_checker(Sphere{0.5}, Sphere{0.5}, shifted(0, 0, 0), options);
  EXPECT_TRUE(sphere.is_free(at(1.1 + 1e-9, 0, 0)));
  EXPECT_FALSE(sphere.is_free(at(1.1 - 1e-9, 0, 0)));
  options.padding = -1;
  EXPECT_THROW(make_checker(Sphere{0.5}, Sphere{0.5}, shifted(0, 0, 0), options), InvalidInput);
}

TEST(Checker, DistanceInClosedForm) {
  CollisionChecker spheres = make_checker(Sphere{0.5}, Sphere{0.25}, shifted(1, 2, 3));
  const DistanceResult d = spheres.distance(at(4, 6, 3));
  EXPECT_NEAR(d.value, 5 - 0.75, 1e-12);
  EXPECT_EQ(d.a, "body");
  EXPECT_EQ(d.b, "object");
  EXPECT_TRUE(d.point_a.isApprox(Eigen::Vector3d(4 - 0.3, 6 - 0.4, 3), 1e-9));
  EXPECT_TRUE(d.point_b.isApprox(Eigen::Vector3d(1 + 0.15, 2 + 0.2, 3), 1e-9));
  EXPECT_NEAR(spheres.distance(at(1, 2.5, 3)).value, -0.25, 1e-9);
  CollisionChecker boxes = make_checker(Box{{1, 1, 1}}, Box{{1, 1, 1}}, shifted(0, 0, 0));
  EXPECT_NEAR(boxes.distance(at(4, 5, 0)).value, 5, 1e-12);
  EXPECT_NEAR(boxes.distance(at(0.9, 0.1, 0.2)).value, -0.1, 1e-9);
  CollisionChecker plane = make_checker(Capsule{0.5, 1}, Plane{Eigen::Vector3d::UnitZ(), 1}, shifted(0, 0, 1));
  EXPECT_NEAR(plane.distance(at(0, 0, 5)).value, 2, 1e-12);
  EXPECT_EQ(CollisionChecker(free_body::group({free_body::link_shape(Sphere{1})}), World()).distance(at(0, 0, 0)).value,
            std::numeric_limits<double>::infinity());
}

TEST(Checker, AttachedObjectsTouchTheirGripperAndNothingElse) {
  const Robot robot = Robot::from_strings(kGripperUrdf, kGripperSrdf);
  const JointGroup arm = robot.group("arm");
  Eigen::VectorXd q(2);
  q << 0, 0;
  World world;
  world.add("part", Box{{0.1, 0.08, 0.02}}, shifted(0.6, 0, 0));
  EXPECT_EQ(CollisionChecker(arm, world).rejection(q), Rejection::scene);
  world.attach("part", "tcp", Pose::Identity());  // overlaps hand and both fingers: all of the end effector
  CollisionChecker attached(arm, world);
  EXPECT_EQ(attached.rejection(q), Rejection::none);
  EXPECT_TRUE(attached.contacts(q).empty());
  // The arm folded back: the part hits the base, the hand does not yet.
  q << 0, 2.9;
  World bar = world;
  bar.remove("part");
  bar.add("part", Box{{0.9, 0.16, 0.02}}, shifted(0, 0, 0));
  bar.attach("part", "tcp", Pose::Identity());
  CollisionChecker folded(arm, bar);
  EXPECT_EQ(folded.rejection(q), Rejection::self_collision);
  bool base = false;
  for (const Contact& c : folded.contacts(q)) base = base || (c.a == "base" && c.b == "part" && !c.with_scene);
  EXPECT_TRUE(base);
  // Explicit touch links replace the default: the fingers are then hit.
  World strict;
  strict.add("part", Box{{0.1, 0.12, 0.02}}, shifted(0, 0, 0));
  strict.attach("part", "tcp", Pose::Identity(), {"hand"});
  q << 0, 0;
  EXPECT_EQ(CollisionChecker(arm, strict).rejection(q), Rejection::self_collision);
  strict.detach("part", shifted(9, 9, 9));
  EXPECT_EQ(CollisionChecker(arm, strict).rejection(q), Rejection::none);
  // Attached part against the scene.
  world.add("wall", Box{{0.1, 1, 1}}, shifted(0.675, 0, 0));
  CollisionChecker walled(arm, world);
  EXPECT_EQ(walled.rejection(q), Rejection::scene);
  bool wall = false;
  for (const Contact& c : walled.contacts(q)) wall = wall || (c.a == "part" && c.b == "wall" && c.with_scene);
  EXPECT_TRUE(wall);
}

TEST(Checker, OpeningTheFingersKeepsTheChecker) {
  const Robot robot = Robot::from_strings(kGripperUrdf, kGripperSrdf);
  const JointGroup arm = robot.group("arm");
  World world;
  world.add("post", Box{{0.02, 0.02, 0.2}}, shifted(0.6, 0.085, 0));
  CollisionChecker closed(arm, world);
  const CollisionChecker& ref = closed;
  CollisionChecker open = ref.with_group(arm.with_reference(robot.values({{"l", 0.05}})));
  Eigen::VectorXd q(2);
  q << 0, 0;
  EXPECT_EQ(closed.rejection(q), Rejection::none);  // finger at y = 0.04
  EXPECT_EQ(open.rejection(q), Rejection::scene);   // finger at y = 0.09
  const Robot other = Robot::from_strings(kGripperUrdf, kGripperSrdf);
  EXPECT_THROW(closed.with_group(other.group("arm")), InvalidInput);
}

TEST(Checker, CausesComeInOrder) {
  const Robot robot = Robot::from_strings(kGripperUrdf, kGripperSrdf);
  World world;
  world.add("everything", Sphere{5}, Pose::Identity());
  CollisionChecker checker(robot.group("arm"), world);
  Eigen::VectorXd q(2);
  q << 3.1, 2.99;
  EXPECT_EQ(checker.rejection(q), Rejection::limits);
  q << 0, 2.99;  // fingers reach back to the arm
  EXPECT_EQ(checker.rejection(q), Rejection::self_collision);
  q << 0, 0;
  EXPECT_EQ(checker.rejection(q), Rejection::scene);
  EXPECT_EQ(checker.queries(), 3u);
  CheckerOptions options;
  options.check_scene = false;
  EXPECT_TRUE(CollisionChecker(robot.group("arm"), world, options).is_free(q));
}

TEST(Checker, EdgesSeeThinWallsBetweenFreeEnds) {
  CollisionChecker checker = make_checker(Sphere{0.02}, Box{{0.01, 2, 2}}, shifted(0.37, 0, 0));
  EXPECT_TRUE(checker.is_free(at(-1, 0, 0)));
  EXPECT_TRUE(checker.is_free(at(1, 0, 0)));
  EXPECT_FALSE(checker.edge_is_free(at(-1, 0, 0), at(1, 0, 0)));
  EXPECT_TRUE(checker.edge_is_free(at(-1, 0, 0), at(0.34, 0.5, 0)));
  EXPECT_FALSE(checker.edge_is_free(at(0.37, 0, 0), at(0.37, 0, 0)));
  // Every step is checked: 100 of them with both ends make 101 configurations.
  const std::size_t before = checker.queries();
  EXPECT_TRUE(checker.edge_is_free(at(-1, 0, 0), at(-1, 2, 0), 0.02));
  EXPECT_EQ(checker.queries() - before, 101u);
  // A wall thinner than a step, where only one sample of the fine grid hits it.
  int found = 0;
  for (int i = 0; i < 100; ++i) {
    CollisionChecker thin = make_checker(Sphere{0.005}, Box{{0.001, 2, 2}}, shifted(-0.99 + 0.0198 * i, 0, 0));
    found += !thin.edge_is_free(at(-1, 0, 0), at(1, 0, 0), 0.01);
  }
  EXPECT_EQ(found, 100);
  EXPECT_THROW(checker.edge_is_free(at(0, 0, 0), at(1, 0, 0), 0), InvalidInput);
}

TEST(Checker, BadInputIsNamed) {
  CollisionChecker checker = make_checker(Sphere{0.1}, Sphere{0.1}, shifted(1, 0, 0));
  EXPECT_THROW(checker.rejection(Eigen::VectorXd::Zero(5)), InvalidInput);
  Eigen::VectorXd q = at(0, 0, 0);
  q[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(checker.rejection(q), InvalidInput);
  EXPECT_THROW(checker.is_free(q), InvalidInput);
  EXPECT_THROW(checker.distance(q), InvalidInput);
  EXPECT_THROW(checker.contacts(q), InvalidInput);
  World world;
  world.add("part", Sphere{0.1}, Pose::Identity());
  world.attach("part", "gripper_of_another_robot", Pose::Identity());
  try {
    CollisionChecker(checker.group(), world);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("gripper_of_another_robot"), std::string::npos);
  }
}

TEST(Checker, FirstContactIsOneOfAll) {
  const Robot robot = Robot::from_strings(kGripperUrdf, kGripperSrdf);
  World world;
  world.add("left wall", Box{{0.1, 1, 1}}, shifted(0.62, 0.3, 0));
  world.add("right wall", Box{{0.1, 1, 1}}, shifted(0.62, -0.8, 0));
  CollisionChecker checker(robot.group("arm"), world);
  Rng rng(12);
  int self = 0, scene = 0, none = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::VectorXd q = rng.uniform(checker.group().lower(), checker.group().upper());
    const std::vector<Contact> all = checker.contacts(q);
    const std::optional<Contact> first = checker.first_contact(q);
    ASSERT_EQ(first.has_value(), !all.empty());
    if (!first) {
      ++none;
      continue;
    }
    bool listed = false, any_self = false;
    for (const Contact& c : all) {
      listed = listed || (c.a == first->a && c.b == first->b && c.with_scene == first->with_scene);
      any_self = any_self || !c.with_scene;
    }
    ASSERT_TRUE(listed) << first->a << " " << first->b;
    ASSERT_EQ(first->with_scene, !any_self);
    ++(any_self ? self : scene);
  }
  EXPECT_GT(self, 20);
  EXPECT_GT(scene, 20);
  EXPECT_GT(none, 20);
}

TEST(Checker, DetachPutsBackAndRemoveTakesAway) {
  const Robot robot = Robot::from_strings(kGripperUrdf, kGripperSrdf);
  Eigen::VectorXd q(2);
  q << 0, 0;
  World attached;
  attached.add("part", Box{{0.1, 0.08, 0.02}}, shifted(0.6, 0, 0));
  attached.attach("part", "tcp", Pose::Identity());
  World detached = attached, removed = attached;
  detached.detach("part", shifted(0.6, 0, 0));  // where the hand is: now it is an obstacle
  removed.remove("part");
  EXPECT_EQ(CollisionChecker(robot.group("arm"), attached).rejection(q), Rejection::none);
  EXPECT_EQ(CollisionChecker(robot.group("arm"), detached).rejection(q), Rejection::scene);
  EXPECT_EQ(CollisionChecker(robot.group("arm"), removed).rejection(q), Rejection::none);
  EXPECT_FALSE(removed.has("part"));
  EXPECT_TRUE(detached.has("part"));
}
