#include <algorithm>
#include <set>

#include "bindings.hpp"
#include "mmgrasp/collision/detail/named_bodies.hpp"
#include "mmgrasp/collision/floor.hpp"
#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/geometry/octree.hpp"
#include "padding.hpp"

namespace mmgrasp::python {
namespace {

constexpr char kBodyShape[] =
    "mmgrasp._core.Box | mmgrasp._core.Sphere | mmgrasp._core.Cylinder | mmgrasp._core.Capsule | mmgrasp._core.Plane | "
    "mmgrasp._core.Mesh | mmgrasp._core.Voxels | collections.abc.Sequence[mmgrasp._core.LinkShape]";
using BodyShape = Shown<kBodyShape>;

/// Occupied leaves of an OctoMap file: one Voxels shape for each leaf size, so that pruned leaves keep their size.
std::vector<LinkShape> octree_shapes(const std::string& path) {
  std::vector<LinkShape> shapes;
  for (const Voxels& voxels : interruptible([&] { return load_octree(path); })) {
    LinkShape shape;
    shape.shape = voxels;
    shapes.push_back(shape);
  }
  return shapes;
}

/// The cells of a grid through the object's origin that hold a point.
Voxels voxels_of_points(const ArrayLike& given, double resolution) {
  const Eigen::MatrixXd rows = matrix_argument(given, "points", 3);
  std::vector<Eigen::Vector3d> points(rows.rows());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) points[i] = rows.row(i);
  return interruptible([&] { return voxelize(points, resolution); });
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

}  // namespace

void bind_world(py::module_& m) {
  m.def(
      "_allowed_bodies",
      [](const Robot& robot, const World& world) {
        const detail::AllowedPairs allowed(robot, world);
        return std::vector<World::NamePair>(allowed.pairs().begin(), allowed.pairs().end());
      },
      py::arg("robot"), py::arg("world"));
  declared<World>(m, "World")
      .def(py::init<>(), "An empty world.")
      .def(
          "copy", [](const World& w) { return World(w); }, "A world of its own with the same bodies.")
      .def(
          "add",
          [](World& w, const std::string& name, const BodyShape& shapes, const OptionalArray& pose) {
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
          [](World& w, const std::string& name, const ArrayLike& size, const OptionalArray& pose) {
            w.add(name, Box{vector3_argument(size, "size")}, pose_argument(pose, "pose"));
          },
          py::arg("name"), py::arg("size"), py::arg("pose") = py::none(), "Full lengths [m], centred.")
      .def(
          "add_cylinder",
          [](World& w, const std::string& name, double radius, double length, const OptionalArray& pose) {
            w.add(name, Cylinder{radius, length}, pose_argument(pose, "pose"));
          },
          py::arg("name"), py::arg("radius"), py::arg("length"), py::arg("pose") = py::none(), "Along z, centred [m].")
      .def(
          "add_sphere",
          [](World& w, const std::string& name, double radius, const OptionalArray& pose) {
            w.add(name, Sphere{radius}, pose_argument(pose, "pose"));
          },
          py::arg("name"), py::arg("radius"), py::arg("pose") = py::none(), "Centred; `radius` [m].")
      .def(
          "add_mesh",
          [](World& w, const std::string& name, const PathLike& path, const OptionalArray& pose,
             const ArrayLike& scale) {
            const py::object shape = py::type::of<LinkShape>().attr("mesh")(path, scale);
            w.add(name, object_of({py::cast<LinkShape>(shape)}, pose));
          },
          py::arg("name"), py::arg("path"), py::arg("pose") = py::none(), py::arg("scale") = 1.0,
          "STL, OBJ, DAE or PLY; closed meshes are solids, open ones surfaces.")
      .def(
          "add_octree",
          [](World& w, const std::string& name, const PathLike& path, const OptionalArray& pose) {
            w.add(name, object_of(octree_shapes(path_argument(path, "path")), pose));
          },
          py::arg("name"), py::arg("path"), py::arg("pose") = py::none(),
          "Occupied leaves of an OctoMap file (.bt or .ot) as solid voxels.")
      .def(
          "add_points",
          [](World& w, const std::string& name, const ArrayLike& points, double resolution, const OptionalArray& pose) {
            w.add(name, voxels_of_points(points, resolution), pose_argument(pose, "pose"));
          },
          py::arg("name"), py::arg("points"), py::arg("resolution"), py::arg("pose") = py::none(),
          "Points (m, 3) as the solid cells of edge `resolution` [m] that hold one.")
      .def(
          "add_field",
          [](World& w, const std::string& name, const std::shared_ptr<DistanceField>& field, const OptionalArray& pose,
             double resolution, bool unknown_is_free) {
            w.add_field(name, {field, pose_argument(pose, "pose"), resolution, unknown_is_free});
          },
          py::arg("name"), py::arg("field").none(false), py::arg("pose") = py::none(), py::kw_only(),
          py::arg("resolution") = FieldObstacle().resolution,
          py::arg("unknown_is_free") = FieldObstacle().unknown_is_free,
          "What a distance field holds, at T_world_field (4, 4): a mesh's or a grid's; maps of cameras by add_sdf. A "
          "body "
          "is\nfree only where the field proves it, and is called so when it is farther away than twice the field's "
          "error "
          "and\n`resolution` [m].")
      .def("add_floor", &add_floor, py::arg("group"), py::arg("height") = 0.0,
           "Level ground, the object \"floor\": everything below z = `height` [m] is solid, without an end. What the "
           "joints of\n`group` move (but a base's x, y and theta) must keep off it, and so must what is attached; all "
           "other links may touch\nit: wheels stand on it, and no configuration brings these links nearer. Raises "
           "InvalidInput when the name is in use\nor `height` is not finite.")
      .def(
          "move",
          [](World& w, const std::string& name, const ArrayLike& pose) { w.move(name, pose_argument(pose, "pose")); },
          py::arg("name"), py::arg("pose"), "Puts an object or a field of the scene at T_world_object (4, 4).")
      .def("remove", &World::remove, py::arg("name"), "Takes an object, attached or not, or a field out of the world.")
      .def(
          "attach",
          [](World& w, const std::string& name, const std::string& link, const OptionalArray& pose,
             const std::set<std::string>& touch_links) {
            w.attach(name, link, pose_argument(pose, "pose"), touch_links);
          },
          py::arg("name"), py::arg("link"), py::arg("pose") = py::none(),
          py::arg("touch_links") = std::set<std::string>{},
          "From the scene to a link, at T_link_object. Empty touch_links: the link, all below it, and its gripper's "
          "fingers.")
      .def(
          "detach",
          [](World& w, const std::string& name, const OptionalArray& pose) {
            const auto held = w.attached().find(name);
            if (held == w.attached().end()) throw InvalidInput("name = '" + name + "': is not attached");
            if (pose.is_none()) {
              w.remove(name);
              return;
            }
            w.detach(name, pose_argument(pose, "pose"));
          },
          py::arg("name"), py::arg("pose") = py::none(),
          "Puts an attached object back into the scene at T_world_object; without a pose it leaves the world.")
      .def(
          "allow", &World::allow, py::arg("a"), py::arg("b"),
          "The two may touch: they are not checked against each other. Each is a link of the robot, an SRDF group (all "
          "its\nlinks) or an object, attached or not. The pair may come before its objects; a checker raises "
          "InvalidInput "
          "for names\nthat robot and world lack. remove() takes the pairs of its object back.")
      .def("disallow", &World::disallow, py::arg("a"), py::arg("b"),
           "Takes a pair of allow() back. Raises InvalidInput unless it is there.")
      .def("forget", &World::forget, py::arg("name"), "Takes back what allow() and padding said about a name.")
      .def_property_readonly(
          "allowed",
          [](const World& w) { return std::vector<World::NamePair>(w.allowed().begin(), w.allowed().end()); },
          "The pairs that may touch, as given to allow(), sorted.")
      .def_property(
          "padding", [](const World& w) { return padding_dict(w.padding()); },
          [](World& w, const PaddingLike& padding) { w.set_padding(padding_argument(padding)); },
          "How far bodies are grown where the robot (with what it holds) meets the scene [m]; never within the robot. "
          "A\n"
          "number is for all links; a dict has the keys `links`, `attached`, `objects` and `by_name` (link, object or\n"
          "SRDF group to its own padding, in place of the others).")
      .def("__contains__", &World::has)
      .def_property_readonly("objects", &keys, "Names of the scene's objects.")
      .def_property_readonly(
          "fields",
          [](const World& w) {
            std::vector<std::string> names;
            for (const auto& [name, obstacle] : w.fields()) names.push_back(name);
            return names;
          },
          "Names of the distance fields.")
      .def_property_readonly("attached", &attached_keys, "Names of the attached objects.")
      .def(
          "pose_of",
          [](const World& w, const std::string& name) {
            const auto object = w.objects().find(name);
            if (object == w.objects().end()) throw InvalidInput("name = '" + name + "': no such scene object");
            return to_array(object->second.T_world_object);
          },
          py::arg("name"), "T_world_object (4, 4) of an object of the scene. Raises InvalidInput on any other name.")
      .def(
          "shapes_of",
          [](const World& w, const std::string& name) {
            const auto object = w.objects().find(name);
            if (object != w.objects().end()) return object->second.shapes;
            const auto held = w.attached().find(name);
            if (held == w.attached().end()) throw InvalidInput("name = '" + name + "': no such object");
            return held->second.shapes;
          },
          py::arg("name"), "Shapes of an object, attached or not, in its own frame.")
      .def("__repr__", [](const World& w) {
        return "World(" + std::to_string(w.objects().size()) + " objects, " + std::to_string(w.attached().size()) +
               " held)";
      });
}

}  // namespace mmgrasp::python
