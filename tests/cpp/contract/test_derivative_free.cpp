#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/optim/derivative_free.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;

VectorXd all(int n, double value) {
  return VectorXd::Constant(n, value);
}

/// (x - target)^2 with unequal weights; the target lies in the box.
DerivativeFreeProblem bowl(int n = 3) {
  DerivativeFreeProblem problem{{all(n, -2), all(n, 3)}, {}, {}, 0};
  problem.objective = [](const VectorXd& x) {
    double sum = 0.25;
    for (Eigen::Index i = 0; i < x.size(); ++i) sum += (1.0 + i) * std::pow(x[i] - 0.3 * static_cast<double>(i + 1), 2);
    return sum;
  };
  return problem;
}

class DerivativeFree : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<DerivativeFreeSolver> solver_ = make_derivative_free_solver(GetParam());
};

TEST_P(DerivativeFree, FindTheBottomOfABowl) {
  EXPECT_EQ(solver_->name(), GetParam());
  DerivativeFreeOptions options;
  options.max_evaluations = 20000;
  const DerivativeFreeResult r = solver_->solve(bowl(), all(3, 2), options);
  EXPECT_TRUE(r.outcome == Outcome::solved || (solver_->is_global() && r.outcome == Outcome::timeout)) << r.message;
  const bool coarse = GetParam() == "esch";  // mutations without local refinement
  EXPECT_NEAR(r.value, 0.25, coarse ? 1e-2 : 1e-6);
  EXPECT_NEAR(r.x[0], 0.3, coarse ? 0.1 : 1e-2);
  EXPECT_EQ(r.value, bowl().objective(r.x));
  EXPECT_EQ(r.violation, 0);
}

TEST_P(DerivativeFree, FindAMinimumOnTheBoundAndAtAKink) {
  DerivativeFreeProblem problem{{all(2, 0.5), all(2, 4)}, [](const VectorXd& x) { return x[0] + x[1] * x[1]; }, {}, 0};
  const DerivativeFreeResult r = solver_->solve(problem, all(2, 3));
  EXPECT_NEAR(r.value, 0.75, GetParam() == "esch" ? 2e-2 : 1e-4);
  DerivativeFreeProblem line{{all(1, -1), all(1, 2)}, [](const VectorXd& x) { return std::abs(x[0] - 0.7); }, {}, 0};
  EXPECT_NEAR(solver_->solve(line, all(1, 0)).value, 0, GetParam() == "esch" ? 2e-2 : 1e-3);
}

/// Global ones leave the basin of the guess: Rastrigin's function, whose minimum 0 is at the origin.
TEST_P(DerivativeFree, GlobalOnesLeaveTheBasinOfTheGuess) {
  if (!solver_->is_global()) GTEST_SKIP() << "local";
  DerivativeFreeProblem problem{{all(2, -4.1), all(2, 5.3)}, {}, {}, 0};
  problem.objective = [](const VectorXd& x) {
    return 20 + x.squaredNorm() - 10 * std::cos(2 * M_PI * x[0]) - 10 * std::cos(2 * M_PI * x[1]);
  };
  DerivativeFreeOptions options;
  options.max_evaluations = 30000;
  double best = problem.objective(all(2, 3));
  for (options.seed = 1; options.seed <= 5; ++options.seed)  // none promises it for a single seed
    best = std::min(best, minimize_derivative_free(GetParam(), problem, all(2, 3), options).value);
  EXPECT_LT(best, 0.5);
}

