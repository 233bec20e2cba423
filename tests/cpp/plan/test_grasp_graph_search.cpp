#include "plan/manipulation/prm_star_mg/grasp_graph_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "support/planar_arm.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kVertices = 100'000;

/// One grasp over a large roadmap; no link leads into its goal, so that a search must expand all vertices.
class WithoutAPath : public ::testing::Test {
 protected:
  WithoutAPath() : graph_(roadmap_, candidate()), robot_(roadmap_), search_(roadmap_) {
    graph_.connect(roadmap_, false, 1e9);
    for (const int link : graph_.into_goals) graph_.links[link].blocked = true;
    search_.robot_is_free = [this](int) {
      if (++checked_ == stop_at_) stop_ = true;
      return true;
    };
    search_.stopped = [this] { return stop_; };
  }

  static Roadmap large_roadmap() {
    RoadmapOptions options;
    options.vertices = kVertices;
    options.neighbours = 8;
    return Roadmap::build(test::PlanarArm(3).group(), options);
  }
  static GraspCandidate candidate() {
    GraspCandidate out;
    out.starts = {Eigen::Vector3d(1, 0.5, 0)};
    out.goals = {Eigen::Vector3d(-1, 0.5, 0.2)};
    return out;
  }

  Roadmap roadmap_ = large_roadmap();
  GraspGraph graph_;
  EdgeValidityCache robot_;
  GraspGraphSearch search_;
  int checked_ = 0, stop_at_ = -1;
  bool stop_ = false;
};

TEST_F(WithoutAPath, StopsSoonAndReportsALowerBound) {
  stop_at_ = 2000;
  const double straight = (graph_.goal(0) - graph_.start(0)).norm();
  EXPECT_EQ(search_.search(graph_, robot_, 1e9), GraspGraphSearch::End::cancelled);
  EXPECT_GE(checked_, stop_at_);
  EXPECT_LE(checked_, stop_at_ + 256);
  EXPECT_GE(search_.lower_bound(), straight - 1e-9);
  const double before = search_.lower_bound();
  // Stopped already.
  EXPECT_EQ(search_.search(graph_, EdgeValidityCache(roadmap_), 1e9), GraspGraphSearch::End::cancelled);
  EXPECT_GE(search_.lower_bound(), straight - 1e-9);
  stop_ = false;
  checked_ = 0;
  stop_at_ = 5000;
  EXPECT_EQ(search_.search(graph_, EdgeValidityCache(roadmap_), 1e9), GraspGraphSearch::End::cancelled);
  EXPECT_GT(search_.lower_bound(), before);
}

TEST_F(WithoutAPath, KnownVerticesAreNotCheckedAgain) {
  stop_at_ = 500;
  EXPECT_EQ(search_.search(graph_, robot_, 1e9), GraspGraphSearch::End::cancelled);
  const int checked = checked_;
  EXPECT_EQ(search_.search(graph_, robot_, 1e9), GraspGraphSearch::End::cancelled);
  EXPECT_EQ(checked_, checked);
  stop_ = false;
  EXPECT_EQ(search_.search(graph_, robot_, 1e9), GraspGraphSearch::End::none);
  EXPECT_GT(checked_, kVertices / 2);
  const int all = checked_;
  EXPECT_EQ(search_.search(graph_, robot_, 1e9), GraspGraphSearch::End::none);
  EXPECT_EQ(checked_, all);
}

/// Graphs of grasps with ends close to each other, as those of neighbouring grasps are, over one roadmap.
class Splicing : public ::testing::Test {
 protected:
  Splicing() : robot_(roadmap_), search_(roadmap_) {
    for (int i = 0; i < 8; ++i) {
      GraspCandidate candidate;
      candidate.grasp = i;
      candidate.cost = 0.01 * i;
      candidate.starts = {Eigen::Vector3d(1.5, 0.5 + 0.05 * i, -0.5), Eigen::Vector3d(1.4, 0.3, -0.9 + 0.04 * i)};
      candidate.goals = {Eigen::Vector3d(-1.5, 1.0 - 0.03 * i, 0.4)};
      graphs_.emplace_back(roadmap_, candidate);
      graphs_.back().connect(roadmap_, false, 1e9);
    }
  }

