#include "any_numbers.hpp"
#include "bindings.hpp"
#include "drive_by_arguments.hpp"
#include "given.hpp"
#include "mmgrasp/optim/nlp_solver.hpp"
#include "mmgrasp/task/drive_by.hpp"
#include "mmgrasp/trajopt/whole_body_program.hpp"

namespace mmgrasp::python {

using namespace py::literals;
namespace {

constexpr char kVectors[] = "tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]";
using Vectors = Shown<kVectors>;
constexpr char kPlaces[] = "tuple[numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32]]";
using Places = Shown<kPlaces>;
constexpr char kMaybeProblem[] = "mmgrasp._core.NonlinearProblem | None";
using MaybeProblem = Shown<kMaybeProblem>;
constexpr char kMaybeProgram[] = "mmgrasp._core.WholeBodyProgram | None";
using MaybeProgram = Shown<kMaybeProgram>;

py::tuple pair(const py::object& value, const std::string& name) {
  if (!py::isinstance<py::sequence>(value) || py::len(value) != 2) throw InvalidInput(name + ": must be two arrays");
  return py::tuple(value);
}
auto as_bounds(const char* name) {
  return [name](const py::object& value) {
    const py::tuple two = pair(value, name);
    const Eigen::VectorXd lower = any_numbers(two[0], name, -1);
    return Bounds{lower, any_numbers(two[1], name, lower.size())};
  };
}
auto as_pattern(const char* name) {
  return [name](const py::object& value) {
    const py::tuple two = pair(value, name);
    const Eigen::VectorXd rows = any_numbers(two[0], name, -1), columns = any_numbers(two[1], name, rows.size());
    SparsePattern pattern;
    for (Eigen::Index i = 0; i < rows.size(); ++i) {
      for (const double place : {rows[i], columns[i]})
        if (!(place >= 0 && place < 1e9 && place == std::floor(place)))
          throw InvalidInput(std::string(name) + ": must hold whole numbers of at least 0");
      pattern.add(static_cast<int>(rows[i]), static_cast<int>(columns[i]));
    }
    return pattern;
  };
}

/// An array argument whose type does not forbid that a method which overrides this one takes arrays alone.
constexpr char kFloats[] = "numpy.typing.NDArray[numpy.float64]";
using Floats = Shown<kFloats>;

/// A problem whose methods a Python class overrides; those that it leaves out are its base's.
class PythonProblem : public NonlinearProblem {
 public:
  explicit PythonProblem(std::shared_ptr<NonlinearProblem> base) : base_(std::move(base)) {}
  const std::shared_ptr<NonlinearProblem>& base() const { return base_; }

  Bounds variable_bounds() const override {
    return call(
        "variable_bounds", [&] { return base_->variable_bounds(); }, as_bounds("variable_bounds()"));
  }
  Bounds constraint_bounds() const override {
    return call(
        "constraint_bounds", [&] { return base_->constraint_bounds(); }, as_bounds("constraint_bounds()"));
  }
  double objective(const Eigen::VectorXd& x) override {
    return call(
        "objective", [&] { return base_->objective(x); },
        [](const py::object& value) {
          const Eigen::VectorXd number = any_numbers(py::make_tuple(value), "objective(x)", 1);
          return number[0];
        },
        x);
  }
  void gradient(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> out) override {
    fill(
        "gradient", out, [&] { base_->gradient(x, out); }, x);
  }
  void constraints(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> out) override {
    fill(
        "constraints", out, [&] { base_->constraints(x, out); }, x);
  }
  const SparsePattern& jacobian_pattern() const override {
    return jacobian_ = call(
               "jacobian_pattern", [&] { return base_->jacobian_pattern(); }, as_pattern("jacobian_pattern()"));
  }
  void jacobian(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> values) override {
    fill(
        "jacobian", values, [&] { base_->jacobian(x, values); }, x);
  }
  const SparsePattern& hessian_pattern() const override {
    return hessian_ = call(
               "hessian_pattern", [&] { return base_->hessian_pattern(); }, as_pattern("hessian_pattern()"));
  }
  void hessian(const Eigen::VectorXd& x, double factor, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::VectorXd> values) override {
    fill(
        "hessian", values, [&] { base_->hessian(x, factor, multipliers, values); }, x, factor, multipliers);
  }
  std::string variable_name(int index) const override { return name("variable_name", index, true); }
  std::string constraint_name(int index) const override { return name("constraint_name", index, false); }

