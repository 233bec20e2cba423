#include "grasp/synthesis/hand_clearance.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "grasp/synthesis/map_surface.hpp"
#include "mmgrasp/core/random.hpp"
#include "scanned_object.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

/// Signed: negative inside, there the depth below the nearest face.
double distance_to_box(const Vector3d& p, const Vector3d& half) {
  const Vector3d d = p.cwiseAbs() - half;
  return d.cwiseMax(0).norm() + std::min(0.0, d.maxCoeff());
}

}  // namespace

TEST(HandClearance, EqualsBruteForce) {
  Rng rng(3);
  std::vector<Vector3d> points, normals;
  std::vector<double> sigma;
  for (int i = 0; i < 400; ++i) {
    points.emplace_back(rng.uniform(-0.1, 0.1), rng.uniform(-0.1, 0.1), rng.uniform(0, 0.08));
    sigma.push_back(rng.uniform(0, 0.005));
    normals.push_back(i % 8 == 0 ? Vector3d::Zero() : Vector3d(rng.rotation() * Vector3d::UnitZ()));
  }
  const double table = -0.01, margin = 0.002, sigmas = 2;
  const detail::HandClearance clearance(points, normals, sigma, sigmas, margin, table);
  int seen[3] = {0, 0, 0}, pierced = 0, aside = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    LinkShape box;
    box.shape.emplace<Box>().size =
        Vector3d(rng.uniform(0.003, 0.06), rng.uniform(0.003, 0.03), rng.uniform(0.003, 0.02));
    box.T_link_shape.linear() = rng.rotation().toRotationMatrix();
    Pose T = Pose::Identity();
    T.linear() = rng.rotation().toRotationMatrix();
    T.translation() = Vector3d(rng.uniform(-0.15, 0.15), rng.uniform(-0.15, 0.15), rng.uniform(-0.02, 0.12));
    const Pose T_box = T * box.T_link_shape;
    const Vector3d half = std::get<Box>(box.shape).size / 2;
    double lowest = 1;
    for (int k = 0; k < 8; ++k) {
      const Vector3d corner((k & 1 ? 1 : -1) * half.x(), (k & 2 ? 1 : -1) * half.y(), (k & 4 ? 1 : -1) * half.z());
      lowest = std::min(lowest, (T_box * corner).z());
    }
    bool touched = false, deep = false, in_sphere = false, close = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double distance = distance_to_box(T_box.inverse() * points[i], half), farther = sigmas * sigma[i];
      double nearest = distance;
      // Along the way that the surface may lie farther out, where that can reach the box at all.
      for (int step = 1; distance < margin + farther && step <= 200; ++step) {
        const Vector3d there = points[i] + farther * step / 200.0 * normals[i];
        nearest = std::min(nearest, distance_to_box(T_box.inverse() * there, half));
      }
      const double left = nearest - margin - (normals[i].isZero(0) ? farther : 0);
      touched = touched || left < 0;
      close = close || std::abs(left) < 3e-5;  // what steps of 50 micrometres may be off
      in_sphere = in_sphere || distance < margin + farther;
      deep = deep || distance < -0.0015;
    }
    if (close && lowest >= table + margin) continue;
    aside += in_sphere && !touched;
    const detail::HandContact expected = lowest < table + margin ? detail::HandContact::table
                                         : touched               ? detail::HandContact::map
                                                                 : detail::HandContact::none;
    ASSERT_EQ(clearance.check({box}, T), expected) << trial;
    ASSERT_EQ(clearance.pierced({box}, T, 0.0015), deep) << trial;
    ++seen[static_cast<int>(expected)];
    pierced += deep;
  }
  for (const int count : seen) EXPECT_GT(count, 100);
  EXPECT_GT(pierced, 50);
  EXPECT_GT(aside, 100);  // beside the way, and as near as its length
}

TEST(MapSurface, BoxOfLeastAreaStandsOnTheTable) {
  std::vector<Vector3d> points;
  const Pose T = test::at(0.3, -0.2, 0.1, 0.7);
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; j <= 10; ++j)
      points.push_back(T * Vector3d(0.12 * (i / 20.0 - 0.5), 0.05 * (j / 10.0 - 0.5), 0.03));
  const ObjectExtent free = detail::fit_extent(points, std::nan(""));
  EXPECT_LT((free.centre - Vector3d(0.3, -0.2, 0.13)).norm(), 1e-3);
  EXPECT_NEAR(free.longest, 0.12, 1e-3);
  const ObjectExtent standing = detail::fit_extent(points, 0.0);
  EXPECT_NEAR(standing.centre.z(), 0.065, 1e-9);
  EXPECT_NEAR(standing.longest, 0.13, 1e-9);  // now the height
}

TEST(MapSurface, PiecesInTheAirAreNoBodies) {
  // A ball of 6 mm flies beside a box of 40 mm; noise leaves smaller ones.
  const ProbabilisticSdf map = test::scan(
      {test::table_plane(), {Box{{0.04, 0.04, 0.04}}, test::at(0, 0, 0.02)}, {Sphere{0.003}, test::at(0.06, 0, 0.05)}});
  SynthesisOptions options;
  options.table = 0.0;
  const detail::MapSurface surface(map, options);
  EXPECT_LT((surface.extent.centre - Vector3d(0, 0, 0.02)).norm(), 0.003);
  for (const Vector3d& p : surface.scene) EXPECT_LT(p.head<2>().cwiseAbs().maxCoeff(), 0.027);
  // Normals of the faces, away from the edges.
  int checked = 0;
  for (std::size_t i = 0; i < surface.object.size(); ++i) {
    const Vector3d p = surface.object[i];
    if (std::abs(p.y()) > 0.012 || p.z() < 0.012 || p.z() > 0.028 || p.x() < 0.018) continue;
    EXPECT_GT(surface.mean_normal(i).x(), 0.998);
    ++checked;
  }
  EXPECT_GT(checked, 20);
}

/// Beside the box the table was seen once, by a camera of 3 mm, and came out 5 mm too high.
TEST(MapSurface, WhatMayBeTheTableIsNoBody) {
  ProbabilisticSdf map = test::scan({test::table_plane(), {Box{{0.04, 0.04, 0.04}}, test::at(0, 0, 0.02)}});
  DepthCamera coarse = test::small_camera(0.003);
  coarse.name = "coarse";
  const PlacedShape raised{Box{{0.1, 0.1, 0.01}}, test::at(0.9, 0, 0)};
  map.integrate(test::frame_of({raised}, coarse, look_down({0.9, 0, 0.35})), coarse);
  SynthesisOptions options;
  options.table = 0.0;
  const detail::MapSurface surface(map, options);
  EXPECT_LT((surface.extent.centre - Vector3d(0, 0, 0.02)).norm(), 0.003);
  for (const Vector3d& p : surface.scene) EXPECT_LT(p.x(), 0.03);
  options.sigmas = 0;
  const detail::MapSurface certain(map, options);
  EXPECT_GT(certain.extent.longest, 0.8);
}

}  // namespace mmgrasp
