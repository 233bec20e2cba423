#include "bindings.hpp"
#include "measured_arguments.hpp"
#include "mmgrasp/geometry/point_cloud.hpp"
#include "mmgrasp/mapping/depth_image.hpp"
#include "mmgrasp/mapping/fit_cuboids.hpp"
#include "mmgrasp/mapping/height_map.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

/// (rows, columns) of float32.
std::vector<float> image_argument(const py::object& value, const std::string& name, int rows, int columns) {
  const auto array = measured_argument<float>(value, name);
  if (array.ndim() != 2 || (rows >= 0 && (array.shape(0) != rows || array.shape(1) != columns))) {
    const std::string wanted =
        rows >= 0 ? "(" + std::to_string(rows) + ", " + std::to_string(columns) + ")" : "(rows, columns)";
    throw InvalidInput(name + ": must have the shape " + wanted);
  }
  return {array.data(), array.data() + array.size()};
}

py::array_t<float> to_image(const std::vector<float>& values, int rows, int columns) {
  py::array_t<float> out({rows, columns});
  std::copy(values.begin(), values.end(), out.mutable_data());
  return out;
}

std::vector<PlacedShape> scene_argument(const std::vector<LinkShape>& shapes) {
  std::vector<PlacedShape> scene;
  for (const LinkShape& shape : shapes) scene.push_back({shape.shape, shape.T_link_shape});
  return scene;
}

const std::vector<OptionField<RenderOptions>>& render_fields() {
  using O = RenderOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("noise", &O::noise,
                "standard deviation of the depth at 1 m; grows with the square of the distance [m]"),
      option<O>("missing", &O::missing, "share of pixels without a measurement, in [0, 1]"),
      option<O>("seed", &O::seed, "same seed, same image"), option<O>("threads", &O::threads, "0: all")};
  return fields;
}

const std::vector<OptionField<HeightMapOptions>>& height_map_fields() {
  using O = HeightMapOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("resolution", &O::resolution, "edge of a cell [m]"),
      option<O>("hole_radius", &O::hole_radius, "holes up to so many pixels from a measurement are filled"),
      option<O>("jump", &O::jump, "neighbouring pixels that differ by more show different surfaces [m]")};
  return fields;
}

const std::vector<OptionField<CuboidFitOptions>>& cuboid_fields() {
  using O = CuboidFitOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("plane_tolerance", &O::plane_tolerance, "points no farther from the plane belong to it [m]"),
      option<O>("wall_margin", &O::wall_margin, "points no farther from a tray's wall are left out [m]"),
      option<O>("up_angle", &O::up_angle, "the plane's normal lies within this of `up` [rad]"),
      option<O>("max_height", &O::max_height, "points higher above the plane are left out [m]"),
      option<O>("cluster_tolerance", &O::cluster_tolerance, "points farther from each other are different parts [m]"),
      option<O>("leaf", &O::leaf, "cell to which points are thinned for the search [m]"),
      option<O>("min_points", &O::min_points, "smaller clusters are left out"),
      option<O>("plane_iterations", &O::plane_iterations, "random planes tried")};
  return fields;
}

void bind_clouds(py::module_& m) {
  py::class_<PointCloud>(m, "PointCloud", "Points of a scan [m]; an organised cloud keeps the image's rows.")
      .def_property_readonly(
          "points", [](const PointCloud& c) { return rows_to_array(c.points); }, "(n, 3); NaN: not measured.")
      .def_readonly("width", &PointCloud::width, "Points in a row.")
      .def_readonly("height", &PointCloud::height, "1 when the points are in no order.")
      .def_readonly("labels", &PointCloud::labels, "One a point where the file has them, else empty.")
      .def_property_readonly(
          "T_world_sensor", [](const PointCloud& c) { return to_array(c.T_world_sensor); },
          "Pose of the sensor that the file gives (4, 4).")
      .def_readonly("warning", &PointCloud::warning, "What the reader put up with, or empty.")
      .def("__repr__", [](const PointCloud& c) {
        return "PointCloud(" + std::to_string(c.width) + " x " + std::to_string(c.height) + ")";
      });
  m.def(
      "read_pcd",
      [](const PathLike& path) {
        const std::string file = path_argument(path, "path");
        return interruptible([&] { return read_pcd(file); });
      },
      py::arg("path"), "Reads a PCD file: ascii, binary or binary_compressed. Raises IoError naming file and rule.");
}

