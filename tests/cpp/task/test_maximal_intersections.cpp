#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "support/tray_numbers.hpp"

namespace mmgrasp {
namespace {

using testing_support::numbers;

BaseGrid make_grid(int nx, int ny, double resolution, std::vector<double> headings = {0}) {
  BaseGrid grid;
  grid.resolution = resolution;
  grid.nx = nx;
  grid.ny = ny;
  grid.headings = std::move(headings);
  return grid;
}

/// Cells whose centres lie in a disc (or in a rectangle of the same half widths).
BaseRegion region_at(const BaseGrid& grid, const Eigen::Vector2d& centre, const Eigen::Vector2d& half, bool round) {
  BaseRegion region;
  region.cells.assign(grid.size(), 0);
  for (int heading = 0; heading < static_cast<int>(grid.headings.size()); ++heading) {
    for (int iy = 0; iy < grid.ny; ++iy) {
      for (int ix = 0; ix < grid.nx; ++ix) {
        const Eigen::Array2d d = (grid.centre(heading, ix, iy).head<2>() - centre).array() / half.array();
        region.cells[grid.index(heading, ix, iy)] = round ? d.matrix().norm() <= 1 : d.abs().maxCoeff() <= 1;
      }
    }
  }
  return region;
}

using Sets = std::vector<std::vector<int>>;

Sets sets_of(const Intersections& found) {
  Sets sets;
  for (const Intersection& some : found.robust) sets.push_back(numbers(some.trays));
  std::sort(sets.begin(), sets.end());
  return sets;
}

/// Those of all robust sets that are part of no other one.
Sets maximal_of(const Intersections& all) {
  Sets sets = sets_of(all), out;
  for (const auto& set : sets) {
    const bool part = std::any_of(sets.begin(), sets.end(), [&](const auto& other) {
      return other.size() > set.size() && std::includes(other.begin(), other.end(), set.begin(), set.end());
    });
    if (!part) out.push_back(set);
  }
  return out;
}

TEST(MaximalIntersections, RandomRegionsAgainstEverySubset) {
  int large = 0;
  for (int instance = 0; instance < 60; ++instance) {
    Rng rng(5, static_cast<std::uint64_t>(instance));
    const BaseGrid grid = make_grid(30, 24, 0.05);
    std::vector<BaseRegion> regions;
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector2d centre(rng.uniform(0.3, 1.2), rng.uniform(0.3, 0.9));
      regions.push_back(
          region_at(grid, centre, {rng.uniform(0.15, 0.45), rng.uniform(0.15, 0.45)}, rng.uniform() < 0.5));
    }
    const double radius = rng.uniform(0.06, 0.14);
    const Intersections found = maximal_intersections(grid, regions, radius);
    ASSERT_TRUE(found.complete);
    const Intersections all = robust_intersections(grid, regions, radius);
    EXPECT_EQ(sets_of(found), maximal_of(all)) << "instance " << instance;
    for (const Intersection& some : found.robust) {
      EXPECT_GE(some.radius, radius - 1e-9);
      large += some.trays.size() > 3;
      const auto same = std::find_if(all.robust.begin(), all.robust.end(),
                                     [&](const Intersection& other) { return other.trays == some.trays; });
      ASSERT_NE(same, all.robust.end());
      EXPECT_NEAR(some.radius, same->radius, 1e-6);
      EXPECT_EQ(some.cells, same->cells);
    }
  }
  EXPECT_GT(large, 60);  // the instances are worth the name
}

/// Asked for the very radius of some disc, or for one a hair beside it, both searches say the same. Half of the regions
/// are mirror images of the others, whose discs differ by roundings alone.
TEST(MaximalIntersections, RadiiOfDiscsThatJustFit) {
  int asked = 0;
  for (int instance = 0; instance < 3; ++instance) {
    Rng rng(6, static_cast<std::uint64_t>(instance));
    const BaseGrid grid = make_grid(30, 24, 0.05);
    std::vector<BaseRegion> regions;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector2d centre(rng.uniform(0.5, 1.0), rng.uniform(0.4, 0.8));
      regions.push_back(
          region_at(grid, centre, {rng.uniform(0.15, 0.45), rng.uniform(0.15, 0.45)}, rng.uniform() < 0.7));
      BaseRegion mirrored = regions.back();
      for (int iy = 0; iy < grid.ny; ++iy) {
        for (int ix = 0; ix < grid.nx; ++ix)
          mirrored.cells[grid.index(0, grid.nx - 1 - ix, iy)] = regions.back().cells[grid.index(0, ix, iy)];
      }
      regions.push_back(mirrored);
    }
    for (const Intersection& some : robust_intersections(grid, regions, 0.04).robust) {
      for (const double beside : {0.0, 1e-8, -1e-8, 3e-7}) {
        const double radius = some.radius + beside;
        const Intersections found = maximal_intersections(grid, regions, radius);
        const Intersections all = robust_intersections(grid, regions, radius);
        ASSERT_TRUE(found.complete);
        ASSERT_EQ(sets_of(found), maximal_of(all))
            << "instance " << instance << ", radius " << radius << ", " << beside;
        const auto sets = sets_of(all);
        EXPECT_EQ(std::count(sets.begin(), sets.end(), numbers(some.trays)), beside > 0 ? 0 : 1);
        ++asked;
      }
    }
  }
  EXPECT_GT(asked, 60);
}