 private:
  template <typename OfBase, typename Convert, typename... Arguments>
  auto call(const char* method, OfBase&& of_base, Convert&& convert, const Arguments&... arguments) const
      -> decltype(of_base()) {
    const py::gil_scoped_acquire gil;
    if (const py::function own = py::get_override(static_cast<const NonlinearProblem*>(this), method))
      return convert(own(arguments...));
    if (!base_) throw InvalidInput(std::string("NonlinearProblem: has neither a method ") + method + " nor a base");
    return of_base();
  }
  template <typename OfBase, typename... Arguments>
  void fill(const char* method, Eigen::Ref<Eigen::VectorXd> out, OfBase&& of_base, const Arguments&... arguments) {
    const auto by_base = [&] {
      of_base();
      return true;
    };
    const auto take = [&](const py::object& value) {
      out = any_numbers(value, std::string(method) + "(x)", out.size());
      return true;
    };
    call(method, by_base, take, arguments...);
  }
  std::string name(const char* method, int index, bool variable) const {
    const auto by_base = [&] {
      return variable ? base_ ? base_->variable_name(index) : NonlinearProblem::variable_name(index)
             : base_ ? base_->constraint_name(index)
                      : NonlinearProblem::constraint_name(index);
    };
    const py::gil_scoped_acquire gil;
    const py::function own = py::get_override(static_cast<const NonlinearProblem*>(this), method);
    return own ? std::string(py::str(own(index))) : by_base();
  }
  std::shared_ptr<NonlinearProblem> base_;
  mutable SparsePattern jacobian_, hessian_;
};

Vectors shown(const Bounds& bounds) {
  return py::make_tuple(bounds.lower, bounds.upper);
}

Places shown(const SparsePattern& pattern) {
  const py::ssize_t n = static_cast<py::ssize_t>(pattern.size());
  return py::make_tuple(py::array_t<int>(n, pattern.rows.data()), py::array_t<int>(n, pattern.columns.data()));
}

Eigen::VectorXd variables(const NonlinearProblem& problem, const Floats& x) {
  return vector_argument(x, "x", problem.variable_bounds().lower.size(), kLargestNumber);
}

std::shared_ptr<NonlinearProblem> shared_problem(const py::object& value, const char* name) {
  if (!py::isinstance<NonlinearProblem>(value)) refuse_value(name, value, "a NonlinearProblem");
  return py::cast<std::shared_ptr<NonlinearProblem>>(value);
}

/// Throws InvalidInput for an index that is none.
int index_argument(const Given<int>& index, Eigen::Index size) {
  const int value = taken(index, "index");
  if (value < 0 || value >= size)
    throw InvalidInput("index = " + std::to_string(value) + ": must be in [0, " + std::to_string(size) + ")");
  return value;
}

void bind_problem(py::module_& m) {
  using P = NonlinearProblem;
  py::class_<P, PythonProblem, std::shared_ptr<P>>(
      m, "NonlinearProblem",
      "min f(x) for lower <= x <= upper and lower <= c(x) <= upper, twice differentiable, on sparse matrices. Derive "
      "from it and\n"
      "give its methods; with a `base`, e.g. the problem of a plan, those that are left out are the base's:\n"
      "\n"
      "    class Rosenbrock(mg.optim.NonlinearProblem):\n"
      "        def variable_bounds(self): return np.full(2, -np.inf), np.full(2, np.inf)\n"
      "        def constraint_bounds(self): return np.zeros(0), np.zeros(0)\n"
      "        def objective(self, x): return 100 * (x[1] - x[0] ** 2) ** 2 + (1 - x[0]) ** 2\n"
      "        def gradient(self, x):\n"
      "            return [400 * x[0] * (x[0] ** 2 - x[1]) - 2 * (1 - x[0]), 200 * (x[1] - x[0] ** 2)]\n"
      "        def constraints(self, x): return []\n"
      "        def jacobian_pattern(self): return [], []\n"
      "        def jacobian(self, x): return []\n"
      "        def hessian_pattern(self): return [0, 1, 1], [0, 0, 1]\n"
      "        def hessian(self, x, factor, multipliers):\n"
      "            return factor * np.array([1200 * x[0] ** 2 - 400 * x[1] + 2, -400 * x[0], 200])\n"
      "    print(mg.optim.solve_nonlinear(Rosenbrock(), [-1.2, 1]).x)\n"
      "\n"
      "Not thread-safe: one solve at a time for each problem.")
      .def(py::init([](const MaybeProblem& base) {
             return std::make_shared<PythonProblem>(base.is_none() ? nullptr : shared_problem(base, "base"));
           }),
           py::arg("base") = py::none(), py::keep_alive<1, 2>(), "A problem of one's own, on top of `base` or on none.")
      .def_property_readonly(
          "base",
          [](const P& p) -> MaybeProblem {
            const auto* own = dynamic_cast<const PythonProblem*>(&p);
            return own && own->base() ? py::cast(own->base()) : py::none();
          },
          "The problem beneath, or None.")
      .def(
          "variable_bounds", [](const P& p) { return shown(p.variable_bounds()); },
          "Lower and upper (n,); infinite where there is none, equal where a value is prescribed.")
      .def(
          "constraint_bounds", [](const P& p) { return shown(p.constraint_bounds()); },
          "Lower and upper (m,); equal for an equation.")
      .def(
          "objective", [](P& p, const Floats& x) { return p.objective(variables(p, x)); }, py::arg("x"), "f(x)")
      .def(
          "gradient",
          [](P& p, const Floats& x) {
            const Eigen::VectorXd at = variables(p, x);
            Eigen::VectorXd out(at.size());
            p.gradient(at, out);
            return out;
          },
          py::arg("x"), "(n,) of f")
      .def(
          "constraints",
          [](P& p, const Floats& x) {
            const Eigen::VectorXd at = variables(p, x);
            Eigen::VectorXd out(p.constraint_bounds().lower.size());
            p.constraints(at, out);
            return out;
          },
          py::arg("x"), "c(x), (m,)")
      .def(
          "jacobian_pattern", [](const P& p) { return shown(p.jacobian_pattern()); },
          "Rows (constraints) and columns (variables) of the Jacobian's entries, in the order of `jacobian`; entries "
          "that repeat add up.")
      .def(
          "jacobian",
          [](P& p, const Floats& x) {
            const Eigen::VectorXd at = variables(p, x);
            Eigen::VectorXd out(static_cast<Eigen::Index>(p.jacobian_pattern().size()));
            p.jacobian(at, out);
            return out;
          },
          py::arg("x"), "Values of the Jacobian's entries.")
      .def(
          "hessian_pattern", [](const P& p) { return shown(p.hessian_pattern()); },
          "Rows and columns (row >= column) of the Hessian's entries, in the order of `hessian`; entries that repeat "
          "add up.")
      .def(
          "hessian",
          [](P& p, const Floats& x, double factor, const Floats& multipliers) {
            const Eigen::VectorXd at = variables(p, x);
            const Eigen::VectorXd of_rows =
                vector_argument(multipliers, "multipliers", p.constraint_bounds().lower.size(), kLargestNumber);
            Eigen::VectorXd out(static_cast<Eigen::Index>(p.hessian_pattern().size()));
            p.hessian(at, factor, of_rows, out);
            return out;
          },
          py::arg("x"), py::arg("factor"), py::arg("multipliers"),
          "Values of the lower triangle of factor * f'' + sum_i multipliers[i] * c_i''.")
      .def(
          "variable_name",
          [](const P& p, const Given<int>& index) {
            return p.variable_name(index_argument(index, p.variable_bounds().lower.size()));
          },
          py::arg("index"), "What messages call a variable.")
      .def(
          "constraint_name",
          [](const P& p, const Given<int>& index) {
            return p.constraint_name(index_argument(index, p.constraint_bounds().lower.size()));
          },
          py::arg("index"), "What messages call a constraint.");
}

const std::vector<OptionField<NlpOptions>>& nlp_fields() {
  using O = NlpOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("tolerance", &O::tolerance, "relative optimality"),
      option<O>("constraint_tolerance", &O::constraint_tolerance, "largest violation of a solved problem"),
      option<O>("max_iterations", &O::max_iterations, "budget in iterations (ipopt) or evaluations (slsqp)"),
      option<O>("time_limit", &O::time_limit, "wall-clock cap [s]"),
      option<O>("barrier", &O::barrier, "ipopt: the first barrier parameter, lowered steadily; 0: chosen in each step"),
      option<O>("warm_start", &O::warm_start,
                "ipopt: 0 starts afresh; else the guess is trusted and the barrier parameter begins with this")};
  return fields;
}

void bind_solver(py::module_& m) {
  using R = NlpResult;
  py::class_<R>(m, "NlpResult", "Where solve_nonlinear ended.")
      .def_readonly("outcome", &R::outcome,
                    "`solved`: locally optimal, every constraint kept; `approximate`: constraints kept, optimality not "
                    "shown;\n`not_found`: constraints are broken; `timeout`: iterations or clock.")
      .def_readonly("x", &R::x, "The answer or, not solved, the best iterate: the least violated, then the cheapest.")
      .def_readonly("objective", &R::objective, "f(x)")
      .def_property_readonly(
          "violation", [](const R& r) { return r.violated.largest(); },
          "How far the worst variable or constraint is outside its bounds; 0 where all hold.")
      .def_readonly("iterations", &R::iterations, "Iterations of Ipopt, or evaluations of SLSQP.")
      .def_readonly("seconds", &R::seconds, "Wall-clock time [s].")
      .def_readonly("message", &R::message, "How the solver itself put it.")
      .def(
          "to_dict",
          [](const R& r) {
            return py::dict("outcome"_a = to_string(r.outcome), "x"_a = py::cast(r.x).attr("tolist")(),
                            "objective"_a = r.objective, "violation"_a = r.violated.largest(),
                            "iterations"_a = r.iterations, "seconds"_a = r.seconds, "message"_a = r.message);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const R& r) {
        return std::string("NlpResult(") + to_string(r.outcome) +
               ", objective=" + std::string(py::repr(py::float_(r.objective))) + ", " + std::to_string(r.iterations) +
               " iterations)";
      });
  m.def(
      "solve_nonlinear",
      [](const Given<NonlinearProblem>& problem, const ArrayLike& given_guess, const std::string& solver,
         const Progress& progress, const py::kwargs& options) {
        const NlpOptions read = read_options(nlp_fields(), options, "solve_nonlinear");
        const std::shared_ptr<NonlinearProblem> to_solve = shared_problem(problem, "problem");
        const Eigen::VectorXd guess =
            vector_argument(given_guess, "guess", to_solve->variable_bounds().lower.size(), kLargestNumber);
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return solve_nonlinear(solver, *to_solve, guess, read, monitor); });
      },
      py::arg("problem"), py::arg("guess"), py::kw_only(), py::arg("solver") = "ipopt",
      py::arg("progress") = py::none(),
      ("A local optimum of a NonlinearProblem near `guess` (n,), which may lie outside the bounds. `solver`: a name of "
       "nlp_solver_names.\nWhat a method of the problem raises ends the solve and is raised here." +
       option_help(nlp_fields()))
          .c_str());
}