void bind_images(py::module_& m) {
  py::class_<DepthImage>(m, "DepthImage",
                         "What a depth camera saw: depth along the camera's axis [m], 0 where nothing was measured.")
      .def(py::init([](const ArrayLike& depth, const PinholeCamera& camera, const OptionalArray& T_world_camera) {
             camera.check();
             DepthImage image{camera, pose_argument(T_world_camera, "T_world_camera"),
                              image_argument(depth, "depth", camera.height, camera.width)};
             image.clean();
             return image;
           }),
           py::arg("depth"), py::arg("camera"), py::arg("T_world_camera") = py::none(),
           "`depth` (height, width) along the camera's axis [m], 0 where nothing was measured; `T_world_camera` (4, "
           "4),\n"
           "default: the identity. Raises InvalidInput where the size is not the camera's.")
      .def_property_readonly(
          "depth", [](const DepthImage& i) { return to_image(i.depth, i.camera.height, i.camera.width); },
          "(height, width) float32 [m]")
      .def_readonly("camera", &DepthImage::camera, "The camera that took it.")
      .def_property_readonly(
          "T_world_camera", [](const DepthImage& i) { return to_array(i.T_world_camera); },
          "Pose of the camera (4, 4); it looks along its +z.")
      .def(
          "points", [](const DepthImage& i) { return rows_to_array(interruptible([&] { return i.points(); })); },
          "(n, 3): every measured point in the world, row by row [m].")
      .def("__repr__", [](const DepthImage& i) {
        return "DepthImage(" + std::to_string(i.camera.width) + " x " + std::to_string(i.camera.height) + ")";
      });
  m.def(
      "render_depth",
      [](const std::vector<LinkShape>& scene, const PinholeCamera& camera, const ArrayLike& T_world_camera,
         const py::kwargs& options) {
        const RenderOptions read = read_options(render_fields(), options, "render_depth");
        const Pose T = pose_argument(T_world_camera, "T_world_camera");
        return interruptible([&] { return render_depth(scene_argument(scene), camera, T, read); });
      },
      py::arg("scene"), py::arg("camera"), py::arg("T_world_camera"),
      ("The depth image of shapes whose poses are in the world: one ray a pixel, first surface in front of the "
       "camera." +
       option_help(render_fields()))
          .c_str());
  m.def(
      "look_down", [](const ArrayLike& eye) { return to_array(look_down(vector3_argument(eye, "eye"))); },
      py::arg("eye"), "T_world_camera of a camera at `eye` [m] that looks straight down, image x along the world's x.");
  py::class_<HeightMap>(m, "HeightMap",
                        "Heights over square cells, seen along -z of the map's frame [m].\n"
                        "\n"
                        "    heights = mg.mapping.HeightMap(np.zeros((120, 160)), resolution=0.002)")
      .def(py::init([](const ArrayLike& height, double resolution, const OptionalArray& T_world_map) {
             HeightMap map;
             map.height = image_argument(height, "height", -1, -1);
             map.upper = map.height;
             const auto array = py::array::ensure(height);
             map.ny = static_cast<int>(array.shape(0));
             map.nx = static_cast<int>(array.shape(1));
             map.resolution = resolution;
             map.T_world_map = pose_argument(T_world_map, "T_world_map");
             map.check();
             return map;
           }),
           py::arg("height"), py::arg("resolution"), py::arg("T_world_map") = py::none(),
           "From heights (ny, nx) [m], NaN where nothing is known; the frame lies in the middle of the rectangle.")
      .def_property_readonly(
          "height", [](const HeightMap& h) { return to_image(h.height, h.ny, h.nx); },
          "(ny, nx) best estimate; NaN: not seen.")
      .def_property_readonly(
          "upper", [](const HeightMap& h) { return to_image(h.upper, h.ny, h.nx); },
          "(ny, nx) no surface is higher; NaN: nothing known.")
      .def_readonly("resolution", &HeightMap::resolution, "Edge of a cell [m].")
      .def_readonly("pixel", &HeightMap::pixel, "What a pixel of the image covers [m]; 0 without an image.")
      .def_property_readonly(
          "T_world_map", [](const HeightMap& h) { return to_array(h.T_world_map); },
          "Frame in the middle of the rectangle (4, 4), z up.")
      .def("__repr__",
           [](const HeightMap& h) { return "HeightMap(" + std::to_string(h.nx) + " x " + std::to_string(h.ny) + ")"; });
  m.def(
      "make_height_map",
      [](const DepthImage& image, const ArrayLike& T_world_map, const ArrayLike& size, const py::kwargs& options) {
        const HeightMapOptions read = read_options(height_map_fields(), options, "make_height_map");
        const Pose T = pose_argument(T_world_map, "T_world_map");
        const Eigen::Vector2d extent = vector2_argument(size, "size");
        return interruptible([&] { return make_height_map(image, T, extent, read); });
      },
      py::arg("image"), py::arg("T_world_map"), py::arg("size"),
      ("Resamples a depth image over a rectangle of `size` (x, y) [m] around a frame whose z points up." +
       option_help(height_map_fields()))
          .c_str());
}

