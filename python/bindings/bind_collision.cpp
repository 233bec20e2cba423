
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <set>

#include "bindings.hpp"
#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/disabled_pairs.hpp"
#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/geometry/octree.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

const std::vector<OptionField<CheckerOptions>>& checker_fields() {
  using O = CheckerOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("padding", &O::padding, "robot shapes are grown by this against the scene [m]"),
      option<O>("check_self", &O::check_self, "robot (and what it holds) against itself"),
      option<O>("check_scene", &O::check_scene, "robot (and what it holds) against the scene")};
  return fields;
}

const std::vector<OptionField<DisabledPairsOptions>>& pair_fields() {
  using O = DisabledPairsOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("samples", &O::samples, "random configurations"),
      option<O>("always_fraction", &O::always_fraction, "a pair in collision at least this often is called always"),
      option<O>("seed", &O::seed, "same seed, same pairs"), option<O>("threads", &O::threads, "0: all")};
  return fields;
}

/// Occupied leaves of an OctoMap file: one Voxels shape for each leaf size, so that pruned leaves keep their size.

std::vector<LinkShape> octree_shapes(const std::string& path) {
  std::vector<LinkShape> shapes;
  for (const Voxels& voxels : load_octree(path)) {
    LinkShape shape;
    shape.shape = voxels;
    shapes.push_back(shape);
  }
  return shapes;
}

/// The cells of a grid through the object's origin that hold a point.
Voxels voxels_of_points(const Eigen::MatrixXd& points, double resolution) {
  if (!(resolution > 0) || !std::isfinite(resolution)) {
    throw InvalidInput("resolution = " + std::to_string(resolution) + ": must be > 0");
  }
  if (points.rows() == 0) throw InvalidInput("points has shape (0, 3): must hold at least one point");
  std::set<std::array<std::int64_t, 3>> cells;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    std::array<std::int64_t, 3> cell;
    for (int k = 0; k < 3; ++k) cell[k] = static_cast<std::int64_t>(std::floor(points(i, k) / resolution));
    cells.insert(cell);
  }
  auto centres = std::make_shared<std::vector<Eigen::Vector3d>>();
  for (const auto& cell : cells) {
    centres->push_back(resolution * Eigen::Vector3d(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5));
  }
  return Voxels{centres, resolution};
}

WorldObject object_of(std::vector<LinkShape> shapes, const py::object& pose) {
  WorldObject object;
  object.shapes = std::move(shapes);
  object.T_world_object = pose_argument(pose, "pose");
  return object;
}

std::vector<std::string> keys(const World& world) {
  std::vector<std::string> names;
  for (const auto& [name, object] : world.objects()) names.push_back(name);
  return names;
}

std::vector<std::string> attached_keys(const World& world) {
  std::vector<std::string> names;
  for (const auto& [name, object] : world.attached()) names.push_back(name);
  return names;
}

