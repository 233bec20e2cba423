#include <optional>

#include "bindings.hpp"
#include "mmgrasp/reach/base_placement.hpp"
#include "mmgrasp/reach/reach_arrays.hpp"
#include "mmgrasp/reach/reach_database.hpp"
#include "mmgrasp/reach/reach_parts.hpp"
#include "mmgrasp/reach/reach_solve.hpp"
#include "option_bounds.hpp"

namespace mmgrasp::python {
namespace {

constexpr char kNamedArrays[] = "dict[str, numpy.typing.NDArray[typing.Any]]";
using NamedArrays = Shown<kNamedArrays>;
constexpr char kArrayList[] = "list[numpy.typing.NDArray[numpy.float64]]";
using ArrayList = Shown<kArrayList>;
constexpr char kMaybeArrayList[] = "list[numpy.typing.NDArray[numpy.float64] | None]";
using MaybeArrayList = Shown<kMaybeArrayList>;

using namespace py::literals;

const std::vector<OptionField<ReachOptions>>& reach_fields() {
  static const std::vector<OptionField<ReachOptions>> fields{
      option<ReachOptions>("samples", &ReachOptions::samples, "arm configurations drawn"),
      option<ReachOptions>("position_cell", &ReachOptions::position_cell, "edge of a position cell [m]"),
      option<ReachOptions>("rotation_cell", &ReachOptions::rotation_cell,
                           "approximate diameter of a rotation cell [rad]"),
      option<ReachOptions>("max_per_cell", &ReachOptions::max_per_cell, "configurations kept in a cell"),
      option<ReachOptions>("min_manipulability", &ReachOptions::min_manipulability,
                           "least manipulability kept, as a fraction of the largest"),
      option<ReachOptions>("thinning", &ReachOptions::thinning,
                           "below this fraction of the largest manipulability kept by chance; 0: all"),
      option<ReachOptions>("seed", &ReachOptions::seed, "same seed, same database"),
      option<ReachOptions>("threads", &ReachOptions::threads, "0: all; does not change the answer")};
  return fields;
}

const BoundedOptions<ReachOptions>& reach_options() {
  static const BoundedOptions<ReachOptions> options(reach_fields(), {{"samples", {1, 2e9, "draws"}},
                                                                     {"position_cell", {0.001, 10, "m"}},
                                                                     {"rotation_cell", {0.051, 3, "rad"}},
                                                                     {"max_per_cell", {1, 1e6, "configurations"}},
                                                                     {"min_manipulability", {0, 0.999, ""}},
                                                                     {"thinning", {0, 1, ""}},
                                                                     {"seed", {0, kMostSeed, ""}},
                                                                     {"threads", {0, 1024, "(0: all)"}}});
  return options;
}

const std::vector<OptionField<ReachSolveOptions>>& solve_fields() {
  static const std::vector<OptionField<ReachSolveOptions>> fields{
      option<ReachSolveOptions>("count", &ReachSolveOptions::count, "solutions at most"),
      option<ReachSolveOptions>("candidates", &ReachSolveOptions::candidates, "stored configurations tried"),
      option<ReachSolveOptions>("distinct", &ReachSolveOptions::distinct,
                                "solutions differ by more than this in some joint [rad or m]"),
      option<ReachSolveOptions>("position_tolerance", &ReachSolveOptions::ik, &IkOptions::position_tolerance, "[m]"),
      option<ReachSolveOptions>("rotation_tolerance", &ReachSolveOptions::ik, &IkOptions::rotation_tolerance, "[rad]"),
      option<ReachSolveOptions>("threads", &ReachSolveOptions::threads, "of batches; 0: all")};
  return fields;
}

const std::vector<OptionField<BasePlacementOptions>>& base_placement_fields() {
  using Options = BasePlacementOptions;
  static const std::vector<OptionField<Options>> fields{
      option<Options>("step", &Options::step, "grid of base positions [m]"),
      option<Options>("headings", &Options::headings, "of the base, evenly over the circle"),
      option<Options>("candidates", &Options::candidates, "best base poses of the grid checked exactly"),
      option<Options>("seeds", &Options::seeds, "stored configurations tried for a target"),
      option<Options>("refinements", &Options::refinements, "rounds of smaller steps about the best"),
      option<Options>("position_tolerance", &Options::ik, &IkOptions::position_tolerance, "[m]"),
      option<Options>("rotation_tolerance", &Options::ik, &IkOptions::rotation_tolerance, "[rad]"),
      option<Options>("threads", &Options::threads, "0: all; does not change the answer")};
  return fields;
}

/// (m, 4, 4)
Poses pose_stack_argument(const ArrayLike& value, const std::string& name) {
  const py::array array = plain_array(value, name);
  if (!array) refuse_value(name, value, "an array (m, 4, 4)");
  if (array.ndim() != 3 || array.shape(1) != 4 || array.shape(2) != 4)
    throw InvalidInput(name + " has shape " + std::string(py::str(array.attr("shape"))) + ": must be (m, 4, 4)");
  Poses out;
  for (py::ssize_t i = 0; i < array.shape(0); ++i)
    out.push_back(pose_argument(py::reinterpret_borrow<ArrayLike>(array[py::int_(i)]), name));
  return out;
}

/// A read-only view that keeps the database alive.
template <typename T>
py::array view(const py::object& owner, const T* data, std::vector<py::ssize_t> shape) {
  py::array out(py::dtype::of<T>(), std::move(shape), {}, data, owner);
  out.attr("setflags")("write"_a = false);
  return out;
}

NamedArrays arrays(const py::object& self) {
  const auto& database = self.cast<const ReachDatabase&>();
  const ReachArrays a = interruptible([&] { return checked_reach_arrays(database); });
  return py::dict("positions"_a = view(self, a.position_cells, {a.positions, 3}),
                  "position_first"_a = view(self, a.position_first, {a.positions + 1}),
                  "rotation_ids"_a = view(self, a.rotation_ids, {a.cells}),
                  "cell_first"_a = view(self, a.cell_first, {a.cells + 1}),
                  "configurations"_a = view(self, a.configurations, {a.size, a.joints}));
}

py::dict database_dict(const ReachDatabase& database) {
  const ReachArrays a = reach_arrays(database);
  py::dict options;
  for (const auto& field : reach_fields()) options[field.name.c_str()] = field.get(database.options());
  const Eigen::AlignedBox3d bounds = database.bounds();
  py::object box = py::none();
  if (!bounds.isEmpty())
    box = py::make_tuple(py::cast(Eigen::VectorXd(bounds.min())).attr("tolist")(),
                         py::cast(Eigen::VectorXd(bounds.max())).attr("tolist")());
  return py::dict("key"_a = database.key(), "robot"_a = a.robot, "tip"_a = a.tip, "joints"_a = a.joint_names,
                  "size"_a = a.size, "cell_count"_a = a.cells, "reach"_a = database.reach(), "bounds"_a = box,
                  "options"_a = options, "path"_a = database.path());
}

void bind_queries(py::module_& m, py::class_<ReachDatabase>& database) {
  py::class_<BasePlacement>(m, "BasePlacement", "One base pose for many tool poses.")
      .def_readonly("base_pose", &BasePlacement::base_pose, "x, y, theta")
      .def_readonly("reached", &BasePlacement::reached, "How many of the targets.")
      .def_property_readonly(
          "configurations",
          [](const BasePlacement& p) -> MaybeArrayList {
            py::list out;
            for (const Eigen::VectorXd& q : p.configurations) out.append(q.size() > 0 ? py::cast(q) : py::none());
            return out;
          },
          "One per target; None where it is not reached.")
      .def(
          "to_dict",
          [](const BasePlacement& p) {
            py::list rows;
            for (const Eigen::VectorXd& q : p.configurations)
              rows.append(q.size() > 0 ? py::object(py::cast(q).attr("tolist")()) : py::none());
            return py::dict("base_pose"_a = py::cast(p.base_pose).attr("tolist")(), "reached"_a = p.reached,
                            "configurations"_a = rows);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const BasePlacement& p) {
        return "BasePlacement(" + std::to_string(p.reached) + " of " + std::to_string(p.configurations.size()) +
               " reached from " + text(p.base_pose) + ")";
      });
  database
      .def(
          "solve",
          [](const ReachDatabase& db, const JointGroup& arm, const ArrayLike& T_base_tip, CollisionChecker* checker,
             const py::kwargs& options) {
            const ReachSolveOptions read = read_options(solve_fields(), options, "ReachDatabase.solve");
            return rows_to_array(solve_reach(db, arm, pose_argument(T_base_tip, "T_base_tip"), read, checker));
          },
          "arm"_a, "T_base_tip"_a, py::kw_only(), "checker"_a = py::none(),
          ("Exact configurations (k, n) for a pose relative to the root, from stored ones near it; the most different "
           "ones first, with a checker the free ones." +
           option_help(solve_fields()))
              .c_str())
      .def(
          "solve_batch",
          [](const ReachDatabase& db, const JointGroup& arm, const ArrayLike& T_base_tips,
             const CollisionChecker* checker, const py::kwargs& options) -> ArrayList {
            const ReachSolveOptions read = read_options(solve_fields(), options, "ReachDatabase.solve_batch");
            const Poses poses = pose_stack_argument(T_base_tips, "T_base_tips");
            const auto found = LongCall(py::none()).run([&](const Monitor& monitor) {
              return solve_reach_batch(db, arm, poses, read, checker, monitor);
            });
            py::list out;
            for (const auto& solutions : found) out.append(rows_to_array(solutions));
            return out;
          },
          "arm"_a, "T_base_tips"_a, py::kw_only(), "checker"_a = py::none(),
          ("solve() for many poses (m, 4, 4) at a time: a list of arrays (k, n)." + option_help(solve_fields()))
              .c_str())
      .def(
          "base_poses_for",
          [](const ReachDatabase& db, const JointGroup& arm, const ArrayLike& T_world_tip, int count,
             const CollisionChecker* checker, const py::kwargs& options) {
            const BasePlacementOptions read =
                read_options(base_placement_fields(), options, "ReachDatabase.base_poses_for");
            const Pose T = pose_argument(T_world_tip, "T_world_tip");
            const auto found = LongCall(py::none()).run([&](const Monitor& monitor) {
              return base_poses_for(db, arm, T, count, read, checker, monitor);
            });
            std::vector<Eigen::Vector3d> bases;
            std::vector<Eigen::VectorXd> configurations;
            for (const BaseReach& reach : found) {
              bases.push_back(reach.base_pose);
              configurations.push_back(reach.q);
            }
            return py::make_tuple(rows_to_array(bases), rows_to_array(configurations));
          },
          "arm"_a, "T_world_tip"_a, py::kw_only(), "count"_a = 32, "checker"_a = py::none(),
          ("Base poses (k, 3) on the floor from which the tool reaches a pose in the world, and the configurations "
           "(k, n) that do." +
           option_help(base_placement_fields()))
              .c_str())
      .def(
          "find_base_placement",
          [](const ReachDatabase& db, const JointGroup& arm, const ArrayLike& T_world_tips,
             const CollisionChecker* checker, const Progress& progress, const py::kwargs& options) {
            const BasePlacementOptions read =
                read_options(base_placement_fields(), options, "ReachDatabase.find_base_placement");
            const Poses poses = pose_stack_argument(T_world_tips, "T_world_tips");
            return LongCall(progress).run(
                [&](const Monitor& monitor) { return find_base_placement(db, arm, poses, read, checker, monitor); });
          },
          "arm"_a, "T_world_tips"_a, py::kw_only(), "checker"_a = py::none(), "progress"_a = py::none(),
          ("One base pose from which as many tool poses (m, 4, 4) in the world as possible are reached." +
           option_help(base_placement_fields()))
              .c_str());
}

}  // namespace

void check_reach_options(const py::kwargs& options) {
  reach_options().read(options, "reach");
}

void bind_reach(py::module_& m) {
  m.def("_reach_option_table", [] { return option_table(reach_fields()); });
  m.def("_reach_option_bounds", [] { return reach_options().bounds(); });
  py::class_<ReachDatabase> database(m, "ReachDatabase",
                                     "Sampled arm configurations free of self-collision, in cells of the tool pose (P1 "
                                     "3.2.1): good first guesses for\n"
                                     "inverse kinematics, and quick answers to \"out of reach\".\n"
                                     "\n"
                                     "    database = mg.ReachDatabase.build(arm, samples=100_000)\n"
                                     "    database.save(\"reach\")\n"
                                     "    guesses = database.query(T_base_tip)  # (m, n), m = 0: out of reach");
  database
      .def_static(
          "build",
          [](const JointGroup& arm, const Progress& progress, const py::kwargs& options) {
            const ReachOptions read = reach_options().read(options, "ReachDatabase.build");
            const JointGroup group = with_sampled_pairs(arm);
            return LongCall(progress).run(
                [&](const Monitor& monitor) { return ReachDatabase::build(group, read, monitor); });
          },
          py::arg("arm"), py::kw_only(), py::arg("progress") = py::none(),
          ("Samples the arm. `progress` is called with (stage, fraction)." + option_help(reach_fields())).c_str())
      .def_static(
          "part_count",
          [](const JointGroup& arm, const py::kwargs& options) {
            return reach_part_count(with_sampled_pairs(arm), reach_options().read(options, "ReachDatabase.part_count"));
          },
          py::arg("arm"),
          ("Into how many parts build_to divides a build with these options." + option_help(reach_fields())).c_str())
      .def_static(
          "build_parts",
          [](const PathLike& folder, const JointGroup& arm, const std::vector<std::int64_t>& parts,
             const Progress& progress, const py::kwargs& options) {
            const ReachOptions read = reach_options().read(options, "ReachDatabase.build_parts");
            const std::string name = path_argument(folder, "folder");
            const JointGroup group = with_sampled_pairs(arm);
            return LongCall(progress).run(
                [&](const Monitor& monitor) { return build_reach_parts(name, group, read, parts, monitor); });
          },
          py::arg("folder"), py::arg("arm"), py::arg("parts"), py::kw_only(), py::arg("progress") = py::none(),
          ("Draws single parts into a folder; in `path`.partial they are what build_to(path, ...) goes on from." +
           option_help(reach_fields()))
              .c_str())
      .def_static(
          "load_or_build",
          [](const JointGroup& arm, const PathLike& cache_dir, const Progress& progress, const py::kwargs& options) {
            const ReachOptions read = reach_options().read(options, "ReachDatabase.load_or_build");
            const std::string folder = path_argument(cache_dir, "cache_dir");
            const JointGroup group = with_sampled_pairs(arm);
            return LongCall(progress).run(
                [&](const Monitor& monitor) { return ReachDatabase::load_or_build(group, read, folder, monitor); });
          },
          py::arg("arm"), py::arg("cache_dir"), py::kw_only(), py::arg("progress") = py::none(),
          ("The database of this arm and these options from the cache folder; built and stored when it is not there. "
           "One "
           "that is damaged is built anew in its place, which `progress` hears as the stage 'replacing a damaged "
           "reachability database'." +
           option_help(reach_fields()))
              .c_str())
      .def_static(
          "build_to",
          [](const PathLike& path, const JointGroup& arm, const Progress& progress, const py::kwargs& options) {
            const ReachOptions read = reach_options().read(options, "ReachDatabase.build_to");
            const std::string name = path_argument(path, "path");
            const JointGroup group = with_sampled_pairs(arm);
            return LongCall(progress).run(
                [&](const Monitor& monitor) { return ReachDatabase::build_to(name, group, read, monitor); });
          },
          py::arg("path"), py::arg("arm"), py::kw_only(), py::arg("progress") = py::none(),
          ("Builds through files into a folder; interrupted and called again, it goes on where it was." +
           option_help(reach_fields()))
              .c_str())
      .def_static(
          "load",
          [](const PathLike& path, const JointGroup* arm) {
            const std::string name = path_argument(path, "path");
            const std::optional<JointGroup> group =
                arm ? std::optional<JointGroup>(with_sampled_pairs(*arm)) : std::nullopt;
            return interruptible([&] { return group ? ReachDatabase::load(name, *group) : ReachDatabase::load(name); });
          },
          py::arg("path"), py::arg("arm") = py::none(),
          "Raises IoError on a truncated, foreign or corrupt database, and on one built for another arm than `arm`.")
      .def(
          "verify",
          [](const ReachDatabase& db) {
            LongCall(py::none()).run([&](const Monitor& monitor) { return db.verify(monitor); });
          },
          "Compares every file with its checksums; raises IoError where they differ.")
      .def(
          "difference",
          [](const ReachDatabase& db, const JointGroup& arm) { return db.difference(with_sampled_pairs(arm)); },
          py::arg("arm"), "What of the arm has changed since the build, in words; empty when nothing.")
      .def_property_readonly(
          "arrays", &arrays,
          "Read-only views of the database's arrays, by file name. Raises IoError where configurations differ from "
          "their checksums, which are compared the first time.")
      .def_property_readonly("path", &ReachDatabase::path, "The folder; empty for a database in memory only.")
      .def_property_readonly(
          "joint_lower", [](const ReachDatabase& db) { return reach_arrays(db).joint_lower; },
          "Least value of each joint [rad or m].")
      .def_property_readonly(
          "joint_step", [](const ReachDatabase& db) { return reach_arrays(db).joint_step; },
          "q = joint_lower + joint_step * arrays['configurations'].")
      .def("to_dict", &database_dict, "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def(
          "save",
          [](const ReachDatabase& db, const PathLike& path) {
            const std::string name = path_argument(path, "path");
            interruptible([&] { db.save(name); });
          },
          py::arg("path"),
          "Writes a folder to a temporary name and renames it; raises IoError where something other than a database "
          "stands.")
      .def_property_readonly("key", &ReachDatabase::key,
                             "Hash of robot, group and options: databases of one key are the same.")
      .def("__len__", &ReachDatabase::size)
      .def_property_readonly("cell_count", &ReachDatabase::cell_count, "Non-empty cells.")
      .def_property_readonly("joint_count", &ReachDatabase::joint_count, "Columns of a stored configuration.")
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
            require_within(count, 1, 1e6, "count", "configurations");
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
  bind_queries(m, database);
}

}  // namespace mmgrasp::python
