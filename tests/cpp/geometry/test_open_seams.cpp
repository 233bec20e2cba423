// Meshes whose triangles say the same vertices with different roundings to single precision.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/geometry/detail/mesh_faults.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp {
namespace {

/// Triangles that share no vertices.
struct Soup {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;

  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    const int first = static_cast<int>(vertices.size());
    for (const Eigen::Vector3d& corner : {a, b, c}) vertices.push_back(corner);
    triangles.push_back({first, first + 1, first + 2});
  }

  void add(const Soup& other) {
    for (const auto& [i, j, k] : other.triangles) add(other.vertices[i], other.vertices[j], other.vertices[k]);
  }
};

/// Each triangle as an exporter may place it that computes in single precision: every second one rounds before it
/// turns.
Soup exported(const TriangleMesh& mesh, const Pose& T) {
  const Eigen::Matrix3f R = T.linear().cast<float>();
  const Eigen::Vector3f t = T.translation().cast<float>();
  Soup soup;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto placed = [&](int corner) -> Eigen::Vector3d {
      const Eigen::Vector3d& v = mesh.vertices[mesh.triangles[i][corner]];
      if (i % 2 == 0) return (T * v).cast<float>().cast<double>();
      return (R * v.cast<float>() + t).cast<double>();
    };
    soup.add(placed(0), placed(1), placed(2));
  }
  return soup;
}

/// A box from corner to corner as triangles that share no vertices, whose lid is moved.
Soup box_with_lid_moved(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Eigen::Vector3d& by) {
  const auto mesh = shape_mesh(Box{high - low});
  Soup soup;
  for (const auto& t : mesh->triangles) {
    bool lid = true;
    for (const int v : t) lid = lid && mesh->vertices[v].z() > 0;
    const auto at = [&](int v) -> Eigen::Vector3d {
      return mesh->vertices[v] + (low + high) / 2 + (lid ? by : Eigen::Vector3d::Zero());
    };
    soup.add(at(t[0]), at(t[1]), at(t[2]));
  }
  return soup;
}

/// A square sheet seen from above and from below, the one `gap` over the other.
Soup double_sheet(double side, double gap) {
  constexpr int kCells = 10;
  Soup soup;
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      const auto at = [&](int x, int y, double z) -> Eigen::Vector3d {
        return {side + x * side / kCells, side + y * side / kCells, z};
      };
      soup.add(at(i, j, gap), at(i + 1, j, gap), at(i + 1, j + 1, gap));
      soup.add(at(i, j, gap), at(i + 1, j + 1, gap), at(i, j + 1, gap));
      soup.add(at(i, j, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0));
      soup.add(at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0));
    }
  return soup;
}

TEST(OpenSeams, SolidsThatWereTurnedInSinglePrecisionAreClosed) {
  const Pose T = pose_from_xyz_rpy({0.31, -0.17, 0.23}, {0.4, -0.7, 1.1});
  for (const Shape& shape : {Shape{Box{{0.05, 0.04, 0.03}}}, Shape{Cylinder{0.02, 0.1}}, Shape{Sphere{0.03}}}) {
    const auto exact = shape_mesh(shape);
    const Soup soup = exported(*exact, T);
    MeshReport report;
    const auto mesh = make_mesh(soup.vertices, soup.triangles, "", &report);
    EXPECT_TRUE(mesh->closed);
    EXPECT_EQ(mesh->vertices.size(), exact->vertices.size());
    EXPECT_EQ(mesh->triangles.size(), exact->triangles.size());
    EXPECT_EQ(report.vertices_merged, static_cast<int>(soup.vertices.size() - exact->vertices.size()));
    EXPECT_NEAR(mesh_volume(*mesh) / mesh_volume(*exact), 1, 1e-4);
    detail::MeshFaults faults;
    detail::make_mesh(soup.vertices, soup.triangles, faults);
    EXPECT_EQ(faults.repeated_triangles, 0);
    EXPECT_EQ(faults.turned_triangles, 0);
  }
}

// A corner in the origin was turned and shifted with the others: what it was rounded by is not that of its own zeros.
TEST(OpenSeams, ACornerMayLieInTheOrigin) {
  Rng rng(1);
  for (int draw = 0; draw < 300; ++draw) {
    const auto angle = [&] { return rng.uniform(-3, 3); };
    const auto box = shape_mesh(Box{{rng.uniform(0.02, 0.2), rng.uniform(0.02, 0.2), rng.uniform(0.02, 0.2)}});
    Pose T = pose_from_xyz_rpy({0, 0, 0}, {angle(), angle(), angle()});
    T.translation() = -(T * box->vertices[rng.index(8)]);
    const Soup soup = exported(*box, T);
    EXPECT_TRUE(make_mesh(soup.vertices, soup.triangles)->closed) << draw;
  }
}

