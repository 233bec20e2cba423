// Widths that are listed are those that fingers reach from outside.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/geometry/fit_primitives.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/geometry/opposite_facets.hpp"
#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp {
namespace {

using detail::kPi;
using Eigen::Vector3d;

std::vector<long> microns(const std::vector<GraspWidth>& widths) {
  std::vector<long> out;
  for (const GraspWidth& w : widths) out.push_back(std::lround(1e6 * w.width));
  std::sort(out.begin(), out.end());
  return out;
}

FittedPrimitive whole(const TriangleMesh& mesh) {
  return fit_primitives(mesh, std::vector<int>(mesh.triangles.size(), 0)).at(0);
}

/// All that lie opposite each other, whether fingers get there or not.
int pairs_of(const TriangleMesh& mesh) {
  int out = 0;
  visit_opposite_facets(mesh, {}, {}, [&](const OppositeFacets&) { ++out; });
  return out;
}

TEST(JawReach, WallsOfAVoidAreNotListed) {
  for (const double turn : {0.0, 0.7}) {
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(turn, Vector3d(3, 1, 2).normalized()).toRotationMatrix();
    const auto outer = shape_mesh(Box{{0.04, 0.03, 0.02}}), inner = shape_mesh(Box{{0.02, 0.012, 0.008}});
    std::vector<Vector3d> v;
    std::vector<std::array<int, 3>> t = outer->triangles;
    for (const Vector3d& p : outer->vertices) v.push_back(rotation * p);
    const int first = static_cast<int>(v.size());
    for (const Vector3d& p : inner->vertices) v.push_back(rotation * p);
    for (const auto& f : inner->triangles) t.push_back({first + f[1], first + f[0], first + f[2]});
    const auto mesh = make_mesh(v, t);
    EXPECT_EQ(pairs_of(*mesh), 9);
    EXPECT_EQ(microns(whole(*mesh).widths), (std::vector<long>{20000, 30000, 40000}));
  }
}

/// A channel along x, open above: walls of 5 mm and a gap between them, 40 mm long and 15 mm deep.
std::shared_ptr<const TriangleMesh> channel(double gap, double turn) {
  const std::vector<Eigen::Vector2d> profile{
      {0, 0},         {gap + 0.01, 0}, {gap + 0.01, 0.02}, {gap + 0.005, 0.02}, {gap + 0.005, 0.005},
      {0.005, 0.005}, {0.005, 0.02},   {0, 0.02}};
  const std::vector<std::array<int, 3>> cap{{0, 1, 4}, {1, 2, 3}, {1, 3, 4}, {0, 4, 5}, {0, 5, 7}, {5, 6, 7}};
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(turn, Vector3d(3, 1, 2).normalized()).toRotationMatrix();
  std::vector<Vector3d> v;
  for (const double x : {0.0, 0.04})
    for (const auto& p : profile) v.emplace_back(rotation * Vector3d(x, p.x(), p.y()));
  std::vector<std::array<int, 3>> t;
  for (const auto& f : cap) {
    t.push_back({f[2], f[1], f[0]});
    t.push_back({f[0] + 8, f[1] + 8, f[2] + 8});
  }
  for (int i = 0; i < 8; ++i) {
    const int k = (i + 1) % 8;
    t.push_back({i, k, k + 8});
    t.push_back({i, k + 8, i + 8});
  }
  return make_mesh(v, t);
}

TEST(JawReach, WallsAreListedWhereAFingerFitsBetweenThem) {
  for (const double turn : {0.0, 0.7}) {
    const std::vector<long> wide{5000, 5000, 20000, 30000, 40000}, narrow{12000, 20000, 40000};
    const auto open = channel(0.02, turn), slit = channel(0.002, turn);
    ASSERT_TRUE(open->closed && slit->closed);
    EXPECT_EQ(microns(whole(*open).widths), wide);
    EXPECT_EQ(microns(whole(*slit).widths), narrow);
  }
}

/// Teeth of a trapezoid profile, twisted along the axis: module 2, 20 teeth, 20 mm wide.
std::shared_ptr<const TriangleMesh> helical_gear(double helix_angle) {
  constexpr double kModule = 0.002, kLength = 0.02;
  constexpr int kTeeth = 20, kRows = 24;
  const double pitch_radius = kModule * kTeeth / 2, tip = pitch_radius + kModule, root = pitch_radius - 1.25 * kModule;
  const std::vector<std::pair<double, double>> tooth{{0.12, root}, {0.44, tip}, {0.56, tip}, {0.88, root}};
  const int sides = 4 * kTeeth;
  std::vector<Vector3d> v;
  for (int row = 0; row <= kRows; ++row) {
    const double z = kLength * row / kRows, twist = z * std::tan(helix_angle) / pitch_radius;
    for (int k = 0; k < kTeeth; ++k) {
      for (const auto& [share, r] : tooth) {
        const double angle = 2 * kPi * (k + share) / kTeeth + twist;
        v.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
      }
    }
  }
  const int low = static_cast<int>(v.size()), high = low + 1;
  v.emplace_back(0, 0, 0);
  v.emplace_back(0, 0, kLength);
  std::vector<std::array<int, 3>> t;
  const auto at = [&](int row, int s) { return row * sides + s % sides; };
  for (int s = 0; s < sides; ++s) {
    t.push_back({low, at(0, s + 1), at(0, s)});
    t.push_back({high, at(kRows, s), at(kRows, s + 1)});
    for (int row = 0; row < kRows; ++row) {
      t.push_back({at(row, s), at(row, s + 1), at(row + 1, s + 1)});
      t.push_back({at(row, s), at(row + 1, s + 1), at(row + 1, s)});
    }
  }
  return make_mesh(v, t);
}

TEST(JawReach, FlanksOfTeethAreNotListed) {
  for (const double angle : {0.0, 0.1, 0.2}) {
    const auto gear = helical_gear(angle);
    ASSERT_TRUE(gear->closed);
    EXPECT_GT(pairs_of(*gear), 1) << angle;
    for (const GraspWidth& w : whole(*gear).widths) {
      const bool ends = std::abs(w.axis.z()) > 0.999;
      EXPECT_NEAR(w.width, ends ? 0.02 : 0.044, ends ? 1e-6 : 1e-3) << angle << " " << w.axis.transpose();
    }
  }
}

}  // namespace
}  // namespace mmgrasp
