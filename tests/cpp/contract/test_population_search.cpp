#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/optim/population_search.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;
using Kind = SearchVariable::Kind;

/// A choice, a number whose bound depends on it, a whole number; feasible right of a line. The optimum is known:
/// choice 2, x1 = 0.8 (of 0..3), x2 = 4, value 0.5.
PopulationProblem mixed() {
  PopulationProblem problem;
  problem.variables = {{"choice", Kind::category, 0, 3}, {"x1", Kind::real, 0, 4}, {"x2", Kind::whole, -5, 9}};
  problem.upper = [](const VectorXd& x, int i) { return i == 1 ? x(0) + 1 : 100.0; };
  problem.evaluate = [](const VectorXd& x) {
    const double away[4] = {3, 1, 0, 2};
    ConstrainedValue value;
    value.violation = std::max(0.0, 0.8 - x(1));
    value.objective = 0.5 + away[static_cast<int>(x(0))] + (x(1) - 0.8) + 0.1 * (x(2) - 4) * (x(2) - 4);
    return value;
  };
  return problem;
}

class Population : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<PopulationSearch> search_ = make_population_search(GetParam());
};

TEST_P(Population, FindsTheBestOfMixedVariables) {
  EXPECT_EQ(search_->name(), GetParam());
  PopulationOptions options;
  options.max_evaluations = 4000;
  int found = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    options.seed = seed;
    const PopulationResult r = search_->solve(mixed(), options);
    EXPECT_EQ(r.outcome, Outcome::timeout);
    EXPECT_EQ(r.value.violation, 0);
    EXPECT_GE(r.value.objective, 0.5);
    EXPECT_EQ(r.value.objective, mixed().evaluate(r.x).objective);
    found += r.value.objective < 0.52;
  }
  EXPECT_GE(found, 18);
}

TEST_P(Population, StaysInsideBoundsAndBudget) {
  PopulationProblem problem = mixed();
  int calls = 0;
  const auto evaluate = problem.evaluate;
  problem.evaluate = [&](const VectorXd& x) {
    ++calls;
    EXPECT_EQ(x(0), std::round(x(0)));
    EXPECT_EQ(x(2), std::round(x(2)));
    EXPECT_TRUE(x(0) >= 0 && x(0) <= 3 && x(1) >= 0 && x(1) <= x(0) + 1 && x(2) >= -5 && x(2) <= 9) << x.transpose();
    return evaluate(x);
  };
  for (const int budget : {1, 33, 34, 35, 777}) {
    PopulationOptions options;
    options.max_evaluations = budget;
    calls = 0;
    const PopulationResult r = search_->solve(problem, options);
    EXPECT_EQ(calls, budget);
    EXPECT_EQ(r.evaluations, budget);
    EXPECT_EQ(r.history.size(), budget);
    EXPECT_TRUE(std::is_sorted(r.history.rbegin(), r.history.rend()));
  }
}

TEST_P(Population, EndsAtTheTarget) {
  PopulationOptions options;
  options.target = 1.5;
  options.max_evaluations = 5000;
  const PopulationResult r = search_->solve(mixed(), options);
  EXPECT_EQ(r.outcome, Outcome::solved);
  EXPECT_LE(r.value.objective, 1.5);
  EXPECT_LT(r.evaluations, 5000);
}

TEST_P(Population, SameSeedSameAnswerFromAnyThread) {
  PopulationOptions options;
  options.seed = 7;
  const PopulationResult a = search_->solve(mixed(), options);
  PopulationResult b;
  std::thread([&] { b = make_population_search(GetParam())->solve(mixed(), options); }).join();
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.history, b.history);
  options.seed = 8;
  EXPECT_NE(search_->solve(mixed(), options).history, a.history);
}

TEST_P(Population, LessViolatedIsBetterWhereNothingIsFeasible) {
  PopulationProblem problem = mixed();
  problem.evaluate = [](const VectorXd& x) { return ConstrainedValue{1 + std::abs(x(1) - 0.5), -x(1)}; };
  PopulationOptions options;
  options.max_evaluations = 3000;
  const PopulationResult r = search_->solve(problem, options);
  EXPECT_NEAR(r.value.violation, 1, 0.02);
  EXPECT_TRUE(std::isinf(r.history.back()));
  EXPECT_EQ(r.outcome, Outcome::timeout);
}

TEST_P(Population, CanBeStopped) {
  Monitor monitor;
  PopulationProblem problem = mixed();
  int calls = 0;
  const auto evaluate = problem.evaluate;
  problem.evaluate = [&](const VectorXd& x) {
    if (++calls == 100) monitor.stop.stop();
    return evaluate(x);
  };
  const PopulationResult r = search_->solve(problem, {}, monitor);
  EXPECT_EQ(r.outcome, Outcome::stopped);
  EXPECT_EQ(r.evaluations, 100);
}

