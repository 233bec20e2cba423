#include <optional>
#include <variant>

#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/structure/pipe.hpp"
#include "mmgrasp/structure/pipe_grasps.hpp"

namespace mmgrasp::python {
namespace {

constexpr char kNodePairs[] = "list[tuple[int, int]]";
using NodePairs = Shown<kNodePairs>;

using namespace py::literals;

const std::vector<OptionField<PipeGraspOptions>>& pipe_grasp_fields() {
  using O = PipeGraspOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("max_opening", &O::max_opening, "thicker sections get no grasps [m]"),
      option<O>("end_margin", &O::end_margin, "kept from either node of a section [m]"),
      option<O>("length_spacing", &O::length_spacing, "grasps are this far apart along a section [m], or"),
      option<O>("angle_spacing", &O::angle_spacing, "this far apart in angle [rad]"),
      option<O>("cost_per_metre", &O::cost_per_metre, "cost for the distance from the centre of mass [1/m]"),
      option<O>("draws", &O::draws, "fruitless draws in a row that end the sampling"),
      option<O>("seed", &O::seed, "same seed, same grasps")};
  return fields;
}

/// Axes from the hand; its opening and margin where no keyword gives them.
PipeGraspOptions grasp_options(const std::optional<Given<Hand>>& gripper, const py::kwargs& keywords,
                               const char* function) {
  PipeGraspOptions read = read_options(pipe_grasp_fields(), keywords, function);
  if (!gripper) return read;
  const PipeGraspOptions own = pipe_grasp_options(taken(*gripper, "gripper"));
  read.approach = own.approach;
  read.closing = own.closing;
  if (!keywords.contains("max_opening")) read.max_opening = own.max_opening;
  if (!keywords.contains("end_margin")) read.end_margin = own.end_margin;
  return read;
}

using Sections = std::vector<std::array<int, 2>>;
using Diameters = std::variant<double, std::vector<double>>;

Diameters diameters_argument(const Given<Diameters>& value) {
  try {
    return py::cast<Diameters>(value);
  } catch (const py::cast_error&) {
    refuse_value("diameters", value, "a number or a list of numbers");
  }
}

Pipe make_pipe(const ArrayLike& nodes, const Given<Sections>& sections, const Given<Diameters>& given_diameters) {
  const Diameters diameters = diameters_argument(given_diameters);
  Pipe pipe;
  for (const Eigen::VectorXd& node : rows_argument(nodes, "nodes", 3)) pipe.nodes.emplace_back(node);
  pipe.sections = taken(sections, "sections", "pairs of whole numbers");
  if (const auto* one = std::get_if<double>(&diameters)) {
    pipe.diameters.assign(pipe.sections.size(), *one);
  } else {
    pipe.diameters = std::get<std::vector<double>>(diameters);
  }
  pipe.check();
  return pipe;
}

}  // namespace

void bind_structure(py::module_& m) {
  m.def("_pipe_grasp_option_table", [] { return option_table(pipe_grasp_fields()); });
  py::class_<Pipe>(m, "Pipe",
                   "A pipe structure: straight round sections between nodes in the object's frame (P2 3.2.2).\n"
                   "\n"
                   "    pipe = mg.grasping.Pipe([[0, 0, 0], [0.4, 0, 0], [0.4, 0.3, 0]], [[0, 1], [1, 2]], 0.028)\n"
                   "    grasps = pipe.sample_grasps(500)")
      .def(py::init(&make_pipe), py::arg("nodes"), py::arg("sections"), py::arg("diameters"),
           "(n, 3) nodes [m], pairs of node indices from 0, and outer diameters [m]: one for all or one a section.")
      .def_property_readonly(
          "nodes", [](const Pipe& p) { return rows_to_array(p.nodes); }, "(n, 3) in the object's frame [m].")
      .def_property_readonly(
          "sections",
          [](const Pipe& p) -> NodePairs {
            py::list pairs;
            for (const auto& [a, b] : p.sections) pairs.append(py::make_tuple(a, b));
            return pairs;
          },
          "First and second node of each section, counted from 0.")
      .def_readonly("diameters", &Pipe::diameters, "Outer diameter of each section [m].")
      .def_property_readonly(
          "lengths",
          [](const Pipe& p) {
            std::vector<double> lengths;
            for (std::size_t i = 0; i < p.sections.size(); ++i) {
              lengths.push_back(p.length(static_cast<int>(i)));
            }
            return lengths;
          },
          "Lengths of the sections [m].")
      .def_property_readonly("centre_of_mass", &Pipe::centre_of_mass, "Centre of mass of tubes with equal walls [m].")
      .def(
          "shapes",
          [](const Pipe& p, bool flat_ends) { return p.shapes(flat_ends ? PipeEnds::flat : PipeEnds::round); },
          py::kw_only(), py::arg("flat_ends") = false,
          "LinkShapes in the object's frame: a capsule a section; with flat_ends cylinders and balls at the bends.")
      .def(
          "grasp",
          [](const Pipe& p, int section, double length, double angle, bool flipped,
             const std::optional<Given<Hand>>& gripper, const py::kwargs& options) {
            return place_pipe_grasp(p, section, length, angle, flipped, grasp_options(gripper, options, "grasp"));
          },
          py::arg("section"), py::arg("length"), py::arg("angle"), py::arg("flipped") = false, py::kw_only(),
          py::arg("gripper") = py::none(),
          ("The grasp with these four variables (P2 3.2.3.1)." + option_help(pipe_grasp_fields())).c_str())
      .def(
          "sample_grasps",
          [](const Pipe& p, const Given<int>& given_count, const std::optional<Given<Hand>>& gripper,
             const py::kwargs& options) {
            const int count = taken(given_count, "count");
            const PipeGraspOptions read = grasp_options(gripper, options, "sample_grasps");
            return interruptible([&] { return sample_pipe_grasps(p, count, read).grasps; });
          },
          py::arg("count"), py::kw_only(), py::arg("gripper") = py::none(),
          ("Grasps drawn over the whole pipe, at most `count`, none nearer to another than the spacings. Axes are the"
           " gripper's,\nor approach x and closing y; so are opening and margin where no keyword gives them." +
           option_help(pipe_grasp_fields()))
              .c_str())
      .def("__repr__", [](const Pipe& p) {
        return "Pipe(" + std::to_string(p.sections.size()) + " sections, " + std::to_string(p.nodes.size()) + " nodes)";
      });
}

}  // namespace mmgrasp::python
