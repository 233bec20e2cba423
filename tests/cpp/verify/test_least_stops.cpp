#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "support/region_layouts.hpp"
#include "verify/tiny_world.hpp"

// The least number of stops: what the check proves by its own means, and what the planner claims.
namespace tiny {
namespace {

/// A plan that has nothing but regions and stops; its other faults do not matter here.
PlanToCheck bare_plan(const mmgrasp::test::Layout& layout, double uncertainty) {
  const mmgrasp::BaseGrid& grid = layout.grid;
  PlanToCheck plan = empty_plan(uncertainty, {grid.origin, grid.resolution, grid.nx, grid.ny, grid.headings});
  for (const mmgrasp::BaseRegion& region : layout.regions) {
    plan.regions.push_back({region.tray, region.cells});
    plan.trays.push_back(region.tray);
    const double apart = 0.1 * static_cast<double>(plan.parts.size());
    plan.parts.push_back(make_part(region.tray + "/cube", region.tray, 0.9, apart, true, 0));
  }
  return plan;
}

PlanCheckOptions few_samples() {
  PlanCheckOptions options = quick();
  options.samples = 1;
  return options;
}

mmgrasp::StopSet planned(const mmgrasp::test::Layout& layout, double uncertainty) {
  mmgrasp::StopOptions options;
  options.min_radius = uncertainty;
  options.tie_time_limit = 0;
  return mmgrasp::plan_stops_exact(layout.grid, layout.regions, options);
}

void add_stops(const mmgrasp::StopSet& set, PlanToCheck& plan) {
  for (const mmgrasp::Stop& stop : set.stops) {
    CheckedStop checked{stop.pose, stop.radius, {}};
    for (const int tray : stop.trays) checked.trays.push_back(plan.trays[tray]);
    plan.stops.push_back(checked);
  }
  plan.lower_bound = set.lower_bound;
}

/// Faults about stops and regions alone.
Codes stop_codes(const PlanCheckResult& result) {
  Codes some;
  for (const std::string& code : codes(result)) {
    if (code.rfind("region-", 0) == 0 || code.rfind("stop-", 0) == 0 || code == "not-minimal" || code == "lower-bound")
      some.insert(code);
  }
  some.erase("stop-order");
  return some;
}

TEST(LeastStops, DiscsOfExactlyTheSizeAskedCount) {
  // Strips 4 cells wide hold discs of 2 cells' radius exactly; two that overlap in a strip share one. The third strip
  // overlaps the second in 3 cells only. A hair more than asked, and none holds any.
  mmgrasp::test::Layout layout;
  layout.grid.origin = Eigen::Vector2d(0.3, -0.7);
  layout.grid.resolution = 0.05;
  layout.grid.nx = 30;
  layout.grid.ny = 10;
  layout.grid.headings = {0.0};
  for (const int first : {0, 10, 17}) {
    mmgrasp::BaseRegion region;
    region.tray = "tray_" + std::to_string(first);
    region.cells.assign(layout.grid.size(), 0);
    for (int iy = 3; iy < 7; ++iy) {
      for (int ix = first; ix < first + (first == 17 ? 10 : 14); ++ix) region.cells[layout.grid.index(0, ix, iy)] = 1;
    }
    layout.regions.push_back(region);
  }
  const PlanCheckResult exact = check_plan(bare_plan(layout, 0.1), few_samples());
  EXPECT_EQ(exact.minimal_stops, 2);
  EXPECT_EQ(exact.lower_bound, 2);
  EXPECT_FALSE(exact.search_cut);
  const PlanCheckResult more = check_plan(bare_plan(layout, 0.1 + 1e-7), few_samples());
  EXPECT_EQ(more.minimal_stops, 0);
  EXPECT_TRUE(stop_codes(more).count("region-too-small"));
}

/// Whoever asks for just the room that there is gets stops, and the check finds as many.
TEST(LeastStops, RadiiOfDiscsThatJustFit) {
  int asked = 0;
  for (int instance = 0; instance < 10; ++instance) {
    mmgrasp::Rng rng(8, static_cast<std::uint64_t>(instance));
    mmgrasp::test::Layout layout;
    layout.grid.origin = Eigen::Vector2d(rng.uniform(-3, 3), rng.uniform(-3, 3));
    layout.grid.resolution = rng.uniform(0.02, 0.1);
    layout.grid.nx = 28;
    layout.grid.ny = 20;
    layout.grid.headings = {0.0};
    for (int tray = 0; tray < 4; ++tray) {
      mmgrasp::BaseRegion region;
      region.tray = "tray_" + std::to_string(tray);
      region.cells.assign(layout.grid.size(), 0);
      const double x = rng.uniform(8, 20), y = rng.uniform(7, 13), a = rng.uniform(3, 8), b = rng.uniform(3, 7);
      for (int iy = 0; iy < layout.grid.ny; ++iy) {
        for (int ix = 0; ix < layout.grid.nx; ++ix)
          region.cells[layout.grid.index(0, ix, iy)] = std::hypot((ix + 0.5 - x) / a, (iy + 0.5 - y) / b) <= 1;
      }
      layout.regions.push_back(region);
    }
    for (const mmgrasp::Intersection& some : mmgrasp::robust_intersections(layout.grid, layout.regions, 1e-3).robust) {
      const mmgrasp::StopSet stops = planned(layout, some.radius);
      if (stops.outcome == mmgrasp::Outcome::infeasible) continue;  // some other tray has no room for it
      ASSERT_EQ(stops.outcome, mmgrasp::Outcome::solved);
      PlanToCheck plan = bare_plan(layout, some.radius);
      add_stops(stops, plan);
      const PlanCheckResult result = check_plan(plan, few_samples());
      EXPECT_EQ(stop_codes(result), Codes{}) << "instance " << instance << ", radius " << some.radius;
      EXPECT_EQ(result.minimal_stops, static_cast<int>(stops.stops.size()));
      ++asked;
    }
  }
  EXPECT_GT(asked, 30);
}

TEST(LeastStops, DiscsBetweenTwoCornersCountOnBothSides) {
  // A corridor as wide as the disc; A keeps the corner (3, 2) free, B a corner at x = 6. From (4.5, 4) both (3, 2) and
  // (6, 6) are 2.5 cells away, and no other place in the corridor is as far from both.
  for (const int corner : {6, 5}) {
    mmgrasp::test::Layout layout;
    layout.grid.origin = Eigen::Vector2d(-1, -1);
    layout.grid.resolution = 0.05;
    layout.grid.nx = layout.grid.ny = 9;
    layout.grid.headings = {0.0};
    for (const bool second : {false, true}) {
      mmgrasp::BaseRegion region;
      region.tray = second ? "B" : "A";
      region.cells.assign(layout.grid.size(), 0);
      for (int iy = 0; iy < 9; ++iy) {
        for (int ix = 2; ix < 7; ++ix)
          region.cells[layout.grid.index(0, ix, iy)] = second ? ix < 6 || iy < corner : ix > 2 || iy > 1;
      }
      layout.regions.push_back(region);
    }
    const PlanCheckResult result = check_plan(bare_plan(layout, 0.125), few_samples());
    EXPECT_EQ(result.lower_bound, result.minimal_stops) << corner;
    EXPECT_EQ(result.minimal_stops, corner == 6 ? 1 : 2);
    EXPECT_EQ(planned(layout, 0.125).lower_bound, corner == 6 ? 1 : 2);
  }
}

TEST(LeastStops, OneMoreThanNeededIsRefused) {
  // The aisle of the benchmarks (bench_sequence.cpp): 6 stops serve its 22 trays with discs of exactly 0.10 m, two
  // cells.
  const mmgrasp::test::Layout layout = mmgrasp::test::aisle_layout(22, 0.45, 1.5);
  const mmgrasp::StopSet stops = planned(layout, 0.1);
  ASSERT_EQ(stops.outcome, mmgrasp::Outcome::solved);
  PlanToCheck plan = bare_plan(layout, 0.1);
  add_stops(stops, plan);
  const PlanCheckResult good = check_plan(plan, few_samples());
  EXPECT_EQ(stop_codes(good), Codes{});
  EXPECT_EQ(good.minimal_stops, 6);
  EXPECT_EQ(plan.stops.size(), 6u);
  EXPECT_EQ(good.lower_bound, good.minimal_stops);
  // One tray gets a stop of its own at its neighbours' place.
  const auto shared =
      std::find_if(plan.stops.begin(), plan.stops.end(), [](const CheckedStop& s) { return s.trays.size() > 1; });
  ASSERT_NE(shared, plan.stops.end());
  CheckedStop own = *shared;
  own.trays = {shared->trays.back()};
  shared->trays.pop_back();
  plan.stops.push_back(own);
  EXPECT_EQ(stop_codes(check_plan(plan, few_samples())), Codes{"not-minimal"});
  plan.lower_bound = static_cast<int>(plan.stops.size());
  EXPECT_EQ(stop_codes(check_plan(plan, few_samples())), (Codes{"not-minimal", "lower-bound"}));
}

TEST(LeastStops, AgreesWithThePlannerOnStorerooms) {
  int several = 0;
  for (const double uncertainty : {0.0, 0.02, 0.05, 0.075, 0.1, 0.1118033988749895, 0.125, 0.15}) {
    for (const mmgrasp::test::Layout& layout :
         {mmgrasp::test::row_layout(12, 0.4), mmgrasp::test::aisle_layout(16, 0.5, 1.4),
          mmgrasp::test::board_layout(18, 3, 0.5, 1.5, 2, 3), mmgrasp::test::random_layout(12, 5),
          mmgrasp::test::overhead_layout(12, 2)}) {
      const mmgrasp::StopSet stops = planned(layout, uncertainty);
      const PlanCheckResult result = check_plan(bare_plan(layout, uncertainty), few_samples());
      const int expected = stops.outcome == mmgrasp::Outcome::solved ? stops.lower_bound : 0;
      EXPECT_EQ(result.minimal_stops, expected) << layout.name << ", " << uncertainty;
      EXPECT_EQ(result.lower_bound, result.minimal_stops) << layout.name << ", " << uncertainty;
      several += result.minimal_stops > 1;
    }
  }
  EXPECT_GT(several, 20) << "must not be trivial";
}

TEST(LeastStops, WhatWasCutIsNotCalledProven) {
  // Forty regions full of holes, discs larger than a cell: more places than the search looks at.
  mmgrasp::test::Layout layout;
  layout.grid.origin = Eigen::Vector2d(0, 0);
  layout.grid.resolution = 0.05;
  layout.grid.nx = layout.grid.ny = 300;
  layout.grid.headings = {0.0, 1.0};
  mmgrasp::Rng rng(3, 0);
  for (int tray = 0; tray < 40; ++tray) {
    mmgrasp::BaseRegion region;
    region.tray = "tray_" + std::to_string(tray);
    region.cells.resize(layout.grid.size());
    for (std::uint8_t& cell : region.cells) cell = rng.uniform() < 0.9;
    layout.regions.push_back(std::move(region));
  }
  const PlanCheckResult result = check_plan(bare_plan(layout, 0.03), few_samples());
  EXPECT_TRUE(result.search_cut);
  EXPECT_LT(result.lower_bound, result.minimal_stops);
  EXPECT_GE(result.lower_bound, 1);
}

}  // namespace
}  // namespace tiny
