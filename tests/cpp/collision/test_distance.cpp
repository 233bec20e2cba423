// Signed distances of single bodies: values against FCL, depths against the separating axis theorem and against FCL's
// yes or no on both sides, and what must hold when the two bodies change places.

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/fcl_reference.hpp"
#include "support/free_body.hpp"

using namespace mmgrasp;

namespace {

MeshShape random_hull(unsigned seed) {
  Rng rng(seed);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 40; ++i) points.emplace_back(0.2 * rng.normal(), 0.1 * rng.normal(), 0.15 * rng.normal());
  return {convex_hull(points)};
}

// A box whose lid is pressed in towards its middle: closed, not convex.
MeshShape concave_box(const Eigen::Vector3d& size) {
  const auto box = shape_mesh(Box{size});
  std::vector<Eigen::Vector3d> v = box->vertices;
  std::vector<std::array<int, 3>> t;
  v.emplace_back(0, 0, 0.2 * size.z());
  const int pit = static_cast<int>(v.size()) - 1;
  for (const auto& c : box->triangles) {
    const bool lid = v[c[0]].z() > 0 && v[c[1]].z() > 0 && v[c[2]].z() > 0;
    if (!lid) t.push_back(c);
  }
  std::vector<int> rim;
  for (int i = 0; i < pit; ++i) {
    if (v[i].z() > 0) rim.push_back(i);
  }
  std::sort(rim.begin(), rim.end(),
            [&](int a, int b) { return std::atan2(v[a].y(), v[a].x()) < std::atan2(v[b].y(), v[b].x()); });
  for (std::size_t i = 0; i < rim.size(); ++i) t.push_back({rim[i], rim[(i + 1) % rim.size()], pit});
  return {make_mesh(v, t)};
}

Voxels stairs() {
  auto cells = std::make_shared<std::vector<Eigen::Vector3d>>();
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k <= i; ++k) cells->emplace_back(0.05 * i - 0.15, 0, 0.05 * k - 0.15);
  }
  return {cells, 0.05};
}

std::vector<Shape> convex_shapes() {
  return {Box{{0.3, 0.2, 0.5}}, Sphere{0.2}, Cylinder{0.15, 0.4}, Capsule{0.1, 0.4}, random_hull(1)};
}

std::vector<Shape> link_shapes() {
  std::vector<Shape> shapes = convex_shapes();
  shapes.push_back(concave_box({0.4, 0.3, 0.5}));
  return shapes;
}

CollisionChecker make_checker(const Shape& body, const Shape& object, const Pose& T = Pose::Identity()) {
  World world;
  world.add("object", object, T);
  return CollisionChecker(free_body::group({free_body::link_shape(body)}), world);
}

Eigen::VectorXd random_q(Rng& rng, double reach) {
  Eigen::VectorXd q(6);
  q << rng.uniform(-reach, reach), rng.uniform(-reach, reach), rng.uniform(-reach, reach), rng.uniform(-3, 3),
      rng.uniform(-3, 3), rng.uniform(-3, 3);
  return q;
}

double fcl_distance(const fcl_reference::Body& a, const Pose& T_a, const fcl_reference::Body& b, const Pose& T_b) {
  double least = std::numeric_limits<double>::infinity();
  fcl::DistanceRequestd request;
  request.distance_tolerance = 1e-9;
  for (const auto& pa : a.parts) {
    for (const auto& pb : b.parts) {
      fcl::CollisionObjectd oa(pa.geometry, Pose(T_a * pa.T)), ob(pb.geometry, Pose(T_b * pb.T));
      fcl::DistanceResultd result;
      least = std::min(least, fcl::distance(&oa, &ob, request, result));
    }
  }
  return least;
}

// Depth of two overlapping boxes: the least overlap along the 15 axes that faces of their difference can have.
double box_depth(const Eigen::Vector3d& ha, const Eigen::Vector3d& hb, const Pose& b) {
  std::vector<Eigen::Vector3d> axes;
  for (int i = 0; i < 3; ++i) {
    axes.push_back(Eigen::Vector3d::Unit(i));
    axes.push_back(b.linear().col(i));
    for (int j = 0; j < 3; ++j) axes.push_back(Eigen::Vector3d::Unit(i).cross(b.linear().col(j)));
  }
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Vector3d axis : axes) {
    if (axis.norm() < 1e-6) continue;
    axis.normalize();
    const double reach = axis.cwiseAbs().dot(ha) + (b.linear().transpose() * axis).cwiseAbs().dot(hb);
    least = std::min(least, reach - std::abs(axis.dot(b.translation())));
  }
  return least;
}

}  // namespace

