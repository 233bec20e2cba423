// Meshes with faces turned round, stored twice, or of several bodies: what was found, and what was mended.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <utility>

#include "mmgrasp/geometry/detail/mesh_faults.hpp"
#include "mmgrasp/geometry/detail/separate_bodies.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp {
namespace {

TEST(MeshFaults, WhatWasTurnedOrRepeatedIsCounted) {
  for (const bool open : {false, true}) {
    TriangleMesh box = *shape_mesh(Box{{1, 2, 3}});
    if (open) box.triangles.pop_back();
    const int faces = static_cast<int>(box.triangles.size());
    const auto built = [&](int turned, bool twice) {
      auto triangles = box.triangles;
      for (int i = 0; i < turned; ++i) std::swap(triangles[i][0], triangles[i][1]);
      const auto once = triangles;
      if (twice) triangles.insert(triangles.end(), once.begin(), once.end());
      detail::MeshFaults faults;
      const auto mesh = detail::make_mesh(box.vertices, triangles, faults);
      EXPECT_EQ(mesh->closed, !open);
      EXPECT_EQ(static_cast<int>(mesh->triangles.size()), faces);
      EXPECT_EQ(faults.repeated_triangles, twice ? faces : 0);
      return std::make_pair(mesh, faults);
    };
    const double volume = mesh_volume(*built(0, false).first);
    for (const bool twice : {false, true}) {
      for (const int turned : {0, 1, 6, 7, 10}) {
        const auto [mesh, faults] = built(turned, twice);
        EXPECT_EQ(faults.turned_triangles, turned) << open << twice;
        EXPECT_FALSE(faults.inside_out);
        EXPECT_NEAR(mesh_volume(*mesh), volume, 1e-12) << open << twice << turned;
      }
      const detail::MeshFaults all = built(faces, twice).second;
      EXPECT_TRUE(all.inside_out);
      EXPECT_EQ(all.turned_triangles, open ? 0 : faces);  // An open one is left as it is.
    }
  }
}

TEST(MeshFaults, FacesOfASheetLookAsMostOfItDid) {
  // 3 x 1 squares, two triangles each; the last square is turned.
  std::vector<Eigen::Vector3d> v;
  for (int x = 0; x < 4; ++x) {
    v.emplace_back(x, 0, 0);
    v.emplace_back(x, 1, 0);
  }
  std::vector<std::array<int, 3>> t;
  for (int x = 0; x < 3; ++x) {
    t.push_back({2 * x, 2 * x + 2, 2 * x + 3});
    t.push_back({2 * x, 2 * x + 3, 2 * x + 1});
    if (x == 2)
      for (auto* last : {&t[4], &t[5]}) std::swap((*last)[0], (*last)[1]);
  }
  detail::MeshFaults faults;
  const auto mesh = detail::make_mesh(v, t, faults);
  EXPECT_EQ(faults.turned_triangles, 2);
  for (const auto& f : mesh->triangles)
    EXPECT_GT((mesh->vertices[f[1]] - mesh->vertices[f[0]]).cross(mesh->vertices[f[2]] - mesh->vertices[f[0]]).z(), 0);
}

TEST(MeshFaults, BodiesThatDoNotTouchAreCounted) {
  const auto bodies = [](const std::vector<std::pair<Box, Eigen::Vector3d>>& boxes, bool inner_is_cavity = false) {
    std::vector<Eigen::Vector3d> v;
    std::vector<std::array<int, 3>> t;
    for (const auto& [box, place] : boxes) {
      const auto one = shape_mesh(box);
      const int first = static_cast<int>(v.size());
      for (const Eigen::Vector3d& p : one->vertices) v.push_back(p + place);
      const bool turned = inner_is_cavity && t.size() == 12;
      for (const auto& f : one->triangles)
        t.push_back({first + f[0], first + f[turned ? 2 : 1], first + f[turned ? 1 : 2]});
    }
    return detail::count_bodies(*make_mesh(v, t));
  };
  const Box unit{{1, 1, 1}}, half{{0.5, 0.5, 0.5}}, tenth{{0.1, 0.1, 0.1}}, long_half{{1, 0.5, 0.5}},
      bar{{3, 0.2, 0.2}}, across{{0.2, 3, 0.2}};
  EXPECT_EQ(bodies({{unit, {0, 0, 0}}}), 1);
  EXPECT_EQ(bodies({{unit, {0, 0, 0}}, {unit, {1.01, 0, 0}}}), 2);
  EXPECT_EQ(bodies({{unit, {0, 0, 0}}, {unit, {1, 0, 0}}}), 1);                               // a face in common
  EXPECT_EQ(bodies({{unit, {0, 0, 0}}, {half, {0.1, 0.05, 0.75}}}), 1);                       // stands on it
  EXPECT_EQ(bodies({{unit, {0, 0, 0}}, {half, {0.1, 0.05, 0.76}}}), 2);                       // floats
  EXPECT_EQ(bodies({{bar, {0, 0, 0}}, {across, {0, 0, 0.1}}}), 1);                            // bars that cross
  EXPECT_EQ(bodies({{bar, {0, 0, 0}}, {across, {0, 0, 0.3}}}), 2);                            // one above the other
  EXPECT_EQ(bodies({{unit, {0, 0, 0}}, {half, {0, 0, 0}}}), 1);                               // within its material
  EXPECT_EQ(bodies({{unit, {0, 0, 0}}, {half, {0, 0, 0}}}, true), 1);                         // a cavity
  EXPECT_EQ(bodies({{unit, {0, 0, 0}}, {half, {0, 0, 0}}, {tenth, {0.05, 0, 0}}}, true), 2);  // loose in the cavity
  EXPECT_EQ(bodies({{unit, {0, 0, 0}}, {unit, {2, 0, 0}}, {unit, {4, 0, 0}}, {long_half, {3, 0, 0}}}), 2);
}

}  // namespace
}  // namespace mmgrasp
