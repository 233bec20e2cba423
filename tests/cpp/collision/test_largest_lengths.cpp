// Whatever enters is at most kLargestLength large and far away: beyond it is refused, up to it answers are right.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/geometry/grid_distance_field.hpp"
#include "mmgrasp/geometry/octree.hpp"
#include "support/free_body.hpp"

using namespace mmgrasp;

namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
const double kTooLarge[] = {1.0001e6, 1e12, 1e100, 1e308, kInf, -kInf, std::nan("")};
const double kNoSize[] = {1.0001e6, 1e12, 1e100, 1e308, kInf, std::nan(""), 0, -1, 1e-10, 1e-300};

Pose shifted(double x, double y, double z) {
  return pose_from_xyz_rpy({x, y, z}, {0, 0, 0});
}

Voxels voxels(const std::vector<Eigen::Vector3d>& centres, double resolution) {
  return {std::make_shared<std::vector<Eigen::Vector3d>>(centres), resolution};
}

// By hand, past make_mesh: what a program may fill in itself.
MeshShape triangle_to(double x) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{0, 0, 0}, {x, 0, 0}, {0, 1, 0}};
  mesh->triangles = {{0, 1, 2}};
  return {mesh};
}

std::vector<Shape> shapes_with(double size) {
  return {Box{{size, 1, 1}}, Box{{1, 1, size}},        Sphere{size}, Cylinder{size, 1}, Cylinder{1, size},
          Capsule{size, 1},  voxels({{0, 0, 0}}, size)};
}

std::vector<Shape> shapes_reaching(double x) {
  return {Capsule{1, x}, Plane{Eigen::Vector3d::UnitZ(), x}, triangle_to(x), voxels({{0, 0, 0}, {0, 0, x}}, 0.01)};
}

std::string urdf_with(const std::string& shape, const std::string& origin) {
  return "<robot name='r'><link name='a'/><link name='b'><collision><geometry>" + shape +
         "</geometry></collision></link><joint name='j' type='fixed'><parent link='a'/><child link='b'/><origin xyz='" +
         origin + "'/></joint></robot>";
}

}  // namespace

TEST(LargestLengths, ShapesBeyondAreRefusedWhereverTheyEnter) {
  std::vector<Shape> bad;
  for (const double size : kNoSize)
    for (const Shape& shape : shapes_with(size)) bad.push_back(shape);
  for (const double x : kTooLarge)
    for (const Shape& shape : shapes_reaching(x)) bad.push_back(shape);
  for (const Shape& shape : bad) {
    World world;
    EXPECT_THROW(world.add("o", shape, Pose::Identity()), InvalidInput) << shape_kind(shape);
    EXPECT_FALSE(world.has("o"));
    EXPECT_THROW(free_body::group({free_body::link_shape(shape)}), InvalidInput) << shape_kind(shape);
  }
  for (const double x : kTooLarge) {
    EXPECT_THROW(make_mesh({{0, 0, 0}, {1, 0, 0}, {0, x, 0}}, {{0, 1, 2}}), InvalidInput) << x;
    EXPECT_THROW(voxelize({{0, 0, 0}, {0, x, 0}}, 0.01), InvalidInput) << x;
  }
}

TEST(LargestLengths, PosesBeyondAreRefusedWhereverTheyEnter) {
  for (const double x : kTooLarge) {
    const Pose far = shifted(0, x, 0);
    World world;
    EXPECT_THROW(world.add("o", Sphere{1}, far), InvalidInput);
    world.add("o", Sphere{1}, Pose::Identity());
    EXPECT_THROW(world.move("o", far), InvalidInput);
    EXPECT_THROW(world.attach("o", "carrier", far), InvalidInput);
    world.attach("o", "carrier", Pose::Identity());
    EXPECT_THROW(world.detach("o", far), InvalidInput);
    WorldObject object;
    object.shapes = {free_body::link_shape(Sphere{1})};
    object.shapes[0].T_link_shape = far;
    EXPECT_THROW(world.add("p", object), InvalidInput);
    EXPECT_THROW(checked_pose(far.matrix(), "pose"), InvalidInput);
    const std::string text = std::isnan(x) ? "nan" : std::to_string(x);
    EXPECT_THROW(Robot::from_strings(urdf_with("<sphere radius='1'/>", "0 " + text + " 0")), InvalidInput) << text;
    EXPECT_THROW(Robot::from_strings(urdf_with("<sphere radius='" + text + "'/>", "0 0 0")), InvalidInput) << text;
    EXPECT_THROW(Robot::from_strings(urdf_with("<box size='1 " + text + " 1'/>", "0 0 0")), InvalidInput) << text;
    Eigen::VectorXd q = Eigen::VectorXd::Zero(6);
    q[2] = x;
    EXPECT_THROW(free_body::group({free_body::link_shape(Sphere{1})}).check_configuration(q, "q"), InvalidInput);
  }
}

TEST(LargestLengths, FieldsBeyondAreRefused) {
  GridDistanceField::Grid good;
  good.size = {2, 2, 2};
  good.values.assign(8, 1.0);
  good.origin.setZero();
  good.spacing = 0.5;
  EXPECT_NO_THROW(GridDistanceField{good});
  for (const double x : kTooLarge) {
    GridDistanceField::Grid far = good, coarse = good, deep = good;
    far.origin[1] = x;
    coarse.spacing = std::abs(x);
    deep.values[3] = x;
    EXPECT_THROW(GridDistanceField{far}, InvalidInput) << x;
    EXPECT_THROW(GridDistanceField{coarse}, InvalidInput) << x;
    if (!std::isnan(x)) EXPECT_THROW(GridDistanceField{deep}, InvalidInput) << x;
    EXPECT_THROW(GridDistanceField{good}.distance({x, 0, 0}), InvalidInput) << x;
  }
}

