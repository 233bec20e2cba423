#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "support/region_layouts.hpp"
#include "support/tray_numbers.hpp"

namespace mmgrasp {
namespace {

using testing_support::numbers;

/// The widest disc for a set of trays, straight from the cells.
double radius_of(const BaseGrid& grid, const std::vector<BaseRegion>& regions, const std::vector<int>& trays) {
  double best = 0;
  for (int heading = 0; heading < static_cast<int>(grid.headings.size()); ++heading) {
    CellMask shared(grid.size(), 1);
    for (int tray : trays) {
      for (std::size_t c = 0; c < shared.size(); ++c) shared[c] = shared[c] && regions[tray].cells[c];
    }
    best = std::max(best, inscribed_circle(grid, shared, heading).radius);
  }
  return best;
}

using Partition = std::vector<std::vector<int>>;

/// Visits every way to split the trays into at most `most` groups, which the visitor may lower.
void each_partition(int trays, const std::size_t& most, const std::function<void(const Partition&)>& visit) {
  Partition parts;
  const std::function<void(int)> place = [&](int tray) {
    if (parts.size() > most) return;
    if (tray == trays) {
      visit(parts);
      return;
    }
    for (std::size_t p = 0; p < parts.size(); ++p) {
      parts[p].push_back(tray);
      place(tray + 1);
      parts[p].pop_back();
    }
    parts.push_back({tray});
    place(tray + 1);
    parts.pop_back();
  };
  place(0);
}

/// The fewest groups whose discs are all large enough, and the largest smallest disc of as few.
struct BestPartition {
  std::size_t groups = 1000;
  double smallest = 0;

  BestPartition(int trays, double min_radius, const std::function<double(const std::vector<int>&)>& radius) {
    each_partition(trays, groups, [&](const Partition& parts) {
      double least = 1e9;
      for (const auto& part : parts) least = std::min(least, radius(part));
      if (least < min_radius) return;
      if (parts.size() < groups || least > smallest) smallest = least;
      groups = parts.size();
    });
  }
};

void expect_sound(const BaseGrid& grid, const std::vector<BaseRegion>& regions, const StopSet& set, double min_radius) {
  std::vector<int> served(regions.size(), 0);
  for (const Stop& stop : set.stops) {
    EXPECT_GE(stop.radius, min_radius - 1e-8);
    EXPECT_NEAR(stop.radius, radius_of(grid, regions, numbers(stop.trays)), 1e-6);  // the widest for exactly its trays
    for (int tray : stop.trays) ++served[tray];
  }
  for (int times : served) EXPECT_EQ(times, 1);
}

TEST(LeastStops, EveryPartitionOfSevenTrays) {
  int several = 0;
  for (unsigned seed = 1; seed <= 25; ++seed) {
    const test::Layout layout = test::overhead_layout(7, seed, 0.15);
    const double min_radius = 0.08;
    std::map<std::vector<int>, double> known;
    const BestPartition best(7, min_radius, [&](const std::vector<int>& trays) {
      const auto [it, is_new] = known.try_emplace(trays, 0.0);
      if (is_new) it->second = radius_of(layout.grid, layout.regions, trays);
      return it->second;
    });
    StopOptions options;
    options.min_radius = min_radius;
    const StopSet set = plan_stops_exact(layout.grid, layout.regions, options);
    ASSERT_EQ(set.outcome, Outcome::solved) << seed;
    EXPECT_EQ(set.stops.size(), best.groups) << seed;
    EXPECT_EQ(set.lower_bound, static_cast<int>(best.groups)) << seed;
    double smallest = 1e9;
    for (const Stop& stop : set.stops) smallest = std::min(smallest, stop.radius);
    EXPECT_NEAR(smallest, best.smallest, 2e-4) << seed;
    expect_sound(layout.grid, layout.regions, set, min_radius);
    several += best.groups > 1 && best.groups < 7;
  }
  EXPECT_GT(several, 15);
}

/// P1 equation 3.2 is a mean: with the number and the smallest disc fixed, the sum of radii decides.
TEST(LeastStops, TheSumOfRadiiIsTheLargest) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const test::Layout layout = test::overhead_layout(6, seed, 0.15);
    StopOptions options;
    options.min_radius = 0.08;
    const StopSet set = plan_stops_exact(layout.grid, layout.regions, options);
    double sum = 0, smallest = 1e9;
    for (const Stop& stop : set.stops) {
      sum += stop.radius;
      smallest = std::min(smallest, stop.radius);
    }
    // All partitions with as many groups and no smaller smallest disc.
    double best = 0;
    each_partition(6, set.stops.size(), [&](const Partition& parts) {
      double total = 0, least = 1e9;
      for (const auto& part : parts) {
        const double radius = radius_of(layout.grid, layout.regions, part);
        total += radius;
        least = std::min(least, radius);
      }
      if (parts.size() == set.stops.size() && least >= smallest - 1e-5) best = std::max(best, total);
    });
    const double step = 0.25 * layout.grid.resolution + 1e-3;  // what plan_stops_exact() promises for each stop
    EXPECT_GE(sum, best - step * static_cast<double>(set.stops.size())) << seed;
    EXPECT_LE(sum, best + 1e-5) << seed;
  }
}

