#include <sstream>

#include <array>
#include <cmath>

#include "bindings.hpp"
#include "long_call.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/geometry/shape.hpp"
#include "mmgrasp/geometry/simplify_mesh.hpp"

namespace mmgrasp::python {
namespace {

constexpr char kStandIn[] = "mmgrasp.records.MeshStandIn";
using StandIn = Shown<kStandIn>;

std::string number(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

template <typename S>
S checked(S shape, const char* field) {
  check_shape(Shape(shape), field);
  return shape;
}

Eigen::Vector3d scale_argument(const py::object& scale) {
  if (py::isinstance<py::float_>(scale) || py::isinstance<py::int_>(scale)) {
    double value = 1;
    convert(scale, "scale", value);
    return Eigen::Vector3d::Constant(value);
  }
  return vector3_argument(scale, "scale");
}

void bind_primitives(py::module_& m) {
  py::class_<Box>(m, "Box", "A box, centred; full lengths [m].")
      .def(py::init([](const ArrayLike& size) { return checked(Box{vector3_argument(size, "size")}, "box"); }),
           py::arg("size"), "`size` (3,): full lengths along x, y, z [m], > 0.")
      .def_readonly("size", &Box::size, "Full lengths (3,) [m].")
      .def("__repr__", [](const Box& s) { return "Box(size=" + text(s.size) + ")"; });
  py::class_<Sphere>(m, "Sphere", "A sphere [m].")
      .def(py::init([](double radius) { return checked(Sphere{radius}, "sphere"); }), py::arg("radius"),
           "`radius` [m], > 0.")
      .def_readonly("radius", &Sphere::radius, "[m]")
      .def("__repr__", [](const Sphere& s) { return "Sphere(radius=" + number(s.radius) + ")"; });
  py::class_<Cylinder>(m, "Cylinder", "A cylinder along z, centred [m].")
      .def(py::init([](double radius, double length) {
             return checked(Cylinder{radius, length}, "cylinder");
           }),
           py::arg("radius"), py::arg("length"), "`radius` and `length` along z [m], > 0.")
      .def_readonly("radius", &Cylinder::radius, "[m]")
      .def_readonly("length", &Cylinder::length, "Along z [m].")
      .def("__repr__", [](const Cylinder& s) {
        return "Cylinder(radius=" + number(s.radius) + ", length=" + number(s.length) + ")";
      });
  py::class_<Capsule>(m, "Capsule", "A capsule along z, centred; `length` without the caps [m].")
      .def(py::init([](double radius, double length) {
             return checked(Capsule{radius, length}, "capsule");
           }),
           py::arg("radius"), py::arg("length"), "`radius` and `length` (without the caps) [m], > 0.")
      .def_readonly("radius", &Capsule::radius, "[m]")
      .def_readonly("length", &Capsule::length, "Length without the caps [m].")
      .def("__repr__", [](const Capsule& s) {
        return "Capsule(radius=" + number(s.radius) + ", length=" + number(s.length) + ")";
      });
  py::class_<Plane>(m, "Plane", "A half space: solid where normal . x <= offset.")
      .def(py::init([](const ArrayLike& normal, double offset) {
             return checked(Plane{vector3_argument(normal, "normal"), offset}, "plane");
           }),
           py::arg("normal"), py::arg("offset"),
           "Solid where normal . x <= offset; `normal` (3,) is a unit vector, `offset` [m].")
      .def_readonly("normal", &Plane::normal, "Unit normal (3,), out of the solid.")
      .def_readonly("offset", &Plane::offset, "normal . x = offset on the surface [m].")
      .def("__repr__",
           [](const Plane& s) { return "Plane(normal=" + text(s.normal) + ", offset=" + number(s.offset) + ")"; });
  py::class_<Voxels>(m, "Voxels", "Axis-aligned solid voxels of one edge length [m].")
      .def(py::init([](const ArrayLike& centres, double resolution) {
             const Eigen::MatrixXd rows = matrix_argument(centres, "centres", 3);
             auto points = std::make_shared<std::vector<Eigen::Vector3d>>();
             return interruptible([&] {
               points->reserve(rows.rows());
               for (Eigen::Index i = 0; i < rows.rows(); ++i) points->push_back(rows.row(i).transpose());
               return checked(Voxels{points, resolution}, "voxels");
             });
           }),
           py::arg("centres"), py::arg("resolution"), "`centres` (m, 3) of cubes with edge `resolution` [m], > 0.")
      .def_property_readonly(
          "centres", [](const Voxels& v) { return rows_to_array(*v.centres); }, "(m, 3) [m].")
      .def_readonly("resolution", &Voxels::resolution, "Edge of a voxel [m].")
      .def("__repr__", [](const Voxels& v) {
        return "Voxels(" + std::to_string(v.centres->size()) + " of " + number(v.resolution) + " m)";
      });
}

std::shared_ptr<const TriangleMesh> mesh_file(const std::string& path, const Eigen::Vector3d& scale) {
  return interruptible([&] { return load_mesh(path, scale); });
}

void bind_mesh(py::module_& m) {
  py::class_<MeshShape>(m, "Mesh",
                        "A triangle mesh [m]; closed ones are solids, open ones surfaces.\n"
                        "\n"
                        "    mesh = mg.Mesh.load(\"bracket.stl\", scale=0.001)\n"
                        "    mesh.closed, len(mesh.triangles)")
      .def_static(
          "load",
          [](const PathLike& path, const ArrayLike& scale) {
            return MeshShape{mesh_file(path_argument(path, "path"), scale_argument(scale))};
          },
          py::arg("path"), py::arg("scale") = 1.0,
          "Reads STL, OBJ, DAE or PLY. `scale` is a number or one per axis. Raises IoError naming file and place.")
      .def_static(
          "from_arrays",
          [](const ArrayLike& vertices, const ArrayLike& triangles) {
            const auto corners = batch_argument(vertices, "vertices", 3),
                       numbers = batch_argument(triangles, "triangles", 3);
            std::vector<Eigen::Vector3d> points(corners.shape(0));
            if (!points.empty()) std::copy(corners.data(), corners.data() + corners.size(), points[0].data());
            std::vector<std::array<int, 3>> faces(numbers.shape(0));
            for (std::size_t i = 0; i < 3 * faces.size(); ++i) {
              const double number = numbers.data()[i];
              // Messages are put together for what is refused only.
              if (number != std::floor(number) || !(number >= 0 && number < static_cast<double>(points.size())))
                require(false, "triangles", number, "must be numbers of vertices, from 0 on");
              faces[i / 3][i % 3] = static_cast<int>(number);
            }
            return MeshShape{interruptible([&] { return make_mesh(std::move(points), std::move(faces)); })};
          },
          py::arg("vertices"), py::arg("triangles"),
          "From vertices (n, 3) [m] and their numbers (m, 3), cleaned as a file's: equal vertices merge, triangles "
          "without area go, closed meshes are turned outwards. Raises InvalidInput for numbers out of range.")
      .def_property_readonly(
          "closed", [](const MeshShape& s) { return s.mesh->closed; }, "A solid; open meshes are surfaces.")
      .def_property_readonly(
          "convex", [](const MeshShape& s) { return s.mesh->convex; }, "Closed and convex.")
      .def_property_readonly(
          "source", [](const MeshShape& s) { return s.mesh->source; }, "File it was read from.")
      .def_property_readonly(
          "volume", [](const MeshShape& s) { return mesh_volume(*s.mesh); },
          "Signed volume [m^3]; meaningful for closed meshes.")
      .def_property_readonly(
          "vertices", [](const MeshShape& s) { return rows_to_array(s.mesh->vertices); }, "(n, 3) [m]")
      .def_property_readonly(
          "triangles",
          [](const MeshShape& s) {
            const auto& t = s.mesh->triangles;
            py::array_t<int> out({static_cast<py::ssize_t>(t.size()), py::ssize_t{3}});
            if (!t.empty()) std::copy(t[0].data(), t[0].data() + 3 * t.size(), out.mutable_data());
            return out;
          },
          "(m, 3) vertex indices.")
      .def("__repr__", [](const MeshShape& s) {
        return "Mesh(" + std::to_string(s.mesh->triangles.size()) + " triangles, " +
               (s.mesh->closed ? "closed" : "open") + ", '" + s.mesh->source + "')";
      });
}

/// The stand-in with the names that a robot's report has.
StandIn stand_in_dict(const MeshShape& mesh, double tolerance) {
  const MeshStandIn found = interruptible([&] { return simplify_mesh(mesh.mesh, tolerance); });
  LinkShape shape;
  shape.shape = found.shape;
  shape.T_link_shape = found.T_mesh_shape;
  return py::dict(py::arg("shape") = shape, py::arg("chosen") = found.chosen,
                  py::arg("triangles_saved") = found.triangles_saved, py::arg("deviation") = found.deviation);
}

}  // namespace

void bind_geometry(py::module_& m) {
  bind_primitives(m);
  bind_mesh(m);
  py::class_<LinkShape>(m, "LinkShape", "A shape and its pose in the body (robot link, part, obstacle) it belongs to.")
      .def(py::init([](const Shape& shape, const OptionalArray& pose) {
             LinkShape out;
             check_shape(shape, "shape");
             out.shape = shape;
             out.T_link_shape = pose_argument(pose, "pose");
             if (const auto* mesh = std::get_if<MeshShape>(&shape)) out.mesh_path = out.mesh_uri = mesh->mesh->source;
             return out;
           }),
           py::arg("shape"), py::arg("pose") = py::none(),
           "`shape` at `pose` (4, 4) in the body's frame, default: the identity.")
      .def_static(
          "mesh",
          [](const PathLike& path, const ArrayLike& scale, const OptionalArray& pose) {
            LinkShape out;
            out.mesh_path = out.mesh_uri = path_argument(path, "path");
            out.mesh_scale = scale_argument(scale);
            out.shape = MeshShape{mesh_file(out.mesh_path, out.mesh_scale)};
            out.T_link_shape = pose_argument(pose, "pose");
            return out;
          },
          py::arg("path"), py::arg("scale") = 1.0, py::arg("pose") = py::none(),
          "A mesh read from a file, which is remembered so that robots and plans can be written out.")
      .def_readonly("shape", &LinkShape::shape, "The shape itself.")
      .def_property_readonly(
          "pose", [](const LinkShape& s) { return to_array(s.T_link_shape); },
          "Pose of the shape in the body's frame (4, 4).")
      .def_readonly("mesh_path", &LinkShape::mesh_path, "File of a mesh; empty for other shapes.")
      .def_readonly("mesh_scale", &LinkShape::mesh_scale, "Scale of the file along its axes (3,).")
      .def_property_readonly(
          "kind", [](const LinkShape& s) { return shape_kind(s.shape); },
          "box, sphere, cylinder, capsule, plane, mesh or voxels.")
      .def_property_readonly(
          "bounds",
          [](const LinkShape& s) {
            const Eigen::AlignedBox3d box = shape_bounds(s.shape, s.T_link_shape);
            return py::make_tuple(Eigen::Vector3d(box.min()), Eigen::Vector3d(box.max()));
          },
          "Lower and upper corner of its axis-aligned box in the body frame [m].")
      .def(
          "surface",
          [](const LinkShape& s, int segments) {
            LinkShape out;
            out.shape = MeshShape{interruptible([&] { return shape_mesh(s.shape, segments); })};
            return std::get<MeshShape>(out.shape);
          },
          py::arg("segments") = 24, "Its surface as triangles in the shape's own frame, for pictures.")
      .def("__repr__", [](const LinkShape& s) {
        return std::string("LinkShape(") + shape_kind(s.shape) + " at " + text(s.T_link_shape.translation()) + ")";
      });
  m.def("simplify_mesh", &stand_in_dict, py::arg("mesh"), py::arg("tolerance") = 0.0,
        "The simplest solid that contains a mesh and has no point farther than `tolerance` [m] from it, as a dict:\n"
        "`shape` (a LinkShape in the mesh's frame), `chosen` (mesh, hull, box, sphere or cylinder), `triangles_saved` "
        "and\n"
        "the proven `deviation` [m]. With 0 the solid stays the same.");
}

}  // namespace mmgrasp::python
