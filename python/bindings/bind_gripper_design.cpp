// The least set of grippers for an assembly, and grippers as files.
#include <optional>
#include <tuple>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/gripper_design/minimal_grippers.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

const std::vector<OptionField<MinimalGrippersOptions>>& minimal_grippers_fields() {
  using O = MinimalGrippersOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("shortest_finger", &O::shortest_finger, "no finger is shorter [m]"),
      option<O>("longest_finger", &O::longest_finger, "no finger is longer [m]"),
      option<O>("opening_margin", &O::opening_margin, "stroke kept free beyond the part at either end [m]"),
      option<O>("length_margin", &O::length_margin, "kept from either limit of the finger length [m]"),
      option<O>("finger_width", &O::finger_width, "of the grippers returned [m]"),
      option<O>("finger_thickness", &O::finger_thickness, "of the grippers returned [m]"),
      option<O>("change_cost", &O::change_cost, "of changing the gripper between two parts"),
      option<O>("max_nodes", &O::max_nodes, "of the search for fewest changes"),
      option<O>("time_limit", &O::time_limit, "wall-clock cap [s]")};
  return fields;
}

double or_infinite(const std::optional<Given<double>>& value, const char* name) {
  return value ? taken(*value, name) : detail::kInfinity;
}

py::object or_none(double value) {
  return value < detail::kInfinity ? py::object(py::float_(value)) : py::none();
}

std::string shown(double value) {
  return py::cast<std::string>(py::repr(py::float_(value)));
}

SegmentRequirement make_requirement(const Given<std::string>& part, const Given<double>& opening,
                                    const Given<std::string>& segment, const Given<int>& fingers,
                                    const Given<double>& shortest, const std::optional<Given<double>>& longest,
                                    const Given<double>& clearance, const Given<double>& least_closed,
                                    const std::optional<Given<double>>& longest_stroke) {
  const SegmentRequirement requirement{taken(part, "part"),
                                       taken(segment, "segment"),
                                       taken(fingers, "fingers"),
                                       taken(opening, "opening"),
                                       taken(shortest, "min_finger_length"),
                                       or_infinite(longest, "max_finger_length"),
                                       taken(clearance, "clearance"),
                                       taken(least_closed, "least_min_opening"),
                                       or_infinite(longest_stroke, "max_stroke")};
  requirement.check();
  return requirement;
}

GripperActuator make_actuator(const Given<std::string>& name, const Given<double>& stroke, const Given<int>& fingers,
                              const std::optional<Given<double>>& max_opening, const Given<double>& cost) {
  return {taken(name, "name"), taken(fingers, "fingers"), taken(stroke, "stroke"),
          or_infinite(max_opening, "max_opening"), taken(cost, "cost")};
}

void bind_requirement(py::module_& m) {
  using R = SegmentRequirement;
  py::class_<R>(
      m, "SegmentRequirement",
      "What a gripper needs to hold one segment of a part in its operation: {F, W, L-, L+} of P1 5.3.4.\n\n"
      "A part with several graspable segments has several; a gripper that meets one of them takes the part.\n\n"
      "    SegmentRequirement(\"sleeve\", 0.0375, fingers=3, min_finger_length=0.0227)")
      .def(
          py::init(&make_requirement), "part"_a, "opening"_a, py::kw_only(), "segment"_a = "", "fingers"_a = 2,
          "min_finger_length"_a = 0.0, "max_finger_length"_a = py::none(), "clearance"_a = 0.0,
          "least_min_opening"_a = 0.0, "max_stroke"_a = py::none(),
          "Part, opening [m], the segment's label, 2 or 3 fingers, limits of their length [m] (None: no upper one), "
          "how far each finger opens to let go [m], how far the gripper may close [m], the longest stroke of its drive "
          "[m] (None: any).")
      .def_readonly("part", &R::part, "Whose segment it is.")
      .def_readonly("segment", &R::segment, "Its label.")
      .def_readonly("fingers", &R::fingers, "2: parallel jaws; 3: centric fingers.")
      .def_readonly("opening", &R::opening, "Diameter, or distance of the faces in touch [m].")
      .def_readonly("min_finger_length", &R::min_finger_length, "[m]")
      .def_property_readonly(
          "max_finger_length", [](const R& r) { return OptionalNumber(or_none(r.max_finger_length)); },
          "[m]; None: any.")
      .def_readonly("clearance", &R::clearance,
                    "Each finger opens by this to let go: twice as much is kept free above the opening [m].")
      .def_readonly("least_min_opening", &R::least_min_opening,
                    "The gripper's smallest opening is no less [m]: centric fingers that close farther have pads too "
                    "narrow to hold it.")
      .def_property_readonly(
          "max_stroke", [](const R& r) { return OptionalNumber(or_none(r.max_stroke)); },
          "The drive's stroke is no more [m]: a longer one has a wider palm, or opens farther to let go; None: any.")
      .def("__repr__", [](const R& r) {
        return "SegmentRequirement(" + r.name() + ", " + std::to_string(r.fingers) + " fingers, opening " +
               shown(r.opening) + ")";
      });
}

