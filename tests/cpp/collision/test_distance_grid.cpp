#include "collision/narrow/distance_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "collision/narrow/solid.hpp"
#include "mmgrasp/core/random.hpp"

// What a distance grid of a mesh promises, against distances to every triangle by vector algebra of its own.

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

/// To the triangle's plane where the foot lies inside, else to the nearest side, by barycentric coordinates.
double distance_to_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  Eigen::Matrix<double, 3, 2> sides;
  sides << b - a, c - a;
  const Eigen::Vector2d uv = (sides.transpose() * sides).ldlt().solve(sides.transpose() * (p - a));
  if (uv.minCoeff() >= 0 && uv.sum() <= 1) return (a + sides * uv - p).norm();
  double best = std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
    const double s = std::min(1.0, std::max(0.0, (p - from).dot(to - from) / (to - from).squaredNorm()));
    best = std::min(best, (from + s * (to - from) - p).norm());
  }
  return best;
}

/// Two spheres apart: one body that is not convex.
TriangleMesh dumbbell() {
  TriangleMesh mesh;
  for (const double z : {-0.12, 0.12}) {
    const auto sphere = shape_mesh(Sphere{0.08}, 16);
    const int first = static_cast<int>(mesh.vertices.size());
    for (const Vector3d& v : sphere->vertices) mesh.vertices.push_back(v + Vector3d(0, 0, z));
    for (const auto& t : sphere->triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  mesh.closed = true;
  return mesh;
}

TEST(DistanceGrid, NeverOverstatesAndLosesHalfACellNearTheBody) {
  const auto mesh = std::make_shared<const TriangleMesh>(dumbbell());
  const auto solid = make_solid(MeshShape{mesh});
  const DistanceGrid grid(*mesh, *solid);
  Rng rng(3);
  const double step = std::cbrt((0.16 + 0.14) * (0.16 + 0.14) * (0.4 + 0.14) / 2e5);
  double lost = 0;
  int near = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d p(rng.uniform(-0.13, 0.13), rng.uniform(-0.13, 0.13), rng.uniform(-0.25, 0.25));
    double truth = std::numeric_limits<double>::infinity();
    for (const auto& t : mesh->triangles) {
      truth =
          std::min(truth, distance_to_triangle(p, mesh->vertices[t[0]], mesh->vertices[t[1]], mesh->vertices[t[2]]));
    }
    if (solid->contains(p)) truth = 0;
    const double said = grid.distance(p);
    EXPECT_LE(said, truth + 1e-12) << p.transpose();
    if (truth > 0 && truth < 2 * step) {
      ++near;
      lost += truth - said;
    }
    // Far away: a diagonal for what the nearest cell holds, one for where p lies in its own, and a unit of the table.
    EXPECT_GT(said, truth - (2 * std::sqrt(3.0) + 0.26) * step) << p.transpose();
  }
  ASSERT_GT(near, 200);
  EXPECT_LT(lost / near, 0.8 * step);  // half a cell on average, and what cells that hold some of the surface lose
}

}  // namespace
}  // namespace mmgrasp::detail
