#include "bindings.hpp"
#include "mmgrasp/optim/set_cover.hpp"
#include "mmgrasp/optim/tour.hpp"

namespace mmgrasp::python {

using namespace py::literals;

void bind_optim(py::module_& m) {
  py::class_<SetCoverResult>(m, "SetCoverResult")
      .def_readonly("outcome", &SetCoverResult::outcome, "`solved` only with a proof of optimality.")
      .def_readonly("chosen", &SetCoverResult::chosen, "Indices of the chosen sets, ascending.")
      .def_readonly("cost", &SetCoverResult::cost)
      .def_readonly("lower_bound", &SetCoverResult::lower_bound, "Proven: no cover costs less.")
      .def_readonly("uncoverable", &SetCoverResult::uncoverable, "Elements in no set.")
      .def("to_dict",
           [](const SetCoverResult& r) {
             return py::dict("outcome"_a = to_string(r.outcome), "chosen"_a = r.chosen, "cost"_a = r.cost,
                             "lower_bound"_a = r.lower_bound, "uncoverable"_a = r.uncoverable);
           })
      .def("__repr__", [](const SetCoverResult& r) {
        return std::string("SetCoverResult(") + to_string(r.outcome) +
               ", chosen=" + std::string(py::repr(py::cast(r.chosen))) +
               ", cost=" + std::string(py::repr(py::cast(r.cost))) + ")";
      });
  m.def(
      "solve_set_cover",
      [](int elements, const std::vector<std::vector<int>>& sets, const std::vector<double>& costs, double time_limit,
         const py::object& progress) {
        SetCoverProblem problem{elements, sets, costs};
        problem.check();
        return LongCall(progress).run([&](const Monitor&) { return solve_set_cover(problem, time_limit); });
      },
      py::arg("elements"), py::arg("sets"), py::arg("costs") = std::vector<double>{}, py::kw_only(),
      py::arg("time_limit") = 60.0, py::arg("progress") = py::none(),
      "Fewest (or cheapest) sets that cover all of 0..elements-1, with a proof (P1, equation 3.1).");

  py::class_<TourResult>(m, "TourResult")
      .def_readonly("outcome", &TourResult::outcome)
      .def_readonly("order", &TourResult::order, "Visiting order of the stops.")
      .def_readonly("length", &TourResult::length)
      .def_readonly("proven", &TourResult::proven, "True when exact.")
      .def("to_dict",
           [](const TourResult& r) {
             return py::dict("outcome"_a = to_string(r.outcome), "order"_a = r.order, "length"_a = r.length,
                             "proven"_a = r.proven);
           })
      .def("__repr__", [](const TourResult& r) {
        return std::string("TourResult(") + to_string(r.outcome) +
               ", order=" + std::string(py::repr(py::cast(r.order))) +
               ", length=" + std::string(py::repr(py::cast(r.length))) + ")";
      });
  m.def(
      "shortest_visiting_tour",
      [](const ArrayLike& given) {
        const Eigen::MatrixXd lengths = matrix_argument(given, "lengths", -1, true);
        py::gil_scoped_release release;
        return shortest_visiting_tour(lengths);
      },
      py::arg("lengths"),
      "Shortest way from start over all n stops to goal. `lengths` is (n + 2, n + 2): stops, start, goal; infinite: no "
      "way.");
}

}  // namespace mmgrasp::python
