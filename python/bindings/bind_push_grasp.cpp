#include <cmath>
#include <optional>

#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/grasp/push_grasp.hpp"
#include "push_fields.hpp"

namespace mmgrasp::python {

using namespace py::literals;

const std::vector<OptionField<PushGraspProblem>>& push_fields() {
  using P = PushGraspProblem;
  static const std::vector<OptionField<P>> fields{
      option<P>("opening", &P::opening, "between the fingers before they close [m]"),
      option<P>("closing_speed", &P::closing_speed, "how fast the opening shrinks [m/s]"),
      option<P>("tool_speed", &P::tool_speed, "along the approach [m/s]"),
      option<P>("finger_length", &P::finger_length, "from the palm to the tips [m]"),
      option<P>("object_width", &P::object_width, "along the closing direction [m]"),
      option<P>("grip_depth", &P::grip_depth, "least engagement that holds [m]"),
      option<P>("planned_depth", &P::planned_depth, "engagement at the planned grasp pose [m]"),
      option<P>("clearance", &P::clearance, "kept on either side while the fingers pass the object [m]"),
      option<P>("max_push", &P::max_push, "how far the object may slide before the palm [m]"),
      option<P>("along_error", &P::along_error, "the object may stand this much nearer or farther [m]"),
      option<P>("lateral_error", &P::lateral_error, "and this much to either side [m]"),
      option<P>("along_deviation", &P::along_deviation,
                "standard deviation of the object's position along the approach [m]"),
      option<P>("lateral_deviation", &P::lateral_deviation, "the same along the closing direction [m]"),
      option<P>("sigmas", &P::sigmas, "errors of this many deviations are covered")};
  return fields;
}

py::dict outcome_dict(const ClosingOutcome& o) {
  return py::dict("start"_a = o.start, "both_touch"_a = o.both_touch, "pushed"_a = o.pushed, "swept"_a = o.swept,
                  "side_clearance"_a = o.side_clearance, "holds"_a = o.holds,
                  "lateral_tolerance"_a = o.lateral_tolerance, "nearer_tolerance"_a = o.nearer_tolerance,
                  "farther_tolerance"_a = o.farther_tolerance,
                  "covered_sigmas"_a = std::isfinite(o.covered_sigmas) ? py::object(py::float_(o.covered_sigmas))
                                                                       : py::object(py::none()),
                  "probability"_a = o.probability);
}

namespace {

std::string number_repr(double value) {
  return std::string(py::repr(py::float_(value)));
}

}  // namespace

void bind_push_grasp(py::module_& m) {
  using O = ClosingOutcome;
  using G = PushGrasp;
  py::class_<O>(
      m, "ClosingOutcome",
      "What one moment to begin closing comes to. Engagement: how far the finger tips are beyond the object's "
      "near face.")
      .def_readonly("start", &O::start, "Engagement at which closing begins [m].")
      .def_readonly("both_touch", &O::both_touch, "The same when both fingers touch, were the object not pushed [m].")
      .def_readonly("pushed", &O::pushed, "How far the object slides before the palm [m].")
      .def_readonly("swept", &O::swept, "How far the tool goes beyond the planned grasp pose [m].")
      .def_readonly("side_clearance", &O::side_clearance,
                    "Free space on either side of a centred object as the tips pass it [m].")
      .def_readonly("holds", &O::holds, "An object standing where planned is held.")
      .def_readonly("lateral_tolerance", &O::lateral_tolerance, "It may stand this far to a side [m]; < 0: none.")
      .def_readonly("nearer_tolerance", &O::nearer_tolerance, "It may stand this much nearer [m].")
      .def_readonly("farther_tolerance", &O::farther_tolerance, "It may stand this much farther [m].")
      .def_readonly("covered_sigmas", &O::covered_sigmas,
                    "Errors of so many standard deviations along and aside together are survived; infinite where these "
                    "are 0, negative where nothing is held.")
      .def_readonly("probability", &O::probability,
                    "That the object is held as planned, its errors independent and normally distributed.")
      .def("to_dict", &outcome_dict, "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const O& o) {
        return "ClosingOutcome(starts at " + number_repr(o.start) + " m, side clearance " +
               number_repr(o.side_clearance) + " m, pushed " + number_repr(o.pushed) +
               (o.holds ? " m, holds)" : " m, does not hold)");
      });
  py::class_<G>(m, "PushGrasp", "Closing windows of a grasp in passing, and both strategies of P1's figure 4.7.")
      .def_readonly("closing_time", &G::closing_time, "[s]")
      .def_readonly("earliest", &G::earliest, "First engagement at which closing may begin [m].")
      .def_readonly("latest", &G::latest, "Last engagement at which closing may begin [m].")
      .def_readonly("feasible", &G::feasible, "There is a moment at which closing may begin.")
      .def_readonly("window", &G::window, "From the first to the last [s].")
      .def_readonly("max_tool_speed", &G::max_tool_speed, "Fastest tool with a window [m/s].")
      .def_readonly("push", &G::push, "Push-grasp: closing begins when the object is between the fingers.")
      .def_readonly("plain", &G::plain, "Closing while moving, so that both fingers touch at the planned pose.")
      .def(
          "to_dict",
          [](const G& g) {
            return py::dict("closing_time"_a = g.closing_time, "earliest"_a = g.earliest, "latest"_a = g.latest,
                            "feasible"_a = g.feasible, "window"_a = g.window, "max_tool_speed"_a = g.max_tool_speed,
                            "push"_a = outcome_dict(g.push), "plain"_a = outcome_dict(g.plain));
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const G& g) {
        return g.feasible ? "PushGrasp(window " + number_repr(g.window) + " s, at most " +
                                number_repr(g.max_tool_speed) + " m/s)"
                          : std::string("PushGrasp(no window)");
      });
  m.def(
      "push_grasp",
      [](const std::optional<Given<Hand>>& hand, const py::kwargs& keywords) {
        PushGraspProblem problem = read_options(push_fields(), keywords, "push_grasp");
        if (hand) {
          const PushGraspProblem own = push_grasp_problem(taken(*hand, "hand"), problem.object_width);
          if (!keywords.contains("opening")) problem.opening = own.opening;
          if (!keywords.contains("finger_length")) problem.finger_length = own.finger_length;
          if (!keywords.contains("grip_depth")) problem.grip_depth = own.grip_depth;
          if (!keywords.contains("planned_depth")) problem.planned_depth = own.planned_depth;
          if (!keywords.contains("clearance")) problem.clearance = own.clearance;
        }
        return push_grasp(problem);
      },
      py::kw_only(), py::arg("hand") = py::none(),
      ("When a hand that moves on may begin to close, and what error of the object's position it forgives (P1 4.3).\n"
       "Lengths are those of `hand` where no keyword gives them." +
       option_help(push_fields()))
          .c_str());
  m.def(
      "closing_outcome",
      [](double start, const py::kwargs& problem) {
        return closing_outcome(read_options(push_fields(), problem, "closing_outcome"), start);
      },
      py::arg("start"),
      ("What beginning to close at an engagement [m] comes to." + option_help(push_fields())).c_str());
  m.def("push_speed_limit", &push_speed_limit, py::kw_only(), py::arg("length"), py::arg("friction"),
        py::arg("restitution"),
        "Fastest tool [m/s] before whose palm a hit object does not leap more than `length` [m].");
  m.def("_push_option_table", [] { return option_table(push_fields()); });
}

}  // namespace mmgrasp::python
