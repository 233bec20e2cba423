#include "mmgrasp/plan/roadmap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <set>
#include <utility>
#include <vector>

#include "mmgrasp/core/parallel.hpp"
#include "plan/roadmap/roadmap_data.hpp"
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
  std::set<std::pair<int, int>> pairs;
  for (int a = 0; a < roadmap.size(); ++a) {
    std::vector<std::pair<double, int>> others;
    for (int b = 0; b < roadmap.size(); ++b)
      if (b != a) others.emplace_back((roadmap.vertices().col(b) - roadmap.vertices().col(a)).norm(), b);
    std::sort(others.begin(), others.end());
    for (std::size_t i = 0; i < others.size(); ++i)
      if (neighbours > 0 ? i < static_cast<std::size_t>(neighbours) : others[i].first <= radius)
        pairs.insert(std::minmax(a, others[i].second));
  }
  return pairs;
}

TEST(Roadmap, JoinsEachPairOnceAndInOrder) {
  const JointGroup group = test::PlanarArm(3).group();
  for (const int neighbours : {0, 5}) {
    const Roadmap roadmap = Roadmap::build(group, with(300, neighbours));
    const std::set<std::pair<int, int>> expected = all_pairs(roadmap, neighbours, roadmap.radius());
    ASSERT_EQ(roadmap.edge_count(), static_cast<int>(expected.size()));
    int edge = 0;
    for (const auto& pair : expected) EXPECT_EQ(roadmap.ends(edge++), pair);
  }
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