TEST_P(DerivativeFree, KeepConstraintsOrRefuseThem) {
  // The nearest point of the unit disc to (2, 1).
  DerivativeFreeProblem problem{{all(2, -2), all(2, 2)}, {}, {}, 1};
  problem.objective = [](const VectorXd& x) { return (x - Eigen::Vector2d(2, 1)).squaredNorm(); };
  problem.constraints = [](const VectorXd& x) { return all(1, x.squaredNorm() - 1); };
  if (!solver_->takes_constraints()) {
    try {
      solver_->solve(problem, all(2, 0));
      FAIL();
    } catch (const InvalidInput& e) {
      EXPECT_NE(std::string(e.what()).find("cobyla, isres"), std::string::npos) << e.what();
    }
    return;
  }
  DerivativeFreeOptions options;
  options.max_evaluations = 40000;
  const DerivativeFreeResult r = solver_->solve(problem, all(2, 1.9), options);
  EXPECT_LE(r.violation, options.constraint_tolerance);
  EXPECT_LE(r.x.squaredNorm() - 1, options.constraint_tolerance);
  EXPECT_NEAR(r.value, std::pow(std::sqrt(5.0) - 1, 2), 1e-3);
  // x0 >= 3 and x0 <= 2 has no answer: the least violated point is handed back.
  problem.constraints = [](const VectorXd& x) { return all(1, 3 - x[0]); };
  options.max_evaluations = 2000;
  const DerivativeFreeResult none = solver_->solve(problem, all(2, 0), options);
  EXPECT_TRUE(none.outcome == Outcome::not_found || none.outcome == Outcome::timeout);
  EXPECT_NEAR(none.violation, 1, solver_->is_global() ? 0.1 : 1e-6);
  // A wrong number of constraints is refused by name.
  problem.constraints = [](const VectorXd&) { return all(2, 0); };
  EXPECT_THROW(solver_->solve(problem, all(2, 0), options), InvalidInput);
}

TEST_P(DerivativeFree, SameSeedSameAnswerFromSeveralThreads) {
  DerivativeFreeOptions options;
  options.max_evaluations = 1500;
  options.seed = 7;
  const DerivativeFreeResult alone = solver_->solve(bowl(5), all(5, 2), options);
  std::vector<DerivativeFreeResult> found(4);
  std::vector<std::thread> threads;
  for (DerivativeFreeResult& mine : found)
    threads.emplace_back([&] { mine = solver_->solve(bowl(5), all(5, 2), options); });
  for (std::thread& thread : threads) thread.join();
  for (const DerivativeFreeResult& r : found) {
    EXPECT_EQ(r.x, alone.x);
    EXPECT_EQ(r.evaluations, alone.evaluations);
  }
  options.seed = 8;
  const bool random = GetParam() == "crs2" || GetParam() == "isres" || GetParam() == "esch";
  EXPECT_EQ(solver_->solve(bowl(5), all(5, 2), options).x != alone.x, random);
}

TEST_P(DerivativeFree, StayInsideBoundsAndBudget) {
  DerivativeFreeProblem problem = bowl(4);
  problem.bounds.lower[1] = problem.bounds.upper[1] = 1.25;  // prescribed
  int calls = 0;
  const auto objective = problem.objective;
  problem.objective = [&](const VectorXd& x) {
    ++calls;
    EXPECT_TRUE((x.array() >= problem.bounds.lower.array()).all() && (x.array() <= problem.bounds.upper.array()).all());
    EXPECT_EQ(x[1], 1.25);
    return objective(x);
  };
  for (const int budget : {1, 2, 17}) {
    DerivativeFreeOptions options;
    options.max_evaluations = budget;
    calls = 0;
    const DerivativeFreeResult r = solver_->solve(problem, all(4, 100), options);
    EXPECT_EQ(r.outcome, Outcome::timeout);
    EXPECT_EQ(r.evaluations, calls);
    EXPECT_EQ(calls, budget);
    EXPECT_EQ(r.value, objective(r.x));
  }
  problem.bounds.upper = problem.bounds.lower;
  const DerivativeFreeResult point = solver_->solve(problem, all(4, 0));
  EXPECT_EQ(point.outcome, Outcome::solved);
  EXPECT_EQ(point.x, problem.bounds.lower);
}

TEST_P(DerivativeFree, EndWhenToldOrLate) {
  DerivativeFreeProblem problem = bowl();
  const auto objective = problem.objective;
  Monitor monitor;
  int calls = 0;
  problem.objective = [&](const VectorXd& x) {
    if (++calls == 5) monitor.stop.stop();
    return objective(x);
  };
  DerivativeFreeResult r = solver_->solve(problem, all(3, 2), {}, monitor);
  EXPECT_EQ(r.outcome, Outcome::stopped);
  EXPECT_EQ(calls, 5);
  EXPECT_EQ(r.value, objective(r.x));
  DerivativeFreeOptions options;
  options.time_limit = 1e-9;
  r = solver_->solve(bowl(), all(3, 2), options);
  EXPECT_EQ(r.outcome, Outcome::timeout);
  EXPECT_TRUE(r.x.allFinite());
}

