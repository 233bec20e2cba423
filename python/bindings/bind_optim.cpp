#include "any_numbers.hpp"
#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/optim/assignment.hpp"
#include "mmgrasp/optim/derivative_free.hpp"
#include "mmgrasp/optim/pairwise_weights.hpp"
#include "mmgrasp/optim/set_cover.hpp"
#include "mmgrasp/optim/shared_tours.hpp"
#include "mmgrasp/optim/tour.hpp"

namespace mmgrasp::python {

using namespace py::literals;
namespace {

constexpr int kMaxConstraints = 1000000;

constexpr char kObjective[] = "collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], float]";
using Objective = Shown<kObjective>;
constexpr char kConstraints[] =
    "collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], numpy.typing.ArrayLike] | None";
using Constraints = Shown<kConstraints>;

const std::vector<OptionField<DerivativeFreeOptions>>& derivative_free_fields() {
  using O = DerivativeFreeOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("tolerance", &O::tolerance, "converged when steps fall below this share of a variable's range"),
      option<O>("constraint_tolerance", &O::constraint_tolerance, "largest c_i(x) that still counts as kept"),
      option<O>("max_evaluations", &O::max_evaluations, "budget in points"),
      option<O>("time_limit", &O::time_limit, "wall-clock cap [s]"),
      option<O>("seed", &O::seed, "same seed, same answer")};
  return fields;
}

DerivativeFreeResult minimize(const Objective& objective, const ArrayLike& given_guess, const ArrayLike& given_lower,
                              const ArrayLike& given_upper, const std::string& solver, const Constraints& constraints,
                              int constraint_count, const Progress& progress, const py::kwargs& options) {
  const DerivativeFreeOptions read = read_options(derivative_free_fields(), options, "minimize_derivative_free");
  const Eigen::VectorXd guess = vector_argument(given_guess, "guess", -1, kLargestNumber);
  if (guess.size() == 0) throw InvalidInput("guess has shape (0,): must be (n,) with n > 0");
  DerivativeFreeProblem problem;
  problem.bounds = {any_numbers(given_lower, "lower", guess.size(), ", as guess"),
                    any_numbers(given_upper, "upper", guess.size(), ", as guess")};
  if (function_argument(objective, "objective").is_none()) throw InvalidInput("objective = None: must be a function");
  problem.objective = [&](const Eigen::VectorXd& x) {
    const py::gil_scoped_acquire gil;
    return py::cast<double>(objective(x));
  };
  if (constraints.is_none() != (constraint_count == 0) || constraint_count < 0 || constraint_count > kMaxConstraints)
    throw InvalidInput("constraint_count = " + std::to_string(constraint_count) +
                       ": must be how many numbers `constraints` gives, up to 1000000; 0 without constraints");
  problem.constraint_count = constraint_count;
  if (!function_argument(constraints, "constraints").is_none()) {
    problem.constraints = [&](const Eigen::VectorXd& x) {
      const py::gil_scoped_acquire gil;
      return any_numbers(constraints(x), "constraints(x)", -1);
    };
  }
  return LongCall(progress).run(
      [&](const Monitor& monitor) { return minimize_derivative_free(solver, problem, guess, read, monitor); });
}

void bind_derivative_free(py::module_& m) {
  using Result = DerivativeFreeResult;
  py::class_<Result>(m, "DerivativeFreeResult", "What a search by values alone found.")
      .def_readonly("outcome", &Result::outcome,
                    "`solved`: converged, constraints kept; `timeout`: the budget or the time limit ended it.")
      .def_readonly("x", &Result::x, "The best point seen: the least violated, then the cheapest; inside the bounds.")
      .def_readonly("value", &Result::value, "Objective at x.")
      .def_readonly("violation", &Result::violation, "Largest c_i(x), or 0.")
      .def_readonly("evaluations", &Result::evaluations, "Points at which the functions were called.")
      .def_readonly("seconds", &Result::seconds, "Wall-clock time [s].")
      .def_readonly("message", &Result::message, "How the solver itself put it.")
      .def(
          "to_dict",
          [](const Result& r) {
            return py::dict("outcome"_a = to_string(r.outcome), "x"_a = r.x, "value"_a = r.value,
                            "violation"_a = r.violation, "evaluations"_a = r.evaluations, "seconds"_a = r.seconds,
                            "message"_a = r.message);
          },
          "All fields by name.")
      .def("__repr__", [](const Result& r) {
        return std::string("DerivativeFreeResult(") + to_string(r.outcome) +
               ", value=" + std::string(py::repr(py::float_(r.value))) + ", " + std::to_string(r.evaluations) +
               " evaluations)";
      });
  m.def("derivative_free_solver_names", &derivative_free_solver_names,
        "Names that minimize_derivative_free's `solver` takes.");
  m.def(
      "minimize_derivative_free", &minimize, py::arg("objective"), py::arg("guess"), py::arg("lower"), py::arg("upper"),
      py::kw_only(), py::arg("solver") = "bobyqa", py::arg("constraints") = py::none(), py::arg("constraint_count") = 0,
      py::arg("progress") = py::none(),
      ("Least value of `objective(x)` for lower <= x <= upper, found by values alone. `x` is a (n,) array; bounds may "
       "be infinite for the local solvers (bobyqa, cobyla, nelder_mead, sbplx), not for the global ones (crs2, isres, "
       "direct_l, esch). `constraints(x)` gives `constraint_count` numbers that must be at most 0 (cobyla, isres). "
       "Values that are not finite are avoided. What a function raises ends the search and is raised here." +
       option_help(derivative_free_fields()))
          .c_str());
}

}  // namespace