TEST(Distance, OfShapesIsFcls) {
  Rng rng(1);
  int compared = 0;
  std::vector<Shape> objects = link_shapes();
  objects.push_back(stairs());
  for (const Shape& body : link_shapes()) {
    for (const Shape& object : objects) {
      const Pose T = pose_from_xyz_rpy({0.1, -0.2, 0.3}, {0.4, -0.9, 2.0});
      CollisionChecker checker = make_checker(body, object, T);
      const auto a = fcl_reference::make_body(body), b = fcl_reference::make_body(object);
      for (int i = 0; i < 25; ++i) {
        const Eigen::VectorXd q = random_q(rng, 0.9);
        const DistanceResult result = checker.distance(q);
        const bool hit = fcl_reference::touch(a, free_body::pose(q), b, T);
        if (std::abs(result.value) > 1e-6) {
          ASSERT_EQ(hit, result.value < 0) << shape_kind(body) << " and " << shape_kind(object);
        }
        if (hit) continue;
        ASSERT_NEAR(result.value, fcl_distance(a, free_body::pose(q), b, T), 2e-6)
            << shape_kind(body) << " and " << shape_kind(object);
        ASSERT_NEAR((result.point_a - result.point_b).norm(), result.value, 1e-9);
        EXPECT_TRUE(result.with_scene);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 500);
}

TEST(Distance, DepthOfBoxesIsTheSeparatingAxes) {
  const Eigen::Vector3d ha(0.15, 0.1, 0.25), hb(0.2, 0.3, 0.1);
  CollisionChecker checker = make_checker(Box{2 * ha}, Box{2 * hb});
  Rng rng(2);
  int compared = 0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::VectorXd q = random_q(rng, 0.3);
    const double depth = box_depth(hb, ha, free_body::pose(q));
    if (depth <= 1e-6) continue;
    ASSERT_NEAR(checker.distance(q).value, -depth, 1e-9) << q.transpose();
    ++compared;
  }
  EXPECT_GT(compared, 150);
}

TEST(Distance, DepthOfRoundBodiesInClosedForm) {
  CollisionChecker spheres = make_checker(Sphere{0.2}, Sphere{0.3});
  CollisionChecker sphere_in_box = make_checker(Sphere{0.1}, Box{{1, 1.2, 2}});
  CollisionChecker pills = make_checker(Capsule{0.1, 0.6}, Capsule{0.2, 0.6});
  CollisionChecker cans = make_checker(Cylinder{0.1, 0.6}, Cylinder{0.2, 0.6});
  Eigen::VectorXd q = Eigen::VectorXd::Zero(6);
  q.head<3>() << 0.03, 0.04, 0.12;  // 0.13 from the middle
  EXPECT_NEAR(spheres.distance(q).value, 0.13 - 0.5, 1e-12);
  EXPECT_NEAR(pills.distance(q).value, 0.05 - 0.3, 1e-9) << "parallel capsules: the axes are 0.05 m apart";
  EXPECT_NEAR(cans.distance(q).value, 0.05 - 0.3, 1e-9);
  q.head<3>() << 0.03, 0.04, 0.55;
  EXPECT_NEAR(cans.distance(q).value, 0.55 - 0.6, 1e-9) << "end to end";
  q.head<3>() << 0.35, 0.1, -0.2;
  EXPECT_NEAR(sphere_in_box.distance(q).value, -(0.5 - 0.35) - 0.1, 1e-9);
  // The deepest points and the way out.
  const DistanceResult out = sphere_in_box.distance_and_gradient(q);
  EXPECT_LT((out.point_a - Eigen::Vector3d(0.25, 0.1, -0.2)).norm(), 1e-7);
  EXPECT_LT((out.point_b - Eigen::Vector3d(0.5, 0.1, -0.2)).norm(), 1e-7);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(6);
  expected[0] = 1;
  EXPECT_LT((out.gradient - expected).norm(), 1e-7);
  // Concentric: any way out is as good.
  q.setZero();
  EXPECT_NEAR(spheres.distance(q).value, -0.5, 1e-12);
}

/// Middles that coincide, and angles as people type them: all faces of the difference lie almost in a few planes.
TEST(Distance, DepthOfBodiesThatAreAlmostSquareToEachOther) {
  const double tiny[] = {0, 1e-12, -1e-10, 1e-9, 1.570796327 - M_PI / 2, -1e-8, 1e-7, 1e-6};
  Rng rng(7);
  for (const double half : {0.015, 0.05, 0.1}) {
    CollisionChecker checker = make_checker(Cylinder{0.05, 0.1}, Box{Eigen::Vector3d::Constant(2 * half)});
    for (int i = 0; i < 2000; ++i) {
      Eigen::VectorXd q(6);
      for (int k = 0; k < 3; ++k) q[k] = i % 2 ? 0 : tiny[rng.index(8)];
      for (int k = 3; k < 6; ++k) q[k] = M_PI / 2 * static_cast<double>(rng.index(4)) + tiny[rng.index(8)];
      ASSERT_NEAR(checker.distance(q).value, -(0.05 + half), 1e-5) << half << ": " << q.transpose();
    }
  }
}

TEST(Distance, DepthIsTheShortestWayOutOfConvexBodies) {
  Rng rng(3);
  int compared = 0;
  for (const Shape& body : convex_shapes()) {
    for (const Shape& object : convex_shapes()) {
      CollisionChecker checker = make_checker(body, object);
      const auto a = fcl_reference::make_body(body), b = fcl_reference::make_body(object);
      for (int i = 0; i < 12; ++i) {
        const Eigen::VectorXd q = random_q(rng, 0.2);
        const DistanceResult result = checker.distance_and_gradient(q);
        if (result.value > -1e-3) continue;
        const Eigen::Vector3d way = (result.point_b - result.point_a).normalized();
        ASSERT_NEAR((result.point_b - result.point_a).norm(), -result.value, 1e-8);
        const auto touches = [&](const Eigen::Vector3d& shift) {
          Pose T = free_body::pose(q);
          T.translation() += shift;
          return fcl_reference::touch(a, T, b, Pose::Identity());
        };
        ASSERT_FALSE(touches((1e-5 - result.value) * way)) << shape_kind(body) << " and " << shape_kind(object);
        for (int k = 0; k < 60; ++k) {
          const Eigen::Vector3d other = Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
          ASSERT_TRUE(touches((-result.value - 1e-5) * other)) << shape_kind(body) << " and " << shape_kind(object);
        }
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 150);
}

TEST(Distance, BodiesMayChangePlaces) {
  Rng rng(4);
  int apart = 0, overlapping = 0;
  for (const Shape& a : link_shapes()) {
    for (const Shape& b : link_shapes()) {
      CollisionChecker forth = make_checker(a, b);
      for (int i = 0; i < 20; ++i) {
        const Eigen::VectorXd q = random_q(rng, 0.5);
        const Pose T = free_body::pose(q);
        CollisionChecker back = make_checker(b, a, T);
        const DistanceResult one = forth.distance(q), other = back.distance(Eigen::VectorXd::Zero(6));
        ASSERT_NEAR(one.value, other.value, 1e-8) << shape_kind(a) << " and " << shape_kind(b);
        ASSERT_EQ(forth.is_free(q), back.is_free(Eigen::VectorXd::Zero(6)));
        ASSERT_EQ(forth.contacts(q).size(), back.contacts(Eigen::VectorXd::Zero(6)).size());
        ++(one.value > 0 ? apart : overlapping);
      }
    }
  }
  EXPECT_GT(apart, 100);
  EXPECT_GT(overlapping, 100);
}

TEST(Distance, OfVoxelsAndPlanes) {
  // One cell of a wall of voxels: 0.05 m cells whose outer face stands at x = 0.025.
  auto cells = std::make_shared<std::vector<Eigen::Vector3d>>();
  for (int i = -5; i <= 5; ++i) {
    for (int k = -5; k <= 5; ++k) cells->emplace_back(0, 0.05 * i, 0.05 * k);
  }
  CollisionChecker wall = make_checker(Sphere{0.1}, Voxels{cells, 0.05});
  Eigen::VectorXd q = Eigen::VectorXd::Zero(6);
  q.head<3>() << 0.3, 0.01, 0.02;
  EXPECT_NEAR(wall.distance(q).value, 0.3 - 0.025 - 0.1, 1e-12);
  q[0] = 0.1;
  EXPECT_NEAR(wall.distance(q).value, -0.025, 1e-9) << "the cell straight ahead is the deepest";
  CollisionChecker floor = make_checker(concave_box({0.4, 0.4, 0.2}), Plane{Eigen::Vector3d::UnitZ(), 0.5});
  q.head<3>() << 1, 2, 1;
  const DistanceResult above = floor.distance_and_gradient(q);
  EXPECT_NEAR(above.value, 0.4, 1e-12);
  EXPECT_NEAR(above.point_b.z(), 0.5, 1e-12);
  EXPECT_NEAR(above.gradient[2], 1, 1e-12);
  q[2] = 0.55;
  EXPECT_NEAR(floor.distance(q).value, -0.05, 1e-12);
}

// Two bodies that keep their places against each other while both move: the points move with them.
TEST(Distance, PointsOfPairsThatNothingChangesMoveWithTheRobot) {
  const std::string urdf =
      "<robot name='free'><link name='root'/>" + free_body::joint("x", "prismatic", "1 0 0", "root", "a") +
      free_body::joint("y", "prismatic", "0 1 0", "a", "b") + free_body::joint("z", "prismatic", "0 0 1", "b", "c") +
      free_body::joint("yaw", "revolute", "0 0 1", "c", "d") +
      free_body::joint("pitch", "revolute", "0 1 0", "d", "e") +
      free_body::joint("roll", "revolute", "1 0 0", "e", "carrier") +
      free_body::joint("spare", "prismatic", "1 0 0", "carrier", "side") + "</robot>";
  const Pose T_left = pose_from_xyz_rpy({-0.3, 0.1, 0}, {0.3, 0.2, 0.1});
  const Pose T_right = pose_from_xyz_rpy({0.4, 0, 0.2}, {0, 0, 0});
  const Robot robot = Robot::from_strings(urdf)
                          .with_link("left", "carrier", T_left, {free_body::link_shape(Box{{0.2, 0.3, 0.1}})})
                          .with_link("right", "side", T_right, {free_body::link_shape(Sphere{0.1})});
  const JointGroup group = robot.chain("root", "carrier");
  CollisionChecker checker(group, World());
  Rng rng(31);
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd q = random_q(rng, 2);
    const DistanceResult result = checker.distance_and_gradient(q);
    const Pose T = free_body::pose(q);
    const bool left_first = result.a == "left";
    ASSERT_EQ(left_first ? result.b : result.a, "right");
    const Eigen::Vector3d in_box = (T * T_left).inverse() * (left_first ? result.point_a : result.point_b);
    const Eigen::Vector3d in_sphere = (T * T_right).inverse() * (left_first ? result.point_b : result.point_a);
    const Eigen::Vector3d beyond = in_box.cwiseAbs() - Eigen::Vector3d(0.1, 0.15, 0.05);
    EXPECT_NEAR(beyond.maxCoeff(), 0, 1e-9);
    EXPECT_NEAR(in_sphere.norm(), 0.1, 1e-9);
    EXPECT_NEAR((result.point_a - result.point_b).norm(), result.value, 1e-9);
    EXPECT_NEAR(result.gradient.norm(), 0, 1e-9) << "nothing the group does changes the gap";
    // Digit for digit what a new checker says.
    CollisionChecker fresh(group, World());
    const DistanceResult again = fresh.distance(q);
    EXPECT_EQ(again.value, result.value);
    EXPECT_EQ(again.point_a, result.point_a);
  }
}

TEST(Distance, BoundsOfWhatIsAskedAreChecked) {
  CollisionChecker checker = make_checker(Sphere{0.1}, Sphere{0.1});
  EXPECT_THROW(checker.distance_and_gradient(Eigen::VectorXd::Zero(5)), InvalidInput);
  EXPECT_THROW(checker.distance(Eigen::VectorXd::Constant(6, NAN)), InvalidInput);
  EXPECT_THROW(checker.distances(Eigen::VectorXd::Zero(6), -1), InvalidInput);
  CollisionChecker empty(free_body::group({free_body::link_shape(Sphere{0.1})}), World());
  const DistanceResult none = empty.distance_and_gradient(Eigen::VectorXd::Zero(6));
  EXPECT_EQ(none.value, std::numeric_limits<double>::infinity());
  EXPECT_EQ(none.gradient, Eigen::VectorXd::Zero(6));
  EXPECT_TRUE(empty.distances(Eigen::VectorXd::Zero(6), 1).empty());
}
