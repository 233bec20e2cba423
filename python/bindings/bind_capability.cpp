#include <cmath>
#include <optional>

#include "bindings.hpp"
#include "mmgrasp/reach/capability_map.hpp"
#include "plan_arguments.hpp"

namespace mmgrasp::python {
namespace {

constexpr char kGridShape[] = "tuple[int, int, int]";
using GridShape = Shown<kGridShape>;

OptionField<CapabilityOptions> vector_option(const char* name, Eigen::Vector3d CapabilityOptions::*member,
                                             const char* help) {
  return {name, "numpy.typing.ArrayLike",
          [=](CapabilityOptions& o, const py::handle& v) { o.*member = vector3_argument(v, name); },
          [=](const CapabilityOptions& o) -> py::object {
            const Eigen::Vector3d& v = o.*member;
            return py::make_tuple(v[0], v[1], v[2]);
          },
          help};
}

const std::vector<OptionField<CapabilityOptions>>& capability_fields() {
  using O = CapabilityOptions;
  static const std::vector<OptionField<O>> fields{
      vector_option("lower", &O::lower, "corner of the grid in the robot's root frame [m]"),
      vector_option("upper", &O::upper, "the opposite corner, a whole number of voxels away [m]"),
      option<O>("voxel", &O::voxel, "edge of a voxel and diameter of its sphere [m]"),
      option<O>("poses", &O::poses, "tool poses in a voxel; a multiple of rolls"),
      option<O>("rolls", &O::rolls, "rolls about each approach direction"),
      vector_option("approach", &O::approach, "where the tool points, in the tip's frame"),
      option<O>("samples", &O::samples, "values tried of joints a pose leaves free; 0: 64 for one, 128 for two"),
      option<O>("sweeps", &O::sweeps, "times that solutions spread from pose to neighbouring pose"),
      option<O>("restarts", &O::restarts, "further random descents for poses that border reached ones"),
      option<O>("padding", &O::padding, "robot links are grown by this against the scene [m]"),
      option<O>("seed", &O::seed, "same seed, same map"),
      option<O>("threads", &O::threads, "0: all; does not change the answer")};
  return fields;
}

/// A read-only view that keeps the map alive.
template <typename T>
py::array view(const std::vector<T>& values, std::vector<py::ssize_t> shape, const py::object& owner) {
  py::array array(py::dtype::of<T>(), std::move(shape), values.data(), owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

std::vector<py::ssize_t> grid_shape(const CapabilityMap& map, std::initializer_list<py::ssize_t> more = {}) {
  std::vector<py::ssize_t> shape(map.shape().begin(), map.shape().end());
  shape.insert(shape.end(), more);
  return shape;
}

py::array_t<double> centres(const CapabilityMap& map) {
  py::array_t<double> out(grid_shape(map, {3}));
  double* at = out.mutable_data();
  for (std::int64_t voxel = 0; voxel < map.voxel_count(); ++voxel, at += 3)
    Eigen::Map<Eigen::Vector3d>(at, 3) = map.centre(voxel);
  return out;
}

py::array_t<double> tool_poses(const CapabilityMap& map) {
  Poses poses;
  for (int k = 0; k < (map.voxel_count() > 0 ? map.options().poses : 0); ++k) {
    Pose T = map.tool_pose(0, k);
    T.translation() -= map.centre(0);
    poses.push_back(T);
  }
  return to_array(poses);
}

void bind_map(py::module_& m) {
  using namespace py::literals;
  py::class_<CapabilityMap>(
      m, "CapabilityMap",
      "The share of tool poses around each point that an arm reaches, with its limits, self-collision and the scene\n"
      "(P3 3.9.2, equation 3.13). Everything is in the robot's root frame. Immutable.\n"
      "\n"
      "    reached = mg.base.CapabilityMap.build(arm, world, voxel=0.2, poses=50)\n"
      "    reached.index_at([0.6, 0.0, 0.8])  # share of tool poses around this point, in [0, 1]")
      .def_static(
          "build",
          [](const JointGroup& arm, const std::optional<World>& world, const Progress& progress,
             const py::kwargs& options) {
            const CapabilityOptions read = read_options(capability_fields(), options, "CapabilityMap.build");
            const JointGroup group = with_sampled_pairs(arm);
            const World scene = world.value_or(World{});
            return LongCall(progress).run(
                [&](const Monitor& monitor) { return CapabilityMap::build(group, scene, read, monitor); });
          },
          "arm"_a, "world"_a = py::none(), py::kw_only(), "progress"_a = py::none(),
          ("Tries every tool pose of every voxel. `progress` is called with (stage, fraction)." +
           option_help(capability_fields()))
              .c_str())
      .def(
          "restricted",
          [](const CapabilityMap& map, const JointGroup& arm, const World& world, const Progress& progress) {
            const JointGroup group = with_sampled_pairs(arm);
            return LongCall(progress).run(
                [&](const Monitor& monitor) { return map.restricted(group, world, monitor); });
          },
          "arm"_a, "world"_a, py::kw_only(), "progress"_a = py::none(),
          "The map of the same arm in a world with more in it: only what is reached here is checked again.")
      .def(
          "save",
          [](const CapabilityMap& map, const PathLike& path) {
            const std::string name = path_argument(path, "path");
            interruptible([&] { map.save(name); });
          },
          "path"_a, "Writes a folder of .npy files and meta.json.")
      .def_static(
          "load",
          [](const PathLike& path) {
            const std::string name = path_argument(path, "path");
            return interruptible([&] { return CapabilityMap::load(name); });
          },
          "path"_a, "Raises IoError on a truncated, foreign or corrupt folder.")
      .def_property_readonly(
          "shape", [](const CapabilityMap& map) -> GridShape { return py::tuple(py::cast(map.shape())); },
          "Voxels along x, y, z.")
      .def_property_readonly(
          "index",
          [](const py::object& self) -> Floats32 {
            const auto& map = self.cast<const CapabilityMap&>();
            return view(map.index(), grid_shape(map), self);
          },
          "Reachability index of each voxel (nx, ny, nz), float32 in [0, 1].")
      .def_property_readonly(
          "classes",
          [](const py::object& self) -> Bytes {
            const auto& map = self.cast<const CapabilityMap&>();
            return view(map.classes(), grid_shape(map, {map.options().poses}), self);
          },
          "What became of each pose (nx, ny, nz, poses), uint8: 0 reached, 1 out of reach, 2 limits, 3 "
          "self-collision,\n"
          "4 scene.")
      .def_property_readonly(
          "configurations",
          [](const py::object& self) -> Floats32 {
            const auto& map = self.cast<const CapabilityMap&>();
            return view(map.configurations(), {map.reached(), map.joint_count()}, self);
          },
          "A configuration for each reached pose (reached, n), float32, in the order of `classes`.")
      .def_property_readonly("centres", &centres, "Centres of the voxels (nx, ny, nz, 3) [m].")
      .def_property_readonly("tool_poses", &tool_poses, "Tool poses around a voxel's centre (poses, 4, 4).")
      .def_property_readonly(
          "lower", [](const CapabilityMap& map) { return map.options().lower; },
          "Lower corner of the grid (3,) in the robot's root frame [m].")
      .def_property_readonly(
          "upper", [](const CapabilityMap& map) { return map.options().upper; },
          "Upper corner of the grid (3,) in the robot's root frame [m].")
      .def_property_readonly(
          "voxel", [](const CapabilityMap& map) { return map.options().voxel; }, "Edge of a voxel [m].")
      .def_property_readonly("reached", &CapabilityMap::reached, "Poses reached.")
      .def_property_readonly("rejections", &CapabilityMap::rejections, "Poses not reached, by cause.")
      .def_property_readonly("maximum", &CapabilityMap::maximum, "The largest index.")
      .def(
          "index_at",
          [](const CapabilityMap& map, const ArrayLike& point) {
            return map.index_at(vector3_argument(point, "point"));
          },
          "point"_a, "Index of the voxel that holds a point of the root frame; 0 outside.")
      .def(
          "configuration",
          [](const CapabilityMap& map, int x, int y, int z, int pose) -> MaybeFloats {
            const Eigen::VectorXd q = map.configuration(map.voxel(x, y, z), pose);
            return q.size() == 0 ? py::none() : py::cast(q);
          },
          "x"_a, "y"_a, "z"_a, "pose"_a, "Configuration that reaches a pose of a voxel, or None.")
      .def(
          "slice",
          [](const py::object& self, const std::string& axis, double at) -> Floats32 {
            const auto& map = self.cast<const CapabilityMap&>();
            const std::size_t which = std::string("xyz").find(axis);
            if (axis.size() != 1 || which == std::string::npos)
              throw InvalidInput("axis = \"" + axis + "\": must be \"x\", \"y\" or \"z\"");
            const auto a = static_cast<Eigen::Index>(which);
            const auto cell = static_cast<int>(
                std::floor((finite_argument(at, "at") - map.options().lower[a]) / map.options().voxel));
            require(cell >= 0 && cell < map.shape()[which], "at", at, "must lie in the grid [m]");
            return py::module_::import("numpy").attr("take")(self.attr("index"), cell, "axis"_a = which);
          },
          "axis"_a, "at"_a, "Cut through the voxels at a coordinate [m]: `slice(\"z\", 0.75)` is (nx, ny).")
      .def(
          "score",
          [](const CapabilityMap& map, const ArrayLike& T_world_tips, const OptionalArray& T_world_root, double cone) {
            const Poses tips = poses_argument(T_world_tips, "T_world_tips");
            const Pose root = pose_argument(T_world_root, "T_world_root");
            finite_argument(cone, "cone");
            return interruptible([&] { return map.score(tips, root, cone); });
          },
          "T_world_tips"_a, "T_world_root"_a = py::none(), "cone"_a = 4.0,
          "Mean index over tool poses (m, 4, 4) with the root at a pose. With `cone` below pi [rad] only tool poses\n"
          "that approach within that angle of each pose count.")
      .def(
          "best_base_distance",
          [](const CapabilityMap& map, const ArrayLike& T_world_tips, const ArrayLike& given, double heading,
             double cone) {
            const Poses tips = poses_argument(T_world_tips, "T_world_tips");
            finite_argument(heading, "heading");
            const std::vector<double> distances = list_argument(given, "distances");
            finite_argument(cone, "cone");
            const BaseDistance best =
                interruptible([&] { return best_base_distance(map, tips, heading, distances, cone); });
            return py::make_tuple(best.distance, best.score, best.scores);
          },
          "T_world_tips"_a, "distances"_a, "heading"_a = 0.0, "cone"_a = 4.0,
          "Which distance [m] to stand behind the poses' middle, facing along `heading` [rad]:\n"
          "(distance, score, scores of all).")
      .def("__repr__", [](const CapabilityMap& map) {
        return "CapabilityMap(" + std::to_string(map.shape()[0]) + " x " + std::to_string(map.shape()[1]) + " x " +
               std::to_string(map.shape()[2]) + " voxels, " + std::to_string(map.reached()) + " of " +
               std::to_string(map.classes().size()) + " poses reached, maximum " + std::to_string(map.maximum()) + ")";
      });
}

}  // namespace

void bind_capability(py::module_& m) {
  m.def("_capability_option_table", [] { return option_table(capability_fields()); });
  bind_map(m);
}

}  // namespace mmgrasp::python