void bind_optim(py::module_& m) {
  bind_derivative_free(m);
  py::class_<SetCoverResult>(m, "SetCoverResult", "What solve_set_cover found.")
      .def_readonly("outcome", &SetCoverResult::outcome, "`solved` only with a proof of optimality.")
      .def_readonly("chosen", &SetCoverResult::chosen, "Indices of the chosen sets, ascending.")
      .def_readonly("cost", &SetCoverResult::cost, "Sum over the chosen sets.")
      .def_readonly("lower_bound", &SetCoverResult::lower_bound, "Proven: no cover costs less.")
      .def_readonly("uncoverable", &SetCoverResult::uncoverable, "Elements in no set.")
      .def(
          "to_dict",
          [](const SetCoverResult& r) {
            return py::dict("outcome"_a = to_string(r.outcome), "chosen"_a = r.chosen, "cost"_a = r.cost,
                            "lower_bound"_a = r.lower_bound, "uncoverable"_a = r.uncoverable);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const SetCoverResult& r) {
        return std::string("SetCoverResult(") + to_string(r.outcome) +
               ", chosen=" + std::string(py::repr(py::cast(r.chosen))) +
               ", cost=" + std::string(py::repr(py::cast(r.cost))) + ")";
      });
  m.def(
      "solve_set_cover",
      [](int elements, const std::vector<std::vector<int>>& sets, const ArrayLike& costs, double time_limit,
         const Progress& progress) {
        SetCoverProblem problem{elements, sets, list_argument(costs, "costs", kLargestNumber)};
        problem.check();
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return solve_set_cover(problem, time_limit, monitor); });
      },
      py::arg("elements"), py::arg("sets"), py::arg("costs") = py::tuple(), py::kw_only(), py::arg("time_limit") = 60.0,
      py::arg("progress") = py::none(),
      "Fewest (or cheapest) sets that cover all of 0..elements-1, with a proof (P1, equation 3.1).");

  py::class_<TourResult>(m, "TourResult", "What shortest_visiting_tour found.")
      .def_readonly("outcome", &TourResult::outcome, "`solved` with a proof of the shortest, `approximate` without.")
      .def_readonly("order", &TourResult::order, "Visiting order of the stops.")
      .def_readonly("length", &TourResult::length, "Length of the tour from start over all stops to the goal.")
      .def_readonly("lower_bound", &TourResult::lower_bound, "Proven: no way is shorter.")
      .def_readonly("proven", &TourResult::proven, "True when the length meets the bound; always up to 15 stops.")
      .def(
          "to_dict",
          [](const TourResult& r) {
            return py::dict("outcome"_a = to_string(r.outcome), "order"_a = r.order, "length"_a = r.length,
                            "lower_bound"_a = r.lower_bound, "proven"_a = r.proven);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const TourResult& r) {
        return std::string("TourResult(") + to_string(r.outcome) +
               ", order=" + std::string(py::repr(py::cast(r.order))) +
               ", length=" + std::string(py::repr(py::cast(r.length))) + ")";
      });
  m.def(
      "shortest_visiting_tour",
      [](const ArrayLike& given) {
        const Eigen::MatrixXd lengths = matrix_argument(given, "lengths", -1, detail::kInfinity);
        return interruptible([&] { return shortest_visiting_tour(lengths); });
      },
      py::arg("lengths"),
      "Shortest way from start over all n stops to goal. `lengths` is (n + 2, n + 2): stops, start, goal; infinite: no "
      "way.");

  m.def(
      "cheapest_assignment",
      [](const ArrayLike& given) {
        const Eigen::MatrixXd costs = matrix_argument(given, "costs", -1, kLargestNumber);
        return interruptible([&] { return cheapest_assignment(costs); });
      },
      py::arg("costs"), "A column of its own for each row of (n, n) so that the sum of costs is least.");

  py::class_<SharedTours>(m, "SharedTours", "Stops shared among several robots.")
      .def_readonly("outcome", &SharedTours::outcome, "`solved`: proven least; `approximate`: a good one with a bound.")
      .def_readonly("orders", &SharedTours::orders, "The stops of each robot in visiting order.")
      .def_readonly("durations", &SharedTours::durations, "One a robot; 0 when it stays.")
      .def_readonly("makespan", &SharedTours::makespan, "The longest duration.")
      .def_readonly("lower_bound", &SharedTours::lower_bound, "Proven: no sharing ends earlier.")
      .def(
          "to_dict",
          [](const SharedTours& s) {
            return py::dict("outcome"_a = to_string(s.outcome), "orders"_a = s.orders, "durations"_a = s.durations,
                            "makespan"_a = s.makespan, "lower_bound"_a = s.lower_bound);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const SharedTours& s) {
        return std::string("SharedTours(") + to_string(s.outcome) + ", " + std::to_string(s.orders.size()) +
               " robots, makespan " + std::string(py::repr(py::float_(s.makespan))) + ")";
      });
  m.def(
      "share_stops",
      [](const ArrayLike& given, const ArrayLike& given_times, int robots) {
        const Eigen::MatrixXd drive_times = matrix_argument(given, "drive_times", -1, detail::kInfinity);
        const std::vector<double> stop_times = list_argument(given_times, "stop_times");
        return interruptible([&] { return share_stops(drive_times, stop_times, robots); });
      },
      py::arg("drive_times"), py::arg("stop_times"), py::arg("robots"),
      "Shares stops among robots so that the last is done as early as can be. `drive_times` is (n + 2 k, n + 2 k): "
      "stops, k starts, k goals; infinite: no way.");

  using W = PairwiseWeights;
  py::class_<W>(m, "PairwiseWeights", "Weights from pairwise comparisons (Saaty's AHP; P2 3.3.2).")
      .def_readonly("weights", &W::weights, "Averages over normalised columns, as P2 takes them; they sum to 1.")
      .def_readonly("eigenvector", &W::eigenvector, "The principal eigenvector, Saaty's own; it sums to 1.")
      .def_readonly("largest_eigenvalue", &W::largest_eigenvalue, "m for a consistent matrix, else more.")
      .def_readonly("consistency_ratio", &W::consistency_ratio, "Saaty's consistency ratio; 0: fully consistent.")
      .def("__repr__", [](const W& w) {
        return "PairwiseWeights(" + text(w.weights) + ", consistency ratio " +
               std::string(py::repr(py::float_(w.consistency_ratio))) + ")";
      });
  m.def(
      "pairwise_weights",
      [](const ArrayLike& comparison, const Given<double>& most) {
        return pairwise_weights(matrix_argument(comparison, "comparison", -1, kLargestNumber),
                                taken(most, "max_consistency_ratio"));
      },
      py::arg("comparison"), py::kw_only(), py::arg("max_consistency_ratio") = 0.1,
      "Weights by Saaty's AHP: `comparison[i, j]` says how much i is preferred to j, and [j, i] is one over it. A ratio"
      "\nabove 10 % is refused, as Saaty advises.");
}

}  // namespace mmgrasp::python