void bind_gripper(py::module_& m) {
  using G = Gripper;
  py::class_<G>(m, "Gripper",
                "A gripper with straight fingers on a drive: two parallel jaws or three centric fingers (P1 5.2.1).\n\n"
                "The base frame lies on the mounting face with z towards the tips; the first finger moves along x. The "
                "tool frame lies on z, half a pad before the tips.\n\n"
                "    gripper = Gripper(fingers=3, min_opening=0.014, max_opening=0.022, finger_length=0.03)\n"
                "    gripper.to_urdf(\"grippers/centric_22\")")
      .def(py::init([](const Given<std::string>& name, const Given<std::string>& actuator, const Given<int>& fingers,
                       const Given<double>& min_opening, const Given<double>& max_opening, const Given<double>& length,
                       const Given<double>& width, const Given<double>& thickness, const Given<double>& palm_height,
                       const Given<double>& max_force, const Given<double>& max_speed) {
             const G gripper{taken(name, "name"),
                             taken(actuator, "actuator"),
                             taken(fingers, "fingers"),
                             taken(min_opening, "min_opening"),
                             taken(max_opening, "max_opening"),
                             taken(length, "finger_length"),
                             taken(width, "finger_width"),
                             taken(thickness, "finger_thickness"),
                             taken(palm_height, "palm_height"),
                             taken(max_force, "max_force"),
                             taken(max_speed, "max_speed")};
             gripper.check();
             return gripper;
           }),
           py::kw_only(), "name"_a = G{}.name, "actuator"_a = G{}.actuator, "fingers"_a = G{}.fingers,
           "min_opening"_a = G{}.min_opening, "max_opening"_a = G{}.max_opening, "finger_length"_a = G{}.finger_length,
           "finger_width"_a = G{}.finger_width, "finger_thickness"_a = G{}.finger_thickness,
           "palm_height"_a = G{}.palm_height, "max_force"_a = G{}.max_force, "max_speed"_a = G{}.max_speed,
           "Lengths in m, force of each finger in N, its speed in m/s.")
      .def_readonly("name", &G::name, "Name of its URDF.")
      .def_readonly("actuator", &G::actuator, "Name of the drive, or ''.")
      .def_readonly("fingers", &G::fingers, "2 or 3.")
      .def_readonly("min_opening", &G::min_opening, "Between the pads, or the diameter that three of them touch [m].")
      .def_readonly("max_opening", &G::max_opening, "[m]")
      .def_readonly("finger_length", &G::finger_length, "From the palm to the tips [m].")
      .def_readonly("finger_width", &G::finger_width, "Across approach and closing direction [m].")
      .def_readonly("finger_thickness", &G::finger_thickness, "Along the closing direction [m].")
      .def_readonly("palm_height", &G::palm_height, "From the mounting face to the palm [m].")
      .def_readonly("max_force", &G::max_force, "Largest force of each finger's joint [N].")
      .def_readonly("max_speed", &G::max_speed, "Largest speed of each finger's joint [m/s].")
      .def_property_readonly("pad_length", &G::pad_length, "Length of the pad along the approach [m].")
      .def_property_readonly(
          "pad_width", &G::pad_width,
          "Width of the pad across the approach: the finger's, or what three fingers that close leave of it [m].")
      .def_property_readonly("palm_radius", &G::palm_radius,
                             "Radius of the palm, a cylinder that covers the fingers while they are open [m].")
      .def(
          "holds", [](const G& g, const Given<SegmentRequirement>& r) { return g.holds(taken(r, "requirement")); },
          "requirement"_a,
          "Whether it holds a segment: (5.2) of P1 with <= in place of <, to 1e-9 m, and closes no farther than it "
          "allows.")
      .def(
          "hand", &G::hand,
          "The Hand that it is, for planners and samplers: tool frame \"tool\", names as to_urdf() writes them. Of two "
          "fingers only (InvalidInput): a Hand has pads that stand opposite each other. Mounted under a prefix, read "
          "it "
          "by Hand.from_robot().")
      .def(
          "finger_mesh", [](const G& g) { return MeshShape{g.finger_mesh()}; },
          "One finger to print: closed, convex, on the palm at z = 0, its pad in the plane x = 0 [m].")
      .def(
          "to_urdf", [](const G& g, const PathLike& folder) { g.to_urdf(path_argument(folder, "folder")); }, "folder"_a,
          "Writes gripper.urdf, gripper.srdf (group \"fingers\", states open and closed) and finger.stl (millimetres) "
          "into a "
          "folder, which is made where it is missing. IoError names the file that cannot be written.")
      .def(
          "to_dict",
          [](const G& g) {
            return py::dict("name"_a = g.name, "actuator"_a = g.actuator, "fingers"_a = g.fingers,
                            "min_opening"_a = g.min_opening, "max_opening"_a = g.max_opening,
                            "finger_length"_a = g.finger_length, "finger_width"_a = g.finger_width,
                            "finger_thickness"_a = g.finger_thickness, "palm_height"_a = g.palm_height,
                            "max_force"_a = g.max_force, "max_speed"_a = g.max_speed);
          },
          "All fields by name.")
      .def("__repr__", [](const G& g) {
        return "Gripper(" + g.name + ", " + std::to_string(g.fingers) + " fingers, opening " + shown(g.min_opening) +
               " to " + shown(g.max_opening) + " m, fingers " + shown(g.finger_length) + " m)";
      });
}