void bind_world(py::module_& m) {
  declared<World>(m, "World")
      .def(py::init<>())
      .def("copy", [](const World& w) { return World(w); })
      .def(
          "add",
          [](World& w, const std::string& name, const py::object& shapes, const py::object& pose) {
            if (py::isinstance<py::list>(shapes)) {
              w.add(name, object_of(py::cast<std::vector<LinkShape>>(shapes), pose));
            } else {
              w.add(name, py::cast<Shape>(shapes), pose_argument(pose, "pose"));
            }
          },
          py::arg("name"), py::arg("shape"), py::arg("pose") = py::none(),
          "A shape, or a list of LinkShape as one body.")
      .def(
          "add_box",
          [](World& w, const std::string& name, const ArrayLike& size, const py::object& pose) {
            w.add(name, Box{vector3_argument(size, "size")}, pose_argument(pose, "pose"));
          },
          py::arg("name"), py::arg("size"), py::arg("pose") = py::none(), "Full lengths [m], centred.")
      .def(
          "add_cylinder",
          [](World& w, const std::string& name, double radius, double length, const py::object& pose) {
            w.add(name, Cylinder{radius, length}, pose_argument(pose, "pose"));
          },
          py::arg("name"), py::arg("radius"), py::arg("length"), py::arg("pose") = py::none(), "Along z, centred [m].")
      .def(
          "add_sphere",
          [](World& w, const std::string& name, double radius, const py::object& pose) {
            w.add(name, Sphere{radius}, pose_argument(pose, "pose"));
          },
          py::arg("name"), py::arg("radius"), py::arg("pose") = py::none())
      .def(
          "add_mesh",
          [](World& w, const std::string& name, const py::object& path, const py::object& pose,
             const py::object& scale) {
            const py::object shape = py::type::of<LinkShape>().attr("mesh")(path, scale);
            w.add(name, object_of({py::cast<LinkShape>(shape)}, pose));
          },
          py::arg("name"), py::arg("path"), py::arg("pose") = py::none(), py::arg("scale") = 1.0,
          "STL, OBJ, DAE or PLY; closed meshes are solids, open ones surfaces.")
      .def(
          "add_octree",
          [](World& w, const std::string& name, const py::object& path, const py::object& pose) {
            w.add(name, object_of(octree_shapes(path_argument(path, "path")), pose));
          },
          py::arg("name"), py::arg("path"), py::arg("pose") = py::none(),
          "Occupied leaves of an OctoMap file (.bt or .ot) as solid voxels.")
      .def(
          "add_points",
          [](World& w, const std::string& name, const ArrayLike& points, double resolution, const py::object& pose) {
            w.add(name, voxels_of_points(matrix_argument(points, "points", 3), resolution),
                  pose_argument(pose, "pose"));
          },
          py::arg("name"), py::arg("points"), py::arg("resolution"), py::arg("pose") = py::none(),
          "Points (m, 3) as the solid cells of edge `resolution` [m] that hold one.")
      .def(
          "move",
          [](World& w, const std::string& name, const ArrayLike& pose) { w.move(name, pose_argument(pose, "pose")); },
          py::arg("name"), py::arg("pose"))
      .def("remove", &World::remove, py::arg("name"), "Takes an object, held or not, out of the world.")
      .def(
          "attach",
          [](World& w, const std::string& name, const std::string& link, const py::object& pose,
             const std::set<std::string>& touch_links) {
            w.attach(name, link, pose_argument(pose, "pose"), touch_links);
          },
          py::arg("name"), py::arg("link"), py::arg("pose") = py::none(),
          py::arg("touch_links") = std::set<std::string>{},
          "From the scene to a link, at T_link_object. Empty touch_links: the link, all below it, and its gripper's "
          "fingers.")
      .def(
          "detach",
          [](World& w, const std::string& name, const py::object& pose) {
            const auto held = w.attached().find(name);
            if (held == w.attached().end()) throw InvalidInput("name = '" + name + "': is not attached");
            if (pose.is_none()) {
              w.remove(name);
              return;
            }
            w.detach(name, pose_argument(pose, "pose"));
          },
          py::arg("name"), py::arg("pose") = py::none(),
          "Puts a held object back into the scene at T_world_object; without a pose it leaves the world.")
      .def("__contains__", &World::has)
      .def_property_readonly("objects", &keys, "Names of the scene's objects.")
      .def_property_readonly("attached", &attached_keys, "Names of the held objects.")
      .def(
          "pose_of",
          [](const World& w, const std::string& name) {
            const auto object = w.objects().find(name);
            if (object == w.objects().end()) throw InvalidInput("name = '" + name + "': no such scene object");
            return to_array(object->second.T_world_object);
          },
          py::arg("name"))
      .def(
          "shapes_of",
          [](const World& w, const std::string& name) {
            const auto object = w.objects().find(name);
            if (object != w.objects().end()) return object->second.shapes;
            const auto held = w.attached().find(name);
            if (held == w.attached().end()) throw InvalidInput("name = '" + name + "': no such object");
            return held->second.shapes;
          },
          py::arg("name"))
      .def("__repr__", [](const World& w) {
        return "World(" + std::to_string(w.objects().size()) + " objects, " + std::to_string(w.attached().size()) +
               " held)";
      });
}

