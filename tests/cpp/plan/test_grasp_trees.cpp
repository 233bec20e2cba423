#include "plan/manipulation/rrt_star_mg/grasp_trees.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "support/around.hpp"
#include "support/random_ends.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;
using test::random_ends;

/// Random growing, rewiring and pruning: the invariants must hold all the time, and every tree must answer as a plain
/// list of its vertices does.
TEST(GraspTrees, InvariantsHoldThroughGrowingRewiringAndPruning) {
  const std::vector<bool> straight(4, false), around{false, true, true, false};
  for (const auto& [grasps, wraps] : {std::pair(2, straight), std::pair(60, straight), std::pair(2, around)}) {
    Rng rng(static_cast<unsigned>(grasps));
    const int d = 4;
    const GraspEnds ends = random_ends(grasps, d, rng, wraps);
    GraspTrees trees(ends);
    EXPECT_NO_THROW(trees.check_invariants());
    const VectorXd lower = VectorXd::Constant(d, -3), upper = VectorXd::Constant(d, 3);
    const auto away = [&, &wraps = wraps](int v, const VectorXd& q) {
      return test::distance_around(wraps, Eigen::Map<const VectorXd>(trees.at(v), d), q);
    };
    const auto apart = [&](int a, int b) { return away(a, Eigen::Map<const VectorXd>(trees.at(b), d)); };
    std::vector<GraspTrees::Near> near;
    int rewired = 0, removed = 0, copied = 0;
    for (int round = 0; round < 1200; ++round) {
      const int tree = static_cast<int>(rng.index(static_cast<std::size_t>(2 * grasps)));
      const VectorXd q = rng.uniform(lower, upper);
      const int nearest = trees.nearest_in_tree(tree, q.data());
      ASSERT_GE(nearest, 0);
      double least = 1e9;
      int members = 0, close = 0;
      for (int v = 0; v < trees.vertex_count(); ++v) {
        if (!trees.vertex(v).alive || trees.vertex(v).tree != tree) continue;
        const double distance = away(v, q);
        ++members;
        close += distance < 1.5;
        least = std::min(least, distance);
      }
      EXPECT_EQ(members, trees.tree_size(tree));
      EXPECT_NEAR(away(nearest, q), least, 1e-12);
      trees.near_in_tree(tree, q.data(), 1.5, near);
      EXPECT_EQ(near.size(), static_cast<std::size_t>(close));
      const int configuration = trees.add_configuration(q.data());
      const int made = trees.add(nearest, configuration, least);
      EXPECT_EQ(trees.find(tree, configuration), made);
      EXPECT_FALSE(trees.has_duplicate(made));
      for (const GraspTrees::Near& entry : near) {
        if (trees.vertex(entry.vertex).parent < 0 || entry.vertex == nearest) continue;
        const double length = apart(entry.vertex, made);
        if (trees.vertex(made).cost + length >= trees.vertex(entry.vertex).cost) continue;
        trees.reparent(entry.vertex, made, length);
        ++rewired;
      }
      if (round % 5 == 0) {
        // The same configuration in another tree.
        const int other = static_cast<int>(rng.index(static_cast<std::size_t>(2 * grasps)));
        if (other != tree) {
          const int parent = trees.nearest_in_tree(other, q.data());
          const int copy = trees.add(parent, configuration, apart(parent, made));
          EXPECT_TRUE(trees.has_duplicate(made));
          EXPECT_TRUE(trees.has_duplicate(copy));
          EXPECT_EQ(trees.find(other, configuration), copy);
          ++copied;
        }
      }
      if (round % 7 == 0) {
        const int v = static_cast<int>(rng.index(static_cast<std::size_t>(trees.vertex_count())));
        if (trees.vertex(v).alive && trees.vertex(v).parent >= 0) {
          trees.remove_below(v, [&](int) { ++removed; });
          EXPECT_FALSE(trees.vertex(v).alive);
        }
      }
      if (round % 50 == 0) {
        EXPECT_NO_THROW(trees.check_invariants());
      }
    }
    EXPECT_NO_THROW(trees.check_invariants());
    EXPECT_GT(removed, 100);
    EXPECT_GT(copied, 100);
    if (grasps == 2) {
      EXPECT_GT(rewired, 100);
    }
  }
}

TEST(GraspTrees, BrokenInvariantsAreNoticed) {
  Rng rng(6);
  const GraspEnds ends = random_ends(2, 3, rng);
  GraspTrees trees(ends);
  const Eigen::Vector3d q(1, 2, 3);
  trees.add(0, trees.add_configuration(q.data()), 0.5);  // Not the edge's length.
  EXPECT_THROW(trees.check_invariants(), std::logic_error);
}

}  // namespace
}  // namespace mmgrasp::detail