void bind_program(py::module_& m) {
  using P = WholeBodyProgram;
  py::class_<P>(m, "WholeBodyProgram",
                "The nonlinear problem of a drive-by: fastest motion through the tasks, nothing in the way (P1 4.1 to "
                "4.9). Variables are\n"
                "positions and drive velocities of the waypoints, drive accelerations between them and a time step for "
                "each segment.")
      .def_property_readonly("problem", &P::nonlinear, "To solve, or the base of a problem of one's own.")
      .def_property_readonly("guess", &P::guess, "(n,): where plan_drive_by begins.")
      .def_property_readonly("positions", &P::positions, "(waypoints, columns): which variables are configurations.")
      .def_property_readonly("velocities", &P::velocities, "(waypoints, drives): which are drive velocities.")
      .def_property_readonly("accelerations", &P::accelerations, "(intervals, drives): which are drive accelerations.")
      .def_property_readonly("steps", &P::steps, "(segments,): which are time steps.")
      .def(
          "trajectory",
          [](const P& p, const ArrayLike& x) {
            return std::make_shared<WholeBodyTrajectory>(p.trajectory(vector_argument(x, "x", p.guess().size())));
          },
          py::arg("x"), "The motion that (n,) numbers stand for.")
      .def(
          "violations",
          [](const P& p, const ArrayLike& x) {
            return violations_dict(p.violations(vector_argument(x, "x", p.guess().size())));
          },
          py::arg("x"),
          "As DriveByResult.violations: what that motion breaks on a roll-out ten times finer than the waypoints, but "
          "for constraints\nof one's own.");
  m.def(
      "drive_by_program",
      [](const JointGroup& group, const ArrayLike& start, const std::vector<DriveByTask>& tasks, const ArrayLike& goal,
         const Given<int>& waypoints, const Given<double>& smoothing) -> MaybeProgram {
        DriveByOptions options;
        options.waypoints = taken(waypoints, "waypoints");
        const Eigen::VectorXd from = vector_argument(start, "start", group.size());
        options.trajectory.smoothing = taken(smoothing, "smoothing");
        auto made = drive_by_program(group, from, tasks, goal_argument(goal, group.size()), options);
        return made ? py::cast(std::move(*made)) : py::none();
      },
      py::arg("group"), py::kw_only(), py::arg("start"), py::arg("tasks"), py::arg("goal"), py::arg("waypoints") = 35,
      py::arg("smoothing") = WholeBodyOptions().smoothing,
      "The nonlinear problem from which plan_drive_by begins, with its guess, obstacles left out; None when a task is "
      "out of reach.\n`smoothing` weighs the mean square of accelerations over their limits [s].");
}

}  // namespace

void bind_nonlinear(py::module_& m) {
  bind_problem(m);
  bind_solver(m);
  bind_program(m);
}

}  // namespace mmgrasp::python
