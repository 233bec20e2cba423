#include <algorithm>
#include <sstream>
#include <tuple>

#include "batch.hpp"
#include "bindings.hpp"
#include "mmgrasp/mapping/frame_registration.hpp"
#include "mmgrasp/mapping/probabilistic_sdf.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;
using Floats = py::array_t<double>;

constexpr char kDistance[] = "typing.Literal['to_plane', 'along_ray']";
constexpr char kUnknown[] = "typing.Literal['unknown', 'free', 'occupied']";
constexpr char kFlags[] = "numpy.typing.NDArray[numpy.bool_]";
using UnknownName = Shown<kUnknown>;
using Flags = Shown<kFlags>;

/// One of the names, as its place among them.
int named_choice(const py::handle& value, const std::string& name, const std::vector<std::string>& names) {
  const std::string given =
      py::isinstance<py::str>(value) ? py::cast<std::string>(value) : std::string(py::repr(value));
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (given == names[k]) return static_cast<int>(k);
  }
  std::string known;
  for (const std::string& each : names) known += (known.empty() ? "" : ", ") + each;
  throw InvalidInput(name + " = " + given + ": must be one of " + known);
}

const std::vector<std::string>& distance_names() {
  static const std::vector<std::string> names{"to_plane", "along_ray"};
  return names;
}

const std::vector<OptionField<SdfOptions>>& sdf_fields() {
  using O = SdfOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("voxel", &O::voxel, "distance of neighbouring voxels [m]"),
      option<O>("truncation", &O::truncation,
                "voxels farther from a depth are not updated by it [m]; at least 3 voxels"),
      {"distance", kDistance,
       [](O& o, const py::handle& v) {
         o.distance = static_cast<SdfDistance>(named_choice(v, "distance", distance_names()));
       },
       [](const O& o) -> py::object { return py::str(distance_names()[static_cast<std::size_t>(o.distance)]); },
       "to the plane through the measured point, or along the ray as in P3 (4.12)"},
      option<O>("max_incidence", &O::max_incidence, "what is seen more slanted is not used [rad]"),
      option<O>(
          "outlier_gate", &O::outlier_gate,
          "depths farther than this many standard deviations from what their neighbours, or three earlier frames, "
          "say are left out; 0: none are"),
      option<O>("persistence", &O::persistence,
                "most frames by which a surface can be ahead of those that looked through it, or behind"),
      option<O>("max_memory", &O::max_memory, "a frame that would need more is refused [bytes]"),
      option<O>("threads", &O::threads, "0: all")};
  return fields;
}

Eigen::Matrix3Xd columns_argument(const py::handle& value, const std::string& name) {
  return matrix_argument(value, name, 3).transpose();
}

Floats sdf_column(const Eigen::VectorXd& values) {
  return Floats(values.size(), values.data());
}

/// Columns as rows (n, 3).
Floats sdf_rows(const Eigen::Matrix3Xd& columns) {
  return Floats({columns.cols(), Eigen::Index{3}}, columns.data());
}

Flags sdf_flags(const std::vector<std::uint8_t>& values) {
  py::array_t<bool> out(static_cast<py::ssize_t>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) out.mutable_data()[i] = values[i] != 0;
  return out;
}

FrameUncertainty uncertainty_argument(const DepthImage& image, const OptionalArray& pose_covariance,
                                      const OptionalArray& sigma) {
  FrameUncertainty out;
  if (!pose_covariance.is_none()) {
    const Eigen::MatrixXd C = matrix_argument(pose_covariance, "pose_covariance", 6);
    require(C.rows() == 6, "pose_covariance", static_cast<double>(C.rows()), "must have 6 rows");
    out.pose_covariance = C;
  }
  if (!sigma.is_none()) {
    const Eigen::MatrixXd s = matrix_argument(sigma, "sigma", image.camera.width);
    for (Eigen::Index v = 0; v < s.rows(); ++v) {
      for (Eigen::Index u = 0; u < s.cols(); ++u) out.sigma.push_back(static_cast<float>(s(v, u)));
    }
  }
  return out;
}

