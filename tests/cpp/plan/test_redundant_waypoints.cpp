#include "plan/motion/redundant_waypoints.hpp"

#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <vector>

#include "mmgrasp/core/random.hpp"

namespace mmgrasp::detail {
namespace {

std::vector<Eigen::VectorXd> numbered(int count) {
  std::vector<Eigen::VectorXd> out;
  for (int i = 0; i < count; ++i) out.push_back(Eigen::VectorXd::Constant(1, i));
  return out;
}

TEST(RedundantWaypoints, StraightLinesKeepTheirEndsAlone) {
  auto waypoints = numbered(50);
  remove_redundant_waypoints(waypoints, [](const auto&, const auto&) { return true; });
  EXPECT_EQ(waypoints,
            (std::vector<Eigen::VectorXd>{Eigen::VectorXd::Constant(1, 0), Eigen::VectorXd::Constant(1, 49)}));
  auto short_one = numbered(2);
  remove_redundant_waypoints(short_one, [](const auto&, const auto&) { return true; });
  EXPECT_EQ(short_one.size(), 2u);
}

/// Whatever edges are free: what is left is a path of free edges of which no waypoint can go.
TEST(RedundantWaypoints, NoneIsLeftThatCouldGo) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    Rng rng(seed);
    const int count = 3 + static_cast<int>(rng.index(30));
    std::set<std::pair<int, int>> free;
    for (int i = 0; i < count; ++i)
      for (int k = i + 1; k < count; ++k)
        if (k == i + 1 || rng.uniform() < 0.3) free.emplace(i, k);
    const auto is_free = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
      return free.count({static_cast<int>(a[0]), static_cast<int>(b[0])}) > 0;
    };
    auto waypoints = numbered(count);
    remove_redundant_waypoints(waypoints, is_free);
    EXPECT_EQ(waypoints.front()[0], 0);
    EXPECT_EQ(waypoints.back()[0], count - 1);
    for (std::size_t i = 0; i + 1 < waypoints.size(); ++i) EXPECT_TRUE(is_free(waypoints[i], waypoints[i + 1]));
    for (std::size_t i = 1; i + 1 < waypoints.size(); ++i) EXPECT_FALSE(is_free(waypoints[i - 1], waypoints[i + 1]));
  }
}

}  // namespace
}  // namespace mmgrasp::detail
