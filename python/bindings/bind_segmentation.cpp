#include "bindings.hpp"
#include "measured_arguments.hpp"
#include "mmgrasp/mapping/segment_objects.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;
using PlaneArgument = std::optional<SupportingPlane>;

const std::vector<OptionField<ObjectSegmentationOptions>>& segmentation_fields() {
  using O = ObjectSegmentationOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("leaf", &O::leaf, "cell to which points are thinned [m]; above the points' spacing"),
      option<O>("plane_tolerance", &O::plane_tolerance, "points no farther from the plane belong to it [m]"),
      option<O>("up_angle", &O::up_angle, "the plane's normal lies within this of `up` [rad]"),
      option<O>("min_plane_share", &O::min_plane_share,
                "planes with a smaller share of the thinned points support nothing"),
      option<O>("max_height", &O::max_height, "points higher above the plane are left out [m]"),
      option<O>("max_beside", &O::max_beside,
                "objects farther than this beside a plane that was found are left out [m]"),
      option<O>("patch", &O::patch, "distance of the patches that convexity is judged between [m]; at least 2 leaf"),
      option<O>("concavity", &O::concavity, "creases of up to this angle do not part objects [rad]"),
      option<O>("min_points", &O::min_points, "smaller objects are left out"),
      option<O>("plane_iterations", &O::plane_iterations, "random planes tried")};
  return fields;
}

ObjectSegmentationOptions segmentation_options(const py::kwargs& keywords, const OptionalArray& up,
                                               const char* function) {
  ObjectSegmentationOptions options = read_options(segmentation_fields(), keywords, function);
  if (!up.is_none()) options.up = vector3_argument(up, "up");
  return options;
}

Eigen::Matrix3Xd as_columns(const std::vector<Eigen::Vector3d>& rows) {
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) columns.col(static_cast<Eigen::Index>(i)) = rows[i];
  return columns;
}

py::array_t<int> index_array(const std::vector<int>& values) {
  return py::array_t<int>(static_cast<py::ssize_t>(values.size()), values.data());
}

void bind_segmentation_results(py::module_& m) {
  py::class_<SupportingPlane>(m, "SupportingPlane", "A plane that objects stand on: normal . x = offset.")
      .def(py::init([](const ArrayLike& normal, double offset) {
             const Eigen::Vector3d n = vector3_argument(normal, "normal");
             require(n.norm() > 1e-9, "normal", n.norm(), "must be a direction");
             return SupportingPlane{n.normalized(), finite_argument(offset, "offset")};
           }),
           "normal"_a, "offset"_a, "`normal` (3,) towards the objects, of any length; `offset` along it [m].")
      .def_readonly("normal", &SupportingPlane::normal, "Unit normal (3,), towards the objects.")
      .def_readonly("offset", &SupportingPlane::offset, "normal . x = offset [m]")
      .def("__repr__", [](const SupportingPlane& p) {
        return "SupportingPlane(" + text(p.normal) + ", " + std::to_string(p.offset) + ")";
      });
  py::class_<SegmentedObject>(m, "SegmentedObject", "An object that was found on a plane.")
      .def_property_readonly(
          "indices", [](const SegmentedObject& o) { return index_array(o.indices); },
          "Indices of its points (n,), ascending.")
      .def_property_readonly(
          "lower", [](const SegmentedObject& o) { return Eigen::Vector3d(o.bounds.min()); },
          "Lower corner of its points' bounds (3,) [m].")
      .def_property_readonly(
          "upper", [](const SegmentedObject& o) { return Eigen::Vector3d(o.bounds.max()); },
          "Upper corner of its points' bounds (3,) [m].")
      .def("__repr__", [](const SegmentedObject& o) {
        return "SegmentedObject(" + std::to_string(o.indices.size()) + " points from " + text(o.bounds.min()) + " to " +
               text(o.bounds.max()) + ")";
      });
  using S = ObjectSegmentation;
  py::class_<S>(m, "ObjectSegmentation", "The supporting plane, the objects on it, and which point belongs to what.")
      .def_readonly("plane", &S::plane, "Found or given; None where there is none, and then no objects.")
      .def_property_readonly(
          "plane_inliers", [](const S& s) { return index_array(s.plane_inliers); },
          "Indices (n,) of the points that belong to the plane, ascending.")
      .def_readonly("objects", &S::objects, "Those with most points first.")
      .def_property_readonly(
          "labels", [](const S& s) { return index_array(s.labels); },
          "(n,): the object of each point, -1 the plane, -2 left out or not measured. Images: row by row.")
      .def_readonly("warning", &S::warning, "What makes the answer doubtful, or empty.")
      .def("__repr__", [](const S& s) {
        return "ObjectSegmentation(" + std::to_string(s.objects.size()) + " objects" + (s.plane ? "" : ", no plane") +
               (s.warning.empty() ? "" : ", warning: " + s.warning) + ")";
      });
}

}  // namespace

void bind_segmentation(py::module_& m) {
  bind_segmentation_results(m);
  m.def("_segmentation_option_table", [] { return option_table(segmentation_fields()); });
  m.def(
      "segment_objects",
      [](const ArrayLike& points, const OptionalArray& normals, const PlaneArgument& plane, const OptionalArray& up,
         const OptionalArray& eye, const py::kwargs& options) {
        const ObjectSegmentationOptions read = segmentation_options(options, up, "segment_objects");
        const Eigen::Vector3d from = eye.is_none() ? Eigen::Vector3d::Zero() : vector3_argument(eye, "eye");
        const auto cloud = as_columns(points_argument(points, "points"));
        Eigen::Matrix3Xd directions(3, 0);
        if (!normals.is_none()) {
          directions = as_columns(points_argument(normals, "normals"));
          require(directions.cols() == cloud.cols(), "normals", static_cast<double>(directions.cols()),
                  "must be one a point, " + std::to_string(cloud.cols()));
        }
        return interruptible([&] { return segment_objects(cloud, directions, read, plane, from); });
      },
      "points"_a, "normals"_a = py::none(), py::kw_only(), "plane"_a = py::none(), "up"_a = py::none(),
      "eye"_a = py::none(),
      ("Objects that stand on a plane, also ones that touch: they are parted where the surface has creases (Stein et "
       "al.,\nCVPR 2014). `points` (n, 3) or (rows, columns, 3) [m], NaN: not measured; `normals` alike, unit, away "
       "from the solid,\nas ProbabilisticSdf.points() gives them; without, they are fitted to the points and turned "
       "to `eye` (default: the\norigin), which suits a scan from one side. The plane is the largest with most other "
       "points above it, its normal near\n`up` when that is given; or `plane`. The arms of an L are two objects, the "
       "inside of a bowl is one of its own. Raises\nInvalidInput on values out of range." +
       option_help(segmentation_fields()))
          .c_str());
  m.def(
      "segment_depth_image",
      [](const DepthImage& image, const PlaneArgument& plane, const OptionalArray& up, const py::kwargs& options) {
        const ObjectSegmentationOptions read = segmentation_options(options, up, "segment_depth_image");
        return interruptible([&] { return segment_depth_image(image, read, plane); });
      },
      "image"_a, py::kw_only(), "plane"_a = py::none(), "up"_a = py::none(),
      ("segment_objects for what one camera sees: labels are one a pixel, row by row, plane and bounds in the world." +
       option_help(segmentation_fields()))
          .c_str());
}

}  // namespace mmgrasp::python
