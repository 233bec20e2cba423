#include <cmath>
#include <sstream>
#include <tuple>

#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/geometry/detail/mesh_faults.hpp"
#include "mmgrasp/geometry/detail/separate_bodies.hpp"
#include "mmgrasp/geometry/fit_primitives.hpp"
#include "mmgrasp/geometry/segment_mesh.hpp"
#include "mmgrasp/geometry/shape_diameter.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

const std::vector<OptionField<ShapeDiameterOptions>>& diameter_fields() {
  using O = ShapeDiameterOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("rays", &O::rays, "rays from the middle of each face"),
      option<O>("cone", &O::cone, "full angle of their cone around the inward normal [rad]"),
      option<O>("outlier", &O::outlier, "standard deviations from the median beyond which rays are left out"),
      option<O>("ray_lengths", &O::ray_lengths, "P1's mean length of the rays, not the width between the surfaces"),
      option<O>("threads", &O::threads, "0: all")};
  return fields;
}

const std::vector<OptionField<MeshSegmentationOptions>>& mesh_segmentation_fields() {
  using O = MeshSegmentationOptions;
  using D = ShapeDiameterOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("rays", &O::diameter, &D::rays, "rays from the middle of each face"),
      option<O>("cone", &O::diameter, &D::cone, "full angle of their cone around the inward normal [rad]"),
      option<O>("outlier", &O::diameter, &D::outlier,
                "standard deviations from the median beyond which rays are left out"),
      option<O>("ray_lengths", &O::diameter, &D::ray_lengths,
                "P1's mean length of the rays, not the width between the surfaces"),
      option<O>("max_clusters", &O::max_clusters, "most Gaussians over the logarithms of the diameters"),
      option<O>("smoothing", &O::smoothing, "cost of a border between clusters beside faces in the wrong one"),
      option<O>("crease", &O::crease, "inward creases of more, sharp or rounded over min_size, part segments [rad]"),
      option<O>("min_size", &O::min_size, "narrower segments join a neighbour, as a share of the mesh's diagonal"),
      option<O>("convexity", &O::convexity,
                "segments join when their hull has at most this share of the smaller one's volume in neither"),
      option<O>("smooth_threads", &O::smooth_threads, "screw threads count as the cylinder through their crests"),
      option<O>("faces", &O::faces, "larger faces are cut until there are about so many, for the work alone"),
      option<O>("seed", &O::seed, "same seed, same segments"),
      option<O>("threads", &O::diameter, &D::threads, "0: all")};
  return fields;
}

