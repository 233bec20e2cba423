// Widths between parallel jaws: prisms of known profiles, coarse, fine and rough.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/geometry/fit_primitives.hpp"
#include "mmgrasp/geometry/opposite_facets.hpp"
#include "mmgrasp/geometry/segment_mesh.hpp"
#include "mmgrasp/grasp/assembly_grasps.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A profile of squares of 5 mm, `rows` from the top, as a prism along z; each square is cut into n x n.
struct SquareProfile {
  const char* name;
  std::vector<const char*> rows;
  std::vector<double> widths;  ///< Across x and y, each once per axis [mm], ascending; the length comes on top.
};

constexpr double kSquare = 0.005, kLength = 0.03;

/// A prism of a filled pattern: walls where a square has no neighbour, caps over every square.
std::shared_ptr<const TriangleMesh> prism(const SquareProfile& profile, int n, double noise = 0) {
  std::vector<Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
  const auto quad = [&](const Vector3d& corner, const Vector3d& u, const Vector3d& v, int along_u, int along_v) {
    for (int i = 0; i < along_u; ++i) {
      for (int k = 0; k < along_v; ++k) {
        const int first = static_cast<int>(vertices.size());
        for (const Vector2d& p : {Vector2d(i, k), Vector2d(i + 1, k), Vector2d(i + 1, k + 1), Vector2d(i, k + 1)})
          vertices.emplace_back(1e-9 * (1e9 * (corner + u * p.x() / along_u + v * p.y() / along_v)).array().round());
        triangles.push_back({first, first + 1, first + 2});
        triangles.push_back({first, first + 2, first + 3});
      }
    }
  };
  const int height = static_cast<int>(profile.rows.size());
  const auto filled = [&](int x, int y) {
    const int row = height - 1 - y;
    if (row < 0 || row >= height || x < 0 || x >= static_cast<int>(std::string(profile.rows[row]).size())) return false;
    return profile.rows[row][x] == '#';
  };
  const Vector3d x(kSquare, 0, 0), y(0, kSquare, 0), z(0, 0, kLength);
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < static_cast<int>(std::string(profile.rows[0]).size()); ++i) {
      if (!filled(i, j)) continue;
      const Vector3d low = i * x + j * y;
      const int m = static_cast<int>(kLength / kSquare) * n;
      quad(low, y, x, n, n);
      quad(low + z, x, y, n, n);
      if (!filled(i - 1, j)) quad(low, z, y, m, n);
      if (!filled(i + 1, j)) quad(low + x, y, z, n, m);
      if (!filled(i, j - 1)) quad(low, x, z, n, m);
      if (!filled(i, j + 1)) quad(low + y, z, x, m, n);
    }
  }
  const auto mesh = make_mesh(vertices, triangles);
  if (noise == 0) return mesh;
  Rng rng(3);
  std::vector<Vector3d> moved = mesh->vertices;
  for (Vector3d& p : moved)
    for (int k = 0; k < 3; ++k) p[k] += noise * rng.normal();
  return make_mesh(moved, mesh->triangles);
}

const std::vector<SquareProfile>& profiles() {
  static const std::vector<SquareProfile> all{
      {"L",
       {"#...........", "#...........", "#...........", "#...........", "#...........", "#...........", "#...........",
        "############"},
       {5, 5, 40, 60}},
      {"U", {"#......#", "#......#", "#......#", "#......#", "########"}, {5, 5, 25, 40}},
      {"T", {"##########", "....##....", "....##....", "....##....", "....##...."}, {5, 10, 25, 50}},
  };
  return all;
}

std::vector<double> sorted_millimetres(const std::vector<GraspWidth>& widths) {
  std::vector<double> out;
  for (const GraspWidth& w : widths) out.push_back(1e3 * w.width);
  std::sort(out.begin(), out.end());
  return out;
}

