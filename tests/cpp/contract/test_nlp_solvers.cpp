// What every solver of nlp_solver_names() promises. Problems and optima: W. Hock, K. Schittkowski, Test Examples for
// Nonlinear Programming Codes, 1981.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <thread>
#include <vector>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/optim/nlp_solver.hpp"
#include "support/formula_problem.hpp"
#include "support/vec.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;
using test::FormulaProblem;
using test::kInf;
using test::vec;
using V = std::vector<test::SecondOrder>;
using Rows = std::vector<FormulaProblem::Row>;

VectorXd all(Eigen::Index n, double value) {
  return VectorXd::Constant(n, value);
}

struct Published {
  const char* name;
  FormulaProblem problem;
  VectorXd start;
  double optimum;
};

/// min sum (x_i - i)^4, neighbours' products at least 1.
class LongChain : public NonlinearProblem {
 public:
  explicit LongChain(int n) : n_(n) {
    for (int i = 0; i + 1 < n; ++i) {
      jacobian_.add(i, i);
      jacobian_.add(i, i + 1);
      hessian_.add(i + 1, i);
    }
    for (int i = 0; i < n; ++i) hessian_.add(i, i);
  }
  std::function<void()> on_first_jacobian;

  Bounds variable_bounds() const override { return {all(n_, -kInf), all(n_, kInf)}; }
  Bounds constraint_bounds() const override { return {all(n_ - 1, 1), all(n_ - 1, kInf)}; }
  double objective(const VectorXd& x) override { return (x - places()).array().pow(4).sum(); }
  void gradient(const VectorXd& x, Eigen::Ref<VectorXd> out) override { out = 4 * (x - places()).array().pow(3); }
  void constraints(const VectorXd& x, Eigen::Ref<VectorXd> out) override {
    out = x.head(n_ - 1).cwiseProduct(x.tail(n_ - 1));
  }
  const SparsePattern& jacobian_pattern() const override { return jacobian_; }
  void jacobian(const VectorXd& x, Eigen::Ref<VectorXd> values) override {
    for (int i = 0; i + 1 < n_; ++i) {
      values[2 * i] = x[i + 1];
      values[2 * i + 1] = x[i];
    }
    if (on_first_jacobian) on_first_jacobian();
    on_first_jacobian = nullptr;
  }
  const SparsePattern& hessian_pattern() const override { return hessian_; }
  void hessian(const VectorXd& x, double factor, const VectorXd& multipliers, Eigen::Ref<VectorXd> values) override {
    values.head(n_ - 1) = multipliers;
    values.tail(n_) = factor * 12 * (x - places()).array().square();
  }

 private:
  VectorXd places() const { return VectorXd::LinSpaced(n_, 0, n_ - 1); }
  int n_;
  SparsePattern jacobian_, hessian_;
};