const std::vector<OptionField<RegistrationOptions>>& registration_fields() {
  using O = RegistrationOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("max_points", &O::max_points, "pixels that are compared, spread evenly; at least 100"),
      option<O>("max_iterations", &O::max_iterations, "steps of Gauss-Newton"),
      option<O>("max_distance", &O::max_distance, "pixels farther from the map's surface are not compared [m]"),
      option<O>("min_overlap", &O::min_overlap, "share of the compared pixels that must meet the map"),
      option<O>("max_correction", &O::max_correction,
                "farther from the given pose, in its standard deviations, is refused"),
      option<O>("min_observability", &O::min_observability,
                "directions along which the surface moves by less than this share of the motion stay as given"),
      option<O>("threads", &O::threads, "0: all")};
  return fields;
}

void bind_registration(py::module_& m) {
  using R = FrameRegistration;
  py::class_<R>(m, "FrameRegistration", "Where a frame's camera stood, by what a map holds.")
      .def_readonly("registered", &R::registered, "Else the pose is the given one, and `reason` says why.")
      .def_property_readonly(
          "T_world_camera", [](const R& r) { return Eigen::Matrix4d(r.T_world_camera.matrix()); }, "(4, 4)")
      .def_readonly("covariance", &R::covariance,
                    "(6, 6) of the pose's error, as `pose_covariance` of ProbabilisticSdf.integrate().")
      .def_readonly("compared", &R::compared, "Pixels that were looked for in the map.")
      .def_readonly("matched", &R::matched, "Compared pixels that met its surface and agree with it in the end.")
      .def_readonly("observed", &R::observed, "Directions of the six that the surface fixes.")
      .def_readonly("iterations", &R::iterations, "Steps of Gauss-Newton.")
      .def_readonly("rms_before", &R::rms_before, "Distance of the matched pixels from the map at the given pose [m].")
      .def_readonly("rms", &R::rms, "The same at the registered one [m].")
      .def_readonly("correction", &R::correction, "From the given pose, in its standard deviations.")
      .def_readonly("reason", &R::reason, "Why it was refused, or empty.")
      .def("__repr__", [](const R& r) {
        return "FrameRegistration(" +
               (r.registered ? std::to_string(r.matched) + " of " + std::to_string(r.compared) + " pixels match"
                             : "refused: " + r.reason) +
               ")";
      });
  m.def(
      "register_frame",
      [](const ProbabilisticSdf& sdf, const DepthImage& image, const DepthCamera& camera,
         const ArrayLike& pose_covariance, const OptionalArray& sigma, const py::kwargs& options) {
        const auto chosen = read_options(registration_fields(), options, "register_frame");
        const FrameUncertainty uncertainty =
            uncertainty_argument(image, py::reinterpret_borrow<OptionalArray>(pose_covariance), sigma);
        return interruptible([&] { return register_frame(sdf, image, camera, uncertainty, chosen); });
      },
      "sdf"_a, "image"_a, "camera"_a, py::kw_only(), "pose_covariance"_a, "sigma"_a = py::none(),
      ("Moves a frame's pose so that its depths meet the map: point to plane on the map's field, Gauss-Newton, "
       "weighted by\n"
       "the variances of both. The given pose counts with `pose_covariance` (6, 6), which must be positive definite: "
       "it says\n"
       "how far the pose may be moved. What the surface does not fix (a plane slid in itself) is not moved. The map "
       "stays as\n"
       "it is; integrate the frame with the pose and the covariance that come back. What all frames of the map are "
       "wrong by\n"
       "together can not be told. Raises InvalidInput on frames that integrate() would refuse, an empty map and "
       "options out\n"
       "of range." +
       option_help(registration_fields()))
          .c_str());
}

