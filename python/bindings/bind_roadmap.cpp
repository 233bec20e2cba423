#include "bindings.hpp"
#include "given.hpp"
#include "joint_weights.hpp"
#include "mmgrasp/plan/roadmap.hpp"

namespace mmgrasp::python {
namespace {

constexpr char kRoadmapStatistics[] = "mmgrasp.records.RoadmapStatistics";
using RoadmapStatisticsDict = Shown<kRoadmapStatistics>;

using namespace py::literals;

const std::vector<OptionField<RoadmapOptions>>& roadmap_fields() {
  using O = RoadmapOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("vertices", &O::vertices, "configurations drawn"),
      option<O>("gamma", &O::gamma,
                "> 0: vertices nearer than gamma (log n / n)^(1/d) are joined (P2: 4) [rad or m]; 0: the "
                "e (1 + 1/d) log n nearest ones"),
      option<O>("neighbours", &O::neighbours, "> 0: that many nearest ones are joined instead"),
      joint_weights_option<O>(&O::joint_weights), option<O>("seed", &O::seed, "same seed, same roadmap")};
  return fields;
}

RoadmapStatisticsDict statistics_dict(const Roadmap& roadmap) {
  const RoadmapStatistics f = roadmap.statistics();
  return py::dict("mean_degree"_a = f.mean_degree, "components"_a = f.components,
                  "largest_component"_a = f.largest_component, "neighbours"_a = f.neighbours, "radius"_a = f.radius,
                  "volume"_a = f.volume, "gamma_star"_a = f.gamma_star);
}

py::array_t<std::int32_t> edges_array(const Roadmap& roadmap) {
  py::array_t<std::int32_t> out({static_cast<py::ssize_t>(roadmap.edge_count()), py::ssize_t{2}});
  auto at = out.mutable_unchecked<2>();
  for (int e = 0; e < roadmap.edge_count(); ++e) {
    const auto [a, b] = roadmap.ends(e);
    at(e, 0) = a;
    at(e, 1) = b;
  }
  return out;
}

py::dict roadmap_dict(const Roadmap& roadmap) {
  py::dict options;
  for (const auto& field : roadmap_fields()) options[field.name.c_str()] = field.get(roadmap.options());
  return py::dict("joints"_a = roadmap.group().names(), "size"_a = roadmap.size(), "edges"_a = roadmap.edge_count(),
                  "options"_a = options, "statistics"_a = statistics_dict(roadmap));
}

}  // namespace

void bind_roadmap(py::module_& m) {
  m.def("_roadmap_option_table", [] { return option_table(roadmap_fields()); });
  py::class_<Roadmap>(m, "Roadmap",
                      "Configurations of a group drawn from its joint limits and joined when near, without any "
                      "collision check: it serves\n"
                      "every grasp, object and scene (P2 4.3.2.1). Immutable.\n"
                      "\n"
                      "    roadmap = mg.planning.Roadmap.build(arm, vertices=2000)\n"
                      "    roadmap.statistics[\"largest_component\"]")
      .def_static(
          "build",
          [](const Given<JointGroup>& given_group, const Progress& progress, const py::kwargs& options) {
            const JointGroup& group = taken(given_group, "group");
            const RoadmapOptions read = read_options(roadmap_fields(), options, "Roadmap.build");
            return LongCall(progress).run([&](const Monitor& monitor) { return Roadmap::build(group, read, monitor); });
          },
          "group"_a, py::kw_only(), "progress"_a = py::none(),
          ("Draws and joins; a larger roadmap of the same seed holds a smaller one's vertices." +
           option_help(roadmap_fields()))
              .c_str())
      .def_static(
          "load",
          [](const PathLike& path, const Given<JointGroup>& given_group) {
            const JointGroup& group = taken(given_group, "group");
            const std::string file = path_argument(path, "path");
            return interruptible([&] { return Roadmap::load(file, group); });
          },
          "path"_a, "group"_a, "Raises IoError on a damaged file or one made for another robot, joints or limits.")
      .def(
          "save",
          [](const Roadmap& roadmap, const PathLike& path) {
            const std::string file = path_argument(path, "path");
            interruptible([&] { roadmap.save(file); });
          },
          "path"_a, "To a temporary name first, then renamed.")
      .def("__len__", &Roadmap::size)
      .def_property_readonly(
          "vertices", [](const Roadmap& r) { return Eigen::MatrixXd(r.vertices().transpose()); }, "(n, joints)")
      .def_property_readonly("edges", &edges_array, "Pairs of vertices (m, 2), the smaller number first.")
      .def(
          "near",
          [](const Roadmap& roadmap, const ArrayLike& q) {
            std::vector<int> out;
            roadmap.near(vector_argument(q, "q", roadmap.group().size()), out);
            return out;
          },
          "q"_a, "Vertices a new configuration would be joined with, ascending.")
      .def_property_readonly(
          "statistics", &statistics_dict,
          "Mean degree, connected parts, the largest one's vertices, nearest ones joined, connection "
          "radius, the volume of the joint limits, and the gamma that PRM* asks for.")
      .def_property_readonly("warning", &Roadmap::warning,
                             "What to set when less than 99 % of the vertices hang together; empty otherwise.")
      .def("to_dict", &roadmap_dict, "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const Roadmap& r) {
        const std::string text = "Roadmap(" + std::to_string(r.size()) + " vertices, " +
                                 std::to_string(r.edge_count()) + " edges, '" + r.group().name() + "'";
        return text + (r.warning().empty() ? ")" : ", warning: " + r.warning() + ")");
      });
}

}  // namespace mmgrasp::python
