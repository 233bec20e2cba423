// Maps of depth cameras as obstacles of a world.
#include <pthread.h>

#include <algorithm>
#include <mutex>
#include <new>
#include <shared_mutex>

#include "batch.hpp"
#include "bindings.hpp"
#include "mmgrasp/collision/add_cells.hpp"
#include "mmgrasp/mapping/occupancy_map.hpp"
#include "mmgrasp/mapping/probabilistic_sdf.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

constexpr char kFreeOrOccupied[] = "typing.Literal['free', 'occupied']";
constexpr char kFlagArray[] = "numpy.typing.NDArray[numpy.bool_]";
using FreeOrOccupied = Shown<kFreeOrOccupied>;
using FlagArray = Shown<kFlagArray>;

bool occupied_argument(const py::handle& value) {
  const std::string given =
      py::isinstance<py::str>(value) ? py::cast<std::string>(value) : std::string(py::repr(value));
  if (given != "free" && given != "occupied") {
    throw InvalidInput("unknown = " + given + ": must be one of free, occupied");
  }
  return given == "occupied";
}

/// Lower and upper corner, (2, 3); None is an empty box.
Eigen::AlignedBox3d bounds_argument(const py::object& value) {
  if (value.is_none()) return {};
  const Eigen::MatrixXd corners = matrix_argument(value, "bounds", 3);
  require(corners.rows() == 2, "bounds", static_cast<double>(corners.rows()), "must have 2 rows: lower, upper corner");
  const bool ordered = ((corners.row(0) - corners.row(1)).array() <= 0).all();
  require(ordered, "bounds", "lower above upper", "must be the lower corner, then the upper one");
  return {Eigen::Vector3d(corners.row(0)), Eigen::Vector3d(corners.row(1))};
}

SdfObstacleOptions sdf_obstacle(double sigmas, const py::handle& unknown, const py::object& bounds) {
  SdfObstacleOptions options;
  options.sigmas = sigmas;
  options.unknown = occupied_argument(unknown) ? UnknownSpace::occupied : UnknownSpace::free;
  options.bounds = bounds_argument(bounds);
  return options;
}

OccupancyObstacleOptions occupancy_obstacle(const py::handle& unknown, const py::object& bounds) {
  OccupancyObstacleOptions options;
  options.unknown_is_free = !occupied_argument(unknown);
  options.bounds = bounds_argument(bounds);
  return options;
}

/// Octrees have no lock of their own: while a frame goes into one map nobody reads or changes any. A child that is
/// forked meanwhile begins with a mutex of its own.
std::shared_mutex& octrees() {
  static std::shared_mutex* mutex = [] {
    ::pthread_atfork(nullptr, nullptr, [] { new (&octrees()) std::shared_mutex; });
    return new std::shared_mutex;
  }();
  return *mutex;
}

template <typename Work>
auto reading_octrees(const Work& work) {
  const std::shared_lock lock(octrees());
  return work();
}

template <typename Work>
auto reading_octrees_interruptibly(const Work& work) {
  return interruptible([&] { return reading_octrees(work); });
}

std::vector<Voxels> sdf_cells(const ProbabilisticSdf& sdf, const SdfObstacleOptions& options) {
  return interruptible([&] { return sdf.obstacle_cells(options); });
}

const std::vector<OptionField<OccupancyOptions>>& occupancy_fields() {
  using O = OccupancyOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("resolution", &O::resolution, "edge of the smallest cell [m]"),
      option<O>("hit", &O::hit, "probability of being occupied that a cell gets from one depth in it; in (0.5, 1)"),
      option<O>("miss", &O::miss, "the same from a ray through it; in (0, 0.5)"),
      option<O>("max_range", &O::max_range, "of a longer ray only the first part counts, as free [m]")};
  return fields;
}