void bind_depth_camera(py::module_& m) {
  const DepthNoise usual;
  py::class_<DepthNoise>(m, "DepthNoise",
                         "Standard deviation of a depth along the camera's axis [m]:\n\n"
                         "    constant + linear z + quadratic z^2 + slant z^slant_power theta^2 / (pi/2 - theta)^2\n\n"
                         "with z the depth [m] and theta the angle of incidence [rad].")
      .def(py::init([](double constant, double linear, double quadratic, double slant, double slant_power) {
             const DepthNoise made{constant, linear, quadratic, slant, slant_power};
             made.check();
             return made;
           }),
           "constant"_a = usual.constant, "linear"_a = usual.linear, "quadratic"_a = usual.quadratic,
           "slant"_a = usual.slant, "slant_power"_a = usual.slant_power,
           "The coefficients. Raises InvalidInput unless they are finite, `slant` is not negative and the standard\n"
           "deviation is positive at some depth; a camera checks its own range.")
      .def_static("structured_light", &structured_light_noise, "The first Kinect: Nguyen, Izadi, Lovell, 3DIMPVT 2012.")
      .def_static(
          "stereo", &stereo_noise, "focal"_a, "baseline"_a, "disparity_sigma"_a,
          "z^2 disparity_sigma / (focal baseline): `focal` and `disparity_sigma` in pixels, `baseline` [m], as\n"
          "in Khoshelham and Elberink, Sensors 12(2), 2012.")
      .def_static("time_of_flight", &time_of_flight_noise, "The second Kinect: Fankhauser et al., ICAR 2015.")
      .def(
          "sigma",
          [](const DepthNoise& noise, double depth, double incidence) {
            return noise.sigma(finite_argument(depth, "depth"), finite_argument(incidence, "incidence"));
          },
          "depth"_a, "incidence"_a = 0.0,
          "Standard deviation [m] at a depth [m] and an angle of incidence in [0, pi/2) [rad].")
      .def_readonly("constant", &DepthNoise::constant, "[m]")
      .def_readonly("linear", &DepthNoise::linear, "Per metre of depth.")
      .def_readonly("quadratic", &DepthNoise::quadratic, "[1/m]")
      .def_readonly("slant", &DepthNoise::slant, "Part of the slant at a depth of 1 m [m].")
      .def_readonly("slant_power", &DepthNoise::slant_power, "How the slant's part grows with the depth.")
      .def("__repr__", [](const DepthNoise& n) {
        std::ostringstream out;
        out << "DepthNoise(constant=" << n.constant << ", linear=" << n.linear << ", quadratic=" << n.quadratic
            << ", slant=" << n.slant << ", slant_power=" << n.slant_power << ")";
        return out.str();
      });
  const DepthCamera camera;
  py::class_<DepthCamera>(m, "DepthCamera", "A depth camera: what it sees and how well it measures.")
      .def(py::init([](const PinholeCamera& intrinsics, const DepthNoise& noise, const std::string& name,
                       double systematic, double systematic_scale) {
             const DepthCamera made{name, intrinsics, noise, systematic, systematic_scale};
             made.check();
             return made;
           }),
           "intrinsics"_a, "noise"_a = camera.noise, "name"_a = camera.name, "systematic"_a = camera.systematic,
           "systematic_scale"_a = camera.systematic_scale,
           "Frames of one `name` share their systematic error: an offset of all depths whose standard deviation is\n"
           "`systematic` [m], with `systematic_scale` times the depth beside it; it never averages away. Raises\n"
           "InvalidInput on values out of range.")
      .def_readonly("name", &DepthCamera::name, "Frames of one name share their systematic error.")
      .def_readonly("intrinsics", &DepthCamera::intrinsics, "Image size, focal lengths, principal point, range.")
      .def_readonly("noise", &DepthCamera::noise, "Standard deviation of each pixel.")
      .def_readonly("systematic", &DepthCamera::systematic, "Standard deviation of the offset of all depths [m].")
      .def_readonly("systematic_scale", &DepthCamera::systematic_scale, "The same in proportion to the depth.")
      .def("__repr__", [](const DepthCamera& c) { return "DepthCamera('" + c.name + "')"; });
}

