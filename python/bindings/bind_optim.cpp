#include "bindings.hpp"
#include "mmgrasp/optim/assignment.hpp"
#include "mmgrasp/optim/set_cover.hpp"
#include "mmgrasp/optim/shared_tours.hpp"
#include "mmgrasp/optim/tour.hpp"

namespace mmgrasp::python {

using namespace py::literals;

void bind_optim(py::module_& m) {
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
      [](int elements, const std::vector<std::vector<int>>& sets, const std::vector<double>& costs, double time_limit,
         const Progress& progress) {
        SetCoverProblem problem{elements, sets, costs};
        problem.check();
        return LongCall(progress).run([&](const Monitor&) { return solve_set_cover(problem, time_limit); });
      },
      py::arg("elements"), py::arg("sets"), py::arg("costs") = std::vector<double>{}, py::kw_only(),
      py::arg("time_limit") = 60.0, py::arg("progress") = py::none(),
      "Fewest (or cheapest) sets that cover all of 0..elements-1, with a proof (P1, equation 3.1).");

  py::class_<TourResult>(m, "TourResult", "What shortest_visiting_tour found.")
      .def_readonly("outcome", &TourResult::outcome, "`solved` with a proof of the shortest, `approximate` without.")
      .def_readonly("order", &TourResult::order, "Visiting order of the stops.")
      .def_readonly("length", &TourResult::length, "Of the tour from start over all stops to the goal.")
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
        const Eigen::MatrixXd lengths = matrix_argument(given, "lengths", -1, true);
        py::gil_scoped_release release;
        return shortest_visiting_tour(lengths);
      },
      py::arg("lengths"),
      "Shortest way from start over all n stops to goal. `lengths` is (n + 2, n + 2): stops, start, goal; infinite: no "
      "way.");

  m.def(
      "cheapest_assignment",
      [](const ArrayLike& given) {
        const Eigen::MatrixXd costs = matrix_argument(given, "costs");
        py::gil_scoped_release release;
        return cheapest_assignment(costs);
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
      [](const ArrayLike& given, const std::vector<double>& stop_times, int robots) {
        const Eigen::MatrixXd drive_times = matrix_argument(given, "drive_times", -1, true);
        py::gil_scoped_release release;
        return share_stops(drive_times, stop_times, robots);
      },
      py::arg("drive_times"), py::arg("stop_times"), py::arg("robots"),
      "Shares stops among robots so that the last is done as early as can be. `drive_times` is (n + 2 k, n + 2 k): "
      "stops, k starts, k goals; infinite: no way.");
}

}  // namespace mmgrasp::python
