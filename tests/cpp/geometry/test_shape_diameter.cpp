#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/geometry/shape.hpp"
#include "mmgrasp/geometry/shape_diameter.hpp"

namespace mmgrasp {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// A pipe of two walls and two rings along z, closed; `ring` faces lie on the ends.
std::shared_ptr<const TriangleMesh> tube(double outer, double inner, double length, int sides, int layers) {
  std::vector<Eigen::Vector3d> v;
  std::vector<std::array<int, 3>> t;
  for (const double r : {outer, inner}) {
    for (int l = 0; l <= layers; ++l) {
      for (int s = 0; s < sides; ++s) {
        const double a = 2 * kPi * s / sides;
        v.emplace_back(r * std::cos(a), r * std::sin(a), length * l / layers);
      }
    }
  }
  const auto at = [&](int wall, int layer, int side) { return (wall * (layers + 1) + layer) * sides + side % sides; };
  for (int s = 0; s < sides; ++s) {
    for (int l = 0; l < layers; ++l) {
      t.push_back({at(0, l, s), at(0, l, s + 1), at(0, l + 1, s + 1)});
      t.push_back({at(0, l, s), at(0, l + 1, s + 1), at(0, l + 1, s)});
      t.push_back({at(1, l, s), at(1, l + 1, s + 1), at(1, l, s + 1)});
      t.push_back({at(1, l, s), at(1, l + 1, s), at(1, l + 1, s + 1)});
    }
    t.push_back({at(0, 0, s), at(1, 0, s), at(1, 0, s + 1)});
    t.push_back({at(0, 0, s), at(1, 0, s + 1), at(0, 0, s + 1)});
    t.push_back({at(0, layers, s), at(1, layers, s + 1), at(1, layers, s)});
    t.push_back({at(0, layers, s), at(0, layers, s + 1), at(1, layers, s + 1)});
  }
  return make_mesh(std::move(v), std::move(t));
}

Eigen::Vector3d centre(const TriangleMesh& mesh, std::size_t f) {
  const auto& t = mesh.triangles[f];
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
}

TEST(ShapeDiameter, BallIsTwiceItsRadius) {
  const auto mesh = shape_mesh(Sphere{0.02}, 192);
  for (const double d : shape_diameters(*mesh)) EXPECT_NEAR(d, 0.04, 0.04 * 0.004);
}

TEST(ShapeDiameter, PlateIsItsThickness) {
  const auto mesh = shape_mesh(Box{{0.2, 0.2, 0.002}});
  const std::vector<double> found = shape_diameters(*mesh);
  int flat = 0;
  for (std::size_t f = 0; f < found.size(); ++f) {
    if (std::abs(std::abs(centre(*mesh, f).z()) - 0.001) > 1e-12) continue;
    ++flat;
    EXPECT_NEAR(found[f], 0.002, 1e-9);
  }
  EXPECT_EQ(flat, 4);
}

TEST(ShapeDiameter, CylinderIsItsDiameter) {
  const auto mesh = shape_mesh(Cylinder{0.005, 0.2}, 128);
  const std::vector<double> found = shape_diameters(*mesh);
  for (std::size_t f = 0; f < found.size(); ++f) {
    if (centre(*mesh, f).head<2>().norm() > 0.0049) {
      EXPECT_NEAR(found[f], 0.01, 0.01 * 0.002);
    }
  }
}

TEST(ShapeDiameter, TubeIsItsWall) {
  const auto mesh = tube(0.02, 0.017, 0.1, 128, 20);
  ASSERT_TRUE(mesh->closed);
  const std::vector<double> found = shape_diameters(*mesh);
  for (std::size_t f = 0; f < found.size(); ++f) {
    const double z = centre(*mesh, f).z();
    if (z > 0.02 && z < 0.08) {
      EXPECT_NEAR(found[f], 0.003, 0.003 * 0.02) << f;
    }
  }
}

TEST(ShapeDiameter, RayLengthsHaveTheirOwnClosedForms) {
  ShapeDiameterOptions options;
  options.ray_lengths = true;
  options.rays = 1000;
  options.outlier = 100;  // all rays
  // Weights z, density constant over z in [1/2, 1]: a ball's chord is 2 r z, a plate's t / z.
  const double mean_z = 3.0 / 8, ball = (7.0 / 24) / mean_z, plate = 0.5 / mean_z;
  for (const double d : shape_diameters(*shape_mesh(Sphere{0.02}, 96), options)) EXPECT_NEAR(d, 0.04 * ball, 2e-4);
  const auto mesh = shape_mesh(Box{{2, 2, 0.002}});
  const std::vector<double> found = shape_diameters(*mesh, options);
  for (std::size_t f = 0; f < found.size(); ++f) {
    if (std::abs(std::abs(centre(*mesh, f).z()) - 0.001) < 1e-12) {
      EXPECT_NEAR(found[f], 0.002 * plate, 1e-6);
    }
  }
}

TEST(ShapeDiameter, ShellsInsideAreLookedThrough) {
  TriangleMesh both = *shape_mesh(Sphere{0.02}, 64);
  const std::size_t outer = both.triangles.size();
  const int n = static_cast<int>(both.vertices.size());
  const auto small = shape_mesh(Sphere{0.005}, 32);
  for (const auto& t : small->triangles) both.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  both.vertices.insert(both.vertices.end(), small->vertices.begin(), small->vertices.end());
  const std::vector<double> found = shape_diameters(both), alone = shape_diameters(*shape_mesh(Sphere{0.02}, 64));
  for (std::size_t f = 0; f < outer; ++f) EXPECT_NEAR(found[f], alone[f], 1e-9);
}

/// Both surfaces as one mesh, the first one's faces first.
TriangleMesh together(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh out = a;
  const int n = static_cast<int>(a.vertices.size());
  for (const auto& t : b.triangles) out.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  out.vertices.insert(out.vertices.end(), b.vertices.begin(), b.vertices.end());
  return out;
}

TEST(ShapeDiameter, ShellsInsideAPlateAndAWallAreLookedThrough) {
  const auto plate = shape_mesh(Box{{0.2, 0.2, 0.004}});
  const std::vector<double> flat = shape_diameters(together(*plate, *shape_mesh(Box{{0.19, 0.19, 0.002}})));
  for (std::size_t f = 0; f < plate->triangles.size(); ++f) {
    if (std::abs(std::abs(centre(*plate, f).z()) - 0.002) < 1e-12) {
      EXPECT_NEAR(flat[f], 0.004, 1e-9) << f;
    }
  }
  const auto wall = tube(0.02, 0.017, 0.1, 128, 20);
  const std::vector<double> found = shape_diameters(together(*wall, *tube(0.019, 0.018, 0.098, 128, 20)));
  for (std::size_t f = 0; f < wall->triangles.size(); ++f) {
    const double z = centre(*wall, f).z();
    if (z > 0.02 && z < 0.08) {
      EXPECT_NEAR(found[f], 0.003, 0.003 * 0.02) << f;
    }
  }
}

TEST(ShapeDiameter, HolesInAPlateAndAWallLeaveTheRest) {
  TriangleMesh plate = *shape_mesh(Box{{0.2, 0.2, 0.002}});
  const auto sides = std::remove_if(plate.triangles.begin(), plate.triangles.end(), [&](const auto& t) {
    const double sum = plate.vertices[t[0]].z() + plate.vertices[t[1]].z() + plate.vertices[t[2]].z();
    return std::abs(std::abs(sum) - 0.003) > 1e-12;
  });
  plate.triangles.erase(sides, plate.triangles.end());
  plate.closed = false;
  ASSERT_EQ(plate.triangles.size(), 4u);
  for (const double d : shape_diameters(plate)) EXPECT_NEAR(d, 0.002, 1e-9);
  TriangleMesh wall = *tube(0.02, 0.017, 0.1, 128, 20);
  std::vector<std::array<int, 3>> kept;
  for (std::size_t f = 0; f < wall.triangles.size(); ++f) {
    const Eigen::Vector3d c = centre(wall, f);
    const bool hole = c.x() > 0.0195 && std::abs(c.y()) < 0.002 && std::abs(c.z() - 0.05) < 0.006;
    if (!hole) kept.push_back(wall.triangles[f]);
  }
  ASSERT_LT(kept.size(), wall.triangles.size() - 10);
  wall.triangles = kept;
  wall.closed = false;
  const std::vector<double> found = shape_diameters(wall);
  for (std::size_t f = 0; f < found.size(); ++f) {
    const double z = centre(wall, f).z();
    if (found[f] > 0 && z > 0.02 && z < 0.08) {  // behind the hole there is nothing
      EXPECT_NEAR(found[f], 0.003, 0.003 * 0.05) << f;
    }
  }
  EXPECT_LT(std::count(found.begin(), found.end(), 0.0), 40);
}

TEST(ShapeDiameter, MovesAndGrowsWithTheMesh) {
  const auto mesh = tube(0.02, 0.015, 0.06, 64, 12);
  const std::vector<double> before = shape_diameters(*mesh);
  for (const double scale : {0.01, 1.0, 30.0}) {
    const Eigen::Isometry3d T = Eigen::Translation3d(0.3 * scale, -1.1 * scale, 0.7 * scale) *
                                Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized());
    TriangleMesh moved = *mesh;
    for (Eigen::Vector3d& v : moved.vertices) v = T * (scale * v);
    const std::vector<double> after = shape_diameters(moved);
    // Turned, the rays are others of the same cones: where the ends are near they meet other things.
    for (std::size_t f = 0; f < before.size(); ++f) {
      const double z = centre(*mesh, f).z();
      if (z > 0.015 && z < 0.045) {
        EXPECT_NEAR(after[f] / scale, before[f], 0.02 * before[f]) << f;  // as near as a wall's is to its closed form
      }
    }
    for (std::size_t v = 0; v < moved.vertices.size(); ++v)
      moved.vertices[v] = scale * (mesh->vertices[v] + Eigen::Vector3d(0.3, -1.1, 0.7));
    const std::vector<double> shifted = shape_diameters(moved);
    for (std::size_t f = 0; f < before.size(); ++f) EXPECT_NEAR(shifted[f] / scale, before[f], 1e-6 * before[f]) << f;
  }
}

