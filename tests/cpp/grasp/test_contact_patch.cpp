#include "mmgrasp/grasp/contact_patch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

FingerPad pad_of(double depth, double width) {
  FingerPad pad;  // pushes along z from the plane z = 0
  pad.depth = depth;
  pad.width = width;
  return pad;
}

/// Rays against a surface z(x, y); NaN where there is none.
SdfHits hits_on(const PadRays& rays, const std::function<double(double, double)>& height, double sigma = 0.001) {
  SdfHits hits;
  const Eigen::Index n = rays.origins.cols();
  hits.distance.setConstant(n, kNaN);
  hits.point.setConstant(3, n, kNaN);
  hits.normal.setConstant(3, n, kNaN);
  hits.sigma.setConstant(n, kNaN);
  hits.hit.assign(n, 0);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vector3d from = rays.origins.col(i);
    const double z = height(from.x(), from.y());
    if (std::isnan(z)) continue;
    hits.hit[i] = 1;
    hits.distance[i] = z - from.z();
    hits.point.col(i) = Vector3d(from.x(), from.y(), z);
    hits.sigma[i] = sigma;
  }
  return hits;
}

}  // namespace

TEST(ContactPatch, RaysStartInTheMiddlesOfEqualCells) {
  FingerPad pad = pad_of(0.05, 0.025);
  pad.T_hand_pad.translation() = Vector3d(0.1, 0, 0);
  Pose T = Pose::Identity();
  T.linear() = Eigen::AngleAxisd(std::acos(-1.0) / 2, Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Vector3d(0, 0, 1);
  const PadRays rays = pad_rays(pad, T);
  ASSERT_EQ(rays.origins.cols(), 25);
  EXPECT_LT((rays.directions.colwise() - Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((rays.origins.rowwise().mean() - Vector3d(0, 0.1, 1)).norm(), 1e-12);
  // Turned by a quarter: depth along y in steps of 10 mm, width along -x in steps of 5 mm.
  EXPECT_LT((rays.origins.col(0) - Vector3d(0.01, 0.08, 1)).norm(), 1e-12);
  EXPECT_LT((rays.origins.col(24) - Vector3d(-0.01, 0.12, 1)).norm(), 1e-12);
}

TEST(ContactPatch, SlantedPlane) {
  const double slope = 0.3;
  const PadRays rays = pad_rays(pad_of(0.03, 0.02), Pose::Identity());
  ContactPatch patch;
  ASSERT_EQ(fit_contact_patch(hits_on(rays, [&](double x, double) { return 0.01 + slope * x; }), Vector3d::UnitZ(),
                              0.05, patch),
            PatchState::found);
  EXPECT_LT((patch.normal - Vector3d(slope, 0, -1).normalized()).norm(), 1e-12);
  EXPECT_NEAR(patch.distance, 0.01, 1e-12);
  EXPECT_NEAR(patch.nearest, 0.01 - slope * 0.012, 1e-12);
  EXPECT_NEAR(patch.sigma, 0.001, 1e-12);
  EXPECT_EQ(patch.hits, 1);
  EXPECT_EQ(patch.inliers, 1);
  EXPECT_LT((patch.point - Vector3d(0, 0, 0.01)).norm(), 1e-12);
}

TEST(ContactPatch, SphereIsFlatEnoughOrNot) {
  const PadRays rays = pad_rays(pad_of(0.02, 0.02), Pose::Identity());
  const auto sphere = [](double radius) {
    return [=](double x, double y) { return 0.01 + radius - std::sqrt(radius * radius - x * x - y * y); };
  };
  ContactPatch patch;
  // Corner rays are (8, 8) mm off: 2.2 mm deeper on a sphere of 30 mm, all within 2 mm of the plane between.
  ASSERT_EQ(fit_contact_patch(hits_on(rays, sphere(0.03)), Vector3d::UnitZ(), 0.05, patch), PatchState::found);
  EXPECT_LT((patch.normal + Vector3d::UnitZ()).norm(), 1e-9);
  double mean = 0;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j) mean += sphere(0.03)(0.004 * i, 0.004 * j) / 25;
  EXPECT_NEAR(patch.distance, mean, 1e-12);
  // On one of 12 mm they are 8 mm deeper, 12 rays more than 2.3 mm: no plane holds 20 of 25.
  EXPECT_EQ(fit_contact_patch(hits_on(rays, sphere(0.012)), Vector3d::UnitZ(), 0.05, patch), PatchState::uneven);
  EXPECT_LT(patch.inliers, 0.8);
}

TEST(ContactPatch, OutliersDoNotTurnThePlane) {
  const PadRays rays = pad_rays(pad_of(0.03, 0.02), Pose::Identity());
  // A step of 15 mm over one of five columns: 20 of 25 rays lie on the nearer plane.
  const auto step = [](double columns) {
    return [=](double x, double) { return x > 0.015 - 0.006 * columns ? 0.025 : 0.01 + 0.1 * x; };
  };
  ContactPatch patch;
  ASSERT_EQ(fit_contact_patch(hits_on(rays, step(1)), Vector3d::UnitZ(), 0.05, patch), PatchState::found);
  EXPECT_NEAR(patch.inliers, 0.8, 1e-12);
  EXPECT_LT((patch.normal - Vector3d(0.1, 0, -1).normalized()).norm(), 1e-9);
  EXPECT_EQ(fit_contact_patch(hits_on(rays, step(2)), Vector3d::UnitZ(), 0.05, patch), PatchState::uneven);
  // Beyond reach the deeper columns do not count: 15 of 25 hits, all in one plane.
  EXPECT_EQ(fit_contact_patch(hits_on(rays, step(2)), Vector3d::UnitZ(), 0.02, patch), PatchState::found);
  EXPECT_NEAR(patch.hits, 0.6, 1e-12);
  EXPECT_EQ(patch.inliers, 1);
}

TEST(ContactPatch, TooFewHits) {
  const PadRays rays = pad_rays(pad_of(0.03, 0.02), Pose::Identity());
  const auto edge = [](double x, double) { return x < -0.003 ? 0.01 : kNaN; };  // two columns of five
  ContactPatch patch;
  EXPECT_EQ(fit_contact_patch(hits_on(rays, edge), Vector3d::UnitZ(), 0.05, patch), PatchState::missed);
  EXPECT_NEAR(patch.hits, 0.4, 1e-12);
  ContactPatchOptions options;
  options.min_hits = 0.4;
  EXPECT_EQ(fit_contact_patch(hits_on(rays, edge), Vector3d::UnitZ(), 0.05, patch, options), PatchState::found);
  options.rays = 1;
  EXPECT_THROW(options.check(), InvalidInput);
}

}  // namespace mmgrasp
