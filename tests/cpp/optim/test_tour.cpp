#include "mmgrasp/optim/tour.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double length_of(const Eigen::MatrixXd& lengths, const std::vector<int>& order) {
  const int n = static_cast<int>(order.size());
  double sum = 0;
  int from = n;
  for (int stop : order) {
    sum += lengths(from, stop);
    from = stop;
  }
  return sum + lengths(from, n + 1);
}

Eigen::MatrixXd random_lengths(Rng& rng, int n, double blocked) {
  Eigen::MatrixXd lengths(n + 2, n + 2);
  for (int i = 0; i < n + 2; ++i) {
    for (int j = 0; j < n + 2; ++j) lengths(i, j) = rng.uniform() < blocked ? kInfinity : rng.uniform(0.1, 5.0);
  }
  return lengths;
}

TEST(Tour, EqualsEveryPermutation) {
  Rng rng(5);
  int blocked_tours = 0;
  for (int repeat = 0; repeat < 200; ++repeat) {
    const int n = static_cast<int>(rng.index(7));
    const Eigen::MatrixXd lengths = random_lengths(rng, n, repeat % 2 ? 0.4 : 0.0);
    std::vector<int> order(n);
    std::iota(order.begin(), order.end(), 0);
    double best = kInfinity;
    do {
      best = std::min(best, length_of(lengths, order));
    } while (std::next_permutation(order.begin(), order.end()));
    const TourResult result = shortest_visiting_tour(lengths);
    EXPECT_TRUE(result.proven);
    if (std::isinf(best)) {
      EXPECT_EQ(result.outcome, Outcome::infeasible);
      ++blocked_tours;
      continue;
    }
    ASSERT_EQ(result.outcome, Outcome::solved);
    EXPECT_NEAR(result.length, best, 1e-12);
    EXPECT_NEAR(length_of(lengths, result.order), best, 1e-12);
  }
  EXPECT_GT(blocked_tours, 10);
}

TEST(Tour, FifteenStopsOnALineAreExact) {
  // Distances on a line: the shortest way from one end to the other visits the stops in order.
  Rng rng(9);
  std::vector<double> x;
  for (int i = 0; i < 15; ++i) x.push_back(rng.uniform(0.0, 10.0));
  x.push_back(-1.0);
  x.push_back(11.0);
  Eigen::MatrixXd lengths(17, 17);
  for (int i = 0; i < 17; ++i) {
    for (int j = 0; j < 17; ++j) lengths(i, j) = std::abs(x[i] - x[j]);
  }
  const TourResult result = shortest_visiting_tour(lengths);
  EXPECT_TRUE(result.proven);
  EXPECT_NEAR(result.length, 12.0, 1e-12);
}

TEST(Tour, ManyStopsOnACircleComeInOrder) {
  // Half a circle, start and goal at its ends: the optimum is known and every 2-opt optimum in the plane has no
  // crossing.
  const int n = 30;
  Eigen::MatrixXd points(n + 2, 2);
  for (int i = 0; i < n; ++i) {
    const double angle = M_PI * (7 * i % n + 1) / (n + 1);
    points.row(i) << std::cos(angle), std::sin(angle);
  }
  points.row(n) << 1, 0;
  points.row(n + 1) << -1, 0;
  Eigen::MatrixXd lengths(n + 2, n + 2);
  for (int i = 0; i < n + 2; ++i) {
    for (int j = 0; j < n + 2; ++j) lengths(i, j) = (points.row(i) - points.row(j)).norm();
  }
  const TourResult result = shortest_visiting_tour(lengths);
  EXPECT_FALSE(result.proven);
  EXPECT_EQ(result.outcome, Outcome::approximate);
  std::vector<int> sorted = result.order;
  std::sort(sorted.begin(), sorted.end());
  for (int i = 0; i < n; ++i) EXPECT_EQ(sorted[i], i);
  EXPECT_NEAR(result.length, (n + 1) * 2 * std::sin(M_PI / (2 * (n + 1))), 1e-9);
}

TEST(Tour, ManyStopsAvoidBlockedWays) {
  Rng rng(2);
  for (int repeat = 0; repeat < 5; ++repeat) {
    const Eigen::MatrixXd lengths = random_lengths(rng, 20, 0.3);
    const TourResult result = shortest_visiting_tour(lengths);
    ASSERT_EQ(result.outcome, Outcome::approximate);
    EXPECT_TRUE(std::isfinite(result.length));
    EXPECT_NEAR(length_of(lengths, result.order), result.length, 1e-12);
  }
}

TEST(Tour, NoStops) {
  Eigen::MatrixXd lengths = Eigen::MatrixXd::Zero(2, 2);
  lengths(0, 1) = 3.5;
  const TourResult result = shortest_visiting_tour(lengths);
  EXPECT_EQ(result.outcome, Outcome::solved);
  EXPECT_EQ(result.length, 3.5);
  lengths(0, 1) = kInfinity;
  EXPECT_EQ(shortest_visiting_tour(lengths).outcome, Outcome::infeasible);
}

TEST(Tour, RefusesBadInput) {
  EXPECT_THROW(shortest_visiting_tour(Eigen::MatrixXd::Zero(1, 1)), InvalidInput);
  EXPECT_THROW(shortest_visiting_tour(Eigen::MatrixXd::Zero(3, 4)), InvalidInput);
  Eigen::MatrixXd lengths = Eigen::MatrixXd::Zero(3, 3);
  lengths(0, 1) = -1;
  EXPECT_THROW(shortest_visiting_tour(lengths), InvalidInput);
  lengths(0, 1) = std::nan("");
  EXPECT_THROW(shortest_visiting_tour(lengths), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