// One face of the object lies at z = 0 of a frame that is turned at random and as far away as can be; the body comes
// down on it from above. How far it is off is known by construction.
TEST(LargestLengths, AnswersAreRightUpToTheLimit) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const double size : {1e-3, 1.0, 1e3, 1e6}) {
    const MeshShape cube{shape_mesh(Box{{size, size, size}})};
    const std::pair<Shape, double> objects[] = {{Box{{size, size, size}}, size / 2},
                                                {Sphere{size / 2}, size / 2},
                                                {Cylinder{size / 2, size}, size / 2},
                                                {Capsule{size / 4, size / 2}, size / 2},
                                                {cube, size / 2},
                                                {voxels({{0, 0, 0}}, size), size / 2},
                                                {Plane{Eigen::Vector3d::UnitZ(), 0}, 0.0}};
    const MeshShape unit{shape_mesh(Box{{1, 1, 1}})};
    const Shape bodies[] = {Box{{1, 1, 1}}, Sphere{0.5}, Cylinder{0.5, 1}, Capsule{0.25, 0.5}, unit};
    for (const auto& [object, half] : objects) {
      for (const Shape& body : bodies) {
        Pose T_world_face(
            Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized());
        T_world_face.translation() << 1e6 - 1, -1e6 + 1, 1e6 - 1;
        Pose T_world_object = T_world_face * shifted(0, 0, -half);
        // The middle may not be farther away than the limit.
        const Eigen::Vector3d in =
            T_world_object.translation().cwiseMax(-1e6).cwiseMin(1e6) - T_world_object.translation();
        T_world_object.pretranslate(in);
        T_world_face.pretranslate(in);
        World world;
        world.add("object", object, T_world_object);
        CollisionChecker checker(free_body::group({free_body::link_shape(body)}).at(T_world_face), world);
        for (const double gap : {2e-6, 1e-3, 1.0, -2e-6, -1e-4}) {
          if (std::abs(gap) > size) continue;
          Eigen::VectorXd q = Eigen::VectorXd::Zero(6);
          q[2] = 0.5 + gap;
          const std::string what = std::string(shape_kind(body)) + " on " + shape_kind(object) + " of " +
                                   std::to_string(size) + " m, gap " + std::to_string(gap);
          EXPECT_EQ(checker.is_free(q), gap > 0) << what;
          EXPECT_NEAR(checker.distance(q).value, gap, 1e-6) << what;
        }
      }
    }
  }
}

// Cells as far from each other as can be: each is met, and nothing between them.
TEST(LargestLengths, VoxelsAtBothEndsOfTheWorld) {
  const std::vector<Eigen::Vector3d> ends = {{-1e6, 0, 0}, {1e6, 0, 0}, {1e6, 1e6, -1e6}, {0, 0, 0}};
  World world;
  world.add("cells", voxels(ends, 0.1), Pose::Identity());
  const JointGroup body = free_body::group({free_body::link_shape(Sphere{0.5})});
  for (const Eigen::Vector3d& cell : ends) {
    CollisionChecker checker(body.at(Pose(Eigen::Translation3d(cell))), world);
    for (const double off : {0.0, 0.3, 0.549, 0.551, 2.0}) {
      Eigen::VectorXd q = Eigen::VectorXd::Zero(6);
      q[1] = off;
      EXPECT_EQ(checker.is_free(q), off > 0.55) << cell.transpose() << " off " << off;
    }
  }
}

// Long rows of cells: squares of cell numbers have more digits than single precision.
TEST(LargestLengths, VoxelsInALongRow) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> cell(0, 60000);
  std::vector<Eigen::Vector3d> centres = {{0.005, 0.005, 0.005}, {600.005, 0.005, 0.005}};
  for (int i = 0; i < 600; ++i) centres.emplace_back(0.01 * cell(random) + 0.005, 0.005, 0.005);
  World world;
  world.add("cells", voxels(centres, 0.01), Pose::Identity());
  const double radius = 0.3;
  const JointGroup body = free_body::group({free_body::link_shape(Sphere{radius})});
  std::uniform_real_distribution<double> along(0, 1), across(-0.06, 0.06);
  int touching = 0;
  for (int metre = 0; metre < 600; ++metre) {
    CollisionChecker checker(body.at(shifted(metre, 0, 0)), world);
    for (int i = 0; i < 40; ++i) {
      Eigen::VectorXd q = Eigen::VectorXd::Zero(6);
      q.head<3>() << along(random), across(random), across(random);
      const Eigen::Vector3d p = q.head<3>() + Eigen::Vector3d(metre, 0, 0);
      double nearest = kInf;
      for (const Eigen::Vector3d& c : centres)
        nearest = std::min(nearest, ((p - c).cwiseAbs().array() - 0.005).max(0.0).matrix().norm());
      if (std::abs(nearest - radius) < 1e-6) continue;
      touching += nearest < radius;
      ASSERT_EQ(checker.is_free(q), nearest > radius) << p.transpose() << " is " << nearest << " off";
    }
  }
  EXPECT_GT(touching, 5000);
}
