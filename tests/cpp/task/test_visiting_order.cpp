#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mmgrasp/task/part_supply.hpp"
#include "mmgrasp/task/visiting_order.hpp"
#include "support/small_storeroom.hpp"

namespace mmgrasp {
namespace {

/// A wall from y = -2 to y = 2 at x = 0, so that places on both sides are near as the crow flies only.
PartSupplyProblem walled() {
  PartSupplyProblem problem = test::small_storeroom();
  problem.world = World();
  problem.trays.clear();
  problem.world.add("wall", test::box_shape(0.2, 4, 1), test::at(0, 0, 0.5));
  problem.start = {-2, 0, 0};
  problem.goal = {2, 0, 0};
  return problem;
}

TEST(RouteLengths, LengthsLeadAroundTheWall) {
  const PartSupplyProblem problem = walled();
  const CollisionChecker checker(problem.arm, problem.world);
  const std::vector<Eigen::Vector3d> places = {{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {-1.0, -2.0, 1.0}, {-3.0, 1.0, 0.0}};
  for (const BaseKind base : {BaseKind::diff_drive, BaseKind::omni}) {
    BaseRouteOptions kind;
    kind.base = base;
    const Eigen::MatrixXd lengths = route_lengths(checker, problem.home, places, kind, 1);
    ASSERT_EQ(lengths.rows(), 4);
    CollisionChecker own = checker.clone();
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(lengths(i, i), 0);
      for (int j = i + 1; j < 4; ++j) {
        EXPECT_NEAR(lengths(i, j), lengths(j, i), 1e-9);
        const Eigen::Vector3d &a = places[i], &b = places[j];
        BaseRouteOptions options;
        options.base = base;
        const BasePath drive = plan_base_route(own, problem.home, a, b, options);
        ASSERT_EQ(drive.outcome, Outcome::solved);
        EXPECT_GE(lengths(i, j), (a - b).head<2>().norm() - 1e-9);
        EXPECT_NEAR(lengths(i, j), drive.length, 0.12 * drive.length) << i << " to " << j;
      }
    }
    EXPECT_GT(lengths(0, 1), 4.5);  // the crow flies 2 m
  }
}

TEST(RouteLengths, AClosedRoomCannotBeLeft) {
  PartSupplyProblem problem = walled();
  for (const double sign : {-1.0, 1.0}) {
    problem.world.add("x" + std::to_string(sign), test::box_shape(0.1, 3, 1), test::at(3 + 1.5 * sign, 0, 0.5));
    problem.world.add("y" + std::to_string(sign), test::box_shape(3, 0.1, 1), test::at(3, 1.5 * sign, 0.5));
  }
  const Eigen::MatrixXd lengths = route_lengths(CollisionChecker(problem.arm, problem.world), problem.home,
                                                {{3, 0, 0}, {-2, 0, 0}, {3.4, 0.2, 0}}, BaseRouteOptions(), 2);
  EXPECT_TRUE(std::isinf(lengths(0, 1)));
  EXPECT_LT(lengths(0, 2), 1);
}

/// Seven stops on both sides of the wall: the best of all orders by the lengths of planned drives.
TEST(VisitingOrder, SevenStopsAroundAWall) {
  const PartSupplyProblem problem = walled();
  std::vector<Stop> stops(7);
  for (int i = 0; i < 7; ++i) {
    const double side = i % 2 == 0 ? -1 : 1;
    stops[i].pose = {0.9 * side, -2.0 + 1.2 * (i / 2), 0};
  }
  const std::vector<int> order = order_stops(problem, stops).stops;
  ASSERT_EQ(order.size(), 7u);
  std::vector<Eigen::Vector3d> places;
  for (const Stop& stop : stops) places.push_back(stop.pose);
  places.push_back(problem.start);
  places.push_back(problem.goal);
  CollisionChecker checker(problem.arm, problem.world);
  Eigen::MatrixXd lengths = Eigen::MatrixXd::Zero(9, 9);
  for (std::size_t i = 0; i < 9; ++i) {
    for (std::size_t j = i + 1; j < 9; ++j) {
      const BasePath drive = plan_base_route(checker, problem.home, places[i], places[j], BaseRouteOptions());
      ASSERT_EQ(drive.outcome, Outcome::solved);
      const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
      lengths(a, b) = lengths(b, a) = drive.length;
    }
  }
  const auto length_of = [&](const std::vector<int>& way) {
    double sum = 0;
    int at = 7;
    for (int stop : way) {
      sum += lengths(at, stop);
      at = stop;
    }
    return sum + lengths(at, 8);
  };
  std::vector<int> trial(7);
  std::iota(trial.begin(), trial.end(), 0);
  double best = 1e9;
  do {
    best = std::min(best, length_of(trial));
  } while (std::next_permutation(trial.begin(), trial.end()));
  EXPECT_LE(length_of(order), 1.02 * best);
  // As the crow flies the stops would be visited in pairs across the wall.
  int changes = 0;
  for (std::size_t i = 1; i < 7; ++i) changes += order[i] % 2 != order[i - 1] % 2;
  EXPECT_EQ(changes, 1);
}

TEST(VisitingOrder, AStopThatCannotBeReachedIsNamed) {
  PartSupplyProblem problem = walled();
  std::vector<Stop> stops(7);
  for (int i = 0; i < 7; ++i) stops[i].pose = {-1.2, -1.5 + 0.5 * i, 0};
  stops[3].pose = {0, 0, 0};  // in the wall
  const VisitingOrder order = order_stops(problem, stops);
  EXPECT_TRUE(order.stops.empty());
  EXPECT_EQ(order.unreachable, 3);
  EXPECT_EQ(order.from, -1);
}

/// Cells of millimetres run out of base poses on the way around the wall; larger ones are tried first.
TEST(VisitingOrder, FineCellsFindWhatCoarseOnesFind) {
  PartSupplyProblem problem = walled();
  std::vector<Stop> stops(2);
  stops[0].pose = {0.9, 0, 0};
  stops[1].pose = {-0.9, 0, 0};
  const VisitingOrder usual = order_stops(problem, stops);
  EXPECT_EQ(usual.stops, (std::vector<int>{1, 0}));
  problem.options.route_resolution = 0.002;
  EXPECT_EQ(order_stops(problem, stops).stops, usual.stops);
}

}  // namespace
}  // namespace mmgrasp
