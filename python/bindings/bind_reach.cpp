#include "bindings.hpp"
#include "mmgrasp/reach/reach_database.hpp"

namespace mmgrasp::python {
namespace {

const std::vector<OptionField<ReachOptions>>& reach_fields() {
  static const std::vector<OptionField<ReachOptions>> fields{
      option<ReachOptions>("samples", &ReachOptions::samples, "arm configurations drawn"),
      option<ReachOptions>("position_cell", &ReachOptions::position_cell, "edge of a position cell [m]"),
      option<ReachOptions>("rotation_cell", &ReachOptions::rotation_cell,
                           "approximate diameter of a rotation cell [rad]"),
      option<ReachOptions>("max_per_cell", &ReachOptions::max_per_cell, "configurations kept in a cell"),
      option<ReachOptions>("min_manipulability", &ReachOptions::min_manipulability,
                           "least manipulability kept, as a fraction of the largest"),
      option<ReachOptions>("seed", &ReachOptions::seed, "same seed, same database"),
      option<ReachOptions>("threads", &ReachOptions::threads, "0: all; does not change the answer")};
  return fields;
}

}  // namespace

void check_reach_options(const py::kwargs& options) {
  read_options(reach_fields(), options, "reach");
}

void bind_reach(py::module_& m) {
  m.def("_reach_option_table", [] { return option_table(reach_fields()); });
  py::class_<ReachDatabase>(m, "ReachDatabase",
                            "Sampled arm configurations free of self-collision, in cells of the tool pose (P1 3.2.1).")
      .def_static(
          "build",
          [](const JointGroup& arm, const py::object& progress, const py::kwargs& options) {
            const ReachOptions read = read_options(reach_fields(), options, "ReachDatabase.build");
            const JointGroup group = with_sampled_pairs(arm);
            return LongCall(progress).run(
                [&](const Monitor& monitor) { return ReachDatabase::build(group, read, monitor); });
          },
          py::arg("arm"), py::kw_only(), py::arg("progress") = py::none(),
          ("Samples the arm. `progress` is called with (stage, fraction)." + option_help(reach_fields())).c_str())
      .def_static(
          "load_or_build",
          [](const JointGroup& arm, const py::object& cache_dir, const py::object& progress,
             const py::kwargs& options) {
            const ReachOptions read = read_options(reach_fields(), options, "ReachDatabase.load_or_build");
            const std::string folder = path_argument(cache_dir, "cache_dir");
            const JointGroup group = with_sampled_pairs(arm);
            return LongCall(progress).run(
                [&](const Monitor& monitor) { return ReachDatabase::load_or_build(group, read, folder, monitor); });
          },
          py::arg("arm"), py::arg("cache_dir"), py::kw_only(), py::arg("progress") = py::none(),
          "The database of this arm and these options from the cache folder; built and stored when it is not there.")
      .def_static(
          "load",
          [](const py::object& path) {
            const std::string name = path_argument(path, "path");
            py::gil_scoped_release release;
            return ReachDatabase::load(name);
          },
          py::arg("path"), "Raises IoError on a truncated, foreign or corrupt file.")
      .def(
          "save",
          [](const ReachDatabase& db, const py::object& path) {
            const std::string name = path_argument(path, "path");
            py::gil_scoped_release release;
            db.save(name);
          },
          py::arg("path"))
      .def_property_readonly("key", &ReachDatabase::key)
      .def("__len__", &ReachDatabase::size)
      .def_property_readonly("cell_count", &ReachDatabase::cell_count, "Non-empty cells.")
      .def_property_readonly("joint_count", &ReachDatabase::joint_count)
      .def_property_readonly("reach", &ReachDatabase::reach,
                             "Largest distance of a stored tool position from the root [m].")
      .def(
          "query",
          [](const ReachDatabase& db, const ArrayLike& T_base_tip) {
            return Eigen::MatrixXd(db.cell(pose_argument(T_base_tip, "T_base_tip")).transpose());
          },
          py::arg("T_base_tip"), "Stored configurations (k, n) whose tool pose lies in the pose's cell; k may be 0.")
      .def(
          "nearest",
          [](const ReachDatabase& db, const ArrayLike& T_base_tip, int count) {
            if (count <= 0) throw InvalidInput("count = " + std::to_string(count) + ": must be > 0");
            Eigen::MatrixXd out;
            const int found = db.nearest(pose_argument(T_base_tip, "T_base_tip"), count, out);
            return Eigen::MatrixXd(out.leftCols(found).transpose());
          },
          py::arg("T_base_tip"), py::arg("count") = 8,
          "Up to `count` stored configurations (k, n) near the pose, nearest first.")
      .def("__repr__", [](const ReachDatabase& db) {
        return "ReachDatabase(" + std::to_string(db.size()) + " configurations in " + std::to_string(db.cell_count()) +
               " cells)";
      });
}

}  // namespace mmgrasp::python
