#include "mmgrasp/task/policies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

/// Trays along x, parts on a grid in each; a part can be grasped from a disc in front of it.
struct Storeroom {
  PartRegions parts;
  std::vector<std::vector<Eigen::Vector2d>> places;

  Storeroom(int trays, int columns, int rows, double spacing, double reach, double jitter = 0, unsigned seed = 1) {
    Rng rng(seed);
    BaseGrid& grid = parts.grid;
    grid.resolution = 0.05;
    grid.origin = {-1.5, -2.0};
    grid.nx = static_cast<int>((spacing * trays + 3) / 0.05);
    grid.ny = 50;
    grid.headings = {M_PI / 2};
    for (int tray = 0; tray < trays; ++tray) {
      parts.cells.emplace_back();
      places.emplace_back();
      for (int i = 0; i < columns * rows; ++i) {
        const Eigen::Vector2d at(spacing * tray + 0.1 * (i % columns) + rng.uniform(-jitter, jitter),
                                 0.1 * (i / columns) + rng.uniform(-jitter, jitter));
        places.back().push_back(at);
        CellMask mask(grid.size(), 0);
        for (int iy = 0; iy < grid.ny; ++iy) {
          for (int ix = 0; ix < grid.nx; ++ix) {
            const Eigen::Vector2d d = grid.centre(0, ix, iy).head<2>() - at;
            mask[grid.index(0, ix, iy)] = d.norm() < reach && d.y() < -0.3;
          }
        }
        parts.cells.back().push_back(std::move(mask));
      }
    }
  }
};

double radius_of(const Storeroom& room, const std::vector<std::pair<int, int>>& tray_and_part) {
  CellMask shared(room.parts.grid.size(), 1);
  for (const auto& [tray, part] : tray_and_part) {
    const CellMask& mask = room.parts.cells[tray][part];
    for (std::size_t i = 0; i < shared.size(); ++i) shared[i] = shared[i] && mask[i];
  }
  return inscribed_circle(room.parts.grid, shared, 0).radius;
}

TEST(PairedOrder, EqualTraysArePairedPartByPart) {
  const Storeroom room(3, 3, 4, 0.5, 0.8);
  const PickingOrder order = paired_order(room.places);
  for (const auto& tray : order) {
    ASSERT_EQ(tray.size(), 12u);
    for (int i = 0; i < 12; ++i) EXPECT_EQ(tray[i], i);
  }
}

TEST(PairedOrder, PartsOfUnequalTraysStayWithTheirPartners) {
  // The single part lies straight across the second of three, 0.5 m away as on average.
  const std::vector<std::vector<Eigen::Vector2d>> places{
      {{0, 0}, {0.3, 0}, {0.6, 0}}, {{0.3, 0.5}}, {{0, 1}, {0.3, 1}}};
  const PickingOrder order = paired_order(places);
  EXPECT_EQ(order[0], (std::vector<int>{0, 1, 2}));
  // One pair has no spread: any partner will do, but the round must be that partner's.
  int round = -1;
  for (std::size_t i = 0; i < order[1].size(); ++i)
    if (order[1][i] == 0) round = static_cast<int>(i);
  ASSERT_GE(round, 0);
  ASSERT_LT(round, 3);
  std::vector<int> seen;
  for (const int part : order[2])
    if (part >= 0) seen.push_back(part);
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(seen, (std::vector<int>{0, 1}));
  ASSERT_GT(static_cast<int>(order[2].size()), round);
  EXPECT_GE(order[2][round], 0) << "picked together with the single part";
}

TEST(OptimisedOrder, TraysWithoutParts) {
  PartRegions parts;
  parts.grid = Storeroom(2, 1, 1, 0.5, 0.8).parts.grid;
  parts.cells = {{}, {}};
  for (const bool smallest : {false, true}) {
    OrderOptions options;
    options.smallest_first = smallest;
    const OptimisedOrder found = optimised_order(parts, {{0, 1}}, {{}, {}}, options);
    EXPECT_EQ(found.order, (PickingOrder{{}, {}}));
    EXPECT_EQ(found.mean_radius, 0);
  }
}

