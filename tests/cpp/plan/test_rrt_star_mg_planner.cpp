// RRT*-MG against exhaustive search: every grasp's shortest path on a grid of all configurations, shortcut.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "support/bar_transfer.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr int kSide = 29;
constexpr double kStep = 0.2, kLower = -2.8;

class GridSearch {
 public:
  GridSearch(const ManipulationProblem& problem, const Grasp& grasp)
      : checker_(problem.group, test::carrying(problem, grasp)) {}

  /// Length of the shortest path from any start to any goal, first along the grid, then shortcut; infinite when there
  /// is none, or none below `bound` on the grid.
  double length(const std::vector<VectorXd>& starts, const std::vector<VectorXd>& goals, double bound) {
    std::vector<VectorXd> nodes;
    for (int i = 0; i < kSide * kSide * kSide; ++i)
      nodes.push_back(Vector3d(kLower + kStep * (i / (kSide * kSide)), kLower + kStep * (i / kSide % kSide),
                               kLower + kStep * (i % kSide)));
    const std::size_t grid = nodes.size();
    nodes.insert(nodes.end(), starts.begin(), starts.end());
    const std::size_t first_goal = nodes.size();
    nodes.insert(nodes.end(), goals.begin(), goals.end());
    const auto left = [&](const VectorXd& q) {
      double least = kInfinite;
      for (const VectorXd& goal : goals) least = std::min(least, (goal - q).norm());
      return least;
    };
    std::vector<double> cost(nodes.size(), kInfinite);
    std::vector<std::size_t> parent(nodes.size(), nodes.size());
    using Entry = std::pair<double, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (std::size_t s = grid; s < first_goal; ++s) {
      cost[s] = 0;
      queue.push({left(nodes[s]), s});
    }
    std::size_t reached = nodes.size();
    std::vector<char> closed(nodes.size(), 0);
    while (!queue.empty()) {
      const auto [key, node] = queue.top();
      queue.pop();
      if (closed[node]) continue;
      if (key > bound) break;
      closed[node] = 1;
      if (node >= first_goal) {
        reached = node;
        break;
      }
      const auto relax = [&](std::size_t next) {
        const double to = cost[node] + (nodes[next] - nodes[node]).norm();
        if (closed[next] || to >= cost[next] || !checker_.edge_is_free(nodes[node], nodes[next], 0.02)) return;
        cost[next] = to;
        parent[next] = node;
        queue.push({to + left(nodes[next]), next});
      };
      each_near(nodes[node], relax);
      for (std::size_t g = first_goal; g < nodes.size(); ++g)
        if ((nodes[g] - nodes[node]).norm() < 2.5 * kStep) relax(g);
    }
    if (reached == nodes.size()) return kInfinite;
    std::vector<VectorXd> path;
    for (std::size_t node = reached; node < nodes.size(); node = parent[node]) path.push_back(nodes[node]);
    return taut_length(path);
  }

 private:
  template <class Visit>
  static void each_near(const VectorXd& q, const Visit& visit) {
    std::array<int, 3> low, high;
    for (int k = 0; k < 3; ++k) {
      const double at = (q[k] - kLower) / kStep;
      low[k] = std::max(0, static_cast<int>(std::ceil(at - 1.001)));
      high[k] = std::min(kSide - 1, static_cast<int>(std::floor(at + 1.001)));
    }
    for (int a = low[0]; a <= high[0]; ++a)
      for (int b = low[1]; b <= high[1]; ++b)
        for (int c = low[2]; c <= high[2]; ++c) visit((a * kSide + b) * kSide + c);
  }

  /// Corners are cut at random as long as that is free.
  double taut_length(std::vector<VectorXd> path) {
    Rng rng(9);
    for (int i = 0; i < 3000 && path.size() > 2; ++i) {
      const std::size_t corner = 1 + rng.index(path.size() - 2);
      const double reach = std::pow(rng.uniform(), 2);
      const VectorXd a = path[corner] + (path[corner - 1] - path[corner]) * (i % 2 ? 1 : reach);
      const VectorXd b = path[corner] + (path[corner + 1] - path[corner]) * (i % 2 ? 1 : rng.uniform());
      if (!checker_.edge_is_free(a, b, 0.005)) continue;
      path[corner] = a;
      path.insert(path.begin() + static_cast<long>(corner) + 1, b);
      for (std::size_t k = 1; k < path.size();)
        if ((path[k] - path[k - 1]).norm() < 1e-9)
          path.erase(path.begin() + static_cast<long>(k));
        else
          ++k;
    }
    double sum = 0;
    for (std::size_t k = 1; k < path.size(); ++k) sum += (path[k] - path[k - 1]).norm();
    return sum;
  }

