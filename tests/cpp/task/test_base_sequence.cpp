#include "mmgrasp/task/base_sequence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/tray_numbers.hpp"

namespace mmgrasp {
namespace {

using testing_support::numbers;

BaseGrid make_grid(int nx, int ny, double resolution = 1, std::vector<double> headings = {0}) {
  BaseGrid grid;
  grid.resolution = resolution;
  grid.nx = nx;
  grid.ny = ny;
  grid.headings = std::move(headings);
  return grid;
}

/// Rows from the top down, '#' for a cell.
CellMask from_picture(const BaseGrid& grid, const std::vector<std::string>& rows) {
  CellMask cells(grid.size(), 0);
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      cells[grid.index(0, ix, iy)] = rows[grid.ny - 1 - iy][ix] == '#';
    }
  }
  return cells;
}

InscribedCircle circle_of(const std::vector<std::string>& rows) {
  const BaseGrid grid = make_grid(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()));
  return inscribed_circle(grid, from_picture(grid, rows), 0);
}

/// Distance from p to everything that is no cell, straight from the definition.
double clearance(const BaseGrid& grid, const CellMask& cells, const Eigen::Vector2d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (int iy = -1; iy <= grid.ny; ++iy) {
    for (int ix = -1; ix <= grid.nx; ++ix) {
      const bool inside = ix >= 0 && iy >= 0 && ix < grid.nx && iy < grid.ny;
      if (inside && cells[grid.index(0, ix, iy)]) continue;
      const double x0 = grid.origin.x() + ix * grid.resolution, y0 = grid.origin.y() + iy * grid.resolution;
      const double dx = std::max({x0 - p.x(), 0.0, p.x() - x0 - grid.resolution});
      const double dy = std::max({y0 - p.y(), 0.0, p.y() - y0 - grid.resolution});
      least = std::min(least, std::hypot(dx, dy));
    }
  }
  return least;
}

TEST(InscribedCircle, OneCellAndNone) {
  EXPECT_NEAR(circle_of({"#"}).radius, 0.5, 1e-6);
  EXPECT_EQ(circle_of({".", "."}).radius, 0);
}

TEST(InscribedCircle, RectangleTakesTheMiddleOfItsRidge) {
  const InscribedCircle circle = circle_of({"#######", "#######", "#######"});
  EXPECT_NEAR(circle.radius, 1.5, 1e-6);
  EXPECT_NEAR((circle.centre - Eigen::Vector2d(3.5, 1.5)).norm(), 0, 1e-5);
}

TEST(InscribedCircle, LongCorridor) {
  const InscribedCircle circle = circle_of({std::string(400, '#'), std::string(400, '#')});
  EXPECT_NEAR(circle.radius, 1.0, 1e-6);
  EXPECT_NEAR(circle.centre.x(), 200, 1e-3);
}

TEST(InscribedCircle, LShapeTouchesTwoEdgesAndTheInnerCorner) {
  // Arms of width w: the disc in the outer corner touches both outer edges and the inner corner, r + r / sqrt(2) = w.
  std::vector<std::string> rows(10, "###.......");
  for (int i = 7; i < 10; ++i) rows[i] = "##########";
  const InscribedCircle circle = circle_of(rows);
  EXPECT_NEAR(circle.radius, 3.0 / (1 + std::sqrt(0.5)), 1e-6);
  EXPECT_NEAR((circle.centre - Eigen::Vector2d(circle.radius, circle.radius)).norm(), 0, 1e-5);
}

TEST(InscribedCircle, CrossTouchesItsFourInnerCorners) {
  std::vector<std::string> rows(9, "...###...");
  for (int i = 3; i < 6; ++i) rows[i] = "#########";
  const InscribedCircle circle = circle_of(rows);
  EXPECT_NEAR(circle.radius, 1.5 * std::sqrt(2.0), 1e-6);
  EXPECT_NEAR((circle.centre - Eigen::Vector2d(4.5, 4.5)).norm(), 0, 1e-5);
}

TEST(InscribedCircle, RingTouchesTheHoleFromItsCorners) {
  // A ring of width 2 about a 2 x 2 hole: in the corner, r (1 + 1 / sqrt(2)) = 2.
  const InscribedCircle circle = circle_of({"######", "######", "##..##", "##..##", "######", "######"});
  EXPECT_NEAR(circle.radius, 2.0 / (1 + std::sqrt(0.5)), 1e-6);
}