TEST_P(DerivativeFree, HandOnWhatAFunctionThrows) {
  DerivativeFreeProblem problem = bowl();
  const auto objective = problem.objective;
  int calls = 0;
  problem.objective = [&](const VectorXd& x) {
    if (++calls == 4) throw IoError("the disk is full");
    return objective(x);
  };
  EXPECT_THROW(solver_->solve(problem, all(3, 2)), IoError);
  EXPECT_EQ(calls, 4);
  EXPECT_NO_THROW(solver_->solve(bowl(), all(3, 2)));
}

TEST_P(DerivativeFree, AvoidWhereNothingIsDefined) {
  DerivativeFreeProblem problem = bowl(2);
  const auto objective = problem.objective;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  problem.objective = [&](const VectorXd& x) { return x[0] > 1.5 ? nan : objective(x); };
  DerivativeFreeOptions options;
  options.max_evaluations = 3000;
  const DerivativeFreeResult r = solver_->solve(problem, all(2, 1), options);
  EXPECT_TRUE(std::isfinite(r.value));
  EXPECT_LE(r.x[0], 1.5);
  EXPECT_LE(r.value, objective(all(2, 1)));
  problem.objective = [&](const VectorXd&) { return nan; };
  const DerivativeFreeResult nowhere = solver_->solve(problem, all(2, 1), options);
  EXPECT_TRUE(nowhere.outcome == Outcome::not_found || nowhere.outcome == Outcome::timeout);
  EXPECT_TRUE(nowhere.x.allFinite());
  EXPECT_TRUE(std::isinf(nowhere.value));
}

TEST_P(DerivativeFree, AnObjectiveMaySolveAProblemItself) {
  DerivativeFreeProblem outer{{all(1, -1), all(1, 1)}, {}, {}, 0};
  outer.objective = [&](const VectorXd& x) {
    DerivativeFreeOptions few;
    few.max_evaluations = 20;
    return x[0] * x[0] + solver_->solve(bowl(2), all(2, x[0]), few).value;
  };
  DerivativeFreeOptions options;
  options.max_evaluations = 30;
  const DerivativeFreeResult a = solver_->solve(outer, all(1, 0.5), options);
  EXPECT_EQ(solver_->solve(outer, all(1, 0.5), options).x, a.x);
}

TEST_P(DerivativeFree, RefuseWhatMakesNoSense) {
  EXPECT_THROW(solver_->solve(bowl(), all(2, 0)), InvalidInput);
  EXPECT_THROW(solver_->solve(bowl(), all(3, std::nan(""))), InvalidInput);
  DerivativeFreeProblem problem = bowl();
  problem.bounds.lower[1] = 5;
  EXPECT_THROW(solver_->solve(problem, all(3, 0)), InvalidInput);
  problem = bowl();
  problem.bounds.upper[2] = std::numeric_limits<double>::infinity();
  if (solver_->is_global()) {
    EXPECT_THROW(solver_->solve(problem, all(3, 0)), InvalidInput);
  } else {
    EXPECT_NEAR(solver_->solve(problem, all(3, 0)).value, 0.25, 1e-4);
  }
  DerivativeFreeOptions options;
  options.max_evaluations = 0;
  EXPECT_THROW(solver_->solve(bowl(), all(3, 0), options), InvalidInput);
  problem.objective = nullptr;
  EXPECT_THROW(solver_->solve(problem, all(3, 0)), InvalidInput);
}

INSTANTIATE_TEST_SUITE_P(All, DerivativeFree, ::testing::ValuesIn(derivative_free_solver_names()),
                         [](const auto& info) { return info.param; });

TEST(DerivativeFreeTable, NamesTheKnownOnes) {
  try {
    make_derivative_free_solver("powell");
    FAIL();
  } catch (const InvalidInput& e) {
    EXPECT_NE(std::string(e.what()).find("bobyqa, cobyla, nelder_mead"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace mmgrasp
