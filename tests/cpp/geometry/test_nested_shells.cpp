// Shells within shells: whatever way each of them looks in the file, the mesh bounds one solid.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/geometry/detail/mesh_faults.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

/// A cube of an edge length around a place; it may look inwards.
struct ShellCube {
  double edge;
  bool inwards;
  Vector3d place = Vector3d::Zero();
};

/// One mesh of all cubes, in any orientation of the whole.
std::pair<std::shared_ptr<const TriangleMesh>, detail::MeshFaults> cubes(const std::vector<ShellCube>& all,
                                                                         double turn = 0.4) {
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(turn, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  std::vector<Vector3d> v;
  std::vector<std::array<int, 3>> t;
  for (const ShellCube& cube : all) {
    const auto mesh = shape_mesh(Box{Vector3d::Constant(cube.edge)});
    const int first = static_cast<int>(v.size());
    for (const Vector3d& p : mesh->vertices) v.push_back(rotation * (p + cube.place));
    for (auto triangle : mesh->triangles) {
      for (int& corner : triangle) corner += first;
      if (cube.inwards) std::swap(triangle[0], triangle[1]);
      t.push_back(triangle);
    }
  }
  detail::MeshFaults faults;
  auto mesh = detail::make_mesh(v, t, faults);
  return {mesh, faults};
}

/// The sum of the volumes between shells of these windings, from the outside in.
double volume_between(const std::vector<double>& edges, const std::vector<bool>& solid) {
  double out = 0;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const double inner = k + 1 < edges.size() ? std::pow(edges[k + 1], 3) : 0;
    if (solid[k]) out += std::pow(edges[k], 3) - inner;
  }
  return out;
}

TEST(NestedShells, TwoOfThemAreASolidWithAVoidUnlessBothLookOutwards) {
  for (const bool outer : {false, true}) {
    for (const bool inner : {false, true}) {
      const auto [mesh, faults] = cubes({{2, outer}, {1, inner}});
      const bool part_in_part = !outer && !inner;
      EXPECT_TRUE(mesh->closed);
      EXPECT_NEAR(mesh_volume(*mesh), volume_between({2, 1}, {true, part_in_part}), 1e-12) << outer << inner;
      EXPECT_EQ(mesh->triangles.size(), part_in_part ? 12U : 24U);
      EXPECT_EQ(faults.enclosed_bodies, part_in_part);
      EXPECT_EQ(faults.turned_triangles, part_in_part ? 0 : 12 * outer + 12 * !inner);
      EXPECT_EQ(faults.inside_out, outer && !inner);
      EXPECT_EQ(faults.repeated_triangles, 0);
      EXPECT_FALSE(mesh_contains(*mesh, {3, 0, 0}));
      EXPECT_TRUE(mesh_contains(*mesh, {0, 0, 0.75}));
      EXPECT_EQ(mesh_contains(*mesh, {0.1, 0.05, 0.02}), part_in_part);
    }
  }
}

TEST(NestedShells, ThreeOfThemAreABodyInAVoidUnlessAPartStandsInAPart) {
  const std::vector<double> edges{2, 1, 0.5};
  for (int looks = 0; looks < 8; ++looks) {
    const bool outer = looks & 1, middle = looks & 2, inner = looks & 4;
    const auto [mesh, faults] = cubes({{edges[0], outer}, {edges[1], middle}, {edges[2], inner}});
    const bool part_in_part = !outer && !middle;  // What is in the material of both changes nothing either.
    const double wanted = part_in_part ? 8 : volume_between(edges, {true, false, true});
    EXPECT_TRUE(mesh->closed);
    EXPECT_NEAR(mesh_volume(*mesh), wanted, 1e-12) << outer << middle << inner;
    EXPECT_EQ(faults.enclosed_bodies, part_in_part ? 2 : 0);
    EXPECT_EQ(mesh_contains(*mesh, {0, 0, 0.4}), part_in_part);
    EXPECT_TRUE(mesh_contains(*mesh, {0.01, 0.02, 0.03}));
  }
}

TEST(NestedShells, EachOfSeveralVoidsIsLookedAtByItself) {
  for (int looks = 0; looks < 8; ++looks) {
    const bool outer = looks & 1, left = looks & 2, right = looks & 4;
    const auto [mesh, faults] = cubes({{0.5, left, {-0.5, 0, 0}}, {2, outer}, {0.5, right, {0.5, 0.1, 0}}});
    const double within = 0.125 * (outer || left) + 0.125 * (outer || right);
    EXPECT_NEAR(mesh_volume(*mesh), 8 - within, 1e-12) << looks;
    EXPECT_EQ(faults.enclosed_bodies, !outer * (!left + !right));
  }
}

TEST(NestedShells, BodiesBesideEachOtherAreTurnedEachByItself) {
  for (const bool second : {false, true}) {
    const auto [mesh, faults] = cubes({{1, true, {-2, 0, 0}}, {1, second, {2, 0, 0}}, {0.5, true, {2, 0, 0}}});
    EXPECT_NEAR(mesh_volume(*mesh), 2 - 0.125, 1e-12) << second;
  }
}

TEST(NestedShells, WhatCrossesOrTouchesIsNoVoid) {
  // Half of the small one stands out of the bounds' corner region, or its top is flush with the large one's.
  const std::vector<std::pair<Vector3d, double>> places{{{0.8, 0, 0}, 0.5}, {{0, 0, 0.75}, 0.5}, {{0.5, 0.5, 0.5}, 1}};
  for (const auto& [place, edge] : places) {
    for (const double turn : {0.0, 0.4}) {
      for (const bool inwards : {false, true}) {
        const auto [mesh, faults] = cubes({{2, false}, {edge, inwards, place}}, turn);
        EXPECT_NEAR(mesh_volume(*mesh), 8 + edge * edge * edge, 1e-12) << place.transpose();
        EXPECT_EQ(faults.enclosed_bodies, 0);
      }
    }
  }
}

TEST(NestedShells, ABodyOnTheFloorOfAVoidIsThere) {
  for (const double above : {0.0, 0.1}) {
    for (const double turn : {0.0, 0.4}) {
      for (const bool inwards : {false, true}) {
        const auto [mesh, faults] = cubes({{2, false}, {1, true}, {0.5, inwards, {0, 0, above - 0.25}}}, turn);
        EXPECT_NEAR(mesh_volume(*mesh), 8 - 1 + 0.125, 1e-12) << above << turn;
        EXPECT_EQ(faults.enclosed_bodies, 0);
      }
    }
  }
}

TEST(NestedShells, HollowBallsOfManyFaces) {
  const auto outer = shape_mesh(Sphere{1}, 64), inner = shape_mesh(Sphere{0.6}, 32);
  for (const bool inwards : {false, true}) {
    std::vector<Vector3d> v = outer->vertices;
    std::vector<std::array<int, 3>> t;
    for (const auto& f : outer->triangles) t.push_back({f[1], f[0], f[2]});
    const int first = static_cast<int>(v.size());
    v.insert(v.end(), inner->vertices.begin(), inner->vertices.end());
    for (const auto& f : inner->triangles)
      t.push_back({first + f[inwards ? 1 : 0], first + f[inwards ? 0 : 1], first + f[2]});
    EXPECT_NEAR(mesh_volume(*make_mesh(v, t)), mesh_volume(*outer) - mesh_volume(*inner), 1e-12);
  }
}

}  // namespace
}  // namespace mmgrasp