void expect_widths(const SquareProfile& profile, const std::vector<GraspWidth>& found, double tolerance) {
  std::vector<double> wanted = profile.widths;
  wanted.push_back(1e3 * kLength);
  std::sort(wanted.begin(), wanted.end());
  const std::vector<double> got = sorted_millimetres(found);
  ASSERT_EQ(got.size(), wanted.size()) << profile.name << ": " << ::testing::PrintToString(got);
  for (std::size_t k = 0; k < got.size(); ++k) EXPECT_NEAR(got[k], wanted[k], tolerance) << profile.name;
}

TEST(OppositeFacets, WidthsOfPrismsAreThoseOfTheirProfiles) {
  for (const SquareProfile& profile : profiles()) {
    for (const int n : {1, 6}) {
      const auto mesh = prism(profile, n);
      ASSERT_TRUE(mesh->closed);
      const auto fits = fit_primitives(*mesh, std::vector<int>(mesh->triangles.size(), 0));
      ASSERT_EQ(fits[0].kind, PrimitiveKind::box);
      expect_widths(profile, fits[0].widths, 1e-6);
    }
  }
}

TEST(OppositeFacets, RoughFacesHaveTheWidthsOfSmoothOnes) {
  for (const SquareProfile& profile : profiles()) {
    const auto mesh = prism(profile, 3, 1e-5);
    expect_widths(profile, fit_primitives(*mesh, std::vector<int>(mesh->triangles.size(), 0))[0].widths, 0.01);
  }
}

TEST(OppositeFacets, WhatIsListedIsWhatIsHeld) {
  for (const SquareProfile& profile : profiles()) {
    const auto mesh = prism(profile, 2);
    const MeshSegmentation cut = segment_mesh(*mesh);
    const auto fits = fit_primitives(*mesh, cut.labels);
    for (std::size_t s = 0; s < fits.size(); ++s) {
      ASSERT_EQ(fits[s].kind, PrimitiveKind::box) << profile.name;
      std::vector<long> listed, held;
      for (const GraspWidth& w : fits[s].widths) listed.push_back(std::lround(1e6 * w.width));
      for (const AssemblyGrasp& g : jaw_grasps(*mesh, cut.segments[s].faces))
        held.push_back(std::lround(1e6 * g.opening));
      for (std::vector<long>* numbers : {&listed, &held}) {
        std::sort(numbers->begin(), numbers->end());
        numbers->erase(std::unique(numbers->begin(), numbers->end()), numbers->end());
      }
      EXPECT_EQ(listed, held) << profile.name << " " << s;
    }
  }
}

TEST(OppositeFacets, CoverIsTheShareOfTheShadow) {
  const auto mesh = prism(profiles()[0], 1);
  const auto fits = fit_primitives(*mesh, std::vector<int>(mesh->triangles.size(), 0));
  for (const GraspWidth& w : fits[0].widths) {
    const bool along_x = std::abs(w.axis.x()) > 0.99;
    const std::map<long, double> shares{
        {5, along_x ? 35.0 / 40 : 55.0 / 60}, {30, 475.0 / 2400}, {40, 5.0 / 60}, {60, 5.0 / 40}};
    EXPECT_NEAR(w.covered, shares.at(std::lround(1e3 * w.width)), 1e-9);
  }
}

TEST(OppositeFacets, LessThanTheLeastContactIsNotHeld) {
  const auto mesh = prism(profiles()[0], 1);
  const std::vector<int> labels(mesh->triangles.size(), 0);
  // The ends of the legs are 5 mm x 30 mm: with contacts of 31 mm they hold nothing, the walls' 35 and 55 mm do.
  const auto widths = sorted_millimetres(fit_primitives(*mesh, labels, {}, {}, 0.031)[0].widths);
  ASSERT_EQ(widths.size(), 2U) << ::testing::PrintToString(widths);
  EXPECT_NEAR(widths[0], 5, 1e-6);
  EXPECT_NEAR(widths[1], 5, 1e-6);
  EXPECT_THROW(fit_primitives(*mesh, labels, {}, {}, 0), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
