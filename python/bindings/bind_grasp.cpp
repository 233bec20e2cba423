#include "bindings.hpp"
#include "mmgrasp/grasp/grasp.hpp"
#include "mmgrasp/grasp/gripper.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

const std::vector<OptionField<GraspSamplerOptions>>& sampler_fields() {
  using O = GraspSamplerOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("approaches", &O::approaches, "approach directions around each closing axis"),
      option<O>("positions", &O::positions, "pad positions along each free direction"),
      option<O>("mesh_samples", &O::mesh_samples, "surface points tried on a mesh"),
      option<O>("max_grasps", &O::max_grasps, "best kept, spread over approach directions"),
      option<O>("friction", &O::friction, "Coulomb coefficient"),
      option<O>("standoff", &O::standoff, "how far the tool centre point stays outside the object's middle [m]"),
      option<O>("seed", &O::seed, "same seed, same grasps")};
  return fields;
}

}  // namespace

void bind_grasp(py::module_& m) {
  m.def("_grasp_option_table", [] { return option_table(sampler_fields()); });
  py::class_<FingerJoint>(m, "FingerJoint", "A finger joint, linear in the opening.")
      .def(py::init([](std::string name, double closed, double open) {
             return FingerJoint{std::move(name), closed, open};
           }),
           py::arg("name"), py::arg("closed"), py::arg("open"))
      .def_readonly("name", &FingerJoint::name)
      .def_readonly("closed", &FingerJoint::closed)
      .def_readonly("open", &FingerJoint::open)
      .def("__repr__", [](const FingerJoint& j) { return "FingerJoint('" + j.name + "')"; });
  py::class_<Gripper>(m, "Gripper",
                      "A parallel-jaw gripper; the tool centre point lies midway between the pads' centres.")
      .def(py::init([](const std::string& tcp_link, const ArrayLike& approach, const ArrayLike& closing,
                       double max_opening, double finger_depth, double finger_width, double clearance,
                       std::vector<FingerJoint> joints, std::vector<std::string> finger_links) {
             Gripper gripper{tcp_link,
                             vector3_argument(approach, "approach"),
                             vector3_argument(closing, "closing"),
                             max_opening,
                             finger_depth,
                             finger_width,
                             clearance,
                             std::move(joints),
                             std::move(finger_links)};
             gripper.check();
             return gripper;
           }),
           py::arg("tcp_link"), py::kw_only(), py::arg("approach"), py::arg("closing"), py::arg("max_opening"),
           py::arg("finger_depth"), py::arg("finger_width"), py::arg("clearance") = Gripper{}.clearance,
           py::arg("joints") = std::vector<FingerJoint>{}, py::arg("finger_links") = std::vector<std::string>{})
      .def_readonly("tcp_link", &Gripper::tcp_link)
      .def_readonly("approach", &Gripper::approach)
      .def_readonly("closing", &Gripper::closing)
      .def_readonly("max_opening", &Gripper::max_opening)
      .def_readonly("finger_depth", &Gripper::finger_depth)
      .def_readonly("finger_width", &Gripper::finger_width)
      .def_readonly("clearance", &Gripper::clearance)
      .def_readonly("joints", &Gripper::joints)
      .def_readonly("finger_links", &Gripper::finger_links)
      .def("joint_values", &Gripper::joint_values, py::arg("opening"), "Finger joint values at an opening [m].")
      .def("pregrasp_opening", &Gripper::pregrasp_opening, py::arg("width"))
      .def("__repr__", [](const Gripper& g) {
        return "Gripper('" + g.tcp_link + "', opens " + std::string(py::repr(py::float_(g.max_opening))) + " m)";
      });
  py::class_<Grasp>(m, "Grasp", "One way to hold an object.")
      .def(py::init([](const ArrayLike& T_object_tcp, double width, double quality) {
             return Grasp{pose_argument(T_object_tcp, "T_object_tcp"), finite_argument(width, "width"),
                          finite_argument(quality, "quality")};
           }),
           py::arg("T_object_tcp"), py::arg("width"), py::arg("quality") = 1.0)
      .def_property_readonly("T_object_tcp", [](const Grasp& g) { return to_array(g.T_object_tcp); })
      .def_readonly("width", &Grasp::width, "Opening of the fingers while holding [m].")
      .def_readonly("quality", &Grasp::quality)
      .def("to_dict",
           [](const Grasp& g) {
             return py::dict("T_object_tcp"_a = to_array(g.T_object_tcp).attr("tolist")(), "width"_a = g.width,
                             "quality"_a = g.quality);
           })
      .def("__repr__", [](const Grasp& g) {
        return "Grasp(at " + text(g.T_object_tcp.translation()) +
               ", width=" + std::string(py::repr(py::float_(g.width))) + ")";
      });
  m.def(
      "_sample_grasps",
      [](const std::vector<LinkShape>& object, const Gripper& gripper, const py::kwargs& options) {
        const GraspSamplerOptions read = read_options(sampler_fields(), options, "sample_grasps");
        int too_wide = 0;
        std::vector<Grasp> grasps;
        {
          py::gil_scoped_release release;
          grasps = sample_grasps(object, gripper, read, &too_wide);
        }
        return py::make_tuple(std::move(grasps), too_wide);
      },
      py::arg("object"), py::arg("gripper"),
      ("(grasps, too_wide): as sample_grasps, with the number dropped as too wide." + option_help(sampler_fields()))
          .c_str());
  m.def(
      "sample_grasps",
      [](const std::vector<LinkShape>& object, const Gripper& gripper, const py::kwargs& options) {
        const GraspSamplerOptions read = read_options(sampler_fields(), options, "sample_grasps");
        py::gil_scoped_release release;
        return sample_grasps(object, gripper, read);
      },
      py::arg("object"), py::arg("gripper"),
      ("Antipodal grasps of a body given as a list of LinkShape (P1 3.4.1), best first." +
       option_help(sampler_fields()))
          .c_str());
}

}  // namespace mmgrasp::python