void bind_sdf_results(py::module_& m) {
  using R = IntegrationReport;
  py::class_<R>(m, "IntegrationReport", "What became of a frame; counts are of pixels.")
      .def_readonly("measured", &R::measured, "Pixels with a depth.")
      .def_readonly("used", &R::used, "Pixels whose surface went into the map.")
      .def_readonly("out_of_range", &R::out_of_range, "Nearer or farther than the camera sees.")
      .def_readonly("too_noisy", &R::too_noisy, "Standard deviation above a third of the truncation.")
      .def_readonly("without_normal", &R::without_normal, "Too few neighbours on the same surface.")
      .def_readonly("too_slanted", &R::too_slanted, "Incidence above max_incidence.")
      .def_readonly("outliers", &R::outliers, "Apart from what their neighbours measured by more than the gate.")
      .def_readonly("contradicted", &R::contradicted, "Voxels at which the outlier gate shut.")
      .def_readonly("invalid", &R::invalid, "NaN, infinite or negative, hence not measured.")
      .def_readonly("new_blocks", &R::new_blocks, "Blocks of 8 x 8 x 8 voxels that the map got.")
      .def_readonly("agreement", &R::agreement,
                    "Share of pixels that confirm an earlier frame where both see the same place; NaN when they have "
                    "too little in common.")
      .def_readonly("warning", &R::warning, "What looks wrong but was integrated, or empty.")
      .def("__repr__", [](const R& r) {
        return "IntegrationReport(" + std::to_string(r.used) + " of " + std::to_string(r.measured) + " pixels used" +
               (r.warning.empty() ? "" : ", warning: " + r.warning) + ")";
      });
  py::class_<SdfHits>(m, "SdfHits", "Where rays meet the surface of a ProbabilisticSdf; NaN where they do not.")
      .def_property_readonly(
          "hit", [](const SdfHits& h) { return sdf_flags(h.hit); }, "(n,) whether the ray meets a seen surface.")
      .def_property_readonly(
          "distance", [](const SdfHits& h) { return sdf_column(h.distance); },
          "(n,) along the ray, in multiples of the direction's length.")
      .def_property_readonly(
          "point", [](const SdfHits& h) { return sdf_rows(h.point); }, "(n, 3) [m]")
      .def_property_readonly(
          "normal", [](const SdfHits& h) { return sdf_rows(h.normal); }, "(n, 3) unit normals, away from the solid.")
      .def_property_readonly(
          "sigma", [](const SdfHits& h) { return sdf_column(h.sigma); },
          "(n,) standard deviation of the surface along its normal [m].")
      .def("__repr__", [](const SdfHits& h) {
        return "SdfHits(" + std::to_string(std::count(h.hit.begin(), h.hit.end(), 1)) + " of " +
               std::to_string(h.hit.size()) + " rays hit)";
      });
}

}  // namespace

