#include "mmgrasp/plan/roadmap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <set>
#include <utility>
#include <vector>

#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/core/random.hpp"
#include "plan/roadmap/roadmap_data.hpp"
#include "support/around.hpp"
#include "support/planar_arm.hpp"

namespace mmgrasp {
namespace {

RoadmapOptions with(int vertices, int neighbours) {
  RoadmapOptions options;
  options.vertices = vertices;
  options.neighbours = neighbours;
  return options;
}

/// Pairs by enumeration.
std::set<std::pair<int, int>> all_pairs(const Roadmap& roadmap, int neighbours, double radius) {
  const std::vector<bool>& wraps = roadmap.group().wraps();
  const Eigen::VectorXd weights = roadmap.options().joint_weights.values;
  std::set<std::pair<int, int>> pairs;
  for (int a = 0; a < roadmap.size(); ++a) {
    std::vector<std::pair<double, int>> others;
    for (int b = 0; b < roadmap.size(); ++b)
      if (b != a)
        others.emplace_back(test::distance_around(wraps, roadmap.vertices().col(a), roadmap.vertices().col(b), weights),
                            b);
    std::sort(others.begin(), others.end());
    for (std::size_t i = 0; i < others.size(); ++i)
      if (neighbours > 0 ? i < static_cast<std::size_t>(neighbours) : others[i].first <= radius)
        pairs.insert(std::minmax(a, others[i].second));
  }
  return pairs;
}

TEST(Roadmap, JoinsEachPairOnceAndInOrder) {
  // Angles that wrap: none, one, all.
  for (const int continuous : {0, 1, 3}) {
    const JointGroup group = test::PlanarArm(3, 0.5, 0.02, continuous == 3, 2.8, continuous).group();
    RoadmapOptions within_radius = with(300, 0);
    within_radius.gamma = 5;
    const int by_theory = 21;  // e (1 + 1/3) log 300 = 20.67
    RoadmapOptions weighted = within_radius, nearest_weighted = with(300, 5);
    weighted.joint_weights = nearest_weighted.joint_weights = Eigen::VectorXd(Eigen::Vector3d(2, 0.5, 1));
    for (const auto& [options, neighbours] :
         {std::pair(within_radius, 0), std::pair(with(300, 5), 5), std::pair(with(300, 0), by_theory),
          std::pair(weighted, 0), std::pair(nearest_weighted, 5)}) {
      const Roadmap roadmap = Roadmap::build(group, options);
      EXPECT_EQ(roadmap.statistics().neighbours, neighbours);
      const std::set<std::pair<int, int>> expected = all_pairs(roadmap, neighbours, roadmap.radius());
      ASSERT_EQ(roadmap.edge_count(), static_cast<int>(expected.size()));
      int edge = 0;
      for (const auto& pair : expected) EXPECT_EQ(roadmap.ends(edge++), pair);
      for (int v = 0; v < roadmap.size(); ++v)
        for (const Roadmap::Arc* arc = roadmap.begin(v); arc != roadmap.end(v); ++arc)
          EXPECT_NEAR(arc->length,
                      test::distance_around(group.wraps(), roadmap.vertices().col(v), roadmap.vertices().col(arc->to),
                                            options.joint_weights.values),
                      1e-12);
    }
  }
}

TEST(Roadmap, FindsVerticesBeyondTheSeam) {
  const JointGroup group = test::PlanarArm(3, 0.5, 0.02, false, 2.8, 1).group();
  const Roadmap roadmap = Roadmap::build(group, with(400, 6));
  Rng rng(2);
  std::vector<int> near;
  for (int i = 0; i < 100; ++i) {
    // In any turn, near the seam.
    const Eigen::Vector3d q(M_PI * (2 * static_cast<int>(rng.index(4)) - 3) + rng.uniform(-0.3, 0.3),
                            rng.uniform(-2.0, 2.0), rng.uniform(-2.0, 2.0));
    std::vector<std::pair<double, int>> others;
    for (int v = 0; v < roadmap.size(); ++v)
      others.emplace_back(test::distance_around(group.wraps(), q, roadmap.vertices().col(v)), v);
    std::sort(others.begin(), others.end());
    std::vector<int> expected;
    for (int k = 0; k < 6; ++k) expected.push_back(others[k].second);
    std::sort(expected.begin(), expected.end());
    roadmap.near(q, near);
    EXPECT_EQ(near, expected);
  }
}

TEST(Roadmap, SaysWhenItIsInPieces) {
  const JointGroup group = test::PlanarArm(3).group();
  EXPECT_EQ(Roadmap::build(group).warning(), "");
  RoadmapOptions sparse;
  sparse.vertices = 300;
  sparse.gamma = 1;
  const Roadmap roadmap = Roadmap::build(group, sparse);
  const RoadmapStatistics statistics = roadmap.statistics();
  ASSERT_LT(statistics.largest_component, 297);
  EXPECT_EQ(roadmap.warning(), "the roadmap is in " + std::to_string(statistics.components) +
                                   " pieces, the largest of " + std::to_string(statistics.largest_component) +
                                   " of 300 vertices: between pieces no path is found; set gamma = 0 and neighbours = "
                                   "0 (the defaults), or more neighbours");
}

/// Work is counted in all_checks whether to go on.
TEST(Roadmap, EveryPartOfTheWorkCanBeStopped) {
  const JointGroup group = test::PlanarArm(3).group();
  const RoadmapOptions options = with(20'000, 8);
  std::atomic<int> checks{0};
  const Roadmap whole = detail::build_roadmap(group, options, {}, [&] { return ++checks < 0; });
  ASSERT_EQ(whole.size(), options.vertices);
  const int all_checks = checks;
  ASSERT_GT(all_checks, 500);
  for (int stop_at = 1; stop_at < all_checks; stop_at += all_checks / 97) {
    checks = 0;
    const Roadmap none = detail::build_roadmap(group, options, {}, [&] { return ++checks >= stop_at; });
    EXPECT_EQ(none.size(), 0) << stop_at << " of " << all_checks;
    EXPECT_LE(checks, stop_at + resolve_threads(0)) << "it went on";
  }
}

/// By nanoflann, which knows nothing of it.
TEST(Roadmap, BuildingTheSearchTreeCanBeStopped) {
  const JointGroup group = test::PlanarArm(3).group();
  Roadmap::Data data(group, with(20'000, 8));
  int checks = 0;
  const std::function<bool()> over = [&] { return ++checks == 3; };
  detail::CancelCheck never, cancel({}, over);
  ASSERT_TRUE(data.draw(never));
  EXPECT_FALSE(data.index(cancel));
  EXPECT_EQ(checks, 3);
}

}  // namespace
}  // namespace mmgrasp
