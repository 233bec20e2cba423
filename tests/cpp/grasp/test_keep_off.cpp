// Surface that fingers must not touch: pieces in boxes by their area, pads by drawing points.
#include "mmgrasp/grasp/keep_off.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

std::shared_ptr<const TriangleMesh> block(const Vector3d& half) {
  std::vector<Vector3d> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(), i & 4 ? half.z() : -half.z());
  return convex_hull(corners);
}

KeepOffBox box_at(const Vector3d& middle, const Vector3d& size) {
  KeepOffBox out;
  out.T_mesh_box.translation() = middle;
  out.size = size;
  return out;
}

double area(const SurfacePieces& pieces) {
  double out = 0;
  for (const auto& p : pieces)
    for (std::size_t i = 1; i + 1 < p.size(); ++i) out += (p[i] - p[0]).cross(p[i + 1] - p[0]).norm() / 2;
  return out;
}

/// Two jaws that close along x from above, tips at height `tips`.
AssemblyGrasp jaws(double opening, double tips) {
  AssemblyGrasp grasp;
  grasp.opening = opening;
  grasp.width = 0.01;
  grasp.T_active_tool.linear() = Vector3d(1, -1, -1).asDiagonal();
  grasp.T_active_tool.translation().z() = tips;
  return grasp;
}

TEST(KeepOff, PiecesInABoxHaveItsAreaOfTheSurface) {
  const auto cube = block({0.01, 0.01, 0.01});
  EXPECT_NEAR(area(surface_in_box(*cube, box_at({0, 0, 0}, {1, 1, 1}))), 6 * 4e-4, 1e-15);
  EXPECT_NEAR(area(surface_in_box(*cube, box_at({0.01, 0, 0}, {0.002, 0.006, 0.004}))), 0.006 * 0.004, 1e-15);
  EXPECT_NEAR(area(surface_in_box(*cube, box_at({0.01, 0.01, 0}, {0.002, 0.006, 0.004}))), 0.004 * (0.003 + 0.001),
              1e-15);
  EXPECT_TRUE(surface_in_box(*cube, box_at({0, 0, 0}, {0.01, 0.01, 0.01})).empty());
  KeepOffBox turned = box_at({0.01, 0, 0}, {0.002, 0.006, 0.006});  // turned in the face's plane: the same area
  turned.T_mesh_box.linear() = Eigen::AngleAxisd(0.7, Vector3d::UnitX()).toRotationMatrix();
  EXPECT_NEAR(area(surface_in_box(*cube, turned)), 0.006 * 0.006, 1e-15);
  EXPECT_NEAR(area(surface_of_faces(*cube, {0, 1})),
              area(surface_of_faces(*cube, {1})) + area(surface_of_faces(*cube, {0})), 1e-18);
}

TEST(KeepOff, PadsTouchWhatIsUnderThem) {
  const auto part = block({0.01, 0.02, 0.02});
  const AssemblyGrasp grasp = jaws(0.02, 0.01);  // pads: |y| < 5 mm, z from 10 mm up
  const auto touched = [&](const Vector3d& middle, const Vector3d& size) {
    return pads_touch(grasp, surface_in_box(*part, box_at(middle, size)));
  };
  EXPECT_TRUE(touched({0.01, 0, 0.015}, {0.001, 0.002, 0.002}));
  EXPECT_TRUE(touched({-0.01, 0, 0.015}, {0.001, 0.002, 0.002}));
  EXPECT_FALSE(touched({0.01, 0.0061, 0.015}, {0.001, 0.002, 0.002}));  // beside the finger
  EXPECT_FALSE(touched({0.01, 0, 0.008}, {0.001, 0.002, 0.002}));       // below the tips
  EXPECT_FALSE(touched({0, 0, 0.02}, {0.015, 0.002, 0.002}));           // on top, between the pads
  EXPECT_TRUE(touched({0, 0, 0.015}, {0.1, 0.1, 0.0001}));              // a ring right through
}

TEST(KeepOff, AsDrawnPointsSay) {
  Rng rng(3);
  const Vector3d half(0.01, 0.02, 0.015);
  const auto part = block(half);
  int touching = 0;
  for (int k = 0; k < 300; ++k) {
    AssemblyGrasp grasp = jaws(0.02, rng.uniform(-0.012, 0.012));
    grasp.T_active_tool.translation().y() = rng.uniform(-0.012, 0.012);
    const KeepOffBox box = box_at({rng.uniform(-0.02, 0.02), rng.uniform(-0.02, 0.02), rng.uniform(-0.02, 0.02)},
                                  {rng.uniform(0.004, 0.03), rng.uniform(0.002, 0.02), rng.uniform(0.002, 0.02)});
    // The two faces x = +-10 mm are what the pads may lie on: overlap of rectangles, in closed form.
    const Vector3d middle = box.T_mesh_box.translation();
    bool expected = false;
    double room = 1;
    for (const double face : {-half.x(), half.x()}) {
      const double in_x = box.size.x() / 2 - std::abs(face - middle.x());
      const double y0 =
          std::max({-half.y(), middle.y() - box.size.y() / 2, grasp.T_active_tool.translation().y() - 0.005});
      const double y1 =
          std::min({half.y(), middle.y() + box.size.y() / 2, grasp.T_active_tool.translation().y() + 0.005});
      const double z0 = std::max({middle.z() - box.size.z() / 2, grasp.T_active_tool.translation().z()});
      const double z1 = std::min(half.z(), middle.z() + box.size.z() / 2);
      const double least = std::min({in_x, y1 - y0, z1 - z0});
      expected = expected || least > 0;
      room = std::min(room, std::abs(least));
    }
    if (room < 1e-4) continue;  // too near to call
    // Edges of the other faces lie on the pads' border, too: those within 0.5 mm of the face count.
    const bool found = pads_touch(grasp, surface_in_box(*part, box), 1e-9);
    if (expected) {
      EXPECT_TRUE(found) << k;
    }
    if (found && !expected) {
      const double near_face = std::abs(std::abs(middle.x()) - half.x()) - box.size.x() / 2;
      EXPECT_LE(near_face, 1e-8) << k;
    }
    touching += expected;
  }
  EXPECT_GT(touching, 30);
}

TEST(KeepOff, WrongNumbersAreNamed) {
  const auto cube = block({0.01, 0.01, 0.01});
  EXPECT_THROW(surface_of_faces(*cube, {12}), InvalidInput);
  EXPECT_THROW(surface_in_box(*cube, box_at({0, 0, 0}, {0.01, 0, 0.01})), InvalidInput);
  EXPECT_THROW(surface_in_box(*cube, box_at({std::nan(""), 0, 0}, {1, 1, 1})), InvalidInput);
  EXPECT_THROW(pads_touch(jaws(0.02, 0), {}, 0), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
