#include "mmgrasp/robot/detail/joint_metric.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/random.hpp"
#include "support/around.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;

const std::vector<bool> kWraps{true, false, true, false};

TEST(JointMetric, GoesTheShortWayRound) {
  const JointMetric metric(kWraps);
  ASSERT_TRUE(metric.any());
  EXPECT_EQ(metric.wrapping(), (std::vector<int>{0, 2}));
  Rng rng(3);
  const VectorXd lower = VectorXd::Constant(4, -12), upper = -lower;
  for (int i = 0; i < 2000; ++i) {
    const VectorXd a = rng.uniform(lower, upper), b = rng.uniform(lower, upper), c = rng.uniform(lower, upper);
    const double distance = test::distance_around(kWraps, a, b);
    EXPECT_NEAR(metric.distance(a, b), distance, 1e-12);
    EXPECT_NEAR(metric.squared_distance(a.data(), b.data(), 4), distance * distance, 1e-10);
    EXPECT_NEAR((metric.nearest(a, b) - test::nearest_image(kWraps, a, b)).norm(), 0, 1e-12);
    EXPECT_NEAR((metric.nearest(a, b) - a).norm(), distance, 1e-12);
    EXPECT_LE(metric.distance(a, c), metric.distance(a, b) + metric.distance(b, c) + 1e-12);
    const VectorXd inside = metric.wrapped(a);
    EXPECT_LE(std::max(std::abs(inside[0]), std::abs(inside[2])), M_PI);
    EXPECT_EQ(inside[1], a[1]);
    EXPECT_NEAR(metric.distance(inside, a), 0, 1e-12);
  }
  // Half a turn either way is as long, and what needs no turn keeps its very value.
  EXPECT_EQ(JointMetric::nearest_angle(0, kPi), kPi);
  EXPECT_EQ(JointMetric::nearest_angle(0, -kPi), -kPi);
  EXPECT_EQ(JointMetric::nearest_angle(7.1, 7.3), 7.3);
}

TEST(JointMetric, IsEuclideanWhereNothingWraps) {
  for (const JointMetric& metric : {JointMetric(), JointMetric({false, false, false})}) {
    EXPECT_FALSE(metric.any());
    const Eigen::Vector3d a(3, -9, 0.5), b(-4, 2, 20);
    EXPECT_EQ(metric.distance(a, b), (a - b).norm());
    EXPECT_EQ(metric.nearest(a, b), b);
    EXPECT_EQ(metric.wrapped(b), b);
  }
}

TEST(JointMetric, WeighsJoints) {
  const Eigen::Vector4d weights(10, 0.5, 2, 1);
  EXPECT_EQ(JointMetric().unit(), 1);
  EXPECT_EQ(JointMetric(kWraps).weight(2), 1);
  for (const std::vector<bool>& wraps : {kWraps, std::vector<bool>(4)}) {
    const JointMetric metric(wraps, weights), doubled(wraps, 2 * weights);
    EXPECT_NEAR(metric.unit(), std::sqrt((100 + 0.25 + 4 + 1) / 4), 1e-12);
    Rng rng(4);
    const VectorXd lower = VectorXd::Constant(4, -12), upper = -lower;
    for (int i = 0; i < 500; ++i) {
      const VectorXd a = rng.uniform(lower, upper), b = rng.uniform(lower, upper), c = rng.uniform(lower, upper);
      const double distance = test::distance_around(wraps, a, b, weights);
      EXPECT_NEAR(metric.distance(a, b), distance, 1e-11);
      EXPECT_NEAR(metric.squared_distance(a.data(), b.data(), 4), distance * distance, 1e-9);
      EXPECT_EQ(doubled.distance(a, b), 2 * metric.distance(a, b));
      EXPECT_LE(metric.distance(a, c), metric.distance(a, b) + metric.distance(b, c) + 1e-11);
      EXPECT_NEAR(metric.norm(metric.nearest(a, b) - a), distance, 1e-11);
      EXPECT_NEAR(metric.length({a, b, c}),
                  test::distance_around(std::vector<bool>(4), a, b, weights) +
                      test::distance_around(std::vector<bool>(4), b, c, weights),
                  1e-11);
      // Euclidean in coordinates, up to the turns that metric.turn() gives.
      VectorXd x(4), y(4), back(4);
      metric.to_coordinates(a.data(), x.data(), 4);
      metric.to_coordinates(b.data(), y.data(), 4);
      VectorXd off = y - x;
      for (const int k : metric.wrapping()) off[k] -= metric.turn(k) * std::round(off[k] / metric.turn(k));
      EXPECT_NEAR(off.norm(), distance, 1e-11);
      metric.from_coordinates(x.data(), back.data(), 4);
      EXPECT_NEAR((back - metric.wrapped(a)).norm(), 0, 1e-12);
    }
  }
}

TEST(JointMetric, PathsRunOnContinuouslyAndComeApartAgain) {
  const JointMetric metric({true, false});
  std::vector<VectorXd> path{Eigen::Vector2d(3, 0), Eigen::Vector2d(-3, 1), Eigen::Vector2d(-1, 1),
                             Eigen::Vector2d(2.5, 1)};
  metric.unroll(path);
  const double turn = 2 * M_PI;
  const std::vector<double> expected{3, turn - 3, turn - 1, 2.5};
  for (std::size_t i = 0; i < path.size(); ++i) EXPECT_NEAR(path[i][0], expected[i], 1e-12);
  // An edge of three quarters of a turn the long way round.
  std::vector<VectorXd> wound{Eigen::Vector2d(0, 0), Eigen::Vector2d(0.75 * turn, 1)};
  metric.split_long_edges(wound);
  ASSERT_EQ(wound.size(), 3u);
  EXPECT_NEAR((wound[1] - Eigen::Vector2d(0.375 * turn, 0.5)).norm(), 0, 1e-12);
  double length = 0;
  for (std::size_t i = 1; i < wound.size(); ++i) length += metric.distance(wound[i], wound[i - 1]);
  EXPECT_NEAR(length, std::hypot(0.75 * turn, 1), 1e-12);
}

}  // namespace
}  // namespace mmgrasp::detail
