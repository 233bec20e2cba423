#include "mmgrasp/optim/shared_tours.hpp"

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

struct Case {
  Eigen::MatrixXd drive;
  std::vector<double> stop;
  int robots;
};

Case plane_case(Rng& rng, int n, int robots) {
  Case c{Eigen::MatrixXd(n + 2 * robots, n + 2 * robots), {}, robots};
  Eigen::MatrixXd points(n + 2 * robots, 2);
  for (double& x : points.reshaped()) x = rng.uniform(0, 10);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    for (Eigen::Index j = 0; j < points.rows(); ++j) c.drive(i, j) = (points.row(i) - points.row(j)).norm();
  }
  for (int i = 0; i < n; ++i) c.stop.push_back(rng.uniform(0, 6));
  return c;
}

double duration(const Case& c, int robot, const std::vector<int>& order) {
  if (order.empty()) return 0;
  const int n = static_cast<int>(c.stop.size());
  double sum = 0;
  int at = n + robot;
  for (int stop : order) {
    sum += c.drive(at, stop) + c.stop[stop];
    at = stop;
  }
  return sum + c.drive(at, n + c.robots + robot);
}

/// Every order of all stops, cut in every way.
double brute_force(const Case& c) {
  std::vector<int> order(c.stop.size());
  std::iota(order.begin(), order.end(), 0);
  double best = kInfinity;
  do {
    for (std::size_t a = 0; a <= order.size(); ++a) {
      const double first = duration(c, 0, {order.begin(), order.begin() + static_cast<std::ptrdiff_t>(a)});
      if (c.robots == 2) {
        best = std::min(best,
                        std::max(first, duration(c, 1, {order.begin() + static_cast<std::ptrdiff_t>(a), order.end()})));
        continue;
      }
      for (std::size_t b = a; b <= order.size(); ++b) {
        const double second = duration(
            c, 1, {order.begin() + static_cast<std::ptrdiff_t>(a), order.begin() + static_cast<std::ptrdiff_t>(b)});
        const double third = duration(c, 2, {order.begin() + static_cast<std::ptrdiff_t>(b), order.end()});
        best = std::min(best, std::max({first, second, third}));
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

void expect_shared(const Case& c, const SharedTours& shared) {
  std::vector<int> served(c.stop.size(), 0);
  ASSERT_EQ(shared.orders.size(), c.robots);
  double longest = 0;
  for (int robot = 0; robot < c.robots; ++robot) {
    const auto& order = shared.orders[robot];
    for (int stop : order) ++served[stop];
    EXPECT_NEAR(shared.durations[robot], duration(c, robot, order), 1e-9);
    longest = std::max(longest, duration(c, robot, order));
  }
  EXPECT_NEAR(shared.makespan, longest, 1e-9);
  for (int times : served) EXPECT_EQ(times, 1);
}

TEST(SharedTours, EqualsEverySharing) {
  Rng rng(8);
  for (int repeat = 0; repeat < 40; ++repeat) {
    Case c = plane_case(rng, static_cast<int>(rng.index(7)), 2 + repeat % 2);
    if (repeat % 4 == 3) {  // directions differ
      for (double& t : c.drive.reshaped()) t *= rng.uniform(0.5, 2);
    }
    const SharedTours shared = share_stops(c.drive, c.stop, c.robots);
    EXPECT_EQ(shared.outcome, Outcome::solved);
    EXPECT_NEAR(shared.makespan, brute_force(c), 1e-9) << repeat;
    EXPECT_NEAR(shared.lower_bound, shared.makespan, 1e-9);
    expect_shared(c, shared);
  }
}

/// Thirteen stops are beyond the table: three of them far apart from the rest at known cost.
TEST(SharedTours, ManyStopsComeWithABoundThatHolds) {
  Rng rng(9);
  for (int repeat = 0; repeat < 4; ++repeat) {
    const Case c = plane_case(rng, 12, 3);
    const double optimum = share_stops(c.drive, c.stop, 3).makespan;
    // A thirteenth stop at the place of the first, served in no time, changes nothing.
    Case more{Eigen::MatrixXd(19, 19), c.stop, 3};
    more.stop.push_back(0.0);
    const auto old = [](Eigen::Index i) { return i < 12 ? i : i == 12 ? 0 : i - 1; };
    for (Eigen::Index i = 0; i < 19; ++i) {
      for (Eigen::Index j = 0; j < 19; ++j) more.drive(i, j) = c.drive(old(i), old(j));
    }
    const SharedTours shared = share_stops(more.drive, more.stop, 3);
    expect_shared(more, shared);
    EXPECT_LE(shared.lower_bound, optimum + 1e-9);
    EXPECT_GE(shared.makespan, optimum - 1e-9);
    EXPECT_LE(shared.makespan, 1.25 * optimum) << repeat;
  }
}

TEST(SharedTours, EqualWorkIsSharedEvenly) {
  // 24 stops on one spot, 10 s each, no driving: four robots take six each, and the bound proves it.
  const Case c{Eigen::MatrixXd::Zero(32, 32), std::vector<double>(24, 10.0), 4};
  const SharedTours shared = share_stops(c.drive, c.stop, 4);
  EXPECT_EQ(shared.outcome, Outcome::solved);
  EXPECT_NEAR(shared.makespan, 60, 1e-9);
  expect_shared(c, shared);
}

TEST(SharedTours, BlockedWaysAndBadInput) {
  Eigen::MatrixXd drive = Eigen::MatrixXd::Constant(6, 6, 1.0);
  drive.col(0).setConstant(kInfinity);  // nobody gets to the first stop
  EXPECT_EQ(share_stops(drive, {1, 1}, 2).outcome, Outcome::infeasible);
  drive(2, 0) = 1;  // the first robot does
  const SharedTours shared = share_stops(drive, {1, 1}, 2);
  EXPECT_EQ(shared.outcome, Outcome::solved);
  EXPECT_EQ(shared.orders[0].front(), 0);
  EXPECT_THROW(share_stops(drive, {1, 1}, 0), InvalidInput);
  EXPECT_THROW(share_stops(drive, {1}, 2), InvalidInput);
  EXPECT_THROW(share_stops(drive, {1, -1}, 2), InvalidInput);
  drive(0, 1) = -1;
  EXPECT_THROW(share_stops(drive, {1, 1}, 2), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