void bind_occupancy(py::module_& m) {
  using R = OccupancyReport;
  py::class_<R>(m, "OccupancyReport", "What became of a frame; counts are of pixels.")
      .def_readonly("measured", &R::measured, "Pixels with a depth.")
      .def_readonly("used", &R::used, "Pixels whose ray went into the map.")
      .def_readonly("out_of_range", &R::out_of_range, "Nearer or farther than the camera sees.")
      .def_readonly("invalid", &R::invalid, "NaN, infinite or negative, hence not measured.")
      .def("__repr__", [](const R& r) {
        return "OccupancyReport(" + std::to_string(r.used) + " of " + std::to_string(r.measured) + " pixels used)";
      });
  py::class_<OccupancyMap>(
      m, "OccupancyMap",
      "An octree of free, occupied and unknown cells, filled by OctoMap's ray insertion from the depth images that a\n"
      "ProbabilisticSdf takes: surfaces are coarser, and it knows also which space was looked through.")
      .def(py::init([](const py::kwargs& options) {
             return OccupancyMap(read_options(occupancy_fields(), options, "OccupancyMap"));
           }),
           ("An empty map." + option_help(occupancy_fields())).c_str())
      .def(
          "integrate",
          [](OccupancyMap& map, const DepthImage& image, const DepthCamera& camera) {
            return interruptible([&] {
              const std::unique_lock lock(octrees());
              return map.integrate(image, camera);
            });
          },
          "image"_a, "camera"_a,
          "Casts a ray through every measured pixel in range; every cell changes at most once. Raises InvalidInput,\n"
          "with the map as it was, for an image of another size or other intrinsics than the camera's, nothing\n"
          "measured, a wrong depth scale, a pose that is no rigid motion, ends beyond 32767 cells from the origin.")
      .def(
          "query",
          [](const OccupancyMap& map, const ArrayLike& points) {
            const Eigen::Matrix3Xd columns = matrix_argument(points, "points", 3).transpose();
            py::array_t<bool> occupied(columns.cols()), known(columns.cols());
            bool *const is_occupied = occupied.mutable_data(), *const is_known = known.mutable_data();
            in_pieces(columns.cols(), [&](Eigen::Index first, Eigen::Index count) {
              const std::vector<Occupancy> states =
                  reading_octrees([&] { return map.states(columns.middleCols(first, count)); });
              for (Eigen::Index i = 0; i < count; ++i) {
                is_occupied[first + i] = states[i] == Occupancy::occupied;
                is_known[first + i] = states[i] != Occupancy::unknown;
              }
            });
            return std::make_tuple(FlagArray(occupied), FlagArray(known));
          },
          "points"_a, "(occupied, known) at `points` (n, 3) [m]: free where known and not occupied.")
      .def(
          "obstacle_cells",
          [](const OccupancyMap& map, const FreeOrOccupied& unknown, const OptionalArray& bounds) {
            const OccupancyObstacleOptions options = occupancy_obstacle(unknown, bounds);
            return reading_octrees_interruptibly([&] { return map.obstacle_cells(options); });
          },
          py::kw_only(), "unknown"_a = "free", "bounds"_a = py::none(),
          "What World.add_occupancy() adds: one Voxels per edge length, finest first.")
      .def(
          "save",
          [](const OccupancyMap& map, const PathLike& path) {
            const std::string file = path_argument(path, "path");
            reading_octrees_interruptibly([&] { map.save(file); });
          },
          "path"_a,
          "Writes OctoMap's format: .bt (occupied or free) or .ot (with probabilities). Raises IoError naming the "
          "file.")
      .def_static(
          "load",
          [](const PathLike& path, const py::kwargs& options) {
            const OccupancyOptions read = read_options(occupancy_fields(), options, "OccupancyMap.load");
            const std::string file = path_argument(path, "path");
            return interruptible([&] { return OccupancyMap::load(file, read); });
          },
          "path"_a,
          ("Reads an OctoMap file, whose resolution replaces the one given. Raises IoError when it is missing, "
           "another\n"
           "kind of tree, truncated or damaged." +
           option_help(occupancy_fields()))
              .c_str())
      .def_property_readonly(
          "frames", [](const OccupancyMap& o) { return reading_octrees([&] { return o.frames(); }); },
          "Integrated since it was made or loaded.")
      .def_property_readonly(
          "cells", [](const OccupancyMap& o) { return reading_octrees([&] { return o.cells(); }); },
          "Leaves, free and occupied.")
      .def_property_readonly(
          "memory", [](const OccupancyMap& o) { return reading_octrees([&] { return o.memory(); }); }, "[bytes]")
      .def_property_readonly(
          "resolution", [](const OccupancyMap& o) { return o.options().resolution; }, "Edge of the smallest cell [m].")
      .def_property_readonly(
          "bounds",
          [](const OccupancyMap& o) {
            const Eigen::AlignedBox3d box = reading_octrees([&] { return o.bounds(); });
            require(!box.isEmpty(), "bounds", "empty", "the map knows nothing yet");
            return std::make_tuple(box.min(), box.max());
          },
          "(lower, upper) corner of the known cells [m]. Raises InvalidInput while nothing is known.")
      .def("__repr__", [](const OccupancyMap& o) {
        const std::size_t cells = reading_octrees([&] { return o.cells(); });
        return "OccupancyMap(" + std::to_string(cells) + " cells of " + std::to_string(o.options().resolution) +
               " m and more)";
      });
}

}  // namespace

