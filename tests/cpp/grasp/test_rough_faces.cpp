// Parts whose faces are not quite plane, parallel or round are held by their outermost points; bosses still block.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/grasp/assembly_grasps.hpp"
#include "mmgrasp/grasp/finger_length_range.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;
using Mesh = std::shared_ptr<const TriangleMesh>;

/// A closed surface of pieces whose corners may be moved.
struct Surface {
  std::vector<Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
  std::map<std::tuple<long, long, long>, int> known;

  int at(const Vector3d& p) {
    const auto key = std::make_tuple(std::lround(1e7 * p.x()), std::lround(1e7 * p.y()), std::lround(1e7 * p.z()));
    const auto [place, is_new] = known.emplace(key, static_cast<int>(vertices.size()));
    if (is_new) vertices.push_back(p);
    return place->second;
  }

  /// A face from a corner along two sides, `n` by `n` squares; outwards is u x v.
  void face(const Vector3d& corner, const Vector3d& u, const Vector3d& v, int n) {
    const auto p = [&](int i, int k) { return at(corner + u * i / n + v * k / n); };
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < n; ++k) {
        triangles.push_back({p(i, k), p(i + 1, k), p(i + 1, k + 1)});
        triangles.push_back({p(i, k), p(i + 1, k + 1), p(i, k + 1)});
      }
    }
  }

  void box(const Vector3d& low, const Vector3d& high, int n) {
    const Vector3d s = high - low;
    const Vector3d x(s.x(), 0, 0), y(0, s.y(), 0), z(0, 0, s.z());
    face(low + x, y, z, n);
    face(low, z, y, n);
    face(low + y, z, x, n);
    face(low, x, z, n);
    face(low + z, x, y, n);
    face(low, y, x, n);
  }

  Mesh with_noise(double deviation, unsigned seed = 1) const {
    Rng rng(seed);
    std::vector<Vector3d> moved = vertices;
    for (Vector3d& p : moved) {
      for (int k = 0; k < 3; ++k) p[k] += deviation * rng.normal();
    }
    return make_mesh(moved, triangles);
  }
};

/// 20 mm across x, 40 mm along y, 20 mm high.
Surface block() {
  Surface out;
  out.box({-0.01, -0.02, 0}, {0.01, 0.02, 0.02}, 8);
  return out;
}

struct Count {
  int tried = 0, free = 0;
  double narrowest = 1, widest = 0;  // Openings of those that are free [m].
};

Count count(const Mesh& mesh, const std::vector<AssemblyGrasp>& grasps) {
  AssemblyOperation operation;
  operation.active = {{"part", mesh}};
  operation.motion = {Pose::Identity()};
  Count out;
  for (const AssemblyGrasp& g : grasps) {
    ++out.tried;
    if (!finger_length_range(g, operation).free) continue;
    ++out.free;
    out.narrowest = std::min(out.narrowest, g.opening);
    out.widest = std::max(out.widest, g.opening);
  }
  return out;
}

/// Jaw grasps whose fingers close along x.
Count across_x(const Mesh& mesh) {
  std::vector<AssemblyGrasp> grasps;
  for (const AssemblyGrasp& g : jaw_grasps(*mesh))
    if (std::abs(g.T_active_tool.linear()(0, 0)) > 0.9) grasps.push_back(g);
  return count(mesh, grasps);
}

TEST(RoughFaces, BlocksWithNoiseAreHeldAsOftenAsWithout) {
  const Count smooth = across_x(block().with_noise(0));
  ASSERT_GT(smooth.free, 30);
  EXPECT_EQ(smooth.free, smooth.tried);
  EXPECT_NEAR(smooth.widest, 0.02, 1e-9);
  for (const double noise : {1e-6, 5e-6, 2e-5}) {
    for (const unsigned seed : {1u, 2u, 3u}) {
      const Count rough = across_x(block().with_noise(noise, seed));
      // The depths that fit are the same, and pads stand on what is outermost under them: none may be lost.
      EXPECT_EQ(rough.tried, smooth.tried) << noise;
      EXPECT_EQ(rough.free, smooth.free) << noise;
      // Two faces have 81 corners each: their outermost are off by no more than five deviations.
      EXPECT_GE(rough.narrowest, 0.02 - 2 * noise) << noise;
      EXPECT_LE(rough.widest, 0.02 + 10 * noise) << noise;
    }
  }
}

TEST(RoughFaces, DraftIsHeldAtTheWiderEndUnderThePads) {
  for (const double degrees : {0.1, 0.5}) {
    Surface drafted = block();
    const double lean = std::tan(degrees * M_PI / 180);  // Each face: wider towards the top.
    for (Vector3d& p : drafted.vertices) {
      if (std::abs(p.x()) > 0.0099) p.x() += std::copysign(lean * p.z(), p.x());
    }
    const Mesh mesh = drafted.with_noise(0);
    const Count found = across_x(mesh);
    EXPECT_EQ(found.free, found.tried) << degrees;
    EXPECT_GT(found.free, 30) << degrees;
    EXPECT_NEAR(found.widest, 0.02 + 2 * lean * 0.02, 1e-6) << degrees;
    for (const AssemblyGrasp& g : jaw_grasps(*mesh)) {
      const Vector3d z = g.T_active_tool.linear().col(2);
      if (std::abs(g.T_active_tool.linear()(0, 0)) < 0.9 || std::abs(z.z()) < 0.9) continue;
      // From below the pads stand on the width at the tips, from above on that at the top.
      const double tips = g.T_active_tool.translation().z();
      EXPECT_NEAR(g.opening, 0.02 + 2 * lean * (z.z() > 0 ? tips : 0.02), 1e-6) << degrees;
    }
  }
}

