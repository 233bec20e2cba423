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
  EXPECT_TRUE(result.proven);  // neighbours on a circle are joined by the shortest tree
  EXPECT_EQ(result.outcome, Outcome::solved);
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
    ASSERT_TRUE(result.outcome == Outcome::approximate || result.outcome == Outcome::solved);
    EXPECT_TRUE(std::isfinite(result.length));
    EXPECT_NEAR(length_of(lengths, result.order), result.length, 1e-12);
  }
}

/// Held and Karp's table, written again for more stops than the library solves exactly.
double optimum_by_table(const Eigen::MatrixXd& lengths) {
  const int n = static_cast<int>(lengths.rows()) - 2;
  std::vector<float> best((std::size_t{1} << n) * static_cast<std::size_t>(n), std::numeric_limits<float>::infinity());
  const auto at = [&](std::size_t mask, int last) -> float& { return best[mask * static_cast<std::size_t>(n) + last]; };
  for (int j = 0; j < n; ++j) at(std::size_t{1} << j, j) = static_cast<float>(lengths(n, j));
  for (std::size_t mask = 1; mask < std::size_t{1} << n; ++mask) {
    for (int last = 0; last < n; ++last) {
      if (!(mask >> last & 1)) continue;
      for (int next = 0; next < n; ++next) {
        if (mask >> next & 1) continue;
        float& to = at(mask | std::size_t{1} << next, next);
        to = std::min(to, at(mask, last) + static_cast<float>(lengths(last, next)));
      }
    }
  }
  double shortest = kInfinity;
  for (int j = 0; j < n; ++j) shortest = std::min(shortest, at((std::size_t{1} << n) - 1, j) + lengths(j, n + 1));
  return shortest;
}

Eigen::MatrixXd plane_lengths(Rng& rng, int n) {
  Eigen::MatrixXd points(n + 2, 2);
  for (double& x : points.reshaped()) x = rng.uniform(0, 10);
  Eigen::MatrixXd lengths(n + 2, n + 2);
  for (int i = 0; i < n + 2; ++i) {
    for (int j = 0; j < n + 2; ++j) lengths(i, j) = (points.row(i) - points.row(j)).norm();
  }
  return lengths;
}

TEST(Tour, BeyondTheTableTheOptimumLiesBetweenBoundAndLength) {
  Rng rng(21);
  for (int repeat = 0; repeat < 8; ++repeat) {
    const bool symmetric = repeat % 2 == 0;
    const Eigen::MatrixXd lengths = symmetric ? plane_lengths(rng, 17) : random_lengths(rng, 17, 0.0);
    const double optimum = optimum_by_table(lengths);
    const TourResult result = shortest_visiting_tour(lengths);
    EXPECT_NEAR(length_of(lengths, result.order), result.length, 1e-12);
    EXPECT_LE(result.lower_bound, optimum * (1 + 1e-5));  // the table holds floats
    EXPECT_GE(result.length, optimum * (1 - 1e-5));
    EXPECT_LE(result.length, optimum * 1.01) << repeat;  // near-optimal
    EXPECT_GE(result.lower_bound, optimum * (symmetric ? 0.97 : 0.85)) << repeat;
    if (result.proven) {
      EXPECT_NEAR(result.length, optimum, 1e-5 * optimum);
    }
  }
}

TEST(Tour, HundredsOfStopsComeWithASmallGap) {
  Rng rng(22);
  for (const int n : {16, 60, 170}) {
    const Eigen::MatrixXd lengths = plane_lengths(rng, n);
    const TourResult result = shortest_visiting_tour(lengths);
    std::vector<int> sorted = result.order;
    std::sort(sorted.begin(), sorted.end());
    for (int i = 0; i < n; ++i) EXPECT_EQ(sorted[i], i);
    EXPECT_NEAR(length_of(lengths, result.order), result.length, 1e-9);
    EXPECT_GT(result.lower_bound, 0.95 * result.length) << n;
    EXPECT_LE(result.lower_bound, result.length);
    EXPECT_EQ(shortest_visiting_tour(lengths).order, result.order);
  }
}

/// A one-way ring: each stop leads cheaply to the next only, so that only directed lengths tell.
TEST(Tour, OneWayStreets) {
  const int n = 40;
  Eigen::MatrixXd lengths = Eigen::MatrixXd::Constant(n + 2, n + 2, 10.0);
  const auto place = [](int k) { return 7 * k % n; };
  lengths(n, place(0)) = 1;
  for (int k = 0; k + 1 < n; ++k) lengths(place(k), place(k + 1)) = 1;
  lengths(place(n - 1), n + 1) = 1;
  const TourResult result = shortest_visiting_tour(lengths);
  EXPECT_TRUE(result.proven);
  EXPECT_NEAR(result.length, n + 1, 1e-9);
  for (int k = 0; k < n; ++k) EXPECT_EQ(result.order[k], place(k));
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

/// Beyond the exact method's size nothing proves that there is no tour, even where a way to a stop is missing.
TEST(Tour, BeyondTheExactMethodNoTourIsNoProof) {
  Eigen::MatrixXd lengths = Eigen::MatrixXd::Constant(22, 22, 1.0);
  lengths.col(3).setConstant(kInfinity);
  const TourResult result = shortest_visiting_tour(lengths);
  EXPECT_EQ(result.outcome, Outcome::not_found);
  EXPECT_FALSE(result.proven);
  EXPECT_TRUE(result.order.empty());
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
