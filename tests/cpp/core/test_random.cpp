#include "mmgrasp/core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

using namespace mmgrasp;

TEST(Rng, SameSeedSameNumbersOtherStreamOtherNumbers) {
  Rng a(7, 3), b(7, 3), c(7, 4), d(8, 3), swapped(3, 7);
  std::set<std::uint64_t> seen;
  for (int i = 0; i < 1000; ++i) {
    const std::uint64_t value = a.next();
    EXPECT_EQ(value, b.next());
    seen.insert({value, c.next(), d.next(), swapped.next()});
  }
  EXPECT_EQ(seen.size(), 4000u);
}

TEST(Rng, MomentsOfUniformNormalAndDisc) {
  Rng rng(1);
  const int count = 200000;
  double mean = 0, square = 0, normal_mean = 0, normal_square = 0, disc_square = 0;
  for (int i = 0; i < count; ++i) {
    const double u = rng.uniform();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    mean += u / count;
    square += u * u / count;
    const double n = rng.normal();
    normal_mean += n / count;
    normal_square += n * n / count;
    const Eigen::Vector2d p = rng.in_disc(2.0);
    ASSERT_LE(p.norm(), 2.0);
    disc_square += p.squaredNorm() / count;
  }
  // Expected values; tolerances are about five standard errors.
  EXPECT_NEAR(mean, 0.5, 0.0035);
  EXPECT_NEAR(square, 1.0 / 3, 0.0035);
  EXPECT_NEAR(normal_mean, 0, 0.012);
  EXPECT_NEAR(normal_square, 1, 0.017);
  EXPECT_NEAR(disc_square, 2.0, 0.014);  // r^2 / 2
}

TEST(Rng, RotationsAreUniform) {
  Rng rng(5);
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  double mean_angle = 0;
  const int count = 50000;
  for (int i = 0; i < count; ++i) {
    const Eigen::Quaterniond q = rng.rotation();
    ASSERT_NEAR(q.norm(), 1, 1e-12);
    mean += q.toRotationMatrix() / count;
    mean_angle += 2 * std::acos(std::min(1.0, std::abs(q.w()))) / count;
  }
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 0.015);
  EXPECT_NEAR(mean_angle, M_PI / 2 + 2 / M_PI, 0.015);  // closed form of the mean rotation angle
}

TEST(Rng, IndexCoversItsRangeEvenly) {
  Rng rng(9);
  int counts[7] = {};
  for (int i = 0; i < 70000; ++i) ++counts[rng.index(7)];
  for (const int count : counts) EXPECT_NEAR(count, 10000, 500);
}

TEST(Rng, VectorStaysInsideItsBox) {
  Rng rng(3);
  const Eigen::Vector3d lower(-1, 0, 5), upper(1, 0.5, 6);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::VectorXd v = rng.uniform(lower, upper);
    ASSERT_TRUE((v.array() >= lower.array()).all() && (v.array() < upper.array()).all());
  }
}