void bind_actuator(py::module_& m) {
  using A = GripperActuator;
  py::class_<A>(m, "GripperActuator",
                "A drive that fingers can be mounted on, e.g. an air chuck. Its stroke is fixed, where the opening "
                "begins is free.\n\n    GripperActuator(\"SMC MHSL3-32D\", 0.008, fingers=3)")
      .def(py::init(&make_actuator), "name"_a, "stroke"_a, py::kw_only(), "fingers"_a = 2, "max_opening"_a = py::none(),
           "cost"_a = 1.0, "Name, stroke [m], 2 or 3 fingers, widest opening [m] (None: any), cost of a gripper.")
      .def_readonly("name", &A::name, "As given.")
      .def_readonly("stroke", &A::stroke, "Largest less smallest opening [m].")
      .def_readonly("fingers", &A::fingers, "2 or 3.")
      .def_property_readonly(
          "max_opening", [](const A& a) { return OptionalNumber(or_none(a.max_opening)); },
          "As wide as fingers can be mounted [m]; None: any.")
      .def_readonly("cost", &A::cost, "Cost of a gripper with this drive.")
      .def("__repr__", [](const A& a) {
        return "GripperActuator(" + a.name + ", " + std::to_string(a.fingers) + " fingers, stroke " + shown(a.stroke) +
               ")";
      });
}

py::dict result_dict(const MinimalGrippersResult& r) {
  py::list grippers;
  for (const Gripper& g : r.grippers) grippers.append(py::cast(g).attr("to_dict")());
  return py::dict("outcome"_a = to_string(r.outcome), "grippers"_a = grippers, "parts"_a = r.parts,
                  "gripper_of_part"_a = r.gripper_of_part, "requirement_of_part"_a = r.requirement_of_part,
                  "cost"_a = r.cost, "lower_bound"_a = r.lower_bound, "changes"_a = r.changes,
                  "changes_bound"_a = r.changes_bound, "preference_finished"_a = r.preference_finished,
                  "candidates"_a = r.candidates, "uncovered"_a = r.uncovered, "explanations"_a = r.explanations);
}