template <typename T>
py::array_t<T> flat_array(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

std::string millimetres(double metres) {
  std::ostringstream out;
  out.precision(4);
  out << 1e3 * metres << " mm";
  return out.str();
}

void bind_segmentation_parts(py::module_& m) {
  py::class_<ScrewThread>(m, "ScrewThread", "A screw thread that segment_mesh found.")
      .def_property_readonly(
          "T_mesh_thread", [](const ScrewThread& t) { return to_array(t.T_mesh_thread); },
          "(4, 4): z along the axis, origin at the middle of the thread.")
      .def_readonly("pitch", &ScrewThread::pitch, "Along the axis in one turn [m]; positive: right-handed.")
      .def_readonly("root_radius", &ScrewThread::root_radius, "[m]")
      .def_readonly("crest_radius", &ScrewThread::crest_radius, "[m]; smaller than the root's in a nut.")
      .def_readonly("length", &ScrewThread::length, "Along the axis [m].")
      .def_property_readonly(
          "faces", [](const ScrewThread& t) { return flat_array(t.faces); }, "Faces of the mesh (n,), ascending.")
      .def("__repr__", [](const ScrewThread& t) {
        return "ScrewThread(diameter " + millimetres(2 * t.crest_radius) + ", pitch " + millimetres(t.pitch) +
               ", length " + millimetres(t.length) + ")";
      });
  py::class_<MeshSegment>(m, "MeshSegment", "One of the simple bodies that a part is composed of.")
      .def_property_readonly(
          "faces", [](const MeshSegment& s) { return flat_array(s.faces); }, "Faces of the mesh (n,), ascending.")
      .def_readonly("area", &MeshSegment::area, "[m^2]")
      .def_readonly("diameter", &MeshSegment::diameter, "Median of its faces' shape diameters by area [m].")
      .def_readonly("threaded", &MeshSegment::threaded,
                    "More than a tenth of its area is screw thread, which must not be grasped.")
      .def("__repr__", [](const MeshSegment& s) {
        return "MeshSegment(" + std::to_string(s.faces.size()) + " faces, diameter " + millimetres(s.diameter) +
               (s.threaded ? ", threaded)" : ")");
      });
}

void bind_fitted_primitives(py::module_& m) {
  py::class_<GraspWidth>(m, "GraspWidth", "A width at which fingers may close on a segment.")
      .def_readonly("width", &GraspWidth::width, "[m]")
      .def_property_readonly(
          "axis", [](const GraspWidth& w) { return Eigen::Vector3d(w.axis); },
          "Closing direction of a box, axis of a round wall (3,): a unit vector in the mesh's frame.")
      .def_readonly(
          "covered", &GraspWidth::covered,
          "Share of the box' shadow along the axis on which facets lie opposite each other, or of the turn around "
          "the wall that is surface.")
      .def("__repr__",
           [](const GraspWidth& w) { return "GraspWidth(" + millimetres(w.width) + " along " + text(w.axis) + ")"; });
  using F = FittedPrimitive;
  py::class_<F>(m, "FittedPrimitive", "The primitive that stands for a segment (P1, section 5.2.2).")
      .def_property_readonly(
          "kind", [](const F& f) { return primitive_kind_name(f.kind); }, "cylinder, box, cone or sphere.")
      .def_property_readonly(
          "T_mesh_primitive", [](const F& f) { return to_array(f.T_mesh_primitive); },
          "(4, 4): centre; z along the axis of a cylinder or cone, which narrows along z.")
      .def_property_readonly(
          "size", [](const F& f) { return Eigen::Vector3d(f.size); },
          "(3,) [m]: lengths of a box; diameter twice and length of a cylinder; diameters at foot and top and length "
          "of "
          "a cone; diameter of a sphere.")
      .def_readonly("volume", &F::volume, "Volume of the primitive [m^3].")
      .def_readonly("hull_volume", &F::hull_volume, "Volume of the segment's convex hull [m^3].")
      .def_readonly("deviation", &F::deviation,
                    "Mean distance of the segment's faces from the primitive's surface that they lie on [m].")
      .def_readonly("widths", &F::widths, "Most covered first; empty where there is no surface to hold.")
      .def("__repr__", [](const F& f) {
        return std::string("FittedPrimitive(") + primitive_kind_name(f.kind) + " of " + text(1e3 * f.size) + " mm, " +
               std::to_string(f.widths.size()) + " widths)";
      });
  m.def(
      "fit_primitives",
      [](const MeshShape& mesh, const ArrayLike& labels, const Given<std::vector<ScrewThread>>& threads,
         const Given<double>& min_contact, const Progress& progress) {
        const double contact = taken(min_contact, "min_contact");
        const Eigen::VectorXd values = vector_argument(labels, "labels");
        const std::size_t faces = mesh.mesh->triangles.size();
        if (static_cast<std::size_t>(values.size()) != faces)
          throw InvalidInput("labels has shape (" + std::to_string(values.size()) + ",): must be (" +
                             std::to_string(faces) + ",), one a face");
        std::vector<int> numbers;
        for (Eigen::Index i = 0; i < values.size(); ++i) {
          if (values[i] != std::floor(values[i]) || std::abs(values[i]) >= 1e9)
            require(false, "labels[" + std::to_string(i) + "]", values[i], "must be a whole number");
          numbers.push_back(static_cast<int>(values[i]));
        }
        const auto smoothed = taken(threads, "threads", "ScrewThread");
        LongCall call(progress);
        return call.run(
            [&](const Monitor& monitor) { return fit_primitives(*mesh.mesh, numbers, smoothed, monitor, contact); });
      },
      "mesh"_a, "labels"_a, py::kw_only(), "threads"_a = py::list(),
      "min_contact"_a = OppositeFacetsOptions{}.min_contact, "progress"_a = py::none(),
      "The cylinder, box, cone or sphere that stands for each segment of a mesh: the one whose volume is closest to "
      "that "
      "of\nthe segment's convex hull, of those with surface on them (P1, section 5.2.2). `labels` (m,): the segment of "
      "each face, as\nMeshSegmentation.labels. Round inner walls are never offered for grasping; a box is held by the "
      "facets "
      "that "
      "`jaw_grasps` takes,\nwhich lie opposite each other over `min_contact` [m] or more. `threads`:\nthose of "
      "MeshSegmentation, which count as the cylinder through their crests. "
      "Raises InvalidInput when there is not one "
      "label\n>= 0 a face, or for threads of other meshes.");
  m.def(
      "segment_names",
      [](const Given<std::vector<F>>& primitives) {
        return segment_names(taken(primitives, "primitives", "FittedPrimitive"));
      },
      "primitives"_a,
      "A name for each segment of a part by its primitive: the kind and the place among those of the kind, from 1, in "
      "the order of the segments, largest area first: cylinder_1, box_1, cylinder_2.");
}

}  // namespace

