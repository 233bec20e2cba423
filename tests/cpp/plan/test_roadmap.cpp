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

/// Pairs by looking at all of them.
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

/// Work is counted in questions whether to go on.
TEST(Roadmap, EveryPartOfTheWorkCanBeStopped) {
  const JointGroup group = test::PlanarArm(3).group();
  const RoadmapOptions options = with(20'000, 8);
  std::atomic<int> asked{0};
  const Roadmap whole = detail::build_roadmap(group, options, {}, [&] { return ++asked < 0; });
  ASSERT_EQ(whole.size(), options.vertices);
  const int questions = asked;
  ASSERT_GT(questions, 500);
  for (int stop_at = 1; stop_at < questions; stop_at += questions / 97) {
    asked = 0;
    const Roadmap none = detail::build_roadmap(group, options, {}, [&] { return ++asked >= stop_at; });
    EXPECT_EQ(none.size(), 0) << stop_at << " of " << questions;
    EXPECT_LE(asked, stop_at + resolve_threads(0)) << "it went on";
  }
}

/// By nanoflann, which knows nothing of it.
TEST(Roadmap, TheSearchTreeAsks) {
  const JointGroup group = test::PlanarArm(3).group();
  Roadmap::Data data(group, with(20'000, 8));
  int asked = 0;
  const std::function<bool()> over = [&] { return ++asked == 3; };
  detail::Until never, until({}, over);
  ASSERT_TRUE(data.draw(never));
  EXPECT_FALSE(data.index(until));
  EXPECT_EQ(asked, 3);
}

}  // namespace
}  // namespace mmgrasp
