#include "bindings.hpp"
#include "mmgrasp/task/platform_locations.hpp"

namespace mmgrasp::python {
namespace {

constexpr char kSearchCounts[] = "mmgrasp.records.SearchCounts";
using SearchCounts = Shown<kSearchCounts>;

using namespace py::literals;

const std::vector<OptionField<PlatformLocationsOptions>>& fields() {
  using O = PlatformLocationsOptions;
  static const std::vector<OptionField<O>> all{
      option<O>("samples", &O::samples, "valid configurations drawn for each pose"),
      option<O>("max_draws", &O::max_draws, "searches for each pose, valid or not"),
      option<O>("least_manipulability", &O::least_manipulability, "over the arm's joints"),
      option<O>("turn_weight", &O::turn_weight, "what one radian of base turn counts as [m]"),
      option<O>("seed", &O::seed, "same seed, same answer"),
      option<O>("time_limit", &O::time_limit, "wall-clock cap [s]")};
  return all;
}

SearchCounts counts_dict(const PlatformLocationsCounts& counts) {
  return py::dict("draws"_a = counts.draws, "rejections"_a = python::to_dict(counts.rejections), "view"_a = counts.view,
                  "singular"_a = counts.singular, "iterations"_a = counts.iterations);
}

MaybeFloats configuration(const PlatformLocations& found, const Eigen::VectorXd& q) {
  return found.outcome == Outcome::solved ? py::cast(q) : py::none();
}

void bind_platform_locations_result(py::module_& m) {
  py::class_<PlatformLocations>(m, "PlatformLocations", "Two base + arm configurations for two tool poses.")
      .def_readonly("outcome", &PlatformLocations::outcome, "How it ended; `solved` alone comes with an answer.")
      .def_property_readonly(
          "q_pick", [](const PlatformLocations& p) { return configuration(p, p.q_pick); },
          "Base and arm at the first pose; None unless solved.")
      .def_property_readonly(
          "q_place", [](const PlatformLocations& p) { return configuration(p, p.q_place); },
          "Base and arm at the second pose; None unless solved.")
      .def_readonly("cost", &PlatformLocations::cost, "Travel [m] + turn_weight * turn [rad].")
      .def_readonly("travel", &PlatformLocations::travel, "Travel of the base between the two [m].")
      .def_readonly("turn", &PlatformLocations::turn, "[rad]")
      .def_property_readonly(
          "pick", [](const PlatformLocations& p) { return counts_dict(p.pick); },
          "Draws, what they fell at, and iterations of the first pose.")
      .def_property_readonly(
          "place", [](const PlatformLocations& p) { return counts_dict(p.place); }, "The same of the second pose.")
      .def(
          "to_dict",
          [](const PlatformLocations& p) {
            return py::dict("outcome"_a = to_string(p.outcome), "q_pick"_a = configuration(p, p.q_pick),
                            "q_place"_a = configuration(p, p.q_place), "cost"_a = p.cost, "travel"_a = p.travel,
                            "turn"_a = p.turn, "pick"_a = counts_dict(p.pick), "place"_a = counts_dict(p.place));
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const PlatformLocations& p) {
        return std::string("PlatformLocations(") + to_string(p.outcome) +
               (p.outcome == Outcome::solved
                    ? ", travel " + std::to_string(p.travel) + " m, turn " + std::to_string(p.turn) + " rad"
                    : std::string()) +
               ")";
      });
}

void bind_camera(py::module_& m) {
  const PinholeCamera usual;
  py::class_<PinholeCamera>(m, "PinholeCamera",
                            "Pinhole camera without distortion: looks along +z, x to the right of the image, y down.")
      .def(py::init(
               [](int width, int height, double fx, double fy, double cx, double cy, double nearest, double farthest) {
                 const PinholeCamera camera{width, height, fx, fy, cx, cy, nearest, farthest};
                 camera.check();
                 return camera;
               }),
           py::arg("width") = usual.width, py::arg("height") = usual.height, py::arg("fx") = usual.fx,
           py::arg("fy") = usual.fy, py::arg("cx") = usual.cx, py::arg("cy") = usual.cy,
           py::arg("nearest") = usual.nearest, py::arg("farthest") = usual.farthest,
           "Sizes, focal lengths and principal point in pixels, depths seen in [nearest, farthest] [m].")
      .def_readonly("width", &PinholeCamera::width, "[pixels]")
      .def_readonly("height", &PinholeCamera::height, "[pixels]")
      .def_readonly("fx", &PinholeCamera::fx, "Focal length along x [pixels].")
      .def_readonly("fy", &PinholeCamera::fy, "Focal length along y [pixels].")
      .def_readonly("cx", &PinholeCamera::cx, "Principal point along x [pixels].")
      .def_readonly("cy", &PinholeCamera::cy, "Principal point along y [pixels].")
      .def_readonly("nearest", &PinholeCamera::nearest, "What lies closer along the axis is not seen [m].")
      .def_readonly("farthest", &PinholeCamera::farthest, "What lies farther along the axis is not seen [m].")
      .def(
          "project",
          [](const PinholeCamera& camera, const ArrayLike& point) -> MaybeFloats {
            const auto pixel = camera.project(vector3_argument(point, "point"));
            return pixel ? py::cast(*pixel) : py::none();
          },
          py::arg("point"), "Pixel (u, v) of a point in the camera's frame, or None when it is not seen.")
      .def("__repr__", [](const PinholeCamera& c) {
        return "PinholeCamera(" + std::to_string(c.width) + " x " + std::to_string(c.height) + ", f " +
               std::to_string(c.fx) + ", " + std::to_string(c.fy) + ")";
      });
}

void bind_database(py::module_& m) {
  py::class_<IkSeedDatabase>(m, "IkSeedDatabase", "Past solutions that start the next searches; grows with use.")
      .def(py::init<const JointGroup&, int>(), py::arg("group"), py::arg("capacity") = 10000,
           "Empty, for configurations of `group`; beyond `capacity` the oldest are forgotten.")
      .def("__len__", &IkSeedDatabase::size)
      .def(
          "add", [](IkSeedDatabase& db, const ArrayLike& q) { db.add(vector_argument(q, "q", db.group().size())); },
          py::arg("q"),
          "Remembers a configuration (n,) with the base taken out: where the tool stood relative to the root, and the "
          "arm's joints.")
      .def(
          "seeds",
          [](const IkSeedDatabase& db, const ArrayLike& T, int count) {
            return rows_to_array(db.seeds(pose_argument(T, "T_world_tip"), count));
          },
          py::arg("T_world_tip"), py::arg("count") = 8,
          "(k, n): remembered arm postures with the base put where they reach the pose, best match first.")
      .def(
          "save", [](const IkSeedDatabase& db, const PathLike& path) { db.save(path_argument(path, "path")); },
          py::arg("path"), "Writes a text file. Raises IoError.")
      .def_static(
          "load",
          [](const PathLike& path, const JointGroup& group, int capacity) {
            return IkSeedDatabase::load(path_argument(path, "path"), group, capacity);
          },
          py::arg("path"), py::arg("group"), py::arg("capacity") = 10000,
          "Raises IoError on a damaged file or one made for another robot.");
}

}  // namespace

void bind_platform_locations(py::module_& m) {
  m.def("_platform_option_table", [] { return option_table(fields()); });
  bind_camera(m);
  bind_platform_locations_result(m);
  bind_database(m);
  m.def(
      "plan_platform_locations",
      [](CollisionChecker& checker, const ArrayLike& T_world_pick, const ArrayLike& T_world_place,
         const OptionalArray& pick_point, const OptionalArray& place_point, const OptionalText& camera_link,
         const OptionalArray& T_link_camera, const PinholeCamera* camera, IkSeedDatabase* database,
         const py::kwargs& options) {
        PlatformLocationsProblem problem;
        problem.T_world_pick = pose_argument(T_world_pick, "T_world_pick");
        problem.T_world_place = pose_argument(T_world_place, "T_world_place");
        problem.pick_point =
            pick_point.is_none() ? problem.T_world_pick.translation() : vector3_argument(pick_point, "pick_point");
        problem.place_point =
            place_point.is_none() ? problem.T_world_place.translation() : vector3_argument(place_point, "place_point");
        if (camera_link.is_none() && (!T_link_camera.is_none() || camera))
          throw InvalidInput(std::string(camera ? "camera" : "T_link_camera") +
                             ": name the camera_link that carries it");
        if (!camera_link.is_none()) {
          MountedCamera mounted;
          if (camera) mounted.camera = *camera;
          std::string link;
          convert(camera_link, "camera_link", link);
          mounted.link = checker.group().robot().link_index(link);
          if (!T_link_camera.is_none()) mounted.T_link_camera = pose_argument(T_link_camera, "T_link_camera");
          problem.camera = mounted;
        }
        const PlatformLocationsOptions read = read_options(fields(), options, "plan_platform_locations");
        CollisionChecker own = checker.clone();
        return LongCall(py::none()).run([&](const Monitor& monitor) {
          return plan_platform_locations(own, problem, read, database, monitor);
        });
      },
      py::arg("checker"), py::arg("T_world_pick"), py::arg("T_world_place"), py::kw_only(),
      py::arg("pick_point") = py::none(), py::arg("place_point") = py::none(), py::arg("camera_link") = py::none(),
      py::arg("T_link_camera") = py::none(), py::arg("camera") = py::none(), py::arg("database") = py::none(),
      ("Two base + arm configurations for two tool poses with the least base travel (P3 3.6, Algorithm 2). The "
       "checker's group\nmust have the base. With a `camera_link` the points (default: the tool positions) are in view "
       "of\n"
       "`camera` (default: PinholeCamera()), whose frame looks along +z. A database starts the searches and learns "
       "from them." +
       option_help(fields()))
          .c_str());
}

}  // namespace mmgrasp::python
