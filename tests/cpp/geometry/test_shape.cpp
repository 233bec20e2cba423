#include "mmgrasp/geometry/shape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"

using namespace mmgrasp;

namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInf = std::numeric_limits<double>::infinity();

Voxels two_voxels() {
  return {std::make_shared<std::vector<Eigen::Vector3d>>(std::vector<Eigen::Vector3d>{{0, 0, 0}, {0.1, 0, 0}}), 0.1};
}

}  // namespace

TEST(Shape, BadDimensionsAreNamed) {
  const Shape bad[] = {Box{{1, 0, 1}},
                       Box{{1, -1, 1}},
                       Box{{kNan, 1, 1}},
                       Sphere{0},
                       Sphere{kInf},
                       Cylinder{1, 0},
                       Cylinder{kNan, 1},
                       Capsule{1, -1},
                       Capsule{0, 1},
                       Plane{{0, 0, 2}, 0},
                       Plane{{0, 0, 1}, kNan},
                       MeshShape{},
                       Voxels{},
                       Voxels{two_voxels().centres, 0}};
  for (const Shape& shape : bad) {
    try {
      check_shape(shape, "table");
      FAIL() << shape_kind(shape);
    } catch (const InvalidInput& error) {
      EXPECT_EQ(std::string(error.what()).rfind("table.", 0), 0u) << error.what();
    }
  }
  for (const Shape& shape : {Shape(Box{{1, 2, 3}}), Shape(Capsule{1, 0}), Shape(Plane{}), Shape(two_voxels())}) {
    EXPECT_NO_THROW(check_shape(shape, "x"));
  }
}

TEST(Shape, BoundsAreTightForRandomPoses) {
  Rng rng(1);
  const Shape shapes[] = {Box{{1, 2, 3}}, Sphere{0.7}, Cylinder{0.5, 2}, Capsule{0.4, 1}, two_voxels()};
  // A fine tessellation is inscribed, so its bounds come close from inside.
  std::vector<std::shared_ptr<const TriangleMesh>> meshes;
  for (const Shape& shape : shapes) meshes.push_back(shape_mesh(shape, 120));
  for (int i = 0; i < 50; ++i) {
    Pose T = Pose::Identity();
    T.translation() = Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
    T.linear() = rng.rotation().toRotationMatrix();
    for (std::size_t k = 0; k < meshes.size(); ++k) {
      const Shape& shape = shapes[k];
      Eigen::AlignedBox3d fine;
      for (const auto& v : meshes[k]->vertices) fine.extend(T * v);
      const Eigen::AlignedBox3d box = shape_bounds(shape, T);
      EXPECT_LT((box.min() - fine.min()).cwiseAbs().maxCoeff(), 2e-3) << shape_kind(shape);
      EXPECT_LT((box.max() - fine.max()).cwiseAbs().maxCoeff(), 2e-3) << shape_kind(shape);
      EXPECT_GT((box.max() - fine.max()).minCoeff(), -1e-12);
    }
  }
  EXPECT_EQ(shape_bounds(Plane{}).max().x(), kInf);
}

TEST(Shape, SurfacesAreClosedAndHaveTheRightVolume) {
  const int n = 48;
  const double cap = n * std::sin(2 * M_PI / n) / 2;  // area of the regular n-gon in the unit circle
  EXPECT_NEAR(mesh_volume(*shape_mesh(Box{{1, 2, 3}})), 6, 1e-12);
  EXPECT_NEAR(mesh_volume(*shape_mesh(Cylinder{0.5, 2}, n)), cap * 0.25 * 2, 1e-12);
  EXPECT_NEAR(mesh_volume(*shape_mesh(Sphere{1}, 200)), 4 * M_PI / 3, 5e-3);
  EXPECT_NEAR(mesh_volume(*shape_mesh(Capsule{0.5, 2}, 200)), M_PI * (4.0 / 3 * 0.125 + 0.25 * 2), 5e-3);
  EXPECT_NEAR(mesh_volume(*shape_mesh(two_voxels())), 0.002, 1e-12);
  EXPECT_EQ(shape_mesh(two_voxels())->triangles.size(), 20u);
  for (const Shape& shape : {Shape(Box{{1, 2, 3}}), Shape(Cylinder{1, 1}), Shape(Sphere{1}), Shape(Capsule{1, 1})}) {
    EXPECT_TRUE(shape_mesh(shape)->closed && shape_mesh(shape)->convex) << shape_kind(shape);
  }
  EXPECT_THROW(shape_mesh(Plane{}), InvalidInput);
  EXPECT_THROW(shape_mesh(Sphere{1}, 2), InvalidInput);
}