void bind_segment_mesh(py::module_& m) {
  bind_segmentation_parts(m);
  bind_fitted_primitives(m);
  using S = MeshSegmentation;
  py::class_<S>(m, "MeshSegmentation", "The bodies that a part is composed of, and which face belongs to which.")
      .def_readonly("outcome", &S::outcome, "Solved.")
      .def_property_readonly(
          "labels", [](const S& s) { return flat_array(s.labels); }, "Segment of each face (m,).")
      .def_property_readonly(
          "diameters", [](const S& s) { return flat_array(s.diameters); },
          "Shape diameter of each face (m,) [m]; 0 where it is unknown.")
      .def_readonly("segments", &S::segments, "Largest area first.")
      .def_readonly("threads", &S::threads, "Screw threads, largest first.")
      .def_readonly("turned", &S::turned, "The mesh was inside out (open ones may be) and its faces were turned.")
      .def_readonly("clusters", &S::clusters, "Gaussians that the diameters called for.")
      .def("__repr__", [](const S& s) {
        return "MeshSegmentation(" + std::to_string(s.segments.size()) + " segments of " +
               std::to_string(s.labels.size()) + " faces, " + std::to_string(s.threads.size()) + " threads)";
      });
  m.def("_shape_diameter_option_table", [] { return option_table(diameter_fields()); });
  m.def(
      "_mesh_with_faults",
      [](const PathLike& path, const Given<double>& scale) {
        const auto [mesh, faults, bodies] =
            interruptible([file = path_argument(path, "path"), metres = taken(scale, "scale")] {
              detail::MeshFaults found;
              const auto read = detail::load_mesh(file, Eigen::Vector3d::Constant(metres), found);
              return std::make_tuple(read, found, detail::count_bodies(*read));
            });
        return std::make_tuple(MeshShape{mesh}, faults.inside_out, faults.turned_triangles, faults.repeated_triangles,
                               faults.enclosed_bodies, bodies);
      },
      "path"_a, "scale"_a = 1.0);
  m.def("_mesh_segmentation_option_table", [] { return option_table(mesh_segmentation_fields()); });
  m.def(
      "shape_diameters",
      [](const MeshShape& mesh, const Progress& progress, const py::kwargs& options) {
        const ShapeDiameterOptions read = read_options(diameter_fields(), options, "shape_diameters");
        LongCall call(progress);
        return flat_array(call.run([&](const Monitor& monitor) { return shape_diameters(*mesh.mesh, read, monitor); }));
      },
      "mesh"_a, py::kw_only(), "progress"_a = py::none(),
      ("Local thickness of a mesh at the middle of each face (m,) [m]; 0 where no ray leaves it. The mean over `rays` "
       "in a\ncone around the inward normal, weighted by the cosine of their angle to it, of the distance between the "
       "two ends along\nthe mean of their normals: exact in balls, cylinders, plates and tubes (P1, section 5.1, takes "
       "the rays' lengths)." +
       option_help(diameter_fields()))
          .c_str());
  m.def(
      "segment_mesh",
      [](const MeshShape& mesh, const Progress& progress, const py::kwargs& options) {
        const MeshSegmentationOptions read = read_options(mesh_segmentation_fields(), options, "segment_mesh");
        LongCall call(progress);
        return call.run([&](const Monitor& monitor) { return segment_mesh(*mesh.mesh, read, monitor); });
      },
      "mesh"_a, py::kw_only(), "progress"_a = py::none(),
      ("Cuts the surface of a mechanical part into the simple bodies that it is composed of (P1, section 5.1): by "
       "shape "
       "diameter\n(Gaussian mixture, minimum cuts) and where the surface bends inwards; pieces whose hull is no more "
       "than the two are joined\nagain, and inner walls go with the outer wall behind them. Raises InvalidInput for a "
       "mesh without area or with more than\n10 million triangles." +
       option_help(mesh_segmentation_fields()))
          .c_str());
}

}  // namespace mmgrasp::python
