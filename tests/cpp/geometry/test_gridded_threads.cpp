// Threads whose mesh is a grid around their axis: no edge of it runs along the root.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/segmentation/find_threads.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/geometry/fit_primitives.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/geometry/segment_mesh.hpp"

namespace mmgrasp {
namespace {

using detail::kPi;
using Eigen::Vector3d;

/// An M10 rod of 20 mm: radius(angle, height) at the corners of a grid of so many sides and rows a pitch.
struct ThreadGrid {
  int sides, rows;
  bool other_diagonal = false, left_handed = false;
  double crest_flat = 1.0 / 8, root_flat = 1.0 / 4;  ///< Of the pitch.
};

constexpr double kPitch = 1.5e-3, kCrest = 5e-3, kRoot = kCrest - 0.61343 * kPitch, kTurns = 14;

double radius_at(const ThreadGrid& grid, double turn, double height) {
  double at = height / kPitch - (grid.left_handed ? -turn : turn);
  at -= std::floor(at);
  const double from_crest = std::abs(at - 0.5), flank = (1 - grid.crest_flat - grid.root_flat) / 2;
  const double down = std::clamp((from_crest - grid.crest_flat / 2) / flank, 0.0, 1.0);
  return kCrest + down * (kRoot - kCrest);
}

/// With `head` a plain collar of 16 mm follows on the thread.
std::shared_ptr<const TriangleMesh> gridded(const ThreadGrid& grid, bool head = false) {
  std::vector<Vector3d> v;
  std::vector<std::array<int, 3>> t;
  const int rows = static_cast<int>(kTurns) * grid.rows;
  const auto ring = [&](double height, const auto& radius) {
    for (int s = 0; s < grid.sides; ++s) {
      const double turn = static_cast<double>(s) / grid.sides, r = radius(turn);
      v.emplace_back(r * std::cos(2 * kPi * turn), r * std::sin(2 * kPi * turn), height);
    }
  };
  for (int i = 0; i <= rows; ++i) {
    const double height = kPitch * i / grid.rows;
    ring(height, [&](double turn) { return radius_at(grid, turn, height); });
  }
  int rings = rows + 1;
  if (head) {
    for (const double height : {kTurns * kPitch, kTurns * kPitch + 0.006}) {
      ring(height, [](double) { return 8e-3; });
      ++rings;
    }
  }
  const double top = v.back().z();
  const int low = static_cast<int>(v.size()), high = low + 1;
  v.emplace_back(0, 0, 0);
  v.emplace_back(0, 0, top);
  const auto at = [&](int row, int s) { return row * grid.sides + s % grid.sides; };
  for (int s = 0; s < grid.sides; ++s) {
    t.push_back({low, at(0, s + 1), at(0, s)});
    t.push_back({high, at(rings - 1, s), at(rings - 1, s + 1)});
    for (int row = 0; row + 1 < rings; ++row) {
      const int a = at(row, s), b = at(row, s + 1), c = at(row + 1, s + 1), d = at(row + 1, s);
      if (grid.other_diagonal) {
        t.push_back({a, b, d});
        t.push_back({b, c, d});
      } else {
        t.push_back({a, b, c});
        t.push_back({a, c, d});
      }
    }
  }
  return make_mesh(std::move(v), std::move(t));
}

std::vector<ThreadGrid> grids() {
  std::vector<ThreadGrid> out;
  for (const int sides : {24, 48, 100})
    for (const int rows : {6, 8, 13, 24})
      for (const bool other : {false, true}) out.push_back({sides, rows, other});
  out.push_back({64, 10, false, true});
  out.push_back({64, 10, false, false, 0, 0});
  out.push_back({200, 40, true});
  return out;
}

std::string name_of(const ThreadGrid& g) {
  return std::to_string(g.sides) + " sides, " + std::to_string(g.rows) + " rows " + (g.other_diagonal ? "/" : "\\");
}

TEST(GriddedThreads, AreFoundWithTheirPitch) {
  for (const ThreadGrid& grid : grids()) {
    const auto mesh = gridded(grid);
    ASSERT_TRUE(mesh->closed);
    const std::vector<ScrewThread> found = detail::find_threads(*mesh);
    ASSERT_EQ(found.size(), 1U) << name_of(grid);
    EXPECT_NEAR(found[0].pitch, grid.left_handed ? -kPitch : kPitch, 0.01 * kPitch) << name_of(grid);
    EXPECT_NEAR(std::abs(found[0].T_mesh_thread.linear()(2, 2)), 1, 1e-5) << name_of(grid);
    EXPECT_NEAR(found[0].crest_radius, kCrest, 1e-4) << name_of(grid);
    // A grid's corners may all miss a sharp root.
    EXPECT_NEAR(found[0].root_radius, kRoot, kPitch / grid.rows) << name_of(grid);
    EXPECT_NEAR(found[0].length, kTurns * kPitch, kPitch) << name_of(grid);
    EXPECT_GT(found[0].faces.size(), 0.9 * static_cast<double>(mesh->triangles.size())) << name_of(grid);
  }
}

TEST(GriddedThreads, OnABoltAreOneSegmentBesideTheHead) {
  for (const ThreadGrid& grid : {ThreadGrid{48, 8}, ThreadGrid{100, 24, true}}) {
    const auto mesh = gridded(grid, true);
    ASSERT_TRUE(mesh->closed);
    const MeshSegmentation found = segment_mesh(*mesh);
    ASSERT_EQ(found.threads.size(), 1U) << name_of(grid);
    ASSERT_EQ(found.segments.size(), 2U) << name_of(grid);
    const auto fits = fit_primitives(*mesh, found.labels, found.threads);
    for (std::size_t k = 0; k < fits.size(); ++k) {
      EXPECT_EQ(fits[k].kind, PrimitiveKind::cylinder);
      EXPECT_NEAR(fits[k].size.x(), found.segments[k].threaded ? 2 * kCrest : 0.016, 1e-4) << name_of(grid);
    }
    EXPECT_NE(found.segments[0].threaded, found.segments[1].threaded);
  }
}

TEST(GriddedThreads, RingsOnAGridAreNone) {
  for (const int sides : {24, 48}) {
    for (const int rows : {6, 8, 13}) {
      const ThreadGrid grid{sides, rows};
      auto mesh = *gridded(grid);
      for (Vector3d& p : mesh.vertices) {
        if (p.head<2>().norm() == 0) continue;
        p.head<2>() *= radius_at(grid, 0, p.z()) / p.head<2>().norm();
      }
      EXPECT_TRUE(detail::find_threads(mesh).empty()) << name_of(grid);
    }
  }
}

}  // namespace
}  // namespace mmgrasp