void bind_world_maps(py::module_& m) {
  m.def("_occupancy_option_table", [] { return option_table(occupancy_fields()); });
  bind_occupancy(m);
  declared<ProbabilisticSdf>(m, "ProbabilisticSdf")
      .def(
          "obstacle_cells",
          [](const ProbabilisticSdf& sdf, double sigmas, const FreeOrOccupied& unknown, const OptionalArray& bounds) {
            return sdf_cells(sdf, sdf_obstacle(sigmas, unknown, bounds));
          },
          "sigmas"_a = SdfObstacleOptions().sigmas, py::kw_only(), "unknown"_a = "free", "bounds"_a = py::none(),
          "What World.add_sdf() adds: one Voxels per edge length, finest first.");
  declared<World>(m, "World")
      .def(
          "add_sdf",
          [](World& w, const std::string& name, const ProbabilisticSdf& sdf, double sigmas,
             const FreeOrOccupied& unknown, const OptionalArray& bounds, const OptionalArray& pose) {
            const SdfObstacleOptions options = sdf_obstacle(sigmas, unknown, bounds);
            add_cells(w, name, sdf_cells(sdf, options), pose_argument(pose, "pose"));
          },
          "name"_a, "sdf"_a, "sigmas"_a = SdfObstacleOptions().sigmas, "unknown"_a = "free", py::kw_only(),
          "bounds"_a = py::none(), "pose"_a = py::none(),
          "The surfaces of a map as solid cells of its voxels' lattice: wherever mean - sigmas * sigma may be zero or\n"
          "less, what is known behind, and what these enclose. Later frames do not change the object. With\n"
          "`unknown=\"occupied\"` all of `bounds` (2, 3) (lower, upper corner [m]; default: the map's) that is not\n"
          "known to be in front of a surface, which a map knows only about two voxels deep: for what cameras looked\n"
          "through see add_occupancy(). Raises InvalidInput when nothing is occupied.")
      .def(
          "add_occupancy",
          [](World& w, const std::string& name, const OccupancyMap& occupancy, const FreeOrOccupied& unknown,
             const OptionalArray& bounds, const OptionalArray& pose) {
            const OccupancyObstacleOptions options = occupancy_obstacle(unknown, bounds);
            add_cells(w, name, reading_octrees_interruptibly([&] { return occupancy.obstacle_cells(options); }),
                      pose_argument(pose, "pose"));
          },
          "name"_a, "occupancy"_a, "unknown"_a = "free", py::kw_only(), "bounds"_a = py::none(), "pose"_a = py::none(),
          "The occupied cells of an octree as solid voxels; with `unknown=\"occupied\"` also those that no ray "
          "passed,\n"
          "within `bounds` (2, 3) (lower, upper corner [m]; default: those of what is known). Later frames do not\n"
          "change the object. Raises InvalidInput when there is no such cell.");
}

}  // namespace mmgrasp::python
