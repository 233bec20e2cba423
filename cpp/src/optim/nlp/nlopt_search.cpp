#include "optim/nlp/nlopt_search.hpp"

#include <nlopt.hpp>

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "optim/nlp/best_iterate.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;

struct Algorithm {
  const char* name;
  nlopt::algorithm id;
  bool global, constraints, random;
};

/// Stands for a value that is not finite: worse than any that is, and still a number to compute with.
constexpr double kUndefined = 1e100;

/// Calls the problem's functions once per point, inside the bounds, within the budget.
class Evaluator {
 public:
  Evaluator(const DerivativeFreeProblem& problem, const DerivativeFreeOptions& options, SolveClock& clock)
      : problem_(problem), options_(options), clock_(clock), best_(options.constraint_tolerance) {}

  /// The solver asks for f at x. Throws nlopt::forced_stop when the solve has to end.
  double objective(unsigned n, const double* x) {
    move(n, x, value_given_);
    value_given_ = true;
    return value_;
  }
  /// The solver asks for c at x: before or after f, the functions are called once.
  const VectorXd& constraints(unsigned n, const double* x) {
    move(n, x, constraints_given_);
    constraints_given_ = true;
    return c_;
  }
  bool exhausted() const { return exhausted_; }
  /// The best point seen; when f was defined at none, the guess.
  void report_best(const VectorXd& guess, DerivativeFreeResult& result) const {
    result.x = best_.any() ? best_.x() : guess;
    result.value = best_.any() ? best_value_ : kInfinity;
    result.violation = best_.any() ? best_violation_ : kInfinity;
  }

  int evaluations = 0;

 private:
  /// `again`: the solver has had the answer for this x; asking again costs, or a solver that stands still never ended.
  void move(unsigned n, const double* given, bool again) {
    if (clock_.over() || exhausted_) throw nlopt::forced_stop();
    const VectorXd x =
        Eigen::Map<const VectorXd>(given, n).cwiseMax(problem_.bounds.lower).cwiseMin(problem_.bounds.upper);
    if (x_.size() > 0 && x == x_ && !again) return;
    if (evaluations == options_.max_evaluations) {
      exhausted_ = true;
      throw nlopt::forced_stop();
    }
    try {
      evaluate(x);
    } catch (...) {
      clock_.error = std::current_exception();
      throw nlopt::forced_stop();
    }
  }

  void evaluate(const VectorXd& x) {
    ++evaluations;
    value_given_ = constraints_given_ = false;
    const double value = problem_.objective(x);
    double violation = 0;
    VectorXd c;
    if (problem_.constraint_count > 0) {
      c = problem_.constraints(x);
      require(c.size() == problem_.constraint_count, "constraints(x)", static_cast<double>(c.size()),
              "must have constraint_count entries");
      for (double& each : c) {
        violation = std::isfinite(each) ? std::max(violation, each) : kInfinity;
        if (!std::isfinite(each)) each = kUndefined;
      }
    }
    x_ = x;
    c_ = c;
    value_ = std::isfinite(value) ? value : kUndefined;
    if (best_.offer(x, value, violation)) {
      best_value_ = value;
      best_violation_ = violation;
    }
  }

  const DerivativeFreeProblem& problem_;
  const DerivativeFreeOptions& options_;
  SolveClock& clock_;
  BestIterate best_;
  VectorXd x_, c_;
  double value_ = 0, best_value_ = 0, best_violation_ = 0;
  bool value_given_ = false, constraints_given_ = false, exhausted_ = false;
};

double objective_of(unsigned n, const double* x, double*, void* data) {
  return static_cast<Evaluator*>(data)->objective(n, x);
}

void constraints_of(unsigned m, double* out, unsigned n, const double* x, double*, void* data) {
  const VectorXd& c = static_cast<Evaluator*>(data)->constraints(n, x);
  std::copy(c.data(), c.data() + m, out);
}

std::vector<double> list(const VectorXd& v) {
  return {v.data(), v.data() + v.size()};
}

/// Steps that count as none.
std::vector<double> step_tolerances(const Bounds& bounds, double tolerance) {
  std::vector<double> out;
  for (Eigen::Index i = 0; i < bounds.lower.size(); ++i) {
    const double range = bounds.upper[i] - bounds.lower[i];
    out.push_back(tolerance * (std::isfinite(range) && range > 0 ? range : 1));
  }
  return out;
}

/// One of NLopt's derivative-free algorithms, by its entry in the table above.
class NloptSearch : public DerivativeFreeSolver {
 public:
  explicit NloptSearch(const Algorithm& algorithm) : algorithm_(algorithm) {}
  std::string name() const override { return algorithm_.name; }
  bool is_global() const override { return algorithm_.global; }
  bool takes_constraints() const override { return algorithm_.constraints; }