void bind_answers(py::module_& m) {
  py::class_<Contact>(m, "Contact", "Two bodies that touch.")
      .def_readonly("a", &Contact::a)
      .def_readonly("b", &Contact::b)
      .def_readonly("with_scene", &Contact::with_scene)
      .def("to_dict",
           [](const Contact& c) { return py::dict("a"_a = c.a, "b"_a = c.b, "with_scene"_a = c.with_scene); })
      .def("__repr__", [](const Contact& c) { return "Contact('" + c.a + "', '" + c.b + "')"; });
  py::class_<DistanceResult>(m, "DistanceResult", "The smallest distance and where it is.")
      .def_readonly("value", &DistanceResult::value, "[m]; negative: penetration depth (approximate).")
      .def_readonly("a", &DistanceResult::a)
      .def_readonly("b", &DistanceResult::b)
      .def_readonly("point_a", &DistanceResult::point_a, "(3,) in the world frame.")
      .def_readonly("point_b", &DistanceResult::point_b)
      .def("to_dict",
           [](const DistanceResult& d) {
             return py::dict("value"_a = d.value, "a"_a = d.a, "b"_a = d.b,
                             "point_a"_a = py::cast(d.point_a).attr("tolist")(),
                             "point_b"_a = py::cast(d.point_b).attr("tolist")());
           })
      .def("__float__", [](const DistanceResult& d) { return d.value; })
      .def("__repr__", [](const DistanceResult& d) {
        return "DistanceResult(" + std::string(py::repr(py::float_(d.value))) + " m between '" + d.a + "' and '" + d.b +
               "')";
      });
}

Eigen::VectorXd configuration(const CollisionChecker& checker, const ArrayLike& q, const char* name) {
  return vector_argument(q, name, checker.group().size());
}

void bind_checker(py::module_& m) {
  py::class_<CollisionChecker>(
      m, "CollisionChecker",
      "Collision questions about one group in a snapshot of the world: later changes of the world\n"
      "are not seen. Links pairs are sampled (and cached) when no SRDF says which never touch.")
      .def(py::init([](const Robot& robot, const World& world, const JointGroup& group, const py::kwargs& options) {
             if (group.robot().hash() != robot.hash()) {
               throw InvalidInput("group: belongs to another robot ('" + group.robot().name() +
                                  "') than the one given ('" + robot.name() + "')");
             }
             return CollisionChecker(with_sampled_pairs(group), world,
                                     read_options(checker_fields(), options, "CollisionChecker"));
           }),
           py::arg("robot"), py::arg("world"), py::arg("group"), option_help(checker_fields()).c_str())
      .def_property_readonly("group", &CollisionChecker::group)
      .def(
          "is_free", [](CollisionChecker& c, const ArrayLike& q) { return c.is_free(configuration(c, q, "q")); },
          py::arg("q"), "Inside limits and without any contact.")
      .def(
          "rejection", [](CollisionChecker& c, const ArrayLike& q) { return c.rejection(configuration(c, q, "q")); },
          py::arg("q"), "The first cause found (limits, self_collision, scene), or Rejection.none.")
      .def(
          "contacts", [](CollisionChecker& c, const ArrayLike& q) { return c.contacts(configuration(c, q, "q")); },
          py::arg("q"), "Every touching pair; limits are not looked at.")
      .def(
          "distance", [](CollisionChecker& c, const ArrayLike& q) { return c.distance(configuration(c, q, "q")); },
          py::arg("q"), "Smallest distance over all checked pairs.")
      .def(
          "edge_is_free",
          [](CollisionChecker& c, const ArrayLike& q0, const ArrayLike& q1, double step) {
            if (!(step > 0)) throw InvalidInput("step = " + std::to_string(step) + ": must be > 0");
            return c.edge_is_free(configuration(c, q0, "q0"), configuration(c, q1, "q1"), step);
          },
          py::arg("q0"), py::arg("q1"), py::arg("step") = 0.02,
          "The straight joint-space edge, checked so finely that no joint moves more than `step` [rad or m].")
      .def("__repr__", [](const CollisionChecker& c) {
        return "CollisionChecker('" + c.group().robot().name() + "', group '" + c.group().name() + "', " +
               std::to_string(c.world().objects().size()) + " objects)";
      });
}

std::filesystem::path cache_folder() {
  if (const char* folder = std::getenv("XDG_CACHE_HOME"); folder && *folder)
    return std::filesystem::path(folder) / "mmgrasp";
  if (const char* home = std::getenv("HOME"); home && *home) return std::filesystem::path(home) / ".cache" / "mmgrasp";
  return std::filesystem::temp_directory_path() / "mmgrasp-cache";
}

/// Pairs by link names, one "a<tab>b<tab>reason" a line; the reason as a number. Empty when the file is absent or
/// foreign.
std::map<std::pair<int, int>, DisabledReason> read_pairs(const std::filesystem::path& file, const Robot& robot) {
  std::map<std::pair<int, int>, DisabledReason> pairs;
  std::ifstream in(file);
  std::string header, a, b, reason;
  if (!std::getline(in, header) || header != "mmgrasp-pairs 1 " + robot.hash()) return pairs;
  while (std::getline(in, a, '\t') && std::getline(in, b, '\t') && std::getline(in, reason)) {
    if (a == "end") return pairs;
    if (!robot.has_link(a) || !robot.has_link(b) || reason.size() != 1 || reason[0] < '0' || reason[0] > '4') break;
    const int i = robot.link_index(a), j = robot.link_index(b);
    pairs[{std::min(i, j), std::max(i, j)}] = static_cast<DisabledReason>(reason[0] - '0');
  }
  return {};
}

