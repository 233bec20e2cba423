#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/verify/plan_check.hpp"
#include "verify/tiny_world.hpp"

// The stops, their regions, the route.
namespace tiny {
namespace {

TEST(PlanCheckStops, ShiftedStop) {
  PlanToCheck plan = good_plan();
  plan.stops[0].pose.y() += 0.005;
  const Codes found = codes_of(plan);
  EXPECT_TRUE(found.count("route-ends"));
  EXPECT_TRUE(found.count("grasp-missed"));
  EXPECT_TRUE(found.count("stop-outside-region")) << "its disc of 0.2 m fills the region to the last millimetre";
}

TEST(PlanCheckStops, DriveClearance) {
  // From stop 0 at (0.4, 0) to stop 1 at (0.4, 3) the base, 0.4 m wide, drives by a post whose side is 0.3 m from it.
  PlanToCheck plan = good_plan();
  const Eigen::Vector3d& a = plan.stops[0].pose;
  const double side = a.x() - 0.2 - 0.3;
  plan.obstacles.push_back(box("post", {0.1, 0.1, 1.0}, at(side - 0.05, 1.5, 0.5)));
  ASSERT_EQ(codes_of(plan), Codes{});
  plan.drive_clearance = 0.299;
  EXPECT_EQ(codes_of(plan), Codes{});
  plan.drive_clearance = 0.301;
  EXPECT_EQ(codes_of(plan), Codes{"route-clearance"});
  plan.obstacles.back() = box("post", {0.1, 0.1, 1.0}, at(side - 0.05, 0.3, 0.5));  // within 1 m of where it stands
  EXPECT_EQ(codes_of(plan), Codes{});
  plan.drive_clearance = -1;
  EXPECT_TRUE(codes_of(plan).count("malformed"));
}

TEST(PlanCheckStops, TraysOfStops) {
  PlanToCheck plan = good_plan();
  plan.stops[1].trays = {"B", "A"};
  EXPECT_TRUE(codes_of(plan).count("tray-repeated"));
  plan = good_plan();
  plan.stops[1].trays.clear();
  EXPECT_TRUE(codes_of(plan).count("tray-forgotten"));
  plan = good_plan();
  plan.stops[1].trays = {"B", "C"};
  EXPECT_EQ(codes_of(plan), Codes{"tray-unknown"});
}

TEST(PlanCheckStops, RadiusBelowUncertainty) {
  PlanToCheck plan = good_plan();
  plan.stops[0].radius = 0.09;
  EXPECT_EQ(codes_of(plan), Codes{"stop-radius"});
}

TEST(PlanCheckStops, HeadingOffTheGrid) {
  PlanToCheck plan = good_plan();
  plan.grid.headings = {0.001};
  EXPECT_TRUE(codes_of(plan).count("stop-heading"));
}

TEST(PlanCheckStops, MissingCellUnderTheDisc) {
  // Nearest points of two border cells to the middle: (0.15, 0.15) at 0.212 m, (0.15, 0.10) at 0.180 m; the disc has
  // 0.2 m.
  const auto without_cell = [](int ix, int iy) {
    PlanToCheck plan = good_plan();
    std::uint8_t& cell = plan.regions[0].cells[iy * plan.grid.nx + ix];
    EXPECT_EQ(cell, 1);
    cell = 0;
    return codes_of(plan);
  };
  const int x0 = 4, y0 = 6;  // lower corner of the region: (0.2, -0.2)
  EXPECT_TRUE(without_cell(x0, y0).empty());
  EXPECT_EQ(without_cell(x0, y0 + 1), Codes{"stop-outside-region"});
}

TEST(PlanCheckStops, TwoStopsWhereOneIsEnough) {
  PlanToCheck plan = good_plan();
  plan.regions[1].cells = plan.regions[0].cells;
  EXPECT_TRUE(codes_of(plan).count("not-minimal"));
}

TEST(PlanCheckStops, LowerBoundMustHold) {
  PlanToCheck plan = good_plan();
  plan.lower_bound = 1;
  EXPECT_EQ(codes_of(plan), Codes{"lower-bound"});
}

TEST(PlanCheckStops, BrokenRegions) {
  PlanToCheck plan = good_plan();
  plan.regions[0].cells.pop_back();
  EXPECT_EQ(codes_of(plan), (Codes{"region-malformed", "region-missing"}));
  plan = good_plan();
  plan.regions.pop_back();
  EXPECT_EQ(codes_of(plan), Codes{"region-missing"});
  plan = good_plan();
  plan.grid.nx = -3;
  EXPECT_EQ(codes_of(plan), Codes{"region-malformed"});
  plan = good_plan();
  std::fill(plan.regions[1].cells.begin(), plan.regions[1].cells.end(), 0);
  EXPECT_EQ(codes_of(plan), (Codes{"region-too-small", "stop-outside-region"}));
}

/// A region that is one rectangle of cells.
struct Rectangle {
  int x0, x1, y0, y1;
};

bool share_disc(const std::vector<Rectangle>& rectangles, unsigned members, double radius, double resolution) {
  Rectangle common{0, 1000, 0, 1000};
  for (std::size_t i = 0; i < rectangles.size(); ++i) {
    if (!(members >> i & 1u)) continue;
    common = {std::max(common.x0, rectangles[i].x0), std::min(common.x1, rectangles[i].x1),
              std::max(common.y0, rectangles[i].y0), std::min(common.y1, rectangles[i].y1)};
  }
  return std::min(common.x1 - common.x0, common.y1 - common.y0) * resolution >= 2 * radius;
}

/// Least number of groups that share a disc each, over all ways to cover the trays (subset by subset).
int plan_stops_exact(const std::vector<Rectangle>& rectangles, double radius, double resolution) {
  const unsigned all = (1u << rectangles.size()) - 1;
  std::vector<int> least(all + 1, 1000);
  least[0] = 0;
  for (unsigned covered = 0; covered <= all; ++covered) {
    for (unsigned group = 1; group <= all; ++group) {
      if (share_disc(rectangles, group, radius, resolution)) {
        least[covered | group] = std::min(least[covered | group], least[covered] + 1);
      }
    }
  }
  return least[all];
}

TEST(PlanCheckStops, LeastNumberAgreesWithBruteForceOnRectangles) {
  // Rectangles share a disc if and only if their intersection is a rectangle at least 2 r wide and high.
  const double resolution = 0.05;
  int several = 0;
  for (int trial = 0; trial < 60; ++trial) {
    mmgrasp::Rng rng(99, trial);
    const double radius = trial % 2 ? 0.07 : 0.012;
    PlanToCheck plan = empty_plan(radius, {Eigen::Vector2d(-1, 2), resolution, 14, 12, {0.0}});
    std::vector<Rectangle> rectangles;
    for (int tray = 0; tray < 5; ++tray) {
      const int w = 3 + static_cast<int>(rng.index(5)), h = 3 + static_cast<int>(rng.index(5));
      const int x = static_cast<int>(rng.index(15 - w)), y = static_cast<int>(rng.index(13 - h));
      rectangles.push_back({x, x + w, y, y + h});
      const std::string name(1, static_cast<char>('A' + tray));
      CheckedRegion region{name, std::vector<std::uint8_t>(14 * 12, 0)};
      for (int iy = y; iy < y + h; ++iy) std::fill_n(region.cells.begin() + iy * 14 + x, w, std::uint8_t{1});
      plan.regions.push_back(region);
      plan.trays.push_back(name);
      plan.parts.push_back(make_part(name + "/cube", name, 0.9, 0.2 * tray, true, 0));
    }
    const int expected = plan_stops_exact(rectangles, radius, resolution);
    EXPECT_EQ(check_plan(plan, quick()).minimal_stops, expected) << "trial " << trial;
    several += expected > 1 && expected < 5;
  }
  EXPECT_GT(several, 20) << "the trials must not be trivial";
}

/// Twenty trays on a large floor, their regions full of holes; the first eight trays are wanted.
PlanToCheck ragged_plan(double uncertainty, double share) {
  PlanToCheck plan = empty_plan(uncertainty, {Eigen::Vector2d(-1, 2), 0.05, 100, 100, {0.0, 1.0, 2.0, 3.0}});
  mmgrasp::Rng rng(7, 0);
  for (int tray = 0; tray < 20; ++tray) {
    const std::string name(1, static_cast<char>('A' + tray));
    CheckedRegion region{name, std::vector<std::uint8_t>(4 * 100 * 100, 0)};
    for (std::uint8_t& cell : region.cells) cell = rng.uniform() < share;
    plan.regions.push_back(region);
    plan.trays.push_back(name);
    if (tray < 8) plan.parts.push_back(make_part(name + "/cube", name, 0.9, 0.2 * tray, true, 0));
  }
  return plan;
}

/// Least number of cells such that every wanted tray's region holds one: a disc smaller than a cell fits into each.
int least_cells(const PlanToCheck& plan) {
  std::set<unsigned> groups;
  for (std::size_t cell = 0; cell < plan.regions[0].cells.size(); ++cell) {
    unsigned group = 0;
    for (unsigned tray = 0; tray < 8; ++tray) group |= plan.regions[tray].cells[cell] ? 1u << tray : 0u;
    groups.insert(group);
  }
  std::vector<int> least(256, 1000);
  least[0] = 0;
  for (unsigned covered = 0; covered < 256; ++covered) {
    for (const unsigned group : groups) least[covered | group] = std::min(least[covered | group], least[covered] + 1);
  }
  return least[255];
}

TEST(PlanCheckStops, SmallUncertaintyOnRaggedRegions) {
  for (const double share : {0.002, 0.02, 0.2}) {
    int expected = 0;
    for (const double uncertainty : {0.0, 0.001, 0.01}) {
      const PlanToCheck plan = ragged_plan(uncertainty, share);
      expected = least_cells(plan);
      EXPECT_EQ(check_plan(plan, quick()).minimal_stops, expected) << share << " " << uncertainty;
    }
    EXPECT_GT(expected, 1) << "must not be trivial";
  }
}

TEST(PlanCheckStops, RaggedRegionsDoNotHoldUpTheSearch) {
  // Discs larger than a cell: never fewer stops than with points instead of discs.
  for (const double share : {0.5, 0.95}) {
    const PlanToCheck plan = ragged_plan(0.03, share);
    EXPECT_GE(check_plan(plan, quick()).minimal_stops, least_cells(plan)) << share;
  }
}

TEST(PlanCheckRoute, MissingLeg) {
  PlanToCheck plan = good_plan();
  plan.route.pop_back();
  EXPECT_TRUE(codes_of(plan).count("route-legs"));
}

TEST(PlanCheckRoute, LegThatEndsElsewhere) {
  PlanToCheck plan = good_plan();
  plan.route[0].back().x() += 2e-6;
  EXPECT_TRUE(codes_of(plan).count("route-ends"));
  plan = good_plan();
  plan.route[2].back().z() += 2 * M_PI;  // a full turn later the base looks the same way; it must turn, though
  EXPECT_EQ(codes_of(plan), Codes{"route-not-driveable"});
  plan.route[2].insert(plan.route[2].begin() + 1, Eigen::Vector3d(0.4, 3, 2 * M_PI));
  EXPECT_TRUE(codes_of(plan).empty());
  plan.route[1].clear();
  EXPECT_EQ(codes_of(plan), Codes{"route-ends"});
}

TEST(PlanCheckFigures, DrivesOfMecanumWheelsTakeTheirTime) {
  PlanToCheck plan = good_plan();
  mmgrasp::RobotOptions options;
  options.base = mmgrasp::BaseKind::omni;
  options.base_limits.wheel_velocity = 0.4;
  options.base_limits.wheel_separation = 0.4;
  options.base_limits.wheelbase = 0.5;
  plan.robot = mmgrasp::source_of(mmgrasp::Robot::from_strings(urdf(), srdf(), options));
  const Eigen::Vector3d a = plan.stops[0].pose, b = plan.stops[1].pose;
  plan.route[1] = {a, 0.5 * (a + b) + Eigen::Vector3d(0, 0, M_PI / 2), b};
  // 1.4 m ahead; twice 1.5 m from aside to ahead and back, by 45 degrees, where the fastest rim has sqrt(2) of it.
  const mmgrasp::BaseLimits& limits = options.base_limits;
  const double ahead = 1.4 / 0.4 + 0.4 / limits.linear_acceleration;
  const double top = 0.4 / (1.5 * std::sqrt(2.0) + 0.45 * M_PI / 2);  // of the piece, [1/s]
  const double piece =
      1 / top + top * std::max(1.5 / limits.linear_acceleration, M_PI / 2 / limits.angular_acceleration);
  plan.leg_values = {{1.4, 0, ahead}, {3, M_PI, 2 * piece}, {1.4, 0, ahead}};
  EXPECT_EQ(codes_of(plan), Codes{});
  for (CheckedLegValues& leg : plan.leg_values) {
    const double right = leg.duration;
    leg.duration /= 1.01;
    EXPECT_EQ(codes_of(plan), Codes{"route-values"});
    leg.duration = right;
  }
}

TEST(PlanCheckFigures, WhatDescribesMustNotLie) {
  PlanToCheck good = good_plan();
  // 1.4 m; 3 m with two quarter turns; 1.4 m, each piece from rest to rest at full speed.
  const mmgrasp::BaseLimits& limits = good.robot.base_limits;
  const auto drive = [&](double way) {
    return way / limits.linear_velocity + limits.linear_velocity / limits.linear_acceleration;
  };
  const double quarter = M_PI / 2 / limits.angular_velocity + limits.angular_velocity / limits.angular_acceleration;
  good.leg_values = {{1.4, 0, drive(1.4)}, {3, M_PI, drive(3) + 2 * quarter}, {1.4, 0, drive(1.4)}};
  good.intersections = {{{"A"}, 0, Eigen::Vector2d(0.4, 0), 0.2}, {{"B"}, 0, Eigen::Vector2d(0.35, 3), 0.15}};
  good.robustness_rate = 1;
  for (CheckedPick& pick : good.picks) {
    for (CheckedMotion& m : pick.motions) {
      m.accelerations.assign(m.times.size(), Eigen::VectorXd::Zero(5));
      for (std::size_t i = 0; i + 1 < m.times.size(); ++i)
        m.accelerations[i] = (m.velocities[i + 1] - m.velocities[i]) / (m.times[i + 1] - m.times[i]);
    }
  }
  EXPECT_EQ(codes_of(good), Codes{});
  std::vector<PlanToCheck> lies(7, good);
  lies[0].leg_values[1].length = 2.99;
  lies[1].leg_values[1].turning = 0;
  lies[2].leg_values[0].duration = 1.39 / good.robot.base_limits.linear_velocity;  // no time to speed up and brake
  lies[3].leg_values.pop_back();
  lies[4].leg_values[2].duration = -1;
  lies[5].leg_values[2].length = std::nan("");
  lies[6].leg_values[0].duration *= 1.1;
  for (const PlanToCheck& lie : lies) EXPECT_EQ(codes_of(lie), Codes{"route-values"}) << &lie - lies.data();
  lies.assign(8, good);
  lies[7].intersections[0].trays.push_back("A");  // twice
  lies[6].intersections[0].radius = 0.19;         // not the largest
  lies[0].intersections[0].radius = 0.21;
  lies[1].intersections[1].trays.push_back("A");
  lies[2].intersections[1].centre.x() = 0.55;
  lies[3].intersections[1].heading = 1;
  lies[4].robustness_rate = 1.1;
  lies[5].robustness_rate = -0.1;
  for (const PlanToCheck& lie : lies) EXPECT_EQ(codes_of(lie), Codes{"wrong-values"}) << &lie - lies.data();
  good.stops[1].radius = 0.19;
  EXPECT_EQ(codes_of(good), Codes{"stop-radius"});
  good.stops[1].radius = 0.2;
  lies.assign(4, good);
  for (Eigen::VectorXd& a : lies[3].picks[1].motions[2].accelerations) a.setZero();  // it moves
  lies[0].picks[1].motions[2].accelerations[3][4] = 2.1;                             // the limit is 2
  lies[1].picks[1].motions[2].accelerations.pop_back();
  lies[2].picks[1].motions[2].accelerations[3][4] = std::nan("");
  for (const PlanToCheck& lie : lies) EXPECT_EQ(codes_of(lie), Codes{"acceleration"}) << &lie - lies.data();
}

TEST(PlanCheckStops, TheBaseStaysInItsWorkspace) {
  PlanToCheck plan = good_plan();  // start and goal at x = -1, the second stop and the goal at y = 3
  plan.robot.base_limits.workspace = 3.2;
  EXPECT_EQ(codes_of(plan), Codes{});
  plan.robot.base_limits.workspace = 3.05;  // less than the stop's y and its uncertainty
  EXPECT_EQ(codes_of(plan), Codes{"base-workspace"});
  plan.robot.base_limits.workspace = 0.9;
  const PlanCheckResult result = check_plan(plan, quick());
  std::set<std::string> places;
  for (const Fault& fault : result.faults) places.insert(fault.where);
  for (const char* where : {"start", "goal", "stop 1", "route leg 0", "route leg 1"}) EXPECT_TRUE(places.count(where));
}

TEST(PlanCheckStops, HeadingsAreThoseOfTheTrays) {
  PlanToCheck plan = good_plan();
  plan.searched["A"] = {{0.0}, {0.9, 0}, 10};
  plan.searched["B"] = {{0.0}, {0.9, 3}, 10};
  EXPECT_EQ(codes_of(plan), Codes{});
  plan.searched["B"].headings = {0.0, 0.3};  // the plan did not look at one of them
  EXPECT_EQ(codes_of(plan), Codes{"region-malformed"});
  plan.searched["B"].headings = {2 * M_PI};
  EXPECT_EQ(codes_of(plan), Codes{});
  plan.grid.headings = {0.3};
  plan.searched["B"].headings = {0.3};
  EXPECT_TRUE(codes_of(plan).count("region-malformed"));  // cells at a heading that tray A does not list
}

TEST(PlanCheckStops, BasePosesAreDrawnInRegionsAndBesideThem) {
  PlanCheckOptions options = quick();
  options.region_samples = 20;
  PlanToCheck plan = good_plan();
  EXPECT_EQ(codes(check_plan(plan, options)), Codes{});  // nothing is known about how trays were searched
  plan.searched["A"] = {{0.0}, {0.9, 0}, 10};
  EXPECT_EQ(codes(check_plan(plan, options)), Codes{"region-incomplete"});  // the arm reaches farther than its square
  EXPECT_TRUE(check_plan(plan, options).regions_searched);
  plan.padded = true;  // grown bodies reach less far, and these are judged as they are
  EXPECT_EQ(codes(check_plan(plan, options)), Codes{});
  EXPECT_FALSE(check_plan(plan, options).regions_searched);
  plan.padded = false;
  plan.searched["A"] = {{0.0}, {0.4, 0}, 0.2};  // what lies beside the square was not to be tried
  EXPECT_EQ(codes(check_plan(plan, options)), Codes{});
  plan.searched.clear();
  plan.regions[0].cells.assign(plan.regions[0].cells.size(), 1);
  EXPECT_TRUE(codes(check_plan(plan, options)).count("region-inflated"));
  plan.stops[0].radius = 0.39;  // within the cells
  EXPECT_TRUE(codes(check_plan(plan, options)).count("region-inflated"));
}

TEST(PlanCheckStops, HeadingsWithoutCellsAreSearchedToo) {
  // Fewer stops may be enough at a heading that was to be tried and of which the plan says nothing.
  PlanCheckOptions options = quick();
  options.region_samples = 20;
  PlanToCheck plan = good_plan();
  plan.grid.headings = {0.0, 0.3};
  for (CheckedRegion& region : plan.regions) region.cells.resize(2 * region.cells.size(), 0);
  plan.searched["A"] = {{0.0}, {0.4, 0}, 0.2};
  EXPECT_EQ(codes(check_plan(plan, options)), Codes{});
  plan.searched["A"] = {{0.0, 0.3}, {0.4, 0}, 0.2};
  EXPECT_EQ(codes(check_plan(plan, options)), Codes{"region-incomplete"});
  plan.searched["A"] = {{0.0, M_PI}, {0.4, 0}, 0.2};  // the arm does not reach backwards
  plan.grid.headings = {0.0, M_PI};
  EXPECT_EQ(codes(check_plan(plan, options)), Codes{});
}

TEST(PlanCheckStops, RegionsOfFewCellsAreLookedAtAllAround) {
  PlanCheckOptions options = quick();
  options.region_samples = 20;
  for (const double half : {0.08, 0.13}) {  // 4 x 4 and 6 x 6 of its cells of 5 cm, or fewer
    PlanToCheck plan = good_plan();
    const CheckedGrid& grid = plan.grid;
    for (int iy = 0; iy < grid.ny; ++iy) {
      for (int ix = 0; ix < grid.nx; ++ix) {
        const Eigen::Vector2d middle = grid.origin + grid.resolution * Eigen::Vector2d(ix + 0.5, iy + 0.5);
        if ((middle - Eigen::Vector2d(0.4, 0)).cwiseAbs().maxCoeff() > half)
          plan.regions[0].cells[iy * grid.nx + ix] = 0;
      }
    }
    plan.positioning_uncertainty = plan.stops[0].radius = 0.04;
    plan.searched["A"] = {{0.0}, {0.4, 0}, 1.0};
    EXPECT_TRUE(codes(check_plan(plan, options)).count("region-incomplete")) << half;
  }
}

TEST(PlanCheckRoute, SidewaysDrive) {
  PlanToCheck plan = good_plan();
  plan.route[1] = {plan.stops[0].pose, plan.stops[1].pose};
  EXPECT_EQ(codes_of(plan), Codes{"route-not-driveable"});
}

TEST(PlanCheckRoute, OmniMayDriveSidewaysFixedMayNot) {
  PlanToCheck plan = good_plan();
  mmgrasp::RobotOptions options;
  options.base = mmgrasp::BaseKind::omni;
  plan.robot = mmgrasp::source_of(mmgrasp::Robot::from_strings(urdf(), srdf(), options));
  plan.route[1] = {plan.stops[0].pose, plan.stops[1].pose};
  EXPECT_TRUE(codes_of(plan).empty());
  options.base = mmgrasp::BaseKind::fixed;
  plan.robot = mmgrasp::source_of(mmgrasp::Robot::from_strings(urdf(), srdf(), options));
  EXPECT_EQ(codes_of(plan), Codes{"route-not-driveable"});
}

TEST(PlanCheckRoute, ObstacleOnTheWay) {
  PlanToCheck plan = good_plan();
  plan.obstacles.push_back(box("post", {0.02, 0.02, 1}, at(0.4, 1.5, 0.5)));
  EXPECT_EQ(codes_of(plan), Codes{"route-collision"});
}

TEST(PlanCheckRoute, ThinObstacleBetweenPoses) {
  PlanToCheck plan = good_plan();
  plan.obstacles.push_back(
      box("sheet", {0.012, 0.012, 0.1}, at(-0.5, 0.195, 0.2)));  // only the base's corner passes it
  EXPECT_EQ(codes_of(plan), Codes{"route-collision"});
}

TEST(PlanCheckRoute, StartAndHome) {
  PlanToCheck plan = good_plan();
  plan.obstacles.push_back(box("crate", {0.2, 0.2, 0.2}, at(-1.15, 0, 0.2)));
  EXPECT_TRUE(codes_of(plan).count("start-collision"));
  plan = good_plan();
  plan.home[0] = 0.51;
  EXPECT_TRUE(codes_of(plan).count("home-limit"));
  plan = good_plan();
  plan.home[0] = -0.6;  // fingers in the base
  EXPECT_TRUE(codes_of(plan).count("home-collision"));
}

}  // namespace
}  // namespace tiny