TEST(InscribedCircle, PlusOfFiveCells) {
  const InscribedCircle circle = circle_of({".#.", "###", ".#."});
  EXPECT_NEAR(circle.radius, std::sqrt(0.5), 1e-6);
}

TEST(InscribedCircle, CellsThatMeetInACornerAreNotJoined) {
  EXPECT_NEAR(circle_of({".#", "#."}).radius, 0.5, 1e-6);
}

TEST(InscribedCircle, ResolutionAndOriginScaleTheAnswer) {
  BaseGrid grid = make_grid(9, 9, 0.05, {0.3, 1.0});
  grid.origin = {-3.1, 2.4};
  CellMask cells(grid.size(), 0);
  for (int iy = 2; iy < 6; ++iy) {
    for (int ix = 1; ix < 8; ++ix) cells[grid.index(1, ix, iy)] = 1;
  }
  EXPECT_EQ(inscribed_circle(grid, cells, 0).radius, 0);
  const InscribedCircle circle = inscribed_circle(grid, cells, 1);
  EXPECT_NEAR(circle.radius, 0.1, 1e-6);
  EXPECT_NEAR((circle.centre - Eigen::Vector2d(-3.1 + 0.225, 2.4 + 0.2)).norm(), 0, 1e-5);
}

TEST(InscribedCircle, RandomRegionsAgainstDenseSampling) {
  for (int instance = 0; instance < 30; ++instance) {
    Rng rng(7, static_cast<std::uint64_t>(instance));
    const BaseGrid grid = make_grid(8, 7);
    CellMask cells(grid.size(), 0);
    for (std::uint8_t& cell : cells) cell = rng.uniform() < 0.5 + 0.45 * rng.uniform();
    const InscribedCircle circle = inscribed_circle(grid, cells, 0);
    if (circle.radius > 0) {
      EXPECT_NEAR(clearance(grid, cells, circle.centre), circle.radius, 1e-9);
    }
    double sampled = 0;
    constexpr double kStep = 0.02;
    for (double x = 0; x <= grid.nx; x += kStep) {
      for (double y = 0; y <= grid.ny; y += kStep) sampled = std::max(sampled, clearance(grid, cells, {x, y}));
    }
    EXPECT_GE(circle.radius, sampled - 1e-6) << "instance " << instance;
    EXPECT_LE(circle.radius, sampled + kStep) << "instance " << instance;
  }
}

BaseRegion disc_region(const BaseGrid& grid, const Eigen::Vector2d& centre, double radius) {
  BaseRegion region;
  region.cells.assign(grid.size(), 0);
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      region.cells[grid.index(0, ix, iy)] = (grid.centre(0, ix, iy).head<2>() - centre).norm() <= radius;
    }
  }
  return region;
}

/// P1 figure 3.9: five discs in a chain. Neighbours overlap widely for (1, 2), (2, 3) and (3, 4), hardly for (1, 3).
TEST(RobustIntersections, ChainOfFiveTrays) {
  const BaseGrid grid = make_grid(160, 40, 0.05);
  std::vector<BaseRegion> regions;
  for (double x : {1.2, 1.7, 2.25, 3.05, 5.0}) regions.push_back(disc_region(grid, {x, 1.0}, 0.6));
  // Lens half-widths: (1.2 - d) / 2 for centres d apart.
  const Intersections found = robust_intersections(grid, regions, 0.10);
  std::vector<std::vector<int>> sets;
  for (const Intersection& some : found.robust) sets.push_back(numbers(some.trays));
  const std::vector<std::vector<int>> expected = {{0}, {1}, {2}, {3}, {4}, {0, 1}, {1, 2}, {2, 3}};
  EXPECT_EQ(sets, expected);
  EXPECT_EQ(found.sets_too_small, 1u);
  ASSERT_EQ(found.too_small.size(), 1u);
  EXPECT_EQ(numbers(found.too_small[0].trays), (std::vector<int>{0, 2}));
  EXPECT_NEAR(found.too_small[0].radius, 0.075, 0.05);
  EXPECT_TRUE(found.complete);

  const StopSet stops = cover_from_intersections(grid, found.robust, 5);
  EXPECT_EQ(stops.outcome, Outcome::solved);
  EXPECT_EQ(stops.lower_bound, 3);
  ASSERT_EQ(stops.stops.size(), 3u);
  std::vector<std::vector<int>> served;
  for (const Stop& stop : stops.stops) served.push_back(numbers(stop.trays));
  std::sort(served.begin(), served.end());
  EXPECT_EQ(served, (std::vector<std::vector<int>>{{0, 1}, {2, 3}, {4}}));
}

