// Ipopt behind the interface of nonlinear solvers.
#include <IpIpoptApplication.hpp>
#include <IpIpoptCalculatedQuantities.hpp>
#include <IpIpoptData.hpp>
#include <IpOrigIpoptNLP.hpp>
#include <IpTNLP.hpp>
#include <IpTNLPAdapter.hpp>
#include <algorithm>
#include <cmath>

#include "optim/nlp/ipopt_factorisation.hpp"
#include "optim/nlp/nlp_backends.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;
using Index = Ipopt::Index;
using Number = Ipopt::Number;
using ConstMap = Eigen::Map<const VectorXd>;
using Map = Eigen::Map<VectorXd>;

constexpr double kInfinity = 1e19;  // Ipopt's

/// A NonlinearProblem as Ipopt asks for it; notes the best iterate and ends the solve when its time is up.
class Adapter : public Ipopt::TNLP {
 public:
  Adapter(NonlinearProblem& problem, const VectorXd& guess, const NlpOptions& options, SolveClock& clock,
          BestIterate& best)
      : problem_(problem),
        guess_(guess),
        clock_(clock),
        best_(best),
        variables_(problem.variable_bounds()),
        constraints_(problem.constraint_bounds()),
        x_(guess),
        options_(options) {}

  VectorXd last;
  int iterations = 0;

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    n = static_cast<Index>(variables_.lower.size());
    m = static_cast<Index>(constraints_.lower.size());
    jacobian = static_cast<Index>(problem_.jacobian_pattern().size());
    hessian = static_cast<Index>(problem_.hessian_pattern().size());
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* xl, Number* xu, Index m, Number* cl, Number* cu) override {
    write(variables_, n, xl, xu);
    write(constraints_, m, cl, cu);
    return true;
  }

  bool get_starting_point(Index n, bool, Number* x, bool, Number* zl, Number* zu, Index m, bool with_multipliers,
                          Number* multipliers) override {
    Map(x, n) = guess_;
    std::fill(zl, zl + n, 1.0);
    std::fill(zu, zu + n, 1.0);
    if (with_multipliers) std::fill(multipliers, multipliers + m, 0.0);
    return true;
  }

  bool eval_f(Index n, const Number* x, bool, Number& value) override {
    return clock_.guarded([&] {
      value = problem_.objective(at(n, x));
      return std::isfinite(value);
    });
  }
  bool eval_grad_f(Index n, const Number* x, bool, Number* out) override {
    return clock_.guarded([&] {
      Map gradient(out, n);
      problem_.gradient(at(n, x), gradient);
      return gradient.allFinite();
    });
  }
  bool eval_g(Index n, const Number* x, bool, Index m, Number* out) override {
    return clock_.guarded([&] {
      Map values(out, m);
      problem_.constraints(at(n, x), values);
      return values.allFinite();
    });
  }
  bool eval_jac_g(Index n, const Number* x, bool, Index, Index count, Index* rows, Index* columns,
                  Number* out) override {
    if (!out) return write(problem_.jacobian_pattern(), rows, columns);
    return clock_.guarded([&] {
      Map values(out, count);
      problem_.jacobian(at(n, x), values);
      return values.allFinite();
    });
  }
  bool eval_h(Index n, const Number* x, bool, Number factor, Index m, const Number* multipliers, bool, Index count,
              Index* rows, Index* columns, Number* out) override {
    if (!out) return write(problem_.hessian_pattern(), rows, columns);
    return clock_.guarded([&] {
      Map values(out, count);
      problem_.hessian(at(n, x), factor, VectorXd(ConstMap(multipliers, m)), values);
      return values.allFinite();
    });
  }

  bool intermediate_callback(Ipopt::AlgorithmMode mode, Index iteration, Number objective, Number violation, Number,
                             Number, Number, Number, Number, Number, Index, const Ipopt::IpoptData* data,
                             Ipopt::IpoptCalculatedQuantities* quantities) override {
    iterations = iteration;
    if (mode == Ipopt::RegularMode) keep(objective, violation, data, quantities);
    clock_.report(iteration, options_.max_iterations);
    return !clock_.over();
  }

  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number*, const Number*, Index,
                         const Number*, const Number*, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    last = ConstMap(x, n);
  }

 private:
  const VectorXd& at(Index n, const Number* x) { return x_ = ConstMap(x, n); }

  static void write(const Bounds& bounds, Index n, Number* lower, Number* upper) {
    for (Index i = 0; i < n; ++i) {
      lower[i] = std::max(bounds.lower[i], -2 * kInfinity);
      upper[i] = std::min(bounds.upper[i], 2 * kInfinity);
    }
  }
  static bool write(const SparsePattern& pattern, Index* rows, Index* columns) {
    std::copy(pattern.rows.begin(), pattern.rows.end(), rows);
    std::copy(pattern.columns.begin(), pattern.columns.end(), columns);
    return true;
  }

  /// Keeps the current point when it beats the best one.
  void keep(double objective, double violation, const Ipopt::IpoptData* data,
            Ipopt::IpoptCalculatedQuantities* quantities) {
    if (!data || !quantities) return;
    auto* nlp = dynamic_cast<Ipopt::OrigIpoptNLP*>(Ipopt::GetRawPtr(quantities->GetIpoptNLP()));
    auto* adapter = nlp ? dynamic_cast<Ipopt::TNLPAdapter*>(Ipopt::GetRawPtr(nlp->nlp())) : nullptr;
    if (!adapter) return;
    VectorXd x(guess_.size());
    adapter->ResortX(*data->curr()->x(), x.data());
    best_.offer(x, objective, violation);
  }

  NonlinearProblem& problem_;
  const VectorXd& guess_;
  SolveClock& clock_;
  BestIterate& best_;
  Bounds variables_, constraints_;
  VectorXd x_;
  NlpOptions options_;
};

