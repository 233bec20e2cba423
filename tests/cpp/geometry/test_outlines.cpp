// Primitives through the crests of surfaces that are not smooth: grooves, flutes and knurls have the outline's width.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/geometry/fit_primitives.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/geometry/segment_mesh.hpp"

namespace mmgrasp {
namespace {

using detail::kPi;
using Eigen::Vector3d;

/// A body around z: radius by turn (0 to 1) and height, at the corners of a grid over `heights`.
std::shared_ptr<const TriangleMesh> around_axis(const std::vector<double>& heights, int sides,
                                                const std::function<double(double, double)>& radius, double noise = 0) {
  std::vector<Vector3d> v;
  std::vector<std::array<int, 3>> t;
  Rng rng(7);
  for (const double z : heights) {
    for (int s = 0; s < sides; ++s) {
      const double turn = static_cast<double>(s) / sides, r = radius(turn, z) + noise * rng.normal();
      v.emplace_back(r * std::cos(2 * kPi * turn), r * std::sin(2 * kPi * turn), z);
    }
  }
  const int low = static_cast<int>(v.size()), high = low + 1, rings = static_cast<int>(heights.size());
  v.emplace_back(0, 0, heights.front());
  v.emplace_back(0, 0, heights.back());
  const auto at = [&](int row, int s) { return row * sides + s % sides; };
  for (int s = 0; s < sides; ++s) {
    t.push_back({low, at(0, s + 1), at(0, s)});
    t.push_back({high, at(rings - 1, s), at(rings - 1, s + 1)});
    for (int row = 0; row + 1 < rings; ++row) {
      t.push_back({at(row, s), at(row, s + 1), at(row + 1, s + 1)});
      t.push_back({at(row, s), at(row + 1, s + 1), at(row + 1, s)});
    }
  }
  return make_mesh(std::move(v), std::move(t));
}

std::vector<double> steps(double length, int count) {
  std::vector<double> out;
  for (int i = 0; i <= count; ++i) out.push_back(length * i / count);
  return out;
}

/// A shaft of 20 mm, 30 mm long, with grooves side by side all along; `from_root`: its ends are at the groove's ground.
std::shared_ptr<const TriangleMesh> grooved(double depth, double pitch, int sides, bool from_root = false,
                                            double noise = 0) {
  const int grooves = static_cast<int>(std::round(0.03 / pitch));
  std::vector<double> heights = steps(0.03, 2 * grooves);
  const double half = 0.03 / (2 * grooves);
  return around_axis(
      heights, sides,
      [&](double, double z) { return 0.01 - (std::lround(z / half) % 2 == (from_root ? 0 : 1) ? depth : 0); }, noise);
}

FittedPrimitive largest_primitive(const TriangleMesh& mesh) {
  const MeshSegmentation cut = segment_mesh(mesh);
  return fit_primitives(mesh, cut.labels, cut.threads).at(0);
}

TEST(Outlines, AGroovedShaftIsTheCylinderOfItsCrests) {
  for (const int sides : {24}) {
    for (const double depth : {1e-4, 2e-4}) {
      for (const double pitch : {4e-4, 1e-3, 3e-3}) {
        if (pitch < 2 * depth) continue;  // steeper than 45 degrees
        for (const bool from_root : {false, true}) {
          const auto mesh = grooved(depth, pitch, sides, from_root);
          ASSERT_TRUE(mesh->closed);
          const MeshSegmentation cut = segment_mesh(*mesh);
          const std::string about = std::to_string(sides) + " sides, " + std::to_string(1e3 * depth) + " deep, pitch " +
                                    std::to_string(1e3 * pitch) + (from_root ? " from root" : "");
          EXPECT_EQ(cut.segments.size(), 1U) << about;
          EXPECT_TRUE(cut.threads.empty()) << about;
          const FittedPrimitive fit = fit_primitives(*mesh, cut.labels).at(0);
          EXPECT_EQ(fit.kind, PrimitiveKind::cylinder) << about;
          if (fit.kind != PrimitiveKind::cylinder) continue;
          ASSERT_EQ(fit.widths.size(), 1U) << about;
          EXPECT_NEAR(fit.widths[0].width, 0.02, 1e-4) << about;
          EXPECT_NEAR(std::abs(fit.widths[0].axis.z()), 1, 1e-4) << about;
          EXPECT_NEAR(fit.size.z(), 0.03 - (from_root ? pitch : 0), 1e-5) << about;  // from crest to crest
        }
      }
    }
  }
}

TEST(Outlines, NoiseOnASmoothShaftDoesNotWidenIt) {
  const auto mesh = around_axis(
      steps(0.03, 30), 64, [](double, double) { return 0.01; }, 2e-5);
  const FittedPrimitive fit = fit_primitives(*mesh, std::vector<int>(mesh->triangles.size(), 0)).at(0);
  EXPECT_EQ(fit.kind, PrimitiveKind::cylinder);
  EXPECT_NEAR(fit.size.x(), 0.02, 1e-5);
}

TEST(Outlines, AKnurledShaftIsTheCylinderOfItsCrests) {
  // Pyramids of 0.3 mm, 40 around.
  const auto mesh = around_axis(steps(0.03, 40), 80, [](double turn, double z) {
    const long row = std::lround(z / 0.00075), column = std::lround(80 * turn);
    return 0.01 - (row % 2 == column % 2 ? 0.0 : 3e-4);
  });
  const FittedPrimitive fit = fit_primitives(*mesh, std::vector<int>(mesh->triangles.size(), 0)).at(0);
  EXPECT_EQ(fit.kind, PrimitiveKind::cylinder);
  EXPECT_NEAR(fit.size.x(), 0.02, 1e-4);
}

TEST(Outlines, PolygonsStayBoxes) {
  // Hexagons and octagons, plain and with chamfered corners as nuts have them.
  for (const int corners : {3, 4, 5, 6, 8}) {
    for (const double chamfer : {0.0, 0.05}) {
      const auto flat = [&](double turn, double z) {
        const double in_sector = 2 * kPi * (turn * corners - std::floor(turn * corners) - 0.5) / corners;
        const double side = 0.01 / std::cos(in_sector), end = std::min(z, 0.012 - z);
        const double widest = 0.01 / std::cos(kPi / corners) * (1 - chamfer * (end < 1e-9));
        return std::min(side, widest);
      };
      const std::vector<double> heights = chamfer > 0 ? std::vector<double>{0, 5e-4, 0.0115, 0.012} : steps(0.012, 1);
      const auto mesh = around_axis(heights, 24 * corners, flat);
      ASSERT_TRUE(mesh->closed);
      const FittedPrimitive fit = fit_primitives(*mesh, std::vector<int>(mesh->triangles.size(), 0)).at(0);
      EXPECT_EQ(fit.kind, PrimitiveKind::box) << corners << " " << chamfer;
      if (corners % 2 != 0) continue;
      bool across_flats = false;
      for (const GraspWidth& w : fit.widths) across_flats |= std::abs(w.width - 0.02) < 1e-6;
      EXPECT_TRUE(across_flats) << corners << " " << chamfer;
    }
  }
}

TEST(Outlines, TipsOfAStarAreNoCylinder) {
  for (const int tips : {12, 24, 40}) {
    const auto mesh = around_axis(steps(0.03, 6), 2 * tips,
                                  [&](double turn, double) { return std::lround(2 * tips * turn) % 2 ? 0.006 : 0.01; });
    const FittedPrimitive fit = fit_primitives(*mesh, std::vector<int>(mesh->triangles.size(), 0)).at(0);
    EXPECT_EQ(fit.kind, PrimitiveKind::box) << tips;
  }
}

}  // namespace
}  // namespace mmgrasp