void bind_result(py::module_& m) {
  using R = MinimalGrippersResult;
  py::class_<R>(m, "MinimalGrippersResult", "What minimal_grippers found: the set, and which gripper takes which part.")
      .def_readonly("outcome", &R::outcome,
                    "`solved`: proven in cost and changes; `approximate`: the bounds say what is proven; `infeasible`: "
                    "see explanations; `stopped`.")
      .def_readonly("grippers", &R::grippers, "The grippers in the order of first use.")
      .def_readonly("parts", &R::parts, "Names of the parts in the order of assembly.")
      .def_readonly("gripper_of_part", &R::gripper_of_part, "Index into grippers, one per part.")
      .def_readonly("requirement_of_part", &R::requirement_of_part, "Index into the requirements, one per part.")
      .def_readonly("cost", &R::cost, "Cost of the grippers and of the changes.")
      .def_readonly("lower_bound", &R::lower_bound, "Proven: no set of grippers costs less.")
      .def_readonly("changes", &R::changes, "How often the gripper changes from part to part.")
      .def_readonly("changes_bound", &R::changes_bound, "Proven: no set of the same cost needs fewer.")
      .def_readonly("preference_finished", &R::preference_finished,
                    "What preferred_grippers set out for: for every better segment of a part it is decided whether the "
                    "set stays as "
                    "good with it. False: max_nodes or the time limit ended first.")
      .def_readonly("candidates", &R::candidates, "Grippers chosen among, none doing only what another does.")
      .def_readonly("uncovered", &R::uncovered, "Parts that no gripper takes.")
      .def_readonly("explanations", &R::explanations, "One per uncovered part.")
      .def("to_dict", &result_dict, "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const R& r) {
        if (!r.uncovered.empty()) return "MinimalGrippersResult(infeasible: " + r.explanations.front() + ")";
        return std::string("MinimalGrippersResult(") + to_string(r.outcome) + ", " + std::to_string(r.grippers.size()) +
               " grippers, " + std::to_string(r.changes) + " changes)";
      });
}

std::pair<int, int> grid_argument(const py::object& grid) {
  if (grid.is_none()) return {0, 0};
  if (!py::isinstance<py::sequence>(grid) || py::len(grid) != 2)
    refuse_value("grid", grid, "None or two whole numbers");
  const py::sequence pair(grid);
  int n = 0, m = 0;
  convert(pair[0], "grid[0]", n);
  convert(pair[1], "grid[1]", m);
  if (n < 1 || m < 1) refuse_value("grid", grid, "two positive whole numbers");
  return {n, m};
}

constexpr char kGrid[] = "tuple[int, int] | None";

}  // namespace

void bind_gripper_design(py::module_& m) {
  bind_requirement(m);
  bind_gripper(m);
  bind_actuator(m);
  bind_result(m);
  m.def("_minimal_grippers_option_table", [] { return option_table(minimal_grippers_fields()); });
  m.def(
      "minimal_grippers",
      [](const Given<std::vector<SegmentRequirement>>& requirements,
         const Given<std::vector<GripperActuator>>& actuators, const Shown<kGrid>& grid, const Progress& progress,
         const py::kwargs& keywords) {
        MinimalGrippersOptions options = read_options(minimal_grippers_fields(), keywords, "minimal_grippers");
        std::tie(options.grid_openings, options.grid_lengths) = grid_argument(grid);
        const auto asked = taken(requirements, "requirements", "SegmentRequirement");
        const auto drives = taken(actuators, "actuators", "GripperActuator");
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return minimal_grippers(asked, drives, options, monitor); });
      },
      "requirements"_a, "actuators"_a, py::kw_only(), "grid"_a = py::none(), "progress"_a = py::none(),
      ("The least set of grippers that takes every part of an assembly, and which one takes which part by which "
       "segment (P1 5.3.4, (5.1) and (5.2) with <=). Parts are assembled in the order in which the requirements first "
       "name them; of all cheapest sets one with the fewest changes of the gripper is taken. Proven over all grippers; "
       "with `grid=(n, m)` only over P1's n openings and m finger lengths." +
       option_help(minimal_grippers_fields()))
          .c_str());
  m.def(
      "preferred_grippers",
      [](const Given<std::vector<SegmentRequirement>>& requirements, const ArrayLike& values,
         const Given<std::vector<GripperActuator>>& actuators, const Progress& progress, const py::kwargs& keywords) {
        const MinimalGrippersOptions options = read_options(minimal_grippers_fields(), keywords, "preferred_grippers");
        const auto asked = taken(requirements, "requirements", "SegmentRequirement");
        const auto drives = taken(actuators, "actuators", "GripperActuator");
        const Eigen::VectorXd given =
            vector_argument(values, "values", static_cast<Eigen::Index>(asked.size()), kLargestNumber);
        const std::vector<double> worth(given.begin(), given.end());
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return preferred_grippers(asked, worth, drives, options, monitor); });
      },
      "requirements"_a, "values"_a, "actuators"_a, py::kw_only(), "progress"_a = py::none(),
      ("A set of no higher cost and no more changes than minimal_grippers' that takes each part by its best segment, "
       "as "
       "far as one does: parts in the order of assembly, of each the requirements by `values` (one per requirement), "
       "highest first." +
       option_help(minimal_grippers_fields()))
          .c_str());
}

}  // namespace mmgrasp::python
