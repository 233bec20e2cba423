#include "plan/manipulation/rrt_star_mg/grasp_trees.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <tuple>

#include "mmgrasp/core/random.hpp"
#include "plan/motion/collision_cache.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;

GraspEnds random_ends(int grasps, int dimension, Rng& rng) {
  const VectorXd lower = VectorXd::Constant(dimension, -3), upper = VectorXd::Constant(dimension, 3);
  std::vector<GraspCandidate> candidates;
  for (int g = 0; g < grasps; ++g) {
    GraspCandidate candidate;
    candidate.grasp = g;
    for (int k = 0; k < 1 + g % 3; ++k) candidate.starts.push_back(rng.uniform(lower, upper));
    for (int k = 0; k < 1 + g % 2; ++k) candidate.goals.push_back(rng.uniform(lower, upper));
    candidates.push_back(candidate);
  }
  return GraspEnds(candidates);
}

TEST(TreeIndex, AnswersAsLookingAtAllDoes) {
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
    EXPECT_EQ(index.size(), static_cast<std::size_t>(std::count(there.begin(), there.end(), 1)));
  }
}

TEST(GraspEnds, AreKeptByTheirStraightCost) {
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

/// Random growing, rewiring and pruning: the books must agree all the time, and every tree must answer as a plain list
/// of its vertices does.
TEST(GraspTrees, BooksAgreeThroughGrowingRewiringAndPruning) {
  for (const int grasps : {2, 60}) {
    Rng rng(static_cast<unsigned>(grasps));
    const int d = 4;
    const GraspEnds ends = random_ends(grasps, d, rng);
    GraspTrees trees(ends);
    EXPECT_NO_THROW(trees.check_books());
    const VectorXd lower = VectorXd::Constant(d, -3), upper = VectorXd::Constant(d, 3);
    const auto apart = [&](int a, int b) { return std::sqrt(squared_distance(trees.at(a), trees.at(b), d)); };
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
        const double distance = std::sqrt(squared_distance(trees.at(v), q.data(), d));
        ++members;
        close += distance < 1.5;
        least = std::min(least, distance);
      }
      EXPECT_EQ(members, trees.tree_size(tree));
      EXPECT_NEAR(std::sqrt(squared_distance(trees.at(nearest), q.data(), d)), least, 1e-12);
      trees.near_in_tree(tree, q.data(), 1.5, near);
      EXPECT_EQ(near.size(), static_cast<std::size_t>(close));
      const int configuration = trees.add_configuration(q.data());
      const int made = trees.add(nearest, configuration, least);
      EXPECT_EQ(trees.find(tree, configuration), made);
      EXPECT_TRUE(trees.only_one(made));
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
          EXPECT_FALSE(trees.only_one(made));
          EXPECT_FALSE(trees.only_one(copy));
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
      if (round % 50 == 0) EXPECT_NO_THROW(trees.check_books());
    }
    EXPECT_NO_THROW(trees.check_books());
    EXPECT_GT(removed, 100);
    EXPECT_GT(copied, 100);
    if (grasps == 2) EXPECT_GT(rewired, 100);
  }
}

TEST(GraspTrees, BooksThatDisagreeAreNoticed) {
  Rng rng(6);
  const GraspEnds ends = random_ends(2, 3, rng);
  GraspTrees trees(ends);
  const Eigen::Vector3d q(1, 2, 3);
  trees.add(0, trees.add_configuration(q.data()), 0.5);  // Not the edge's length.
  EXPECT_THROW(trees.check_books(), std::logic_error);
}

TEST(CollisionCache, KeepsWhatItWasTold) {
  Rng rng(8);
  CollisionCache memory;
  std::map<std::tuple<int, int, int>, bool> told;
  for (int i = 0; i < 20000; ++i) {
    const int opening = static_cast<int>(rng.index(5)), a = static_cast<int>(rng.index(300)),
              b = static_cast<int>(rng.index(300));
    const auto key = std::make_tuple(opening, std::min(a, b), std::max(a, b));
    const auto known = told.find(key);
    EXPECT_EQ(memory.recall(opening, a, b), known == told.end() ? -1 : known->second ? 1 : 0);
    EXPECT_EQ(memory.recall(opening, b, a), memory.recall(opening, a, b));
    told[key] = rng.uniform() < 0.5;
    memory.keep(opening, a, b, told[key]);
  }
}

}  // namespace
}  // namespace mmgrasp::detail