void write_pairs(const std::filesystem::path& file, const Robot& before, const Robot& after) {
  std::error_code ignored;  // a cache that cannot be written costs time only
  std::filesystem::create_directories(file.parent_path(), ignored);
  const std::filesystem::path draft = file.string() + "." + std::to_string(::getpid()) + ".tmp";
  {
    std::ofstream out(draft);
    out << "mmgrasp-pairs 1 " << before.hash() << "\n";
    for (const auto& [pair, reason] : after.disabled_pairs()) {
      out << after.links()[pair.first].name << "\t" << after.links()[pair.second].name << "\t"
          << static_cast<int>(reason) << "\n";
    }
    out << "end\tend\t0\n";
    if (!out) return;
  }
  std::filesystem::rename(draft, file, ignored);
}

Robot sampled(const Robot& robot, const py::object& progress) {
  const std::filesystem::path file = cache_folder() / ("pairs-" + robot.hash() + ".txt");
  if (auto pairs = read_pairs(file, robot); !pairs.empty()) return robot.with_disabled_pairs(std::move(pairs));
  Robot out =
      LongCall(progress).run([&](const Monitor& monitor) { return compute_disabled_pairs(robot, {}, monitor); });
  write_pairs(file, robot, out);
  return out;
}

bool knows_more_than_adjacent(const Robot& robot) {
  for (const auto& [pair, reason] : robot.disabled_pairs()) {
    if (reason != DisabledReason::adjacent) return true;
  }
  return false;
}

int links_with_shapes(const Robot& robot) {
  int count = 0;
  for (const Link& link : robot.links()) count += !link.collisions.empty();
  return count;
}

/// The group again on a robot that differs in its pairs only.
JointGroup rebuilt(const JointGroup& group, const Robot& robot) {
  const std::string tip = robot.links()[group.tip_link()].name;
  const int first = group.joints()[group.has_base() ? 3 : 0];
  const std::string base = robot.links()[robot.joints()[first].parent_link].name;
  const bool named = [&] {
    for (const GroupDescription& description : robot.groups()) {
      if (description.name == group.name()) return true;
    }
    return false;
  }();
  JointGroup out = named ? robot.group(group.name(), tip, group.has_base()) : robot.chain(base, tip, group.has_base());
  out = out.with_reference(group.reference()).with_acceleration_limits(group.acceleration_limits());
  return group.has_base() ? out : out.at(group.T_world_root());
}

}  // namespace

JointGroup with_sampled_pairs(const JointGroup& group) {
  const Robot& robot = group.robot();
  if (knows_more_than_adjacent(robot) || links_with_shapes(robot) < 3) return group;
  // One process asks for the same few robots again and again.
  static std::map<std::string, Robot> known;
  const std::string key = robot.hash();
  auto found = known.find(key);
  if (found == known.end()) {
    if (known.size() >= 16) known.clear();
    found = known.emplace(key, sampled(robot, py::none())).first;
  }
  return rebuilt(group, found->second);
}

void bind_collision(py::module_& m) {
  bind_world(m);
  bind_answers(m);
  bind_checker(m);
  m.def(
      "compute_disabled_pairs",
      [](const Robot& robot, const py::object& progress, const py::kwargs& options) {
        const DisabledPairsOptions read = read_options(pair_fields(), options, "compute_disabled_pairs");
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return compute_disabled_pairs(robot, read, monitor); });
      },
      py::arg("robot"), py::kw_only(), py::arg("progress") = py::none(),
      ("The robot with the link pairs that always or never touch found by sampling; those of an SRDF are kept." +
       option_help(pair_fields()))
          .c_str());
  m.def("with_sampled_pairs", &sampled, py::arg("robot"), py::kw_only(), py::arg("progress") = py::none(),
        "compute_disabled_pairs with default options, its result cached on disk under the robot's hash.");
  m.def(
      "cache_folder", [] { return cache_folder().string(); }, "$XDG_CACHE_HOME/mmgrasp, or ~/.cache/mmgrasp.");
}

}  // namespace mmgrasp::python