std::vector<Published> hock_schittkowski() {
  const auto free = [](test::Formula f, Rows rows, Eigen::Index n) {
    return FormulaProblem(std::move(f), std::move(rows), all(n, -kInf), all(n, kInf));
  };
  std::vector<Published> list;
  list.push_back({"6",
                  free([](const V& x) { return pow(1 - x[0], 2); },
                       {{[](const V& x) { return 10.0 * (x[1] - pow(x[0], 2)); }, 0, 0}}, 2),
                  vec({-1.2, 1}), 0});
  list.push_back({"7",
                  free([](const V& x) { return log(pow(x[0], 2) + 1) - x[1]; },
                       {{[](const V& x) { return pow(pow(x[0], 2) + 1, 2) + pow(x[1], 2); }, 4, 4}}, 2),
                  vec({2, 2}), -std::sqrt(3.0)});
  list.push_back(
      {"21",
       FormulaProblem([](const V& x) { return 0.01 * pow(x[0], 2) + pow(x[1], 2) - 100; },
                      {{[](const V& x) { return 10.0 * x[0] - x[1]; }, 10, kInf}}, vec({2, -50}), vec({50, 50})),
       vec({-1, -1}), -99.96});
  list.push_back({"28",
                  free([](const V& x) { return pow(x[0] + x[1], 2) + pow(x[1] + x[2], 2); },
                       {{[](const V& x) { return x[0] + 2.0 * x[1] + 3.0 * x[2]; }, 1, 1}}, 3),
                  vec({-4, 1, 1}), 0});
  list.push_back({"35",
                  FormulaProblem(
                      [](const V& x) {
                        return 9 - 8.0 * x[0] - 6.0 * x[1] - 4.0 * x[2] + 2.0 * pow(x[0], 2) + 2.0 * pow(x[1], 2) +
                               pow(x[2], 2) + 2.0 * (x[0] * x[1]) + 2.0 * (x[0] * x[2]);
                      },
                      {{[](const V& x) { return x[0] + x[1] + 2.0 * x[2]; }, -kInf, 3}}, all(3, 0), all(3, kInf)),
                  all(3, 0.5), 1.0 / 9});
  list.push_back({"39",
                  free([](const V& x) { return -1.0 * x[0]; },
                       {{[](const V& x) { return x[1] - pow(x[0], 3) - pow(x[2], 2); }, 0, 0},
                        {[](const V& x) { return pow(x[0], 2) - x[1] - pow(x[3], 2); }, 0, 0}},
                       4),
                  all(4, 2), -1});
  list.push_back(
      {"43",
       free(
           [](const V& x) {
             return pow(x[0], 2) + pow(x[1], 2) + 2.0 * pow(x[2], 2) + pow(x[3], 2) - 5.0 * x[0] - 5.0 * x[1] -
                    21.0 * x[2] + 7.0 * x[3];
           },
           {{[](const V& x) {
               return pow(x[0], 2) + pow(x[1], 2) + pow(x[2], 2) + pow(x[3], 2) + x[0] - x[1] + x[2] - x[3];
             },
             -kInf, 8},
            {[](const V& x) {
               return pow(x[0], 2) + 2.0 * pow(x[1], 2) + pow(x[2], 2) + 2.0 * pow(x[3], 2) - x[0] - x[3];
             },
             -kInf, 10},
            {[](const V& x) { return 2.0 * pow(x[0], 2) + pow(x[1], 2) + pow(x[2], 2) + 2.0 * x[0] - x[1] - x[3]; },
             -kInf, 5}},
           4),
       all(4, 0), -44});
  list.push_back(
      {"71",
       FormulaProblem([](const V& x) { return x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2]; },
                      {{[](const V& x) { return x[0] * x[1] * x[2] * x[3]; }, 25, kInf},
                       {[](const V& x) { return pow(x[0], 2) + pow(x[1], 2) + pow(x[2], 2) + pow(x[3], 2); }, 40, 40}},
                      all(4, 1), all(4, 5)),
       vec({1, 5, 5, 1}), 17.0140173});
  list.push_back(
      {"77",
       free(
           [](const V& x) {
             return pow(x[0] - 1, 2) + pow(x[0] - x[1], 2) + pow(x[2] - 1, 2) + pow(x[3] - 1, 4) + pow(x[4] - 1, 6);
           },
           {{[](const V& x) { return pow(x[0], 2) * x[3] + sin(x[3] - x[4]); }, 2 * std::sqrt(2.0), 2 * std::sqrt(2.0)},
            {[](const V& x) { return x[1] + pow(x[2], 4) * pow(x[3], 2); }, 8 + std::sqrt(2.0), 8 + std::sqrt(2.0)}},
           5),
       all(5, 2), 0.24150513});
  list.push_back(
      {"78",
       free([](const V& x) { return x[0] * x[1] * x[2] * x[3] * x[4]; },
            {{[](const V& x) { return pow(x[0], 2) + pow(x[1], 2) + pow(x[2], 2) + pow(x[3], 2) + pow(x[4], 2); }, 10,
              10},
             {[](const V& x) { return x[1] * x[2] - 5.0 * (x[3] * x[4]); }, 0, 0},
             {[](const V& x) { return pow(x[0], 3) + pow(x[1], 3); }, -1, -1}},
            5),
       vec({-2, 1.5, 2, -1, -1}), -2.91970041});
  list.push_back(
      {"100",
       free(
           [](const V& x) {
             return pow(x[0] - 10, 2) + 5.0 * pow(x[1] - 12, 2) + pow(x[2], 4) + 3.0 * pow(x[3] - 11, 2) +
                    10.0 * pow(x[4], 6) + 7.0 * pow(x[5], 2) + pow(x[6], 4) - 4.0 * (x[5] * x[6]) - 10.0 * x[5] -
                    8.0 * x[6];
           },
           {{[](const V& x) {
               return 2.0 * pow(x[0], 2) + 3.0 * pow(x[1], 4) + x[2] + 4.0 * pow(x[3], 2) + 5.0 * x[4];
             },
             -kInf, 127},
            {[](const V& x) { return 7.0 * x[0] + 3.0 * x[1] + 10.0 * pow(x[2], 2) + x[3] - x[4]; }, -kInf, 282},
            {[](const V& x) { return 23.0 * x[0] + pow(x[1], 2) + 6.0 * pow(x[5], 2) - 8.0 * x[6]; }, -kInf, 196},
            {[](const V& x) {
               return 4.0 * pow(x[0], 2) + pow(x[1], 2) - 3.0 * (x[0] * x[1]) + 2.0 * pow(x[2], 2) + 5.0 * x[5] -
                      11.0 * x[6];
             },
             -kInf, 0}},
           7),
       vec({1, 2, 0, 4, 0, 1, 1}), 680.6300573});
  return list;
}

