#include "mmgrasp/optim/set_cover.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <thread>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/orlib.hpp"

namespace mmgrasp {
namespace {

double cost_of(const SetCoverProblem& problem, int set) {
  return problem.costs.empty() ? 1.0 : problem.costs[set];
}

SetCoverProblem random_problem(Rng& rng, int case_index) {
  SetCoverProblem problem;
  problem.elements = 1 + static_cast<int>(rng.index(10));
  const int sets = 1 + static_cast<int>(rng.index(12));
  const double density = rng.uniform(0.1, 0.7);
  for (int s = 0; s < sets; ++s) {
    std::vector<int> elements;
    for (int e = 0; e < problem.elements; ++e) {
      if (rng.uniform() < density) elements.push_back(e);
    }
    problem.sets.push_back(elements);
    if (case_index % 3 == 1) problem.costs.push_back(1.0 + static_cast<double>(rng.index(9)));
    if (case_index % 3 == 2) problem.costs.push_back(rng.uniform(0.1, 3.0));
  }
  return problem;
}

/// Cheapest cover by trying every subset of sets; infinite when there is none.
double brute_force(const SetCoverProblem& problem) {
  double best = std::numeric_limits<double>::infinity();
  for (unsigned mask = 0; mask < (1u << problem.sets.size()); ++mask) {
    unsigned covered = 0;
    double cost = 0;
    for (std::size_t s = 0; s < problem.sets.size(); ++s) {
      if (!(mask >> s & 1)) continue;
      cost += cost_of(problem, static_cast<int>(s));
      for (int e : problem.sets[s]) covered |= 1u << e;
    }
    if (covered == (1u << problem.elements) - 1) best = std::min(best, cost);
  }
  return best;
}

void expect_cover(const SetCoverProblem& problem, const SetCoverResult& result) {
  std::vector<bool> covered(problem.elements, false);
  double cost = 0;
  for (int s : result.chosen) {
    cost += cost_of(problem, s);
    for (int e : problem.sets[s]) covered[e] = true;
  }
  EXPECT_EQ(std::count(covered.begin(), covered.end(), false), 0);
  EXPECT_NEAR(cost, result.cost, 1e-12);
  EXPECT_TRUE(std::is_sorted(result.chosen.begin(), result.chosen.end()));
}

TEST(SetCover, EqualsBruteForceOnRandomInstances) {
  Rng rng(7);
  int solved = 0, infeasible = 0;
  for (int i = 0; i < 300; ++i) {
    const SetCoverProblem problem = random_problem(rng, i);
    const double expected = brute_force(problem);
    const SetCoverResult result = solve_set_cover(problem);
    if (std::isinf(expected)) {
      EXPECT_EQ(result.outcome, Outcome::infeasible) << i;
      EXPECT_FALSE(result.uncoverable.empty());
      ++infeasible;
      continue;
    }
    ASSERT_EQ(result.outcome, Outcome::solved) << i;
    EXPECT_NEAR(result.cost, expected, 1e-9) << i;
    EXPECT_NEAR(result.lower_bound, expected, 1e-9) << i;
    expect_cover(problem, result);
    ++solved;
  }
  EXPECT_GT(solved, 100);
  EXPECT_GT(infeasible, 30);
}

/// Beyond what trying all subsets allows: the same covers by a plain branching over elements, without any bound but the
/// best cover's cost. Two or three components, so that they are distinguished.
double by_branching(const SetCoverProblem& problem) {
  double best = std::numeric_limits<double>::infinity();
  std::vector<int> times(problem.elements, 0);
  const std::function<void(double)> descend = [&](double cost) {
    if (cost >= best) return;
    const auto open = std::find(times.begin(), times.end(), 0);
    if (open == times.end()) {
      best = cost;
      return;
    }
    const int element = static_cast<int>(open - times.begin());
    for (std::size_t s = 0; s < problem.sets.size(); ++s) {
      const auto& set = problem.sets[s];
      if (std::find(set.begin(), set.end(), element) == set.end()) continue;
      for (int e : set) ++times[e];
      descend(cost + cost_of(problem, static_cast<int>(s)));
      for (int e : set) --times[e];
    }
  };
  descend(0);
  return best;
}

TEST(SetCover, LargerInstancesInSeveralComponents) {
  Rng rng(19);
  int with_gap = 0;
  for (int repeat = 0; repeat < 30; ++repeat) {
    SetCoverProblem problem;
    const int blocks = 2 + repeat % 2, size = 9;
    problem.elements = blocks * size;
    double sum = 0;
    for (int block = 0; block < blocks; ++block) {
      SetCoverProblem one;
      one.elements = size;
      for (int s = 0; s < 22; ++s) {
        std::vector<int> here, there;
        for (int e = 0; e < size; ++e) {
          if (rng.uniform() > 0.28 && s % size != e) continue;
          here.push_back(e);
          there.push_back(block * size + e);
        }
        one.sets.push_back(here);
        problem.sets.push_back(there);
        const double cost = repeat % 3 == 0   ? 1.0
                            : repeat % 3 == 1 ? 1.0 + static_cast<double>(rng.index(5))
                                              : rng.uniform(1, 2);
        one.costs.push_back(cost);
        problem.costs.push_back(cost);
      }
      sum += by_branching(one);
    }
    const SetCoverResult result = solve_set_cover(problem);
    ASSERT_EQ(result.outcome, Outcome::solved);
    EXPECT_NEAR(result.cost, sum, 1e-7) << repeat;
    EXPECT_NEAR(result.lower_bound, sum, 1e-7) << repeat;
    expect_cover(problem, result);
    with_gap += result.chosen.size() > 6;
  }
  EXPECT_GT(with_gap, 5);
}

struct OrLibraryCase {
  const char* name;
  double optimum;  // As published by Beasley; equal to data/reference/transcribed/scp_optima.json.
};

class OrLibrary : public ::testing::TestWithParam<OrLibraryCase> {};

TEST_P(OrLibrary, ReachesThePublishedOptimum) {
  std::ifstream in(std::string(MMGRASP_SHARED_DATA) + "/reference/orlib_scp/" + GetParam().name + ".txt");
  if (!in) GTEST_SKIP() << "OR-Library files are not here";
  const SetCoverProblem problem = test::read_orlib(in);
  const SetCoverResult result = solve_set_cover(problem, 60.0);
  EXPECT_EQ(result.outcome, Outcome::solved);
  EXPECT_DOUBLE_EQ(result.cost, GetParam().optimum);
  EXPECT_DOUBLE_EQ(result.lower_bound, GetParam().optimum);
  expect_cover(problem, result);
}

INSTANTIATE_TEST_SUITE_P(Beasley, OrLibrary,
                         ::testing::Values(OrLibraryCase{"scp41", 429}, OrLibraryCase{"scp42", 512},
                                           OrLibraryCase{"scp43", 516}, OrLibraryCase{"scp44", 494},
                                           OrLibraryCase{"scp45", 512}, OrLibraryCase{"scp51", 253},
                                           OrLibraryCase{"scp52", 302}, OrLibraryCase{"scp53", 226},
                                           OrLibraryCase{"scp61", 138}, OrLibraryCase{"scpa1", 253}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(SetCover, FewestFirstThenTheLargerRadius) {
  // Two sets always suffice; among the pairs the one with the largest sum of radii wins.
  SetCoverProblem problem;
  problem.elements = 4;
  problem.sets = {{0, 1}, {2, 3}, {0, 2}, {1, 3}, {0}, {1}, {2}, {3}};
  const std::vector<double> radius{0.30, 0.31, 0.40, 0.20, 0.9, 0.9, 0.9, 0.9};
  for (double r : radius) problem.costs.push_back(1.0 + (1.0 - r) / (2.0 * radius.size()));
  const SetCoverResult result = solve_set_cover(problem);
  EXPECT_EQ(result.outcome, Outcome::solved);
  EXPECT_EQ(result.chosen, (std::vector<int>{0, 1}));
}

TEST(SetCover, TinyCostDifferencesDecide) {
  // Five elements in a ring: three neighbours' pairs are needed; no reduction applies, CBC has to tell costs apart.
  Rng rng(3);
  for (int repeat = 0; repeat < 20; ++repeat) {
    SetCoverProblem problem;
    problem.elements = 5;
    for (int s = 0; s < 5; ++s) {
      problem.sets.push_back({s, (s + 1) % 5});
      problem.costs.push_back(1.0 + 1e-4 * rng.uniform());
    }
    const SetCoverResult result = solve_set_cover(problem);
    EXPECT_NEAR(result.cost, brute_force(problem), 1e-8);
  }
}

TEST(SetCover, CostsInAnyUnitHaveTheSameAnswer) {
  // Rings, where no reduction applies; whole numbers, and costs that are none.
  Rng rng(5);
  for (int repeat = 0; repeat < 30; ++repeat) {
    SetCoverProblem problem;
    problem.elements = 7;
    for (int s = 0; s < 14; ++s) {
      problem.sets.push_back({s % 7, (s + 1 + s / 7) % 7});
      problem.costs.push_back(repeat % 2 ? rng.uniform(0.5, 2) : 1.0 + static_cast<double>(rng.index(5)));
    }
    const double least = brute_force(problem);
    for (const double unit : {1e-12, 1e-3, 1.0, 1e6, 1e12, 1e100}) {
      SetCoverProblem other = problem;
      for (double& cost : other.costs) cost *= unit;
      const SetCoverResult result = solve_set_cover(other, 20);
      EXPECT_EQ(result.outcome, Outcome::solved) << repeat << " " << unit;
      EXPECT_NEAR(result.cost / unit, least, 1e-9) << repeat << " " << unit;
    }
  }
}

TEST(SetCover, CostsOfVeryDifferentSizes) {
  // The dear set is worth it or not by one cheap one: a difference of one in a million.
  SetCoverProblem problem;
  problem.elements = 3;
  problem.sets = {{0, 1, 2}, {0, 1}, {1, 2}, {0, 2}, {0}, {1}, {2}};
  problem.costs = {2e6 + 1, 1e6, 1e6, 1e6, 1e6 + 2, 1e6 + 2, 1e6 + 2};
  EXPECT_EQ(solve_set_cover(problem).cost, 2e6);
  problem.costs[0] = 2e6 - 1;
  EXPECT_EQ(solve_set_cover(problem).chosen, std::vector<int>{0});
}

TEST(SetCover, TimeLimitLeavesACoverAndAValidBound) {
  std::ifstream in(std::string(MMGRASP_SHARED_DATA) + "/reference/orlib_scp/scp61.txt");
  if (!in) GTEST_SKIP() << "OR-Library files are not here";
  const SetCoverProblem problem = test::read_orlib(in);
  const SetCoverResult result = solve_set_cover(problem, 1e-3);
  expect_cover(problem, result);
  EXPECT_GE(result.cost, 138);
  EXPECT_LE(result.lower_bound, 138);
}

TEST(SetCover, NothingToCover) {
  const SetCoverResult result = solve_set_cover(SetCoverProblem{});
  EXPECT_EQ(result.outcome, Outcome::solved);
  EXPECT_TRUE(result.chosen.empty());
  EXPECT_EQ(result.cost, 0);
}

TEST(SetCover, NamesUncoverableElements) {
  SetCoverProblem problem;
  problem.elements = 4;
  problem.sets = {{0}, {2}};
  EXPECT_EQ(solve_set_cover(problem).uncoverable, (std::vector<int>{1, 3}));
}

TEST(SetCover, SameAnswerFromSeveralThreads) {
  Rng rng(11);
  SetCoverProblem problem;
  problem.elements = 30;
  for (int s = 0; s < 60; ++s) {
    problem.sets.push_back({});
    for (int e = 0; e < problem.elements; ++e) {
      if (rng.uniform() < 0.12 || s == e) problem.sets.back().push_back(e);
    }
  }
  const SetCoverResult expected = solve_set_cover(problem);
  std::vector<SetCoverResult> results(4);
  std::vector<std::thread> threads;
  for (auto& result : results) threads.emplace_back([&] { result = solve_set_cover(problem); });
  for (auto& thread : threads) thread.join();
  for (const auto& result : results) EXPECT_EQ(result.chosen, expected.chosen);
}

/// 300 elements in 900 sets of 12: no proof within minutes.
SetCoverProblem hard_problem() {
  Rng rng(5);
  SetCoverProblem problem;
  problem.elements = 300;
  for (int s = 0; s < 900; ++s) {
    problem.sets.push_back({s % 300});
    for (int k = 0; k < 11; ++k) problem.sets.back().push_back(static_cast<int>(rng.index(300)));
  }
  return problem;
}

TEST(SetCover, CanBeEndedWithinCbc) {
  const SetCoverProblem problem = hard_problem();
  Monitor monitor;
  std::thread ender([&monitor] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    monitor.stop.stop();
  });
  const SetCoverResult result = solve_set_cover(problem, 1000, monitor);
  ender.join();
  EXPECT_EQ(result.outcome, Outcome::stopped);
  EXPECT_FALSE(result.chosen.empty());
  EXPECT_LE(result.lower_bound, result.cost);
}

TEST(SetCover, AForkedChildIsNotHeldUpByARunThatItDoesNotHave) {
  const SetCoverProblem problem = hard_problem();
  Monitor monitor;
  std::thread busy([&] { solve_set_cover(problem, 1000, monitor); });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const ::pid_t child = ::fork();
  if (child == 0) {
    ::alarm(20);
    ::_exit(solve_set_cover(problem, 0.05).chosen.empty() ? 1 : 0);
  }
  int status = -1;
  ::waitpid(child, &status, 0);
  monitor.stop.stop();
  busy.join();
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST(SetCover, RefusesBadInput) {
  SetCoverProblem problem;
  problem.elements = 2;
  problem.sets = {{0, 2}};
  EXPECT_THROW(solve_set_cover(problem), InvalidInput);
  problem.sets = {{0, 1}};
  problem.costs = {0.0};
  EXPECT_THROW(solve_set_cover(problem), InvalidInput);
  problem.costs = {1.0, 1.0};
  EXPECT_THROW(solve_set_cover(problem), InvalidInput);
  problem.costs = {std::nan("")};
  EXPECT_THROW(solve_set_cover(problem), InvalidInput);
  problem.sets = {{0}, {1}};
  problem.costs = {1.0, 1.1e9};
  EXPECT_THROW(solve_set_cover(problem), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
