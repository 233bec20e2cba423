#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/detail/attached_checker.hpp"
#include "mmgrasp/collision/edge.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/concave_box.hpp"
#include "support/free_body.hpp"

namespace mmgrasp {
namespace {

Eigen::VectorXd at(double x, double y, double z) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(6);
  q.head<3>() << x, y, z;
  return q;
}

Pose shifted(double x, double y, double z) {
  return pose_from_xyz_rpy({x, y, z}, {0, 0, 0});
}

Padding padding(double links, double attached, double objects) {
  Padding out;
  out.links = links;
  out.attached = attached;
  out.objects = objects;
  return out;
}

Shape row_of_cells() {
  auto cells = std::make_shared<std::vector<Eigen::Vector3d>>();
  for (int i = 0; i < 8; ++i) cells->push_back({0.1 * i, i == 3 ? 0.1 : 0.0, 0});
  return Voxels{cells, 0.1};
}

/// Whatever grows like a sphere (all but boxes, cylinders and their corners) collides exactly where the distance is the
/// sum of the paddings.
TEST(Padding, IsADistanceThatIsKept) {
  const Shape links[] = {Sphere{0.2}, Capsule{0.1, 0.3}, test::concave_box(Eigen::Vector3d::Constant(0.4)),
                         MeshShape{shape_mesh(Box{{0.3, 0.2, 0.4}})}};
  const Shape objects[] = {Sphere{0.3},
                           Capsule{0.1, 0.5},
                           test::concave_box(Eigen::Vector3d::Constant(0.5)),
                           row_of_cells(),
                           Plane{Eigen::Vector3d::UnitZ(), 0},
                           MeshShape{shape_mesh(Box{{0.3, 0.5, 0.4}})}};
  Rng rng(2);
  int free = 0, colliding = 0, by_padding = 0;
  for (const Shape& link : links) {
    for (const Shape& object : objects) {
      World world;
      world.add("object", object, shifted(0.1, -0.2, 0.3));
      const JointGroup group = free_body::group({free_body::link_shape(link)});
      CollisionChecker bare(group, world);
      world.set_padding(padding(0.04, 0, 0.03));
      CollisionChecker padded(group, world);
      for (int i = 0; i < 150; ++i) {
        Eigen::VectorXd q(6);
        for (int k = 0; k < 3; ++k) q[k] = rng.uniform(-0.8, 0.8);
        for (int k = 3; k < 6; ++k) q[k] = rng.uniform(-3, 3);
        const double distance = bare.distance(q).value;
        EXPECT_EQ(padded.distance(q).value, distance) << "padding is not subtracted";
        if (std::abs(distance - 0.07) < 1e-6 || std::abs(distance) < 1e-6) continue;
        const bool expected = distance > 0.07;
        ASSERT_EQ(padded.is_free(q), expected) << shape_kind(link) << " " << shape_kind(object) << " " << distance;
        ASSERT_EQ(padded.contacts(q).empty(), expected);
        if (!expected) {
          EXPECT_EQ(padded.contacts(q)[0].by_padding, distance > 0);
          EXPECT_EQ(padded.first_contact(q)->by_padding, distance > 0);
          by_padding += distance > 0;
        }
        (expected ? free : colliding)++;
        // Edges look at their states in other ways.
        const Eigen::VectorXd to = q + Eigen::VectorXd::Constant(6, 0.05);
        bool edge = true;
        for (int k = 0; k <= 20; ++k) edge = edge && padded.is_free(q + k / 20.0 * (to - q));
        EXPECT_EQ(padded.edge_is_free(q, to, 0.05 / 20), edge) << shape_kind(link) << " " << shape_kind(object);
        EdgeOptions continuous;
        continuous.continuous = true;
        if (!edge) {
          EXPECT_FALSE(check_edge(padded, q, to, continuous).free);
        }
      }
    }
  }
  EXPECT_GT(free, 500);
  EXPECT_GT(colliding, 500);
  EXPECT_GT(by_padding, 100);
}

TEST(Padding, BodiesThatJustTouchAndNamesThatOverride) {
  World world;
  world.add("box", Box{{1, 1, 1}}, shifted(0, 0, 0));
  const JointGroup group = free_body::group({free_body::link_shape(Box{{1, 1, 1}})});
  const auto free_at = [&](double distance) { return CollisionChecker(group, world).is_free(at(0, 0, 1 + distance)); };
  EXPECT_TRUE(free_at(1e-6));
  EXPECT_FALSE(free_at(-1e-6));
  world.set_padding(padding(0.1, 5, 0.02));
  EXPECT_TRUE(free_at(0.12 + 1e-6));
  EXPECT_FALSE(free_at(0.12 - 1e-6));
  Padding named = world.padding();
  named.by_name = {{"body", 0.3}, {"box", 0}};
  world.set_padding(named);
  EXPECT_TRUE(free_at(0.3 + 1e-6));
  EXPECT_FALSE(free_at(0.3 - 1e-6));
  CheckerOptions options;
  options.padding = 0.4;  // at least this
  EXPECT_FALSE(CollisionChecker(group, world, options).is_free(at(0, 0, 1.35)));
  options.padding = 0.2;
  EXPECT_TRUE(CollisionChecker(group, world, options).is_free(at(0, 0, 1.35)));
  named.by_name = {{"bodi", 0.3}};
  world.set_padding(named);
  try {
    CollisionChecker checker(group, world);
    ADD_FAILURE() << "an unknown name was taken";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"body\""), std::string::npos) << error.what();
  }
  EXPECT_THROW(world.set_padding(padding(-0.1, 0, 0)), InvalidInput);
  named.by_name = {{"body", NAN}};
  EXPECT_THROW(world.set_padding(named), InvalidInput);
}