/// Discs whose diameter is a whole number of cells: places shrink to lines and points, which count.
TEST(MaximalIntersections, PlacesThatAreLinesAndPoints) {
  const BaseGrid grid = make_grid(40, 20, 0.05);
  const std::vector<BaseRegion> regions = {region_at(grid, {0.5, 0.5}, {0.25, 0.25}, false),
                                           region_at(grid, {0.8, 0.5}, {0.25, 0.25}, false),
                                           region_at(grid, {0.8, 0.8}, {0.25, 0.25}, false)};
  // Squares of 0.5 m share 0.2 m: a disc of 0.1 m has a line of places for two trays and one point for all three.
  const Intersections found = maximal_intersections(grid, regions, 0.10);
  EXPECT_EQ(sets_of(found), (Sets{{0, 1, 2}}));
  EXPECT_NEAR(found.robust[0].centre.x(), 0.65, 1e-6);
  EXPECT_NEAR(found.robust[0].centre.y(), 0.65, 1e-6);
  EXPECT_EQ(sets_of(maximal_intersections(grid, regions, 0.101)), (Sets{{0}, {1}, {2}}));
  EXPECT_EQ(sets_of(maximal_intersections(grid, regions, 0.0)), (Sets{{0, 1, 2}}));
}

/// Trays every 0.4 m whose regions are 1 m wide: a disc of 0.1 m fits into what two or three neighbours share. The
/// least number of stops is known: each serves at most as many neighbours as an interval of that length holds.
TEST(MaximalIntersections, ARowOfFiveHundredTraysHasAProvenLeastSequence) {
  const int trays = 500;
  const BaseGrid grid = make_grid(4040, 16, 0.05);
  std::vector<BaseRegion> regions;
  for (int i = 0; i < trays; ++i) regions.push_back(region_at(grid, {1.0 + 0.4 * i, 0.4}, {0.5, 0.3}, false));
  const Intersections found = maximal_intersections(grid, regions, 0.10);
  ASSERT_TRUE(found.complete);
  // Three neighbours share 1.0 - 0.8 = 0.2 m: exactly the disc.
  EXPECT_EQ(found.robust.size(), trays - 2);
  const StopSet stops = cover_from_intersections(grid, found, trays);
  EXPECT_EQ(stops.outcome, Outcome::solved);
  EXPECT_EQ(stops.stops.size(), 167u);  // ceil(500 / 3)
  EXPECT_EQ(stops.lower_bound, 167);
}

TEST(MaximalIntersections, ABudgetThatEndsEarlyIsSaid) {
  const BaseGrid grid = make_grid(30, 24, 0.05);
  const std::vector<BaseRegion> regions = {region_at(grid, {0.6, 0.6}, {0.4, 0.4}, true),
                                           region_at(grid, {0.9, 0.6}, {0.4, 0.4}, true)};
  EXPECT_FALSE(maximal_intersections(grid, regions, 0.1, 3).complete);
  EXPECT_TRUE(maximal_intersections(grid, regions, 0.1).complete);
  Monitor stopped;
  stopped.stop.stop();
  EXPECT_FALSE(maximal_intersections(grid, regions, 0.1, 1'000'000, stopped).complete);
}

TEST(MaximalIntersections, HeadingsAreSearchedApart) {
  const BaseGrid grid = make_grid(30, 24, 0.05, {0, 1.5});
  std::vector<BaseRegion> regions = {region_at(grid, {0.6, 0.6}, {0.4, 0.4}, true),
                                     region_at(grid, {0.7, 0.6}, {0.4, 0.4}, true)};
  for (int i = 0; i < grid.cells_per_layer(); ++i) regions[1].cells[i] = 0;
  const Intersections found = maximal_intersections(grid, regions, 0.1);
  ASSERT_EQ(found.robust.size(), 2u);
  EXPECT_EQ(numbers(found.robust[0].trays), (std::vector<int>{0}));
  EXPECT_EQ(found.robust[0].heading, 0);
  EXPECT_EQ(numbers(found.robust[1].trays), (std::vector<int>{0, 1}));
  EXPECT_EQ(found.robust[1].heading, 1);
}

}  // namespace
}  // namespace mmgrasp
