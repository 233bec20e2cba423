// NLopt's SLSQP behind the interface of nonlinear solvers.
#include <nlopt.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "optim/nlp/handoff.hpp"
#include "optim/nlp/nearest_kept.hpp"
#include "optim/nlp/nlp_backends.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;

/// One side of a constraint: factor * (c - bound) <= 0, or = 0.
struct Side {
  int row;
  double factor, bound;
};

/// Evaluates the problem once per point, and hands out rows of it.
class Dense {
 public:
  Dense(NonlinearProblem& problem, const Bounds& variables, const Bounds& bounds, SolveClock& clock, BestIterate& best)
      : problem_(problem), variables_(variables), clock_(clock), best_(best), bounds_(bounds) {
    for (Eigen::Index i = 0; i < bounds.lower.size(); ++i) {
      const int row = static_cast<int>(i);
      if (bounds.lower[i] == bounds.upper[i]) {
        equal.push_back({row, 1, bounds.lower[i]});
        continue;
      }
      if (std::isfinite(bounds.upper[i])) below.push_back({row, 1, bounds.upper[i]});
      if (std::isfinite(bounds.lower[i])) below.push_back({row, -1, bounds.lower[i]});
    }
    c_.resize(bounds.lower.size());
    jacobian_.resize(static_cast<Eigen::Index>(problem.jacobian_pattern().size()));
  }

  std::vector<Side> equal, below;
  int evaluations = 0;
  double latest() const { return value_; }

  /// False: the run has to end.
  bool objective(unsigned n, const double* x, double& value, double* gradient) {
    return clock_.guarded([&] {
      if (!move(n, x)) return false;
      value = value_;
      if (gradient) problem_.gradient(x_, Eigen::Map<VectorXd>(gradient, n));
      return true;
    });
  }
  bool sides(const std::vector<Side>& which, unsigned n, const double* x, double* out, double* gradient) {
    return clock_.guarded([&] {
      if (!move(n, x)) return false;
      for (std::size_t i = 0; i < which.size(); ++i) out[i] = which[i].factor * (c_[which[i].row] - which[i].bound);
      if (gradient) rows(which, n, gradient);
      return true;
    });
  }

 private:
  /// SLSQP turns in circles on numbers that are not finite, so they end it.
  bool move(unsigned n, const double* x) {
    const Eigen::Map<const VectorXd> to(x, n);
    if (x_.size() > 0 && x_ == to) return true;
    x_ = to;
    if (!x_.allFinite()) return false;
    value_ = problem_.objective(x_);
    if (c_.size() > 0) problem_.constraints(x_, c_);
    if (jacobian_.size() > 0) problem_.jacobian(x_, jacobian_);
    if (!std::isfinite(value_) || !c_.allFinite() || !jacobian_.allFinite()) return false;
    ++evaluations;
    double violation = 0;
    for (Eigen::Index i = 0; i < c_.size(); ++i)
      violation = std::max({violation, bounds_.lower[i] - c_[i], c_[i] - bounds_.upper[i]});
    best_.offer(x_.cwiseMax(variables_.lower).cwiseMin(variables_.upper), value_, violation);
    return true;
  }

  void rows(const std::vector<Side>& which, unsigned n, double* gradient) {
    const SparsePattern& pattern = problem_.jacobian_pattern();
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>& J = dense_;
    J.setZero(c_.size(), n);
    for (std::size_t i = 0; i < pattern.size(); ++i)
      J(pattern.rows[i], pattern.columns[i]) += jacobian_[static_cast<Eigen::Index>(i)];
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> out(
        gradient, static_cast<Eigen::Index>(which.size()), n);
    for (std::size_t i = 0; i < which.size(); ++i)
      out.row(static_cast<Eigen::Index>(i)) = which[i].factor * J.row(which[i].row);
  }

  NonlinearProblem& problem_;
  const Bounds& variables_;
  SolveClock& clock_;
  BestIterate& best_;
  Bounds bounds_;
  VectorXd x_, c_, jacobian_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> dense_;
  double value_ = 0;
};

std::vector<double> list(const VectorXd& v) {
  return {v.data(), v.data() + v.size()};
}

/// One run of NLopt in a thread of its own, which may outlast its caller. Of the caller it touches `dense` alone, and
/// that only while the caller serves.
struct Run {
  Handoff handoff;
  Dense* dense;
  std::vector<double> lower, upper, at, equal, below;  ///< equal, below: tolerances of the constraints.
  double ftol = 0;
  int evaluations = 0;
  nlopt::result code = nlopt::FAILURE;
  std::string message;