/// Attached things are grown against the scene, and neither they nor links against each other.
TEST(Padding, OfWhatIsHeldActsAgainstTheSceneOnly) {
  const Robot robot = Robot::from_strings(R"(<robot name="r">
    <link name="base"><collision><geometry><box size="1 1 0.2"/></geometry></collision></link>
    <link name="middle"><collision><geometry><sphere radius="0.01"/></geometry></collision></link>
    <link name="hand"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
    <joint name="x" type="prismatic"><parent link="base"/><child link="middle"/><axis xyz="1 0 0"/><limit lower="-5" upper="5" velocity="1" effort="1"/></joint>
    <joint name="z" type="prismatic"><parent link="middle"/><child link="hand"/><axis xyz="0 0 1"/><limit lower="0" upper="5" velocity="1" effort="1"/></joint>
    </robot>)",
                                          "<robot name='r'><group name='both'><link name='base'/><link name='hand'/>"
                                          "</group></robot>");
  const JointGroup group = robot.chain("base", "hand");
  World world;
  world.add("can", Sphere{0.1}, shifted(0, 0, 0));
  world.attach("can", "hand", shifted(0, 0, 0.5), {"hand"});
  world.add("wall", Box{{1, 1, 1}}, shifted(1.5, 0, 2.5));
  const auto free_at = [&](double x, double z) {
    const Eigen::VectorXd q = Eigen::Vector2d(x, z);
    const bool free = CollisionChecker(group, world).is_free(q);
    EXPECT_EQ(detail::AttachedChecker(group, world).is_free(q), free);
    return free;
  };
  world.set_padding(padding(0.05, 0.2, 0));
  EXPECT_TRUE(free_at(0, 0.2 + 1e-6));  // the hand just above the base: no padding within the robot
  EXPECT_FALSE(free_at(0, 0.2 - 1e-6));
  EXPECT_TRUE(free_at(0.7 - 1e-6, 2));  // can (0.1 + 0.2) beside the wall
  EXPECT_FALSE(free_at(0.7 + 1e-6, 2));
  EXPECT_TRUE(free_at(0.85 - 1e-6, 3));  // hand (0.1 + 0.05) beside the wall, the can above it
  EXPECT_FALSE(free_at(0.85 + 1e-6, 3));
  Padding of_group;
  of_group.by_name = {{"both", 0.15}, {"can", 0.01}};
  world.set_padding(of_group);
  EXPECT_TRUE(free_at(0.75 - 1e-6, 3));
  EXPECT_FALSE(free_at(0.75 + 1e-6, 3));
  of_group.by_name["hand"] = 0.02;  // a link's own goes before its group's
  world.set_padding(of_group);
  EXPECT_TRUE(free_at(0.88 - 1e-6, 3));
  EXPECT_FALSE(free_at(0.88 + 1e-6, 3));
}

TEST(Padding, IsNamedAsTheReason) {
  World world;
  world.add("box", Box{{1, 1, 1}}, shifted(0, 0, 0));
  world.set_padding(padding(0.1, 0, 0));
  CollisionChecker checker(free_body::group({free_body::link_shape(Box{{1, 1, 1}})}), world);
  EXPECT_EQ(describe(*checker.first_contact(at(0, 0, 1.05))), "'body' comes closer to 'box' than their padding");
  EXPECT_EQ(describe(*checker.first_contact(at(0, 0, 0.95))), "'body' touches 'box'");
}

}  // namespace
}  // namespace mmgrasp
