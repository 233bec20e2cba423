#include "mmgrasp/grasp/assembly_grasps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

std::shared_ptr<const TriangleMesh> box(double x, double y, double z) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back((i & 1 ? x : -x) / 2, (i & 2 ? y : -y) / 2, (i & 4 ? z : -z) / 2);
  }
  return convex_hull(corners);
}

/// An upright prism over a regular polygon whose opposite sides are `width` apart.
std::shared_ptr<const TriangleMesh> prism(int sides, double width, double height) {
  std::vector<Eigen::Vector3d> corners;
  const double radius = width / 2 / std::cos(M_PI / sides);
  for (int i = 0; i < sides; ++i) {
    const double turn = 2 * M_PI * i / sides;
    for (const double z : {0.0, height}) corners.emplace_back(radius * std::cos(turn), radius * std::sin(turn), z);
  }
  return convex_hull(corners);
}

TEST(PlanarFacets, OfABoxAndANut) {
  const auto mesh = box(0.02, 0.03, 0.05);
  const auto facets = planar_facets(*mesh);
  ASSERT_EQ(facets.size(), 6u);
  EXPECT_NEAR(facets[0].area, 0.03 * 0.05, 1e-12);
  EXPECT_NEAR(facets[5].area, 0.02 * 0.03, 1e-12);
  for (const Facet& f : facets) {
    EXPECT_NEAR(f.normal.cwiseAbs().maxCoeff(), 1, 1e-12);
    EXPECT_NEAR(f.centre.cwiseAbs().sum(), f.centre.cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_GT(f.centre.dot(f.normal), 0);
  }
  EXPECT_EQ(planar_facets(*prism(6, 0.017, 0.01)).size(), 8u);
  EXPECT_THROW(planar_facets(*mesh, {99}), InvalidInput);
}

TEST(JawGrasps, OpenAsFarAsFacesAreApart) {
  std::set<int> openings;  // [0.1 mm]
  for (const AssemblyGrasp& g : jaw_grasps(*box(0.02, 0.03, 0.05))) {
    openings.insert(static_cast<int>(std::lround(1e4 * g.opening)));
    // The tool stands half way between the faces, the tips at most a pad deep.
    const Eigen::Vector3d x = g.T_active_tool.linear().col(0), z = g.T_active_tool.linear().col(2);
    EXPECT_NEAR(x.dot(g.T_active_tool.translation()), 0, 1e-9);
    EXPECT_NEAR(x.dot(z), 0, 1e-12);
    EXPECT_NEAR(g.T_active_tool.linear().determinant(), 1, 1e-9);
  }
  EXPECT_EQ(openings, (std::set<int>{200, 300, 500}));
  std::set<int> of_nut;
  for (const AssemblyGrasp& g : jaw_grasps(*prism(6, 0.017, 0.01))) of_nut.insert(std::lround(1e4 * g.opening));
  EXPECT_EQ(of_nut, (std::set<int>{100, 170}));
  EXPECT_TRUE(jaw_grasps(*prism(3, 0.017, 0.01), {}, {}).size() > 0);  // By its ends.
  for (const AssemblyGrasp& g : jaw_grasps(*prism(3, 0.017, 0.01))) EXPECT_NEAR(g.opening, 0.01, 1e-9);
}

TEST(JawGrasps, DepthsFollowTheOverlap) {
  AssemblyGraspOptions options;
  options.directions = 4;
  std::set<int> tips;  // Along -z from the upper end [0.1 mm].
  for (const AssemblyGrasp& g : jaw_grasps(*box(0.02, 0.03, 0.05), {}, options)) {
    if (g.T_active_tool.linear().col(2).z() < -0.99 && g.opening < 0.025)
      tips.insert(std::lround(1e4 * (0.025 - g.T_active_tool.translation().z())));
  }
  EXPECT_EQ(tips, (std::set<int>{30, 100, 200}));
}

TEST(JawGrasps, FacetsThatDoNotFaceEachOtherAreNoPair) {
  // A step: its upper and its lower ledge look the same way, two far apart faces never overlap.
  std::vector<Eigen::Vector3d> corners;
  const auto a = box(0.02, 0.02, 0.01);
  std::vector<Eigen::Vector3d> vertices = a->vertices;
  std::vector<std::array<int, 3>> triangles = a->triangles;
  for (const Eigen::Vector3d& v : a->vertices) vertices.push_back(v + Eigen::Vector3d(0.1, 0, 0.03));
  for (auto t : a->triangles) triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  const auto mesh = make_mesh(vertices, triangles);
  std::set<int> openings;
  for (const AssemblyGrasp& g : jaw_grasps(*mesh)) openings.insert(std::lround(1e4 * g.opening));
  EXPECT_EQ(openings, (std::set<int>{100, 200}));  // 0.04 between the ledges is not among them.
}

TEST(CentricGrasps, StandOnTheAxis) {
  CylinderFit cylinder;
  cylinder.T_mesh_cylinder.translation() << 0.1, 0.2, 0.3;
  cylinder.T_mesh_cylinder.linear() = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()).toRotationMatrix();
  cylinder.diameter = 0.04;
  cylinder.low = -0.005;
  cylinder.high = 0.005;
  AssemblyGraspOptions options;
  options.directions = 3;
  const auto grasps = centric_grasps(cylinder, options);
  EXPECT_EQ(grasps.size(), 2u * 2u * 3u);  // Ends, depths of 3 and 10 mm, turns.
  for (const AssemblyGrasp& g : grasps) {
    const Pose in_cylinder = cylinder.T_mesh_cylinder.inverse() * g.T_active_tool;
    EXPECT_NEAR(in_cylinder.translation().head<2>().norm(), 0, 1e-12);
    const double approach = in_cylinder.linear()(2, 2), z = in_cylinder.translation().z();
    EXPECT_NEAR(std::abs(approach), 1, 1e-12);
    const double depth = approach < 0 ? 0.005 - z : z + 0.005;
    EXPECT_TRUE(std::abs(depth - 0.003) < 1e-9 || std::abs(depth - 0.01) < 1e-9) << depth;
    EXPECT_EQ(g.opening, 0.04);
  }
  cylinder.high = cylinder.low;
  EXPECT_THROW(centric_grasps(cylinder), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
