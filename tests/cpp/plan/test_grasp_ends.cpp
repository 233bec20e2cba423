#include "plan/manipulation/common/grasp_ends.hpp"

#include <gtest/gtest.h>

#include <algorithm>

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

}  // namespace
}  // namespace mmgrasp::detail