  CollisionChecker checker_;
};

/// Taut grid length of each grasp.
std::vector<double> exhaustive(const ManipulationProblem& problem, double bound) {
  std::vector<double> out;
  for (const Grasp& grasp : problem.grasps) {
    CollisionChecker checker(problem.group, test::carrying(problem, grasp));
    const auto ends = [&](const Pose& T) {
      return solve_ik_all(problem.group, T * grasp.T_object_hand, 4, {},
                          [&](const VectorXd& q) { return checker.rejection(q); });
    };
    const auto starts = ends(problem.T_world_start), goals = ends(problem.T_world_goal);
    const bool any = !starts.empty() && !goals.empty();
    out.push_back(any ? GridSearch(problem, grasp).length(starts, goals, bound) : kInfinite);
  }
  return out;
}

ManipulationOptions options_of(int samples, unsigned seed = 1) {
  ManipulationOptions options;
  options.planner = "rrt_star_mg";
  options.rrt.max_iterations = samples;
  options.seed = seed;
  options.time_limit = 300;
  options.first_grasps = 0;
  return options;
}

TEST(RrtStarMgOptimal, ConvergesToTheBestOfAllGrasps) {
  // The narrower the passage, the longer the detours; and one where the grasp with the least straight cost is not the
  // best.
  ManipulationProblem problem = test::bar_transfer();
  for (const bool wall : {false, true}) {
    if (wall) problem.world.add("wall", Shape(Box{{0.04, 0.3, 0.2}}), test::flat_pose(0.62, 0.02, 0.3));
    const std::vector<double> lengths = exhaustive(problem, 9);
    const double best = *std::min_element(lengths.begin(), lengths.end());
    ASSERT_LT(best, 9);
    // Costs above the best by samples, the mean of eight runs. With a first path of two grasps to begin with, too.
    for (const int first_grasps : {0, 2}) {
      double last = kInfinite;
      for (const int samples : {300, 5000, 20000}) {
        if (samples == 20000 && !(wall && first_grasps == 0)) continue;
        double sum = 0;
        for (unsigned seed = 1; seed <= 8; ++seed) {
          ManipulationOptions options = options_of(samples, seed);
          options.first_grasps = first_grasps;
          const ManipulationResult result = plan_manipulation(problem, options);
          ASSERT_EQ(result.outcome, Outcome::solved) << wall << samples;
          // The grid's path is a real one, and shortcutting ended at some point: ours may be a little shorter.
          EXPECT_GT(result.cost, 0.97 * best);
          if (samples == 5000) {
            EXPECT_LT(result.cost, 1.06 * best) << wall << " seed " << seed;
          }
          if (samples == 20000) {
            EXPECT_LT(result.cost, 1.02 * best) << wall << " seed " << seed;
          }
          sum += result.cost / best - 1;
        }
        EXPECT_LE(sum / 8, last + 1e-9) << wall << samples;
        last = sum / 8;
        if (samples == 5000) {
          EXPECT_LT(last, 0.02) << wall;
        }
        if (samples == 20000) {
          EXPECT_LT(last, 0.01) << wall;
        }
      }
    }
    // So does the other planner once it draws small roadmaps where a cheaper path can pass.
    for (unsigned seed = 1; seed <= 3; ++seed) {
      ManipulationOptions options = options_of(1, seed);
      options.planner = "prm_star_mg";
      options.prm.roadmap.vertices = 300;
      options.prm.refinements = 150;
      const ManipulationResult result = plan_manipulation(problem, options);
      EXPECT_GT(result.cost, 0.97 * best);
      EXPECT_LT(result.cost, 1.02 * best) << wall << " seed " << seed;
    }
  }
}

TEST(RrtStarMgOptimal, SingleGraspsComeNearTheirOwnOptima) {
  const ManipulationProblem all = test::bar_transfer();
  const std::vector<double> lengths = exhaustive(all, 9);
  int compared = 0;
  for (std::size_t g = 0; g < all.grasps.size(); g += 3) {
    if (lengths[g] > 9) continue;
    ManipulationProblem problem = all;
    problem.grasps = {all.grasps[g]};
    const ManipulationResult result = plan_manipulation(problem, options_of(4000));
    ASSERT_EQ(result.outcome, Outcome::solved) << g;
    EXPECT_LT(result.cost, 1.02 * lengths[g]) << g;
    ++compared;
  }
  EXPECT_GT(compared, 2);
}

}  // namespace
}  // namespace mmgrasp
