#include "mapping/segmentation/greedy_multicut.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>

#include "mmgrasp/core/random.hpp"

using mmgrasp::detail::greedy_multicut;
using mmgrasp::detail::SignedEdge;
using Parts = std::vector<int>;

namespace {

double within(const Parts& part, const std::vector<SignedEdge>& edges) {
  double sum = 0;
  for (const SignedEdge& e : edges) sum += part[e.a] == part[e.b] ? e.weight : 0;
  return sum;
}

/// The largest sum within the parts, over all ways to part `nodes` nodes.
double best_within(int nodes, const std::vector<SignedEdge>& edges) {
  double best = 0;
  Parts part(nodes, 0);
  const std::function<void(int, int)> place = [&](int node, int parts) {
    if (node == nodes) {
      best = std::max(best, within(part, edges));
      return;
    }
    for (int p = 0; p <= parts; ++p) {
      part[node] = p;
      place(node + 1, std::max(parts, p + 1));
    }
  };
  place(0, 0);
  return best;
}

}  // namespace

TEST(GreedyMulticut, SignsDecide) {
  EXPECT_EQ(greedy_multicut(0, {}), Parts{});
  EXPECT_EQ(greedy_multicut(3, {}), (Parts{0, 1, 2}));
  EXPECT_EQ(greedy_multicut(3, {{0, 1, 1}, {1, 2, -2}}), (Parts{0, 0, 1}));
  EXPECT_EQ(greedy_multicut(4, {{2, 3, 1}, {0, 3, 2}, {0, 1, -1}}), (Parts{0, 1, 0, 0}));
  EXPECT_EQ(greedy_multicut(2, {{0, 1, 0}}), (Parts{0, 1}));
  EXPECT_EQ(greedy_multicut(2, {{0, 1, 3}, {1, 0, -4}, {0, 0, 9}}), (Parts{0, 1}));  // edges of one pair add up
}

/// What connected components of the positive edges would join.
TEST(GreedyMulticut, OneWrongEdgeDoesNotJoinTwoObjects) {
  std::vector<SignedEdge> edges;
  for (int i = 0; i < 5; ++i) {
    for (int j = i + 1; j < 5; ++j) {
      edges.push_back({i, j, 1});
      edges.push_back({i + 5, j + 5, 1});
    }
  }
  for (int i = 0; i < 4; ++i) edges.push_back({i, i + 5, -0.5});
  edges.push_back({4, 9, 0.9});
  EXPECT_EQ(greedy_multicut(10, edges), (Parts{0, 0, 0, 0, 0, 1, 1, 1, 1, 1}));
}

/// Beside the optimum over all ways to part 7 nodes.
TEST(GreedyMulticut, NearTheOptimumOnSmallGraphs) {
  mmgrasp::Rng rng(7);
  double found = 0, best = 0;
  for (int graph = 0; graph < 60; ++graph) {
    std::vector<SignedEdge> edges;
    for (int i = 0; i < 7; ++i) {
      for (int j = i + 1; j < 7; ++j) {
        if (rng.uniform() < 0.6) edges.push_back({i, j, rng.uniform(-1, 1)});
      }
    }
    const Parts part = greedy_multicut(7, edges);
    std::map<std::pair<int, int>, double> between;
    for (const SignedEdge& e : edges) {
      if (part[e.a] != part[e.b]) between[std::minmax(part[e.a], part[e.b])] += e.weight;
    }
    for (const auto& [pair, sum] : between) EXPECT_LE(sum, 1e-12) << "joining two parts would gain";
    const double optimum = best_within(7, edges), here = within(part, edges);
    EXPECT_LE(here, optimum + 1e-12);
    found += here;
    best += optimum;
  }
  EXPECT_GT(found, 0.95 * best);
}
