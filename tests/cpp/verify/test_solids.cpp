#include <fcl/narrowphase/collision.h>
#include <gtest/gtest.h>

#include <random>

#include "mmgrasp/geometry/mesh.hpp"
#include "verify/robot/solid.hpp"

// The bodies of the independent check, beside FCL called directly.
namespace mmgrasp::verify::detail {
namespace {

/// A pyramid beside a small tetrahedron, and a vertex far away that no triangle uses.
std::shared_ptr<const TriangleMesh> two_pieces() {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{-0.2, -0.1, 0},  {0.2, -0.1, 0},    {0.2, 0.1, 0},     {-0.2, 0.1, 0}, {0, 0, 0.3},
                    {0.4, 0.4, -0.2}, {0.42, 0.4, -0.2}, {0.4, 0.43, -0.2}, {0.4, 0.4, 0},  {0, 0, -50}};
  mesh->triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4},
                     {3, 0, 4}, {5, 7, 6}, {5, 6, 8}, {6, 7, 8}, {7, 5, 8}};
  return mesh;
}

Pose random_pose(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  return Eigen::Translation3d(0.3 * normal(random), 0.3 * normal(random), 0.3 * normal(random)) * q.normalized();
}

TEST(Solids, MeshesMeetPlanesWhereFclSaysSo) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const Solid mesh = make_solids({{MeshShape{two_pieces()}, Pose::Identity()}}).front();
  int touching = 0;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d n(normal(random), normal(random), normal(random));
    const Solid plane = make_solids({{Plane{n.normalized(), 0.2 * normal(random)}, Pose::Identity()}}).front();
    const Pose T_mesh = random_pose(random), T_plane = random_pose(random);
    fcl::CollisionResultd result;
    fcl::collide(mesh.geometry.get(), T_mesh, plane.geometry.get(), T_plane, fcl::CollisionRequestd(1, false), result);
    EXPECT_EQ(touches(mesh, T_mesh, plane, T_plane), result.isCollision()) << i;
    EXPECT_EQ(touches(plane, T_plane, mesh, T_mesh), result.isCollision()) << i;
    touching += result.isCollision();
  }
  EXPECT_GT(touching, 1000);
  EXPECT_LT(touching, 4000);
}

Solid solid_of(const Shape& shape) {
  return make_solids({{shape, Pose::Identity()}}).front();
}

Pose shifted(double x, double y, double z) {
  return Pose(Eigen::Translation3d(x, y, z));
}

TEST(Solids, ComeCloserThanTheirClosedFormSays) {
  const Solid ball = solid_of(Sphere{0.1}), block = solid_of(Box{Eigen::Vector3d(0.4, 0.2, 0.6)});
  const Solid tin = solid_of(Cylinder{0.15, 0.5}), pyramid = solid_of(MeshShape{two_pieces()});
  const Solid wall = solid_of(Plane{Eigen::Vector3d::UnitX(), -1.0});  // all below x = -1
  struct Row {
    const Solid &a, &b;
    Pose T_a, T_b;
    double distance;
  };
  const std::vector<Row> rows = {
      {ball, block, shifted(0.5, 0, 0), shifted(0, 0, 0), 0.2},
      {ball, block, shifted(0.5, 0.5, 0), shifted(0, 0, 0), std::hypot(0.3, 0.4) - 0.1},  // past an edge
      {tin, block, shifted(0, 0.55, 0), shifted(0, 0, 0), 0.3},
      {tin, tin, shifted(1, 0, 0.7), shifted(0, 0, 0), std::hypot(0.7, 0.2)},  // from rim to rim
      {pyramid, ball, shifted(0, 0, 0), shifted(0, 0, 0.55), 0.15},
      {pyramid, block, shifted(0, 0, 0), shifted(0, 0, 0.85), 0.25},
      {pyramid, pyramid, shifted(0, 0, 0), shifted(0, 0, 0.8), 0.5},
      {wall, ball, shifted(0, 0, 0), shifted(0, 3, 2), 0.9},
      {wall, pyramid, shifted(0.5, 0, 0), shifted(0, 0, 0), 0.3},
      {block, wall, shifted(0.2, 0, 0), shifted(0.3, 5, 0), 0.7},
  };
  for (const Row& row : rows) {
    const long index = &row - rows.data();
    EXPECT_FALSE(closer_than(row.distance - 1e-5, row.a, row.T_a, row.b, row.T_b)) << index;
    EXPECT_TRUE(closer_than(row.distance + 1e-5, row.a, row.T_a, row.b, row.T_b)) << index;
    EXPECT_FALSE(closer_than(row.distance - 1e-5, row.b, row.T_b, row.a, row.T_a)) << index;
    EXPECT_TRUE(closer_than(row.distance + 1e-5, row.b, row.T_b, row.a, row.T_a)) << index;
  }
  auto closed = std::make_shared<TriangleMesh>(*two_pieces());
  closed->closed = true;
  const Solid solid = solid_of(MeshShape{closed}), grain = solid_of(Sphere{0.01});
  EXPECT_TRUE(closer_than(0.001, solid, shifted(0, 0, 0), grain, shifted(0, 0, 0.1))) << "within a closed mesh";
}

}  // namespace
}  // namespace mmgrasp::verify::detail