const char* said(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
      return "optimal solution found";
    case Ipopt::Solved_To_Acceptable_Level:
      return "solved to an acceptable level";
    case Ipopt::Infeasible_Problem_Detected:
      return "converged to a point of local infeasibility";
    case Ipopt::Search_Direction_Becomes_Too_Small:
      return "search direction becomes too small";
    case Ipopt::Diverging_Iterates:
      return "iterates diverge";
    case Ipopt::User_Requested_Stop:
      return "stopped";
    case Ipopt::Feasible_Point_Found:
      return "feasible point found";
    case Ipopt::Maximum_Iterations_Exceeded:
      return "iterations exceeded";
    case Ipopt::Restoration_Failed:
      return "restoration failed";
    case Ipopt::Error_In_Step_Computation:
      return "error in step computation";
    case Ipopt::Maximum_CpuTime_Exceeded:
      return "time exceeded";
    case Ipopt::Not_Enough_Degrees_Of_Freedom:
      return "more equations than free variables";
    case Ipopt::Invalid_Number_Detected:
      return "a callback gave a number that is not finite";
    default:
      return "internal error";
  }
}

/// Interior points.
class IpoptSolver : public NlpSolver {
 public:
  std::string name() const override { return "ipopt"; }

 private:
  NlpResult run(NonlinearProblem& problem, const VectorXd& guess, const NlpOptions& options,
                const Monitor& monitor) const override {
    SolveClock clock(options.time_limit, monitor);
    BestIterate best(options.constraint_tolerance);
    Ipopt::SmartPtr<Adapter> adapter = new Adapter(problem, guess, options, clock, best);
    const Ipopt::ApplicationReturnStatus status = optimize(*adapter, options);
    if (clock.error) std::rethrow_exception(clock.error);
    const bool converged = status == Ipopt::Solve_Succeeded || status == Ipopt::Solved_To_Acceptable_Level;
    NlpResult result = judged(problem, adapter->last, converged, status == Ipopt::Maximum_Iterations_Exceeded, best,
                              guess, options, clock);
    result.iterations = adapter->iterations;
    result.message = clock.stopped() ? "stopped" : clock.late() ? "time exceeded" : said(status);
    return result;
  }

  static Ipopt::ApplicationReturnStatus optimize(Adapter& adapter, const NlpOptions& options) {
    Ipopt::SmartPtr<Ipopt::IpoptApplication> app = new Ipopt::IpoptApplication(false);
    auto settings = app->Options();
    settings->SetIntegerValue("print_level", 0);
    settings->SetStringValue("sb", "yes");
    settings->SetIntegerValue("max_iter", options.max_iterations);
    settings->SetNumericValue("tol", options.tolerance);
    settings->SetNumericValue("constr_viol_tol", 0.5 * options.constraint_tolerance);
    settings->SetNumericValue("acceptable_tol", 100 * options.tolerance);
    settings->SetNumericValue("acceptable_constr_viol_tol", 0.5 * options.constraint_tolerance);
    settings->SetIntegerValue("acceptable_iter", 5);
    settings->SetNumericValue("bound_relax_factor", 0.0);
    give_ipopt_sparse_ldlt();
    settings->SetStringValue("linear_solver", "ma97");
    settings->SetStringValue("ma97_scaling", "none");
    settings->SetStringValue("linear_system_scaling", "none");
    settings->SetStringValue("mu_strategy", "adaptive");
    settings->SetNumericValue("mu_min", std::min(1e-6, 0.01 * options.tolerance));
    settings->SetStringValue("honor_original_bounds", "yes");
    // Ipopt scales the problem itself and refines where residuals are large: twice is only slower.
    settings->SetIntegerValue("min_refinement_steps", 0);
    if (options.barrier > 0) {
      settings->SetStringValue("mu_strategy", "monotone");
      settings->SetNumericValue("mu_init", options.barrier);
    }
    if (options.warm_start > 0) {
      settings->SetStringValue("mu_strategy", "monotone");
      settings->SetNumericValue("mu_init", options.warm_start);
      settings->SetNumericValue("bound_push", 1e-4);
      settings->SetNumericValue("bound_frac", 1e-4);
      settings->SetNumericValue("slack_bound_push", 1e-4);
      settings->SetNumericValue("slack_bound_frac", 1e-4);
    }
    if (app->Initialize("") != Ipopt::Solve_Succeeded) return Ipopt::Internal_Error;
    return app->OptimizeTNLP(&adapter);
  }
};

}  // namespace

std::unique_ptr<NlpSolver> make_ipopt() {
  return std::make_unique<IpoptSolver>();
}

}  // namespace mmgrasp::detail