  void solve() {
    try {
      nlopt::opt solver(nlopt::LD_SLSQP, static_cast<unsigned>(at.size()));
      solver.set_lower_bounds(lower);
      solver.set_upper_bounds(upper);
      solver.set_min_objective(&objective_of, this);
      if (!equal.empty()) solver.add_equality_mconstraint(&equal_of, this, equal);
      if (!below.empty()) solver.add_inequality_mconstraint(&below_of, this, below);
      solver.set_ftol_rel(ftol);
      solver.set_xtol_rel(1e-12);
      solver.set_maxeval(evaluations);
      double value = 0;
      code = solver.optimize(at, value);
      message = code == nlopt::MAXEVAL_REACHED ? "evaluations exceeded" : "converged";
    } catch (const std::exception& error) {
      message = error.what();
    }
    handoff.finish();
  }

 private:
  template <typename Function>
  void ask(Function&& function) {
    bool goes_on = false;
    if (!handoff.ask([&] { goes_on = function(); }) || !goes_on) throw nlopt::forced_stop();
  }
  static double objective_of(unsigned n, const double* x, double* gradient, void* data) {
    Run* run = static_cast<Run*>(data);
    double value = 0;
    run->ask([&] { return run->dense->objective(n, x, value, gradient); });
    return value;
  }
  static void equal_of(unsigned, double* out, unsigned n, const double* x, double* gradient, void* data) {
    Run* run = static_cast<Run*>(data);
    run->ask([&] { return run->dense->sides(run->dense->equal, n, x, out, gradient); });
  }
  static void below_of(unsigned, double* out, unsigned n, const double* x, double* gradient, void* data) {
    Run* run = static_cast<Run*>(data);
    run->ask([&] { return run->dense->sides(run->dense->below, n, x, out, gradient); });
  }
};

/// Sequential least squares on dense matrices, run again from its answer until that stays.
class SlsqpSolver : public NlpSolver {
 public:
  std::string name() const override { return "slsqp"; }

 private:
  NlpResult run(NonlinearProblem& problem, const VectorXd& guess, const NlpOptions& options,
                const Monitor& monitor) const override {
    SolveClock clock(options.time_limit, monitor);
    BestIterate best(options.constraint_tolerance);
    const Bounds variables = problem.variable_bounds();
    Dense dense(problem, variables, problem.constraint_bounds(), clock, best);
    VectorXd last = guess.cwiseMax(variables.lower).cwiseMin(variables.upper);
    nlopt::result code = nlopt::FAILURE;
    std::string message;
    // A single short step ends a run of it: an answer is one when a fresh run from there finds nothing better.
    for (double before = 0; dense.evaluations < options.max_iterations; before = dense.latest()) {
      const bool first = dense.evaluations == 0;
      const std::shared_ptr<const Run> run = optimize(dense, variables, options, clock, last);
      if (!run) break;
      code = run->code;
      message = run->message;
      if (code < 0) break;
      last = Eigen::Map<const VectorXd>(run->at.data(), last.size());
      const double now = dense.latest();
      if (!first && std::abs(now - before) <= options.tolerance * std::max(1.0, std::abs(now))) break;
    }
    if (clock.error) std::rethrow_exception(clock.error);
    // It ends by the objective, which tells little of constraints kept to a millionth.
    if (code > 0 && !clock.over()) last = nearest_kept(problem, last);
    const bool converged = code == nlopt::SUCCESS || code == nlopt::FTOL_REACHED || code == nlopt::XTOL_REACHED;
    NlpResult result = judged(problem, last, converged, code == nlopt::MAXEVAL_REACHED, best, guess, options, clock);
    result.iterations = dense.evaluations;
    result.message = clock.stopped() ? "stopped" : clock.late() ? "time exceeded" : message;
    return result;
  }

  /// Null when the caller left before the end.
  static std::shared_ptr<const Run> optimize(Dense& dense, const Bounds& variables, const NlpOptions& options,
                                             const SolveClock& clock, const VectorXd& from) {
    const auto run = std::make_shared<Run>();
    run->dense = &dense;
    run->lower = list(variables.lower);
    run->upper = list(variables.upper);
    run->at = list(from);
    run->equal.assign(dense.equal.size(), 0.5 * options.constraint_tolerance);
    run->below.assign(dense.below.size(), 0.5 * options.constraint_tolerance);
    run->ftol = options.tolerance;
    run->evaluations = options.max_iterations - dense.evaluations;
    std::thread thread([run] { run->solve(); });
    if (run->handoff.serve([&] { return clock.over(); })) {
      thread.join();
      return run;
    }
    thread.detach();
    return nullptr;
  }
};

}  // namespace

std::unique_ptr<NlpSolver> make_slsqp() {
  return std::make_unique<SlsqpSolver>();
}

}  // namespace mmgrasp::detail