TEST(RobustIntersections, RadiusIsTheCirclesAndCellsAreShared) {
  const BaseGrid grid = make_grid(60, 40, 0.05);
  const std::vector<BaseRegion> regions = {disc_region(grid, {1.2, 1.0}, 0.6), disc_region(grid, {1.7, 1.0}, 0.6)};
  const Intersections found = robust_intersections(grid, regions, 0.0);
  ASSERT_EQ(found.robust.size(), 3u);
  CellMask both(grid.size());
  for (std::size_t i = 0; i < both.size(); ++i) both[i] = regions[0].cells[i] && regions[1].cells[i];
  const InscribedCircle circle = inscribed_circle(grid, both, 0);
  EXPECT_EQ(found.robust[2].radius, circle.radius);
  EXPECT_EQ(found.robust[2].centre, circle.centre);
  EXPECT_EQ(found.robust[2].cells, std::count(both.begin(), both.end(), 1));
}

TEST(RobustIntersections, ARegionOfTheWrongSizeIsRefused) {
  const BaseGrid grid = make_grid(4, 4);
  std::vector<BaseRegion> regions(1);
  regions[0].tray = "A";
  EXPECT_THROW(robust_intersections(grid, regions, 0.1), InvalidInput);
}

/// Sets of trays by the definition: every subset of the trays, its cells, its disc.
TEST(RobustIntersections, RandomRegionsAgainstAllSubsets) {
  for (int instance = 0; instance < 20; ++instance) {
    Rng rng(11, static_cast<std::uint64_t>(instance));
    const BaseGrid grid = make_grid(16, 12, 0.1);
    std::vector<BaseRegion> regions;
    for (int i = 0; i < 5; ++i) {
      regions.push_back(disc_region(grid, {rng.uniform(0.2, 1.4), rng.uniform(0.2, 1.0)}, rng.uniform(0.2, 0.6)));
    }
    std::vector<std::vector<int>> expected;
    for (unsigned subset = 1; subset < 32; ++subset) {
      CellMask shared(grid.size(), 1);
      std::vector<int> trays;
      for (int i = 0; i < 5; ++i) {
        if (!(subset >> i & 1u)) continue;
        trays.push_back(i);
        for (std::size_t c = 0; c < shared.size(); ++c) shared[c] = shared[c] && regions[i].cells[c];
      }
      if (inscribed_circle(grid, shared, 0).radius >= 0.12) expected.push_back(trays);
    }
    std::vector<std::vector<int>> found;
    for (const Intersection& some : robust_intersections(grid, regions, 0.12).robust)
      found.push_back(numbers(some.trays));
    std::sort(expected.begin(), expected.end());
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected) << "instance " << instance;
  }
}

TEST(MinimalStops, TraysWithoutAPlaceAreNamed) {
  const BaseGrid grid = make_grid(4, 4);
  Intersection only;
  only.trays = {TrayId(0), TrayId(2)};
  only.radius = 1;
  const StopSet stops = cover_from_intersections(grid, {only}, 4);
  EXPECT_EQ(stops.outcome, Outcome::infeasible);
  EXPECT_EQ(numbers(stops.unreachable_trays), (std::vector<int>{1, 3}));
}

