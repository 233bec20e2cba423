// Planar and floating joints as columns of a checker's group.

#include <gtest/gtest.h>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/edge.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/fcl_reference.hpp"

namespace mmgrasp {
namespace {

Robot cart_and_kite() {
  return Robot::from_strings(R"(<robot name="r"><link name="root"/>
<link name="cart"><collision><geometry><box size="0.4 0.3 0.2"/></geometry></collision></link>
<link name="arm"><collision><origin xyz="0.2 0 0"/><geometry><cylinder radius="0.05" length="0.5"/></geometry></collision></link>
<link name="kite"><collision><origin xyz="0.1 0.1 0"/><geometry><box size="0.3 0.2 0.1"/></geometry></collision></link>
<joint name="floor" type="planar"><parent link="root"/><child link="cart"/><origin xyz="0.1 0 0.2" rpy="0.3 0 0.2"/>
 <axis xyz="0 0.6 0.8"/></joint>
<joint name="elbow" type="revolute"><parent link="cart"/><child link="arm"/><origin xyz="0 0 0.4"/><axis xyz="0 1 0"/>
 <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
<joint name="string" type="floating"><parent link="arm"/><child link="kite"/><origin xyz="0.3 0 0" rpy="0 0.4 0"/></joint>
</robot>)");
}

Eigen::VectorXd somewhere(const JointGroup& group, Rng& rng) {
  Eigen::VectorXd q = rng.uniform(group.sample_lower(), group.sample_upper());
  for (const int translation : {0, 1, 4, 5, 6}) q[translation] = rng.uniform(-0.8, 0.8);
  return q;
}

TEST(JointsOfSeveralValues, CollideWhereFclSaysSo) {
  const Robot robot = cart_and_kite();
  const JointGroup group = robot.chain("root", "kite");
  ASSERT_EQ(group.size(), 10);
  World world;
  Pose T = Pose::Identity();
  T.translation() << 0.4, 0.1, 0.5;
  const Shape post = Box{Eigen::Vector3d(0.3, 0.3, 0.6)};
  world.add("post", post, T);
  CollisionChecker checker(group, world);
  const fcl_reference::Body obstacle = fcl_reference::make_body(post);
  Rng rng(4);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::VectorXd q = somewhere(group, rng);
    const Poses links = robot.link_poses(group.full_values(q));
    bool touches = false, unsure = false;
    for (std::size_t a = 0; a < links.size(); ++a) {
      for (const LinkShape& shape : robot.links()[a].collisions) {
        const fcl_reference::Body body = fcl_reference::make_body(shape.shape);
        const Pose T_body = links[a] * shape.T_link_shape;
        touches = touches || fcl_reference::touch(body, T_body, obstacle, T);
        unsure = unsure || fcl_reference::on_the_edge(body, T_body, obstacle, T);
      }
    }
    const auto cart = fcl_reference::make_body(robot.links()[1].collisions[0].shape);
    const auto kite = fcl_reference::make_body(robot.links()[3].collisions[0].shape);
    const Pose T_kite = links[3] * robot.links()[3].collisions[0].T_link_shape;
    touches = touches || fcl_reference::touch(cart, links[1], kite, T_kite);
    unsure = unsure || fcl_reference::on_the_edge(cart, links[1], kite, T_kite);
    if (unsure) continue;
    hits += touches;
    EXPECT_EQ(checker.is_free(q), !touches) << q.transpose();
  }
  EXPECT_GT(hits, 200);
  EXPECT_LT(hits, 1800);
}

TEST(JointsOfSeveralValues, MoveNoPointFartherThanTheirBound) {
  const Robot robot = cart_and_kite();
  const JointGroup group = robot.chain("root", "kite");
  const CollisionChecker checker(group, World{});
  const Eigen::VectorXd bounds = motion_bounds(checker);
  const Eigen::Vector3d corner(0.25, 0.2, 0.05);  // of the kite
  Rng rng(9);
  double closest = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::VectorXd q = somewhere(group, rng);
    Eigen::VectorXd moved = q;
    const Eigen::Index column = static_cast<Eigen::Index>(rng.index(10));
    const double step = 1e-4;
    moved[column] += step;
    const auto corner_at = [&](const Eigen::VectorXd& values) {
      return robot.link_poses(group.full_values(values))[3] * corner;
    };
    const double rate = (corner_at(moved) - corner_at(q)).norm() / step;
    EXPECT_LE(rate, bounds[column] * (1 + 1e-6)) << column;
    closest = std::max(closest, rate / bounds[column]);
  }
  EXPECT_GT(closest, 0.9);  // translations are met exactly
}

}  // namespace
}  // namespace mmgrasp