TEST(RoughFaces, FacesTiltedToOneSideAreHeldInTheirMiddle) {
  Surface leaning = block();
  for (Vector3d& p : leaning.vertices) {
    if (p.x() > 0.0099) p.x() += 0.001 * p.z() / 0.02;  // One face alone, by 0.05 rad.
  }
  const Mesh mesh = leaning.with_noise(0);
  const Count found = across_x(mesh);
  EXPECT_GT(found.free, 30);
  EXPECT_EQ(found.free, found.tried);
}

TEST(RoughFaces, ABossBesideTheSegmentStillBlocks) {
  for (const double noise : {0.0, 5e-6}) {
    Surface with_boss = block();
    // On the one face, 10 mm wide and 0.5 mm high, over its whole height.
    with_boss.box({0.01, -0.005, 0}, {0.0105, 0.005, 0.02}, 1);
    const Mesh mesh = with_boss.with_noise(noise);
    for (const AssemblyGrasp& g : jaw_grasps(*mesh)) {
      const Pose& T = g.T_active_tool;
      if (std::abs(T.linear()(0, 0)) < 0.9 || g.opening > 0.0203) continue;  // Those that stand on the boss are wider.
      AssemblyOperation operation;
      operation.active = {{"part", mesh}};
      operation.motion = {Pose::Identity()};
      const bool over_boss = std::abs(T.translation().y()) < 0.005 + 0.0075 && std::abs(T.linear()(2, 2)) > 0.9;
      if (over_boss) {
        EXPECT_FALSE(finger_length_range(g, operation).free) << noise;
      }
    }
  }
}

/// A ring of 20 mm, 20 mm high, with a bore of 10 mm.
Surface ring(double boss = 0) {
  Surface out;
  constexpr int kSides = 64, kRows = 5;
  const auto p = [&](double radius, int i, double z) {
    const double turn = 2 * M_PI * i / kSides, lifted = radius > 0.009 && i == 0 ? radius + boss : radius;
    return out.at({lifted * std::cos(turn), lifted * std::sin(turn), z});
  };
  const auto strip = [&](double r0, double z0, double r1, double z1) {
    for (int i = 0; i < kSides; ++i) {
      const int k = (i + 1) % kSides;
      out.triangles.push_back({p(r0, i, z0), p(r0, k, z0), p(r1, k, z1)});
      out.triangles.push_back({p(r0, i, z0), p(r1, k, z1), p(r1, i, z1)});
    }
  };
  for (int row = 0; row < kRows; ++row) {
    strip(0.01, 0.02 * row / kRows, 0.01, 0.02 * (row + 1) / kRows);
    strip(0.005, 0.02 * (row + 1) / kRows, 0.005, 0.02 * row / kRows);
  }
  strip(0.01, 0.02, 0.005, 0.02);
  strip(0.005, 0, 0.01, 0);
  return out;
}

CylinderFit ring_cylinder() {
  CylinderFit out;
  out.diameter = 0.02;
  out.low = 0;
  out.high = 0.02;
  return out;
}

TEST(RoughFaces, RingsWithNoiseAreHeldAsOftenAsWithout) {
  const Mesh smooth = ring().with_noise(0);
  const Count even = count(smooth, centric_grasps(*smooth, {}, ring_cylinder()));
  ASSERT_GT(even.free, 30);
  EXPECT_EQ(even.free, even.tried);
  EXPECT_EQ(even.widest, 0.02);
  EXPECT_EQ(even.narrowest, 0.02);
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Mesh rough = ring().with_noise(2e-5, seed);
    const Count found = count(rough, centric_grasps(*rough, {}, ring_cylinder()));
    // Some 400 corners: in one of forty rings one is off by more than the four deviations that count as rough.
    EXPECT_EQ(found.tried, even.tried) << seed;
    EXPECT_EQ(found.free, even.free) << seed;
    EXPECT_LE(found.widest, 0.02 + 2 * 5 * 2e-5) << seed;
  }
}

TEST(RoughFaces, ARidgeOnARingStillBlocks) {
  for (const double noise : {0.0, 5e-6}) {
    const Mesh mesh = ring(0.0005).with_noise(noise);
    CylinderFit cylinder = ring_cylinder();
    const std::vector<AssemblyGrasp> grasps = centric_grasps(*mesh, {}, cylinder);
    int over_ridge = 0;
    for (const AssemblyGrasp& g : grasps) {
      bool over = false;
      for (int i = 0; i < 3; ++i) {
        const double turn = 2 * M_PI * i / 3;
        over = over || (g.T_active_tool.linear() * Vector3d(std::cos(turn), std::sin(turn), 0)).x() > 0.999;
      }
      AssemblyOperation operation;
      operation.active = {{"part", mesh}};
      operation.motion = {Pose::Identity()};
      if (over) {
        EXPECT_FALSE(finger_length_range(g, operation).free) << noise;
      }
      over_ridge += over;
    }
    EXPECT_GT(over_ridge, 0);
  }
}

}  // namespace
}  // namespace mmgrasp
