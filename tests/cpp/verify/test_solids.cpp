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

}  // namespace
}  // namespace mmgrasp::verify::detail