TEST(MinimalStops, AnIntersectionNamesEachTrayOnce) {
  const auto refusal = [](std::vector<TrayId> trays, int heading = 0) -> std::string {
    Intersection one;
    one.trays = std::move(trays);
    one.heading = heading;
    one.radius = 1;
    try {
      cover_from_intersections(make_grid(4, 4), {one}, 3);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal({TrayId(0), TrayId(1), TrayId(2)}), "");
  EXPECT_EQ(refusal({TrayId(0), TrayId(1), TrayId(1)}),
            "intersections.trays = 1: must not be named twice in an intersection");
  EXPECT_EQ(refusal({TrayId(0), TrayId(1), TrayId(0)}),
            "intersections.trays = 0: must not be named twice in an intersection");
  EXPECT_EQ(refusal({TrayId(1), TrayId(0)}), "intersections.trays = 0: must be ascending");
  EXPECT_EQ(refusal({TrayId(3)}), "intersections.trays = 3: must be at least 0 and below the number of trays, 3");
  EXPECT_EQ(refusal({TrayId(0)}, 1), "intersections.heading = 1: must be one of the grid's 1");
}

/// Two trays that share all their cells, but the search ends before their pair is looked at.
TEST(MinimalStops, AnIncompleteSearchIsNoProof) {
  const BaseGrid grid = make_grid(10, 10);
  std::vector<BaseRegion> regions(2);
  for (BaseRegion& region : regions) region.cells.assign(grid.size(), 1);
  const StopSet all = cover_from_intersections(grid, robust_intersections(grid, regions, 0.0), 2);
  EXPECT_EQ(all.outcome, Outcome::solved);
  EXPECT_EQ(all.stops.size(), 1u);
  const Intersections some = robust_intersections(grid, regions, 0.0, 2);
  ASSERT_FALSE(some.complete);
  const StopSet stops = cover_from_intersections(grid, some, 2);
  EXPECT_EQ(stops.outcome, Outcome::approximate);
  EXPECT_EQ(stops.stops.size(), 2u);
  EXPECT_EQ(stops.lower_bound, 1);
  const StopSet single = cover_from_intersections(grid, robust_intersections(grid, {regions[0]}, 0.0, 1), 1);
  EXPECT_EQ(single.outcome, Outcome::solved);  // one stop is needed anyway
  Intersections none;
  none.complete = false;
  EXPECT_EQ(cover_from_intersections(grid, none, 1).outcome, Outcome::timeout);
  none.complete = true;
  EXPECT_EQ(cover_from_intersections(grid, none, 1).outcome, Outcome::infeasible);
}

/// Least count, and of those the largest sum of radii, by trying all subsets of intersections.
TEST(MinimalStops, TwoHundredRandomInstancesAgainstEnumeration) {
  for (int instance = 0; instance < 200; ++instance) {
    Rng rng(3, static_cast<std::uint64_t>(instance));
    const BaseGrid grid = make_grid(4, 4);
    const int trays = 2 + static_cast<int>(rng.index(5)), count = 3 + static_cast<int>(rng.index(9));
    std::vector<Intersection> places;
    for (int i = 0; i < count; ++i) {
      Intersection place;
      for (int tray = 0; tray < trays; ++tray) {
        if (rng.uniform() < 0.4) place.trays.emplace_back(tray);
      }
      if (place.trays.empty()) place.trays.emplace_back(static_cast<int>(rng.index(trays)));
      place.radius = rng.uniform(0.1, 1.0);
      places.push_back(place);
    }
    int least = -1;
    double best_radii = 0;
    for (unsigned subset = 0; subset < 1u << count; ++subset) {
      unsigned covered = 0;
      double radii = 0;
      for (int i = 0; i < count; ++i) {
        if (!(subset >> i & 1u)) continue;
        for (int tray : places[i].trays) covered |= 1u << tray;
        radii += places[i].radius;
      }
      if (covered + 1 != 1u << trays) continue;
      const int size = __builtin_popcount(subset);
      if (least < 0 || size < least || (size == least && radii > best_radii)) {
        least = size;
        best_radii = radii;
      }
    }
    const StopSet stops = cover_from_intersections(grid, places, trays);
    if (least < 0) {
      EXPECT_EQ(stops.outcome, Outcome::infeasible);
      continue;
    }
    ASSERT_EQ(stops.outcome, Outcome::solved);
    EXPECT_EQ(static_cast<int>(stops.stops.size()), least) << "instance " << instance;
    EXPECT_EQ(stops.lower_bound, least);
    std::vector<int> served(trays, 0);
    double radii = 0;
    for (const Stop& stop : stops.stops) {
      const Intersection& place = places[stop.intersection];
      EXPECT_EQ(stop.radius, place.radius);
      radii += stop.radius;
      for (int tray : stop.trays) {
        ++served[tray];
        EXPECT_TRUE(std::binary_search(place.trays.begin(), place.trays.end(), TrayId(tray)));
      }
    }
    for (int times : served) EXPECT_EQ(times, 1);
    EXPECT_GE(radii, best_radii - 1e-6) << "instance " << instance;
  }
}

}  // namespace
}  // namespace mmgrasp