TEST(OpenSeams, WhatStaysOpenIsToldAsItWas) {
  // A box with a body inside, and beside it a sheet stored from both sides, which makes all of it no solid.
  Soup soup = box_with_lid_moved({0.3, 0.1, 0.1}, {0.4, 0.2, 0.2}, {0, 0, 0});
  soup.add(box_with_lid_moved({0.33, 0.13, 0.13}, {0.36, 0.16, 0.16}, {0, 0, 0}));
  soup.add(double_sheet(0.1, 2e-8));
  detail::MeshFaults faults;
  EXPECT_FALSE(detail::make_mesh(soup.vertices, soup.triangles, faults)->closed);
  EXPECT_EQ(faults.repeated_triangles, 0);
  EXPECT_EQ(faults.enclosed_bodies, 0);
}

TEST(OpenSeams, WiderGapsStayOpen) {
  const Eigen::Vector3d low(0.1, 0.1, 0.1), high(0.2, 0.2, 0.2);
  for (const auto& [by, closed] : {std::pair{2e-8, true}, std::pair{1e-6, false}, std::pair{1e-4, false}}) {
    const Soup soup = box_with_lid_moved(low, high, {by, -by, by});
    EXPECT_EQ(make_mesh(soup.vertices, soup.triangles)->closed, closed) << by;
  }
}

TEST(OpenSeams, AFarVertexWidensNoToleranceElsewhere) {
  const Soup near = box_with_lid_moved({0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}, {0, 0, 1e-6});
  const Soup far = box_with_lid_moved({1000, 1000, 1000}, {1001, 1001, 1001}, {0, 0, 1e-4});
  EXPECT_TRUE(make_mesh(far.vertices, far.triangles)->closed);  // 1e-4 m is rounding there
  Soup both = near;
  both.add(far);
  EXPECT_FALSE(make_mesh(both.vertices, both.triangles)->closed);
  Soup mended = box_with_lid_moved({0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}, {0, 0, 1e-8});
  mended.add(far);
  EXPECT_TRUE(make_mesh(mended.vertices, mended.triangles)->closed);
}

TEST(OpenSeams, ASheetStoredFromBothSidesIsNoSolid) {
  for (const double gap : {0.0, 2e-8}) {  // single precision is 3e-8 m here
    const Soup sheet = double_sheet(0.1, gap);
    const auto mesh = make_mesh(sheet.vertices, sheet.triangles);
    EXPECT_FALSE(mesh->closed) << gap;
    EXPECT_EQ(mesh->vertices.size(), (gap > 0 ? 2u : 1u) * 11 * 11);  // neither side was joined to the other
    Soup beside = box_with_lid_moved({0.3, 0.1, 0.1}, {0.4, 0.2, 0.2}, {0, 0, 2e-8});
    beside.add(sheet);
    EXPECT_FALSE(make_mesh(beside.vertices, beside.triangles)->closed) << gap;
  }
}

TEST(OpenSeams, ASheetWhoseSidesAreCutOtherwiseIsNoSolid) {
  const Pose T = pose_from_xyz_rpy({0.31, -0.17, 0.23}, {0.4, -0.7, 1.1});
  Soup sheet;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) {
      const auto at = [&](int x, int y) -> Eigen::Vector3d {
        return (T * Eigen::Vector3d(0.02 * x, 0.02 * y, 0)).cast<float>().cast<double>();
      };
      sheet.add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      sheet.add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
      sheet.add(at(i, j), at(i, j + 1), at(i + 1, j));
      sheet.add(at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
    }
  EXPECT_FALSE(make_mesh(sheet.vertices, sheet.triangles)->closed);
  sheet.add(box_with_lid_moved({0.4, 0.1, 0.1}, {0.5, 0.2, 0.2}, {0, 0, 0}));
  EXPECT_TRUE(make_mesh(sheet.vertices, sheet.triangles)->closed);  // as a solid with a wart is
}

TEST(OpenSeams, APlateOfATenthOfAMillimetreIsASolid) {
  const Soup plate = box_with_lid_moved({0.1, 0.1, 0.1}, {0.2, 0.2, 0.1001}, {1e-8, 0, 0});
  const auto mesh = make_mesh(plate.vertices, plate.triangles);
  EXPECT_TRUE(mesh->closed);
  EXPECT_NEAR(mesh_volume(*mesh), 1e-6, 1e-11);
}

}  // namespace
}  // namespace mmgrasp