TEST_P(Population, ExceptionsReachTheCaller) {
  PopulationProblem problem = mixed();
  problem.evaluate = [](const VectorXd&) -> ConstrainedValue { throw Error("no value"); };
  EXPECT_THROW(search_->solve(problem), Error);
}

TEST_P(Population, RefusesBadProblemsAndOptions) {
  PopulationProblem problem = mixed();
  problem.variables[1].upper = -1;
  EXPECT_THROW(search_->solve(problem), InvalidInput);
  problem = mixed();
  problem.variables[0].lower = 0.5;
  EXPECT_THROW(search_->solve(problem), InvalidInput);
  problem = mixed();
  problem.variables[1].mutation = -0.1;
  EXPECT_THROW(search_->solve(problem), InvalidInput);
  problem = mixed();
  problem.evaluate = nullptr;
  EXPECT_THROW(search_->solve(problem), InvalidInput);
  PopulationOptions options;
  options.elite_recruits = 50;
  EXPECT_THROW(search_->solve(mixed(), options), InvalidInput);
  options = {};
  options.shrinking = 0;
  EXPECT_THROW(search_->solve(mixed(), options), InvalidInput);
  EXPECT_THROW(make_population_search("ants"), InvalidInput);
}

INSTANTIATE_TEST_SUITE_P(All, Population, ::testing::ValuesIn(population_search_names()),
                         [](const auto& info) { return info.param; });

/// Points by the order of their evaluation.
std::vector<VectorXd> points_of(const std::string& name, PopulationProblem problem, const PopulationOptions& options) {
  std::vector<VectorXd> seen;
  const auto evaluate = problem.evaluate;
  problem.evaluate = [&](const VectorXd& x) {
    seen.push_back(x);
    return evaluate(x);
  };
  make_population_search(name)->solve(problem, options);
  return seen;
}

/// Two valleys far apart, the second a little deeper: particles that hear of the closest only stay in their own.
TEST(ParticleSwarm, HearsOfTheClosest) {
  PopulationProblem problem;
  problem.variables = {{"x", Kind::real, 0, 100}};
  problem.evaluate = [](const VectorXd& x) {
    return ConstrainedValue{0, std::min(std::abs(x(0) - 10), std::abs(x(0) - 90) - 1)};
  };
  PopulationOptions options;
  options.population = 20;
  options.max_evaluations = 4000;
  options.acceleration = 1;  // converges
  const auto at_the_shallow_one = [&](double connectivity) {
    options.connectivity = connectivity;
    const std::vector<VectorXd> seen = points_of("pso", problem, options);
    return std::count_if(seen.end() - 200, seen.end(), [](const VectorXd& x) { return std::abs(x(0) - 10) < 5; });
  };
  EXPECT_GT(at_the_shallow_one(0.1), 20);  // 2 of 20 neighbours
  EXPECT_LT(at_the_shallow_one(1.0), 5);   // all hear of the deeper one
}

/// Nothing is feasible or better than anything: the children differ from their parents by crossover and mutation alone.
TEST(Genetic, MutatesWithinTheVariablesOwnWidth) {
  PopulationProblem problem;
  problem.variables = {{"x", Kind::real, 0, 100, 2.0}};
  problem.evaluate = [](const VectorXd&) { return ConstrainedValue{0, 1}; };
  PopulationOptions options;
  options.population = 34;
  options.max_evaluations = 67;
  options.mutation_rate = 1;
  const std::vector<VectorXd> seen = points_of("ga", problem, options);
  double widest = 0;
  for (std::size_t i = 34; i < seen.size(); ++i) {
    double nearest = 100;
    for (std::size_t k = 0; k < 34; ++k) nearest = std::min(nearest, std::abs(seen[i](0) - seen[k](0)));
    EXPECT_LE(nearest, 2.0);
    widest = std::max(widest, nearest);
  }
  EXPECT_GT(widest, 0.3);
}

TEST(PopulationRules, CompareAsDebDoes) {
  const ConstrainedValue good{0, 5}, cheap{0, 4}, broken{1, -9}, worse{2, -99};
  EXPECT_TRUE(cheap.better_than(good));
  EXPECT_TRUE(good.better_than(broken));
  EXPECT_TRUE(broken.better_than(worse));
  EXPECT_FALSE(good.better_than(good));
  EXPECT_FALSE(broken.better_than(cheap));
}

}  // namespace
}  // namespace mmgrasp