void bind_sdf(py::module_& m) {
  bind_depth_camera(m);
  bind_sdf_results(m);
  py::class_<ProbabilisticSdf>(
      m, "ProbabilisticSdf",
      "A map of surfaces seen by depth cameras: the signed distance of every voxel near a surface as a normal\n"
      "distribution (P3 4.5.2, 4.5.3), positive in front. The order of frames does not matter beyond the rounding of\n"
      "floats; what lies deeper than the truncation behind a surface stays unknown.")
      .def(py::init([](const py::kwargs& options) {
             return ProbabilisticSdf(read_options(sdf_fields(), options, "ProbabilisticSdf"));
           }),
           ("An empty map." + option_help(sdf_fields())).c_str())
      .def(
          "integrate",
          [](ProbabilisticSdf& sdf, const DepthImage& image, const DepthCamera& camera,
             const OptionalArray& pose_covariance, const OptionalArray& sigma) {
            const FrameUncertainty uncertainty = uncertainty_argument(image, pose_covariance, sigma);
            return interruptible([&] { return sdf.integrate(image, camera, uncertainty); });
          },
          "image"_a, "camera"_a, py::kw_only(), "pose_covariance"_a = py::none(), "sigma"_a = py::none(),
          "Adds a frame. `pose_covariance` (6, 6): of the error of T_world_camera, displacement [m] first, then\n"
          "rotation vector about the camera's origin [rad], along the world's axes, independent from frame to frame.\n"
          "`sigma` (height, width): standard deviation of each depth [m] in place of the camera's noise.\n"
          "Raises InvalidInput, with the map as it was, for an image of another size or other intrinsics than the\n"
          "camera's, nothing measured, a wrong depth scale, poses that are no rigid motions or the wrong way round,\n"
          "another camera of a known name, depths all too noisy for the truncation, a map above max_memory.")
      .def(
          "query",
          [](const ProbabilisticSdf& sdf, const ArrayLike& points, int threads) {
            const auto rows = batch_argument(points, "points", 3);
            const SdfValues values = for_rows(rows.shape(0), [&] { return sdf.query(positions_of(rows), threads); });
            return std::make_tuple(sdf_column(values.mean), sdf_column(values.sigma), sdf_flags(values.known));
          },
          "points"_a, "threads"_a = 0,
          "(mean, sigma, known) at `points` (n, 3): signed distance and its standard deviation [m], NaN where unknown.")
      .def(
          "cast_rays",
          [](const ProbabilisticSdf& sdf, const ArrayLike& origins, const ArrayLike& directions, int threads) {
            const auto from = batch_argument(origins, "origins", 3),
                       along = batch_argument(directions, "directions", 3);
            return for_rows(from.shape(0),
                            [&] { return sdf.cast_rays(positions_of(from), positions_of(along), threads); });
          },
          "origins"_a, "directions"_a, "threads"_a = 0,
          "The first surface from the front along each ray, (n, 3) both. Unknown space does not stop a ray.")
      .def(
          "mesh",
          [](const ProbabilisticSdf& sdf) {
            const SdfMesh found = LongCall(py::none()).run([&](const Monitor& monitor) { return sdf.mesh(monitor); });
            return std::make_tuple(MeshShape{found.mesh},
                                   Floats(static_cast<py::ssize_t>(found.sigma.size()), found.sigma.data()));
          },
          "(mesh, sigma): the zero level by marching cubes and the standard deviation at each vertex [m].")
      .def(
          "points",
          [](const ProbabilisticSdf& sdf) {
            const SdfPoints found =
                LongCall(py::none()).run([&](const Monitor& monitor) { return sdf.points(monitor); });
            return std::make_tuple(sdf_rows(found.point), sdf_rows(found.normal), sdf_column(found.sigma));
          },
          "(points, normals, sigma) of the surface: (n, 3), (n, 3), (n,).")
      .def(
          "distances",
          [](const ProbabilisticSdf& sdf, const ArrayLike& points, double sigmas, const UnknownName& unknown) {
            const int choice = named_choice(unknown, "unknown", {"unknown", "free", "occupied"});
            const Eigen::Matrix3Xd columns = columns_argument(points, "points");
            const auto field = sdf.distance_field(sigmas, static_cast<UnknownSpace>(choice));
            Eigen::VectorXd distances(columns.cols());
            in_pieces(columns.cols(), [&](Eigen::Index first, Eigen::Index count) {
              distances.segment(first, count) = field->distances(columns.middleCols(first, count));
            });
            return sdf_column(distances);
          },
          "points"_a, "sigmas"_a = 2.0, "unknown"_a = "unknown",
          "mean - sigmas * sigma at `points` (n, 3), clipped to the truncation [m]. "
          "Where\n"
          "no camera saw: NaN, or free or occupied as deep as the truncation.")
      .def(
          "save",
          [](const ProbabilisticSdf& sdf, const PathLike& path) {
            const std::string file = path_argument(path, "path");
            interruptible([&] { sdf.save(file); });
          },
          "path"_a, "Writes a file of its own format. Raises IoError naming it.")
      .def_static(
          "load",
          [](const PathLike& path, int threads) {
            const std::string file = path_argument(path, "path");
            return interruptible([&] { return ProbabilisticSdf::load(file, threads); });
          },
          "path"_a, "threads"_a = 0,
          "Reads what save() wrote. Raises IoError when it is no map, of another version, truncated or damaged.")
      .def_property_readonly("frames", &ProbabilisticSdf::frames, "Integrated so far.")
      .def_property_readonly("blocks", &ProbabilisticSdf::blocks, "Blocks of 8 x 8 x 8 voxels.")
      .def_property_readonly("memory", &ProbabilisticSdf::memory, "Size of the blocks and their index [bytes].")
      .def_property_readonly(
          "voxel", [](const ProbabilisticSdf& s) { return s.options().voxel; }, "Distance of neighbouring voxels [m].")
      .def_property_readonly(
          "truncation", [](const ProbabilisticSdf& s) { return s.options().truncation; },
          "Voxels farther from a depth are not updated by it [m].")
      .def("__repr__", [](const ProbabilisticSdf& s) {
        std::ostringstream out;
        out << "ProbabilisticSdf(" << s.frames() << " frames, " << s.blocks() << " blocks of voxels of "
            << s.options().voxel << " m)";
        return out.str();
      });
  bind_registration(m);
  m.def("_sdf_option_table", [] { return option_table(sdf_fields()); });
}

}  // namespace mmgrasp::python