void bind_cuboids(py::module_& m) {
  py::class_<FittedCuboid>(m, "FittedCuboid", "A box-shaped part on its supporting plane.")
      .def_property_readonly(
          "T_world_box", [](const FittedCuboid& c) { return to_array(c.T_world_box); },
          "Pose of its centre (4, 4): z along the plane's normal, x along the longer side.")
      .def_readonly("size", &FittedCuboid::size, "Full lengths, the longer side of the top first [m].")
      .def_readonly("points", &FittedCuboid::points, "Number of points it was fitted to.")
      .def_readonly("fill", &FittedCuboid::fill, "Share of the top rectangle that was seen: how box-like it is.")
      .def(
          "shape", [](const FittedCuboid& c) { return Box{c.size}; }, "The cuboid as a shape.")
      .def("__repr__", [](const FittedCuboid& c) {
        return "FittedCuboid(size=" + text(c.size) + " at " + text(c.T_world_box.translation()) + ")";
      });
  py::class_<CuboidFit>(m, "CuboidFit", "The supporting plane, the cuboids on it, and which point belongs to what.")
      .def_readonly("plane_found", &CuboidFit::plane_found, "A supporting plane was found, or given.")
      .def_readonly("plane_normal", &CuboidFit::plane_normal,
                    "Unit normal of the plane (3,), upwards, in the points' frame.")
      .def_readonly("plane_offset", &CuboidFit::plane_offset, "plane_normal . x = plane_offset [m]")
      .def_readonly("cuboids", &CuboidFit::cuboids, "Those with most points first.")
      .def_readonly("labels", &CuboidFit::labels, "One a point: its cuboid, -1 the plane, -2 left out.")
      .def("__repr__",
           [](const CuboidFit& f) { return "CuboidFit(" + std::to_string(f.cuboids.size()) + " cuboids)"; });
  m.def(
      "fit_cuboids",
      [](const ArrayLike& points, const OptionalArray& T_world_tray, const OptionalArray& tray_size, double wall,
         const OptionalArray& up, const OptionalArray& eye, const py::kwargs& options) {
        CuboidFitOptions read = read_options(cuboid_fields(), options, "fit_cuboids");
        if (!up.is_none()) read.up = vector3_argument(up, "up");
        const Eigen::Vector3d from = eye.is_none() ? Eigen::Vector3d::Zero() : vector3_argument(eye, "eye");
        finite_argument(wall, "wall");  // also where no tray is given that has one
        std::optional<KnownTray> tray;
        if (!tray_size.is_none()) {
          tray = KnownTray{pose_argument(T_world_tray, "T_world_tray"), vector3_argument(tray_size, "tray_size"), wall};
        } else if (!T_world_tray.is_none()) {
          throw InvalidInput("T_world_tray: needs tray_size");
        }
        const auto cloud = points_argument(points, "points");
        return interruptible([&] { return fit_cuboids(cloud, read, tray, from); });
      },
      py::arg("points"), py::kw_only(), py::arg("T_world_tray") = py::none(), py::arg("tray_size") = py::none(),
      py::arg("wall") = KnownTray{}.wall, py::arg("up") = py::none(), py::arg("eye") = py::none(),
      ("Box-shaped parts in a cloud (n, 3) (P1 3.7.1): the supporting plane and the tray are taken out, every cluster "
       "above\ngets an upright cuboid. With a tray (outer `tray_size`, frame at the middle of its floor) the floor "
       "carries the parts;\nwithout, the dominant plane does whose normal is near `up` (z; zeros: any plane, `eye` is "
       "above it)." +
       option_help(cuboid_fields()))
          .c_str());
}

}  // namespace

void bind_mapping(py::module_& m) {
  m.def("_cuboid_option_table", [] { return option_table(cuboid_fields()); });
  bind_clouds(m);
  bind_images(m);
  bind_cuboids(m);
}

}  // namespace mmgrasp::python