TEST(ShapeDiameter, HolesInTheSurfaceLeaveTheRest) {
  TriangleMesh ball = *shape_mesh(Sphere{0.02}, 192);
  std::vector<std::array<int, 3>> kept;
  for (std::size_t f = 0; f < ball.triangles.size(); ++f) {
    if (centre(ball, f).z() < 0.015) kept.push_back(ball.triangles[f]);
  }
  ball.triangles = kept;
  ball.closed = false;
  for (const double d : shape_diameters(ball)) EXPECT_NEAR(d, 0.04, 0.04 * 0.006);
}

TEST(ShapeDiameter, SameAtAnyNumberOfThreads) {
  const auto mesh = tube(0.02, 0.01, 0.05, 40, 10);
  ShapeDiameterOptions one, three;
  one.threads = 1;
  three.threads = 3;
  EXPECT_EQ(shape_diameters(*mesh, one), shape_diameters(*mesh, three));
}

TEST(ShapeDiameter, RefusesBadOptions) {
  ShapeDiameterOptions options;
  options.cone = 3.2;
  EXPECT_THROW(shape_diameters(*shape_mesh(Sphere{1}), options), InvalidInput);
  options = {};
  options.rays = 0;
  EXPECT_THROW(shape_diameters(*shape_mesh(Sphere{1}), options), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
