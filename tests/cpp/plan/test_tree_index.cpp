#include "plan/manipulation/rrt_star_mg/tree_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "mmgrasp/core/random.hpp"
#include "support/around.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;

TEST(TreeIndex, AnswersAsAScanOfAllPointsDoes) {
  for (const int d : {1, 2, 6, 9}) {
    Rng rng(static_cast<unsigned>(d));
    TreeIndex index(d);
    std::vector<VectorXd> points;
    std::vector<char> there;
    const VectorXd lower = VectorXd::Constant(d, -1), upper = VectorXd::Constant(d, 1);
    for (int round = 0; round < 1500; ++round) {
      // Now and then the same point many times over, and points on a coarse grid.
      VectorXd q = rng.uniform(lower, upper);
      if (round % 3 == 0) q = (q * 2).array().round() / 2;
      if (round > 600 && round < 660) q = points[7];
      index.insert(static_cast<int>(points.size()), q.data());
      points.push_back(q);
      there.push_back(1);
      if (round % 4 == 0) {
        const std::size_t gone = rng.index(points.size());
        if (there[gone]) index.remove(static_cast<int>(gone));
        there[gone] = 0;
      }
      if (round % 10 != 0) continue;
      const VectorXd at = rng.uniform(lower, upper);
      const auto take = [](int id) { return id % 3 != 1; };
      double least = std::numeric_limits<double>::infinity();
      std::set<int> expected, found;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (!there[i]) continue;
        const double distance = (points[i] - at).norm();
        if (take(static_cast<int>(i))) least = std::min(least, distance);
        if (distance < 0.5) expected.insert(static_cast<int>(i));
      }
      double squared;
      const int nearest = index.nearest(at.data(), take, squared);
      if (std::isinf(least)) {
        EXPECT_EQ(nearest, -1);
      } else {
        ASSERT_GE(nearest, 0);
        EXPECT_TRUE(there[nearest] && take(nearest));
        EXPECT_NEAR(std::sqrt(squared), least, 1e-12);
        EXPECT_NEAR((points[nearest] - at).norm(), least, 1e-12);
      }
      index.within(at.data(), 0.5, [&](int id, double found_squared) {
        EXPECT_NEAR((points[id] - at).squaredNorm(), found_squared, 1e-12);
        EXPECT_TRUE(found.insert(id).second);
      });
      EXPECT_EQ(found, expected);
    }
    EXPECT_EQ(index.size(), std::count(there.begin(), there.end(), 1));
  }
}

TEST(TreeIndex, FindsWhatLiesBeyondTheSeamOfAnAngle) {
  using Case = std::pair<std::vector<bool>, std::vector<double>>;
  for (const auto& [wraps, weighing] :
       {Case{{true}, {}}, Case{{true, true}, {}}, Case{{true, false, true}, {}},
        Case{{true, true, true, true, false, true}, {}}, Case{{true}, {0.3}}, Case{{true, false, true}, {0.5, 1.5, 1}},
        Case{{false, false}, {0.4, 1.6}}, Case{{true, false, true, false}, {1.3, 0.2, 0.6, 1}}}) {
    const auto d = static_cast<Eigen::Index>(wraps.size());
    const VectorXd weights = Eigen::Map<const VectorXd>(weighing.data(), static_cast<Eigen::Index>(weighing.size()));
    Rng rng(static_cast<unsigned>(d));
    TreeIndex index(static_cast<int>(d), JointMetric(wraps, weights));
    std::vector<VectorXd> points;
    // In any turn.
    const VectorXd lower = VectorXd::Constant(d, -9), upper = -lower;
    for (int i = 0; i < 4000; ++i) {
      points.push_back(rng.uniform(lower, upper));
      // Half of them in a crowd at the seam.
      if (i % 2 == 0) points.back() = (M_PI + 0.02 * points.back().array()).matrix();
      index.insert(i, points.back().data());
    }
    int beyond = 0;
    for (int i = 0; i < 300; ++i) {
      VectorXd at = rng.uniform(lower, upper);
      if (i % 2 == 0) at = (M_PI + 0.02 * at.array()).matrix();
      double least = 1e9, straight = 1e9;
      std::set<int> expected, found;
      for (std::size_t p = 0; p < points.size(); ++p) {
        const double distance = test::distance_around(wraps, points[p], at, weights);
        least = std::min(least, distance);
        straight = std::min(straight, test::distance_around(std::vector<bool>(d), points[p], at, weights));
        if (distance < 0.3) expected.insert(static_cast<int>(p));
      }
      double squared;
      const int nearest = index.nearest(
          at.data(), [](int) { return true; }, squared);
      ASSERT_GE(nearest, 0);
      EXPECT_NEAR(std::sqrt(squared), least, 1e-12);
      EXPECT_NEAR(test::distance_around(wraps, points[nearest], at, weights), least, 1e-12);
      beyond += least < straight - 1e-9;
      index.within(at.data(), 0.3, [&](int id, double found_squared) {
        EXPECT_NEAR(test::distance_around(wraps, points[id], at, weights), std::sqrt(found_squared), 1e-12);
        EXPECT_TRUE(found.insert(id).second);
      });
      EXPECT_EQ(found, expected);
    }
    EXPECT_GT(beyond, wraps[0] ? 50 : -1);
  }
}

}  // namespace
}  // namespace mmgrasp::detail