  static Roadmap roadmap() {
    RoadmapOptions options;
    options.vertices = 3000;
    options.neighbours = 10;
    return Roadmap::build(test::PlanarArm(3).group(), options);
  }

  /// Every pair of links onto the path and off it again, summed one by one.
  double by_enumeration(const GraspGraph& graph, const std::vector<int>& nodes) const {
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t in = 1; in + 1 < nodes.size(); ++in)
      for (std::size_t out = in; out + 1 < nodes.size(); ++out) {
        double along = 0;
        for (std::size_t k = in; k < out; ++k)
          along += (roadmap_.vertices().col(nodes[k + 1]) - roadmap_.vertices().col(nodes[k])).norm();
        for (const GraspGraph::Link& first : graph.links)
          for (const GraspGraph::Link& last : graph.links)
            if (first.from >= graph.vertex_count && first.to == nodes[in] && !first.blocked &&
                last.to >= graph.first_goal() && last.from == nodes[out] && !last.blocked)
              best = std::min(best, first.length + along + last.length + graph.candidate.cost);
      }
    return best;
  }

  Roadmap roadmap_ = roadmap();
  std::vector<GraspGraph> graphs_;
  EdgeValidityCache robot_;
  GraspGraphSearch search_;
};

TEST_F(Splicing, IsTheCheapestPathByPartOfAnEarlierOne) {
  ASSERT_EQ(search_.search(graphs_[0], robot_, 1e9), GraspGraphSearch::End::found);
  const std::vector<int> path = graphs_[0].nodes;
  int finite = 0;
  for (GraspGraph& graph : graphs_) {
    const double expected = by_enumeration(graph, path);
    if (!std::isfinite(expected)) {
      EXPECT_EQ(spliced_cost(roadmap_, graph, path), expected);
      continue;
    }
    ++finite;
    EXPECT_NEAR(spliced_cost(roadmap_, graph, path), expected, 1e-12);
    // Links known to be blocked do not count.
    for (GraspGraph::Link& link : graph.links) link.blocked = link.to == path[1] || link.from == path[1];
    const double other = by_enumeration(graph, path);
    EXPECT_GE(other, expected);
    if (std::isfinite(other)) {
      EXPECT_NEAR(spliced_cost(roadmap_, graph, path), other, 1e-12);
    } else {
      EXPECT_EQ(spliced_cost(roadmap_, graph, path), other);
    }
    for (GraspGraph::Link& link : graph.links) link.blocked = false;
  }
  EXPECT_GE(finite, 4);
  EXPECT_NEAR(spliced_cost(roadmap_, graphs_[0], path), graphs_[0].path_cost, 1e-12);
}

TEST_F(Splicing, BoundsTheSearchAndLeavesTheOptimum) {
  ASSERT_EQ(search_.search(graphs_[0], robot_, 1e9), GraspGraphSearch::End::found);
  const std::vector<int> path = graphs_[0].nodes;
  std::size_t open = 0, open_bounded = 0;
  for (std::size_t i = 1; i < graphs_.size(); ++i) {
    GraspGraph& graph = graphs_[i];
    const double bound = spliced_cost(roadmap_, graph, path);
    ASSERT_EQ(search_.search(graph, robot_, 1e9), GraspGraphSearch::End::found);
    open += search_.nodes_left_open();
    const double optimum = graph.path_cost;
    const std::vector<int> nodes = graph.nodes;
    EXPECT_GE(bound, optimum * (1 - 1e-12));
    ASSERT_EQ(search_.search(graph, robot_, bound), GraspGraphSearch::End::found);
    open_bounded += search_.nodes_left_open();
    EXPECT_EQ(graph.path_cost, optimum);
    EXPECT_EQ(graph.nodes, nodes);
    // Below the optimum there is nothing; at it, however it was summed, the path itself.
    EXPECT_EQ(search_.search(graph, robot_, optimum * (1 - 1e-6)), GraspGraphSearch::End::none);
    EXPECT_EQ(search_.search(graph, robot_, optimum * (1 - 1e-12)), GraspGraphSearch::End::found);
  }
  EXPECT_LT(open_bounded, open / 2);
}

}  // namespace
}  // namespace mmgrasp::detail