 private:
  DerivativeFreeResult run(const DerivativeFreeProblem& problem, const VectorXd& guess,
                           const DerivativeFreeOptions& options, const Monitor& monitor) const override {
    SolveClock clock(options.time_limit, monitor);
    Evaluator evaluator(problem, options, clock);
    DerivativeFreeResult result;
    const bool converged = optimize(problem, guess, options, clock, evaluator, result.message);
    if (clock.error) std::rethrow_exception(clock.error);
    evaluator.report_best(guess, result);
    const bool keeps = std::isfinite(result.value) && result.violation <= options.constraint_tolerance;
    result.outcome = clock.stopped()                         ? Outcome::stopped
                     : evaluator.exhausted() || clock.late() ? Outcome::timeout
                     : !keeps                                ? Outcome::not_found
                     : converged                             ? Outcome::solved
                                                             : Outcome::approximate;
    result.evaluations = evaluator.evaluations;
    result.seconds = clock.seconds();
    return result;
  }

  bool optimize(const DerivativeFreeProblem& problem, const VectorXd& guess, const DerivativeFreeOptions& options,
                const SolveClock& clock, Evaluator& evaluator, std::string& message) const {
    std::vector<double> x = list(guess);
    if (problem.bounds.lower == problem.bounds.upper) {  // one point
      try {
        evaluator.objective(static_cast<unsigned>(x.size()), x.data());
      } catch (const nlopt::forced_stop&) {
        return false;
      }
      message = "nothing to search";
      return true;
    }
    if (algorithm_.random) nlopt::srand(options.seed);  // of this thread: NLopt has one generator a thread
    try {
      nlopt::opt solver(algorithm_.id, static_cast<unsigned>(x.size()));
      solver.set_lower_bounds(list(problem.bounds.lower));
      solver.set_upper_bounds(list(problem.bounds.upper));
      solver.set_min_objective(&objective_of, &evaluator);
      if (problem.constraint_count > 0)
        solver.add_inequality_mconstraint(&constraints_of, &evaluator,
                                          std::vector<double>(problem.constraint_count, options.constraint_tolerance));
      solver.set_xtol_abs(step_tolerances(problem.bounds, options.tolerance));
      // Values change with the square of the step around a minimum. A search of the whole box is not over because it
      // has found nothing better for a while.
      if (!algorithm_.global) solver.set_ftol_rel(options.tolerance * options.tolerance);
      double value = 0;
      const nlopt::result code = solver.optimize(x, value);
      message = code == nlopt::XTOL_REACHED ? "steps below the tolerance" : "values no longer change";
      return true;
    } catch (const nlopt::forced_stop&) {
      message = evaluator.exhausted() ? "evaluations exceeded" : clock.stopped() ? "stopped" : "time exceeded";
    } catch (const std::exception& error) {
      message = error.what();
    }
    return false;
  }

  Algorithm algorithm_;
};

}  // namespace

// name, algorithm, global, takes constraints, draws random numbers
std::unique_ptr<DerivativeFreeSolver> make_bobyqa() {
  return std::make_unique<NloptSearch>(Algorithm{"bobyqa", nlopt::LN_BOBYQA, false, false, false});
}
std::unique_ptr<DerivativeFreeSolver> make_cobyla() {
  return std::make_unique<NloptSearch>(Algorithm{"cobyla", nlopt::LN_COBYLA, false, true, false});
}
std::unique_ptr<DerivativeFreeSolver> make_nelder_mead() {
  return std::make_unique<NloptSearch>(Algorithm{"nelder_mead", nlopt::LN_NELDERMEAD, false, false, false});
}
std::unique_ptr<DerivativeFreeSolver> make_sbplx() {
  return std::make_unique<NloptSearch>(Algorithm{"sbplx", nlopt::LN_SBPLX, false, false, false});
}
std::unique_ptr<DerivativeFreeSolver> make_crs2() {
  return std::make_unique<NloptSearch>(Algorithm{"crs2", nlopt::GN_CRS2_LM, true, false, true});
}
std::unique_ptr<DerivativeFreeSolver> make_isres() {
  return std::make_unique<NloptSearch>(Algorithm{"isres", nlopt::GN_ISRES, true, true, true});
}
std::unique_ptr<DerivativeFreeSolver> make_direct_l() {
  return std::make_unique<NloptSearch>(Algorithm{"direct_l", nlopt::GN_DIRECT_L, true, false, false});
}
std::unique_ptr<DerivativeFreeSolver> make_esch() {
  return std::make_unique<NloptSearch>(Algorithm{"esch", nlopt::GN_ESCH, true, false, true});
}

}  // namespace mmgrasp::detail
