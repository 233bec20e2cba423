#include <gtest/gtest.h>

#include <cmath>

#include "mapping/sdf_scenes.hpp"
#include "mmgrasp/mapping/probabilistic_sdf.hpp"

using namespace mmgrasp;
using namespace mmgrasp::test;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

TEST(SdfQueries, PointsAnswerTheSameHoweverMany) {
  DepthCamera fine = small_camera(0.0005), biased = small_camera(0.001);
  biased.name = "biased";
  biased.systematic = 0.0005;
  for (const bool two : {false, true}) {
    ProbabilisticSdf sdf;
    for (const DepthImage& frame : noisy_sphere_frames(6, fine, 0.05)) sdf.integrate(frame, fine);
    for (int k = 0; k < 9; ++k) sdf.integrate(wall(two ? biased : fine, 0.3), two ? biased : fine);
    Matrix3Xd points = random_points(60'000, 0.055);
    for (int i = 0; i < 3000; ++i) points.col(i) = 0.016 * (points.col(i) / 0.016).array().round().matrix();  // corners
    for (int i = 3000; i < 6000; ++i) points(i % 3, i) = 0.016 * std::round(points(i % 3, i) / 0.016);        // faces
    points.col(6000) = Vector3d(1e6, 0, 0);
    points.col(6001) = Vector3d(0, -1e6, 0);
    points.col(6002) = Vector3d(0, 0, 8.0 * ((1 << 20) - 8) * 0.002);
    ASSERT_LE(4 * sdf.blocks(), 4096u);  // so that all points at once are sorted
    const SdfValues all = sdf.query(points);
    int known = 0;
    const auto expect_same = [&](const SdfValues& part, Eigen::Index first) {
      for (Eigen::Index i = 0; i < part.mean.size(); ++i) {
        ASSERT_EQ(part.known[i], all.known[first + i]) << two << " " << first + i;
        if (!part.known[i]) continue;
        ++known;
        ASSERT_EQ(part.mean[i], all.mean[first + i]) << two << " " << first + i;
        ASSERT_EQ(part.sigma[i], all.sigma[first + i]) << two << " " << first + i;
      }
    };
    for (Eigen::Index first = 0; first < points.cols(); first += 100)
      expect_same(sdf.query(points.middleCols(first, 100)), first);
    for (Eigen::Index i = 0; i < points.cols(); i += 7) expect_same(sdf.query(points.col(i)), i);
    EXPECT_GT(known, 5000);
    EXPECT_FALSE(all.known[6000] || all.known[6001] || all.known[6002]);
  }
}

TEST(SdfQueries, CroppedMapsAnswerTheSameAndTakeFrames) {
  DepthCamera fine = small_camera(0.0005), biased = small_camera(0.001);
  biased.name = "biased";
  biased.systematic = 0.0005;
  ProbabilisticSdf whole;
  for (const DepthImage& frame : noisy_sphere_frames(6, fine, 0.05)) whole.integrate(frame, fine);
  for (int k = 0; k < 3; ++k) whole.integrate(wall(biased, 0.3), biased);
  const Eigen::AlignedBox3d box(Vector3d(-0.02, -0.06, -0.01), Vector3d(0.06, 0.03, 0.06));
  ProbabilisticSdf part = whole.cropped(box);
  EXPECT_LT(2 * part.blocks(), whole.blocks());
  EXPECT_EQ(part.frames(), whole.frames());
  Matrix3Xd points = random_points(20'000, 0.06);
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    points.col(i) = points.col(i).cwiseMax(box.min()).cwiseMin(box.max());  // many on its faces and edges
  int known = 0;
  const auto expect_same = [&] {
    const SdfValues all = whole.query(points), own = part.query(points);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      ASSERT_EQ(own.known[i], all.known[i]) << i;
      if (!own.known[i]) continue;
      ++known;
      ASSERT_EQ(own.mean[i], all.mean[i]) << i;
      ASSERT_EQ(own.sigma[i], all.sigma[i]) << i;
    }
  };
  expect_same();
  EXPECT_GT(known, 500);
  const std::size_t blocks = whole.blocks();
  for (ProbabilisticSdf* map : {&whole, &part}) map->integrate(wall(fine, 0.25), fine);
  expect_same();
  EXPECT_GE(whole.blocks(), blocks);
}