class NlpSolvers : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<NlpSolver> solver_ = make_nlp_solver(GetParam());
};

TEST_P(NlpSolvers, ReachPublishedOptima) {
  for (Published& p : hock_schittkowski()) {
    NlpOptions options;
    options.tolerance = 1e-10;
    const NlpResult r = solver_->solve(p.problem, p.start, options);
    EXPECT_EQ(r.outcome, Outcome::solved) << "HS " << p.name << ": " << r.message;
    EXPECT_NEAR(r.objective, p.optimum, 1e-6 * std::max(1.0, std::abs(p.optimum))) << "HS " << p.name;
    EXPECT_LE(r.violated.largest(), options.constraint_tolerance) << "HS " << p.name;
    EXPECT_EQ(r.violated.largest(), violations(p.problem, r.x).largest());
    EXPECT_GT(r.iterations, 0);
  }
}

TEST_P(NlpSolvers, RepeatThemselves) {
  for (Published& p : hock_schittkowski()) {
    const NlpResult a = solver_->solve(p.problem, p.start), b = solver_->solve(p.problem, p.start);
    EXPECT_EQ(a.x, b.x);
    EXPECT_EQ(a.iterations, b.iterations);
  }
}

/// Also for ThreadSanitizer: solvers keep nothing that calls of other threads could change.
TEST_P(NlpSolvers, AnswerTheSameFromSeveralThreadsAtOnce) {
  const auto answers = [&] {
    std::vector<VectorXd> found;
    for (Published& p : hock_schittkowski()) found.push_back(solver_->solve(p.problem, p.start).x);
    return found;
  };
  const std::vector<VectorXd> alone = answers();
  std::vector<std::vector<VectorXd>> found(4);
  std::vector<std::thread> threads;
  for (std::vector<VectorXd>& mine : found) threads.emplace_back([&] { mine = answers(); });
  for (std::thread& thread : threads) thread.join();
  for (const std::vector<VectorXd>& theirs : found) EXPECT_EQ(theirs, alone);
}

TEST_P(NlpSolvers, SayInfeasibleAndKeepTheLeastViolatedPoint) {
  // x^2 + 1 <= 0 has no answer; its violation is least at 0.
  FormulaProblem problem([](const V& x) { return x[0]; }, {{[](const V& x) { return pow(x[0], 2) + 1; }, -kInf, 0}},
                         vec({-5}), vec({5}));
  const NlpResult r = solver_->solve(problem, vec({3}));
  EXPECT_NE(r.outcome, Outcome::solved);
  EXPECT_NE(r.outcome, Outcome::approximate);
  ASSERT_TRUE(r.x.allFinite());
  EXPECT_GE(r.violated.largest(), 1);
  EXPECT_LT(r.violated.largest(), 10);
}

TEST_P(NlpSolvers, SurviveNumbersThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  FormulaProblem everywhere([&](const V& x) { return nan * x[0]; }, {}, vec({-1}), vec({1}));
  NlpResult r = solver_->solve(everywhere, vec({0.5}));
  EXPECT_NE(r.outcome, Outcome::solved);
  EXPECT_TRUE(r.x.allFinite());
  // log is undefined left of 0, where a full step leads.
  FormulaProblem partly([](const V& x) { return x[0] - log(x[0]); },
                        {{[&](const V& x) { return log(x[0]); }, -kInf, 5}}, vec({-kInf}), vec({kInf}));
  r = solver_->solve(partly, vec({40}));
  EXPECT_TRUE(r.x.allFinite());
  if (r.outcome == Outcome::solved) {
    EXPECT_NEAR(r.x[0], 1, 1e-4);
  }
  FormulaProblem constraint([](const V& x) { return x[0]; }, {{[&](const V& x) { return nan * x[0]; }, 0, 0}},
                            vec({-1}), vec({1}));
  r = solver_->solve(constraint, vec({0.5}));
  EXPECT_NE(r.outcome, Outcome::solved);
  EXPECT_TRUE(r.x.allFinite());
}

