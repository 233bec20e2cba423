#include "plan/manipulation/common/grasp_ends.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/around.hpp"
#include "support/random_ends.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;
using test::random_ends;

TEST(GraspEnds, AreSortedByTheirStraightCost) {
  Rng rng(4);
  const GraspEnds ends = random_ends(40, 3, rng);
  for (int g = 0; g + 1 < ends.size(); ++g) EXPECT_LE(ends.straight_cost(g), ends.straight_cost(g + 1));
  for (const double cost : {0.5, 2.0, 3.3, 20.0}) {
    int below = 0;
    for (int g = 0; g < ends.size(); ++g) below += ends.straight_cost(g) < cost;
    EXPECT_EQ(ends.below(cost), below);
  }
  const VectorXd q = Eigen::Vector3d(0.3, -0.2, 1);
  for (int g = 0; g < ends.size(); ++g) {
    double least[2] = {1e9, 1e9};
    for (const int side : {0, 1})
      for (int k = 0; k < ends.count(g, side); ++k)
        least[side] = std::min(least[side], (Eigen::Map<const VectorXd>(ends.end(g, side, k), 3) - q).norm());
    EXPECT_NEAR(ends.estimate(g, q.data()), least[0] + least[1], 1e-12);
  }
}

TEST(GraspEnds, DistancesGoTheShortWayRound) {
  Rng rng(5);
  const std::vector<bool> wraps{true, false, true};
  const GraspEnds ends = random_ends(40, 3, rng, wraps);
  const VectorXd q = Eigen::Vector3d(3.1, -0.2, -2.9);
  for (int g = 0; g < ends.size(); ++g) {
    double least[2] = {1e9, 1e9}, straight = 1e9;
    const auto end = [&](int side, int k) { return VectorXd(Eigen::Map<const VectorXd>(ends.end(g, side, k), 3)); };
    for (const int side : {0, 1})
      for (int k = 0; k < ends.count(g, side); ++k)
        least[side] = std::min(least[side], test::distance_around(wraps, end(side, k), q));
    for (int s = 0; s < ends.count(g, 0); ++s)
      for (int k = 0; k < ends.count(g, 1); ++k)
        straight = std::min(straight, test::distance_around(wraps, end(0, s), end(1, k)));
    EXPECT_NEAR(ends.estimate(g, q.data()), least[0] + least[1], 1e-12);
    EXPECT_NEAR(ends.straight_cost(g), straight, 1e-12);
  }
}

}  // namespace
}  // namespace mmgrasp::detail