/// The spread of the distances within pairs is the least over all pairings.
TEST(PairedOrder, LeastSpreadOfDistances) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Storeroom room(2, 2, 3, 0.5, 0.8, 0.08, seed);
    const auto spread = [&](const std::vector<int>& second) {
      double sum = 0, squares = 0;
      for (std::size_t i = 0; i < 6; ++i) {
        const double d = (room.places[0][i] - room.places[1][second[i]]).norm();
        sum += d;
        squares += d * d;
      }
      return squares - sum * sum / 6;
    };
    std::vector<int> trial(6);
    std::iota(trial.begin(), trial.end(), 0);
    const double in_order = spread(trial);
    double best = 1e9;
    do {
      best = std::min(best, spread(trial));
    } while (std::next_permutation(trial.begin(), trial.end()));
    const double found = spread(paired_order(room.places)[1]);
    EXPECT_LE(found, std::max(4 * best, 0.3 * in_order) + 1e-12) << seed;  // a heuristic, but a good one
    EXPECT_GE(found, best - 1e-12);
  }
}

TEST(OptimisedOrder, TwoTraysAgainstEveryOrder) {
  for (const bool smallest_first : {false, true}) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const Storeroom room(2, 2, 3, 0.9, 0.8, 0.05, seed);
      const PickingOrder paired = paired_order(room.places);
      OrderOptions options;
      options.smallest_first = smallest_first;
      const OptimisedOrder found = optimised_order(room.parts, {{0, 1}}, paired, options);
      EXPECT_TRUE(found.proven);
      Eigen::MatrixXd radii(6, 6);
      for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) radii(i, j) = radius_of(room, {{0, i}, {1, j}});
      }
      std::vector<int> trial(6);
      std::iota(trial.begin(), trial.end(), 0);
      double best_sum = 0, best_smallest = 0, paired_sum = 0;
      do {
        double sum = 0, smallest = 1e9;
        for (int i = 0; i < 6; ++i) {
          const double r = radii(i, trial[i]);
          sum += r;
          smallest = std::min(smallest, r);
        }
        if (!smallest_first) {
          best_sum = std::max(best_sum, sum);
        } else if (smallest > best_smallest + 1e-6) {
          best_smallest = smallest;
          best_sum = sum;
        } else if (smallest > best_smallest - 1e-6) {
          best_sum = std::max(best_sum, sum);
        }
      } while (std::next_permutation(trial.begin(), trial.end()));
      for (std::size_t i = 0; i < 6; ++i) paired_sum += radius_of(room, {{0, paired[0][i]}, {1, paired[1][i]}});
      EXPECT_NEAR(6 * found.mean_radius, best_sum, 1e-5) << seed;
      if (smallest_first) {
        EXPECT_NEAR(found.smallest_radius, best_smallest, 1e-6) << seed;
      } else {
        EXPECT_GE(6 * found.mean_radius, paired_sum - 1e-6);
      }
    }
  }
}

TEST(OptimisedOrder, ThreeTraysTriedOutAndSearched) {
  const Storeroom room(3, 2, 2, 0.45, 0.8, 0.05, 7);
  const PickingOrder paired = paired_order(room.places);
  const OptimisedOrder all = optimised_order(room.parts, {{0, 1, 2}}, paired);
  EXPECT_TRUE(all.proven);
  OrderOptions few;
  few.max_tried = 0;
  const OptimisedOrder searched = optimised_order(room.parts, {{0, 1, 2}}, paired, few);
  EXPECT_FALSE(searched.proven);
  EXPECT_LE(searched.mean_radius, all.mean_radius + 1e-9);
  double paired_sum = 0;
  for (std::size_t i = 0; i < 4; ++i)
    paired_sum += radius_of(room, {{0, paired[0][i]}, {1, paired[1][i]}, {2, paired[2][i]}});
  EXPECT_GE(4 * searched.mean_radius, paired_sum - 1e-6);
  EXPECT_THROW(optimised_order(room.parts, {{0, 0}}, paired), InvalidInput);
  EXPECT_THROW(optimised_order(room.parts, {{0, 3}}, paired), InvalidInput);
  PickingOrder twice = paired;
  twice[1] = {0, 0, 1, 2};
  EXPECT_THROW(optimised_order(room.parts, {{0, 1}}, twice), InvalidInput);
}