/// Five equal trays, two to a stop: the one served alone may be any of three; the route decides which.
TEST(LeastStops, EquallyGoodSequencesAreToldApartByTheRoute) {
  BaseGrid grid;
  grid.resolution = 0.05;
  grid.nx = 80;
  grid.ny = 20;
  grid.headings = {0};
  std::vector<BaseRegion> regions(5);
  for (int i = 0; i < 5; ++i) {
    regions[i].cells.assign(grid.size(), 0);
    for (int iy = 2; iy < 14; ++iy) {
      for (int ix = 2 + 8 * i; ix < 14 + 8 * i; ++ix) regions[i].cells[grid.index(0, ix, iy)] = 1;
    }
  }
  // Neighbours share 4 cells (0.2 m): a disc of exactly 0.1 m. Radii do not tell {01}{23}{4}, {01}{2}{34}, {0}{12}{34}
  // apart.
  for (const double wanted : {0.0, 4.0}) {
    StopOptions options;
    options.min_radius = 0.10;
    options.route_length = [wanted](const std::vector<Stop>& stops) {
      double least = 1e9;  // how near a lone tray's stop is to one end
      for (const Stop& stop : stops) {
        if (stop.trays.size() == 1) least = std::min(least, std::abs(stop.pose.x() - wanted));
      }
      return least;
    };
    const StopSet set = plan_stops_exact(grid, regions, options);
    ASSERT_EQ(set.stops.size(), 3u);
    const int lone = wanted == 0.0 ? 0 : 4;
    EXPECT_TRUE(std::any_of(set.stops.begin(), set.stops.end(), [&](const Stop& stop) {
      return numbers(stop.trays) == std::vector<int>{lone} && std::abs(stop.radius - 0.3) < 1e-6;
    }));
    expect_sound(grid, regions, set, 0.10);
  }
}

/// Jittered rows, aisles and storerooms of some hundred trays: proven, and no tray has less room than asked.
TEST(LeastStops, HundredsOfTraysAreProven) {
  for (const test::Layout& layout :
       {test::row_layout(300, 0.33), test::aisle_layout(200, 0.37, 1.5), test::block_layout(120, 0.45, 1.5),
        test::random_layout(120, 4), test::overhead_layout(120, 5)}) {
    StopOptions options;
    options.tie_time_limit = 0;
    const StopSet set = plan_stops_exact(layout.grid, layout.regions, options);
    EXPECT_EQ(set.outcome, Outcome::solved) << layout.name;
    EXPECT_EQ(set.lower_bound, static_cast<int>(set.stops.size())) << layout.name;
    expect_sound(layout.grid, layout.regions, set, options.min_radius);
  }
}

TEST(LeastStops, TraysWithoutRoomAreNamedAndStopsAreEnded) {
  test::Layout layout = test::row_layout(4, 0.45);
  std::fill(layout.regions[2].cells.begin(), layout.regions[2].cells.end(), std::uint8_t{0});
  const StopSet set = plan_stops_exact(layout.grid, layout.regions);
  EXPECT_EQ(set.outcome, Outcome::infeasible);
  EXPECT_EQ(numbers(set.unreachable_trays), (std::vector<int>{2}));
  Monitor stopped;
  stopped.stop.stop();
  EXPECT_EQ(plan_stops_exact(layout.grid, layout.regions, {}, stopped).outcome, Outcome::stopped);
  const StopSet none = plan_stops_exact(layout.grid, {});
  EXPECT_EQ(none.outcome, Outcome::solved);
  EXPECT_TRUE(none.stops.empty());
  StopOptions wrong;
  wrong.min_radius = -1;
  EXPECT_THROW(plan_stops_exact(layout.grid, layout.regions, wrong), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