TEST_P(NlpSolvers, EndOnProblemsWithoutBottom) {
  FormulaProblem problem([](const V& x) { return -1.0 * exp(x[0]); }, {{[](const V& x) { return x[0] - x[1]; }, 0, 0}},
                         all(2, -kInf), all(2, kInf));
  const NlpResult r = solver_->solve(problem, all(2, 1));
  EXPECT_NE(r.outcome, Outcome::solved);
  EXPECT_TRUE(r.x.allFinite());
}

TEST_P(NlpSolvers, HandBackTheBestPointWhenIterationsOrTimeEnd) {
  std::vector<Published> list = hock_schittkowski();
  Published& p = list.back();
  NlpOptions options;
  options.max_iterations = 4;
  NlpResult r = solver_->solve(p.problem, p.start, options);
  EXPECT_EQ(r.outcome, Outcome::timeout);
  const double start = violations(p.problem, p.start).largest();
  EXPECT_LE(r.violated.largest(), std::max(start, options.constraint_tolerance));
  options.max_iterations = 1000;
  options.time_limit = 1e-9;
  r = solver_->solve(p.problem, p.start, options);
  EXPECT_EQ(r.outcome, Outcome::timeout);
  EXPECT_TRUE(r.x.allFinite());
}

TEST_P(NlpSolvers, EndWhenTold) {
  std::vector<Published> list = hock_schittkowski();
  Published& p = list.back();
  Monitor monitor;
  // Every evaluation after the third is slow: a solver that does not look at the token would take a minute.
  p.problem.on_evaluation = [&] {
    if (p.problem.evaluations == 3) monitor.stop.stop();
    if (p.problem.evaluations > 6) std::this_thread::sleep_for(std::chrono::seconds(2));
  };
  const NlpResult r = solver_->solve(p.problem, p.start, {}, monitor);
  EXPECT_EQ(r.outcome, Outcome::stopped);
  EXPECT_LE(p.problem.evaluations, 6);
  EXPECT_TRUE(r.x.allFinite());
}

TEST_P(NlpSolvers, EndWhenToldWhileTheyComputeThemselves) {
  // A dense solver is busy with the first step for minutes, without a callback.
  LongChain problem(1500);
  Monitor monitor;
  std::thread teller;
  problem.on_first_jacobian = [&] {
    teller = std::thread([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      monitor.stop.stop();
    });
  };
  NlpOptions options;
  options.tolerance = 1e-300;  // nothing is good enough to end before
  options.max_iterations = 1000000;
  const NlpResult r = solver_->solve(problem, all(1500, 0.5), options, monitor);
  teller.join();
  EXPECT_NE(r.outcome, Outcome::solved);
  EXPECT_TRUE(r.x.allFinite());
}

TEST_P(NlpSolvers, HandOnWhatACallbackThrows) {
  std::vector<Published> list = hock_schittkowski();
  Published& p = list.back();
  p.problem.on_evaluation = [&] {
    if (p.problem.evaluations == 4) throw IoError("the disk is full");
  };
  EXPECT_THROW(solver_->solve(p.problem, p.start), IoError);
}

TEST_P(NlpSolvers, RefuseWhatMakesNoSense) {
  const test::Formula f = [](const V& x) { return pow(x[0], 2); };
  FormulaProblem good(f, {}, vec({-1}), vec({1}));
  EXPECT_THROW(solver_->solve(good, vec({1, 2})), InvalidInput);
  EXPECT_THROW(solver_->solve(good, vec({std::nan("")})), InvalidInput);
  FormulaProblem crossed(f, {}, vec({1}), vec({-1}));
  EXPECT_THROW(solver_->solve(crossed, vec({0})), InvalidInput);
  FormulaProblem contradictory(f, {{f, 2, 1}}, vec({-1}), vec({1}));
  EXPECT_THROW(solver_->solve(contradictory, vec({0})), InvalidInput);
  NlpOptions options;
  options.max_iterations = 0;
  EXPECT_THROW(solver_->solve(good, vec({0}), options), InvalidInput);
}

INSTANTIATE_TEST_SUITE_P(All, NlpSolvers, ::testing::ValuesIn(nlp_solver_names()),
                         [](const auto& info) { return info.param; });

TEST(NlpSolverTable, NamesTheKnownOnes) {
  try {
    make_nlp_solver("snopt");
    FAIL();
  } catch (const InvalidInput& e) {
    EXPECT_NE(std::string(e.what()).find("ipopt, slsqp"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace mmgrasp