/// P1 3.6.3: the fewer parts a round is planned for, the more room its stops have.
TEST(Policies, UpdatingWidensTheDiscs) {
  const Storeroom room(5, 3, 4, 0.45, 0.85);
  const PickingOrder order = paired_order(room.places);
  PolicyOptions options;
  options.stops.min_radius = 0.10;
  std::vector<PolicyResult> results;
  for (const UpdatePolicy policy : {UpdatePolicy::all, UpdatePolicy::remaining, UpdatePolicy::targets}) {
    results.push_back(run_policy(regions_for(policy, room.parts, order), room.parts, order, options));
    const PolicyResult& result = results.back();
    ASSERT_EQ(result.rounds.size(), 12u);
    EXPECT_TRUE(result.solved);
    EXPECT_TRUE(result.reliable);  // what was planned for holds what is picked
    double sum = 0;
    for (const PolicyRound& round : result.rounds) {
      std::vector<int> served(5, 0);
      double mean = 0;
      for (const Stop& stop : round.stops) {
        mean += stop.radius / static_cast<double>(round.stops.size());
        for (int tray : stop.trays) ++served[tray];
      }
      EXPECT_NEAR(round.mean_radius, mean, 1e-12);
      sum += mean;
      for (int times : served) EXPECT_EQ(times, 1);
    }
    EXPECT_NEAR(result.mean_radius, sum / 12, 1e-12);
  }
  EXPECT_EQ(results[0].rounds[0].stops.size(), results[0].rounds[11].stops.size());
  // Fewer stops come first: never more of them, and with as many at least as much room.
  EXPECT_LE(results[1].mean_stops, results[0].mean_stops + 1e-12);
  EXPECT_LE(results[2].mean_stops, results[1].mean_stops + 1e-12);
  EXPECT_NEAR(results[1].rounds[0].mean_radius, results[0].rounds[0].mean_radius, 1e-12);    // all parts are there
  EXPECT_NEAR(results[1].rounds[11].mean_radius, results[2].rounds[11].mean_radius, 1e-12);  // the last part
}

/// Regions estimated for other parts than are picked: the discs leave the true ones.
TEST(Policies, WrongRegionsAreUnreliable) {
  const Storeroom room(2, 3, 4, 0.45, 0.6), elsewhere(2, 3, 4, 0.45, 0.6, 0.1, 3);
  const PickingOrder order = paired_order(room.places);
  PolicyOptions options;
  options.stops.min_radius = 0.10;
  const PolicyResult sound =
      run_policy(regions_for(UpdatePolicy::targets, room.parts, order), room.parts, order, options);
  EXPECT_TRUE(sound.reliable);
  const auto shifted = [&](int round) {
    std::vector<BaseRegion> regions = regions_for(UpdatePolicy::targets, room.parts, order)(round);
    for (BaseRegion& region : regions) {
      CellMask moved(region.cells.size(), 0);
      for (std::size_t i = 12; i < moved.size(); ++i) moved[i] = region.cells[i - 12];
      region.cells = moved;
    }
    return regions;
  };
  const PolicyResult wrong = run_policy(shifted, room.parts, order, options);
  EXPECT_TRUE(wrong.solved);
  EXPECT_FALSE(wrong.reliable);
  EXPECT_FALSE(wrong.feasible);
}

TEST(Policies, TraysWithoutAPickAreNotVisited) {
  const Storeroom room(3, 2, 1, 0.45, 0.8);
  const PickingOrder order = {{0, 1}, {-1, 1}, {0}};
  const PolicyResult result = run_policy(regions_for(UpdatePolicy::targets, room.parts, order), room.parts, order);
  ASSERT_EQ(result.rounds.size(), 2u);
  std::vector<int> first, second;
  for (const Stop& stop : result.rounds[0].stops) first.insert(first.end(), stop.trays.begin(), stop.trays.end());
  for (const Stop& stop : result.rounds[1].stops) second.insert(second.end(), stop.trays.begin(), stop.trays.end());
  std::sort(first.begin(), first.end());
  std::sort(second.begin(), second.end());
  EXPECT_EQ(first, (std::vector<int>{0, 2}));
  EXPECT_EQ(second, (std::vector<int>{0, 1}));
}

TEST(Policies, NamesAndBadInput) {
  EXPECT_EQ(make_update_policy("remaining"), UpdatePolicy::remaining);
  EXPECT_THROW(make_update_policy("updateR"), InvalidInput);
  const Storeroom room(2, 2, 1, 0.45, 0.8);
  EXPECT_THROW(regions_for(UpdatePolicy::all, room.parts, {{0, 1}}), InvalidInput);
  EXPECT_THROW(regions_for(UpdatePolicy::all, room.parts, {{0, 0}, {0, 1}}), InvalidInput);
  EXPECT_THROW(regions_for(UpdatePolicy::all, room.parts, {{0, 2}, {0, 1}}), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
