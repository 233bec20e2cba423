#include <map>

#include "bindings.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::python {
namespace {

Eigen::VectorXd configuration(const JointGroup& g, const ArrayLike& q, const char* name = "q") {
  return vector_argument(q, name, g.size());
}

void bind_group_class(py::module_& m) {
  declared<JointGroup>(m, "JointGroup")
      .def_property_readonly("robot", &JointGroup::robot)
      .def_property_readonly("name", &JointGroup::name)
      .def_property_readonly("names", &JointGroup::names, "Joint names; x, y, theta first when the group has the base.")
      .def_property_readonly("size", &JointGroup::size)
      .def("__len__", &JointGroup::size)
      .def_property_readonly("has_base", &JointGroup::has_base)
      .def_property_readonly("tip", [](const JointGroup& g) { return g.robot().links()[g.tip_link()].name; })
      .def_property_readonly("lower", &JointGroup::lower, "[rad or m], -inf for continuous joints.")
      .def_property_readonly("upper", &JointGroup::upper)
      .def_property_readonly("velocity_limits", &JointGroup::velocity_limits)
      .def_property_readonly("acceleration_limits", &JointGroup::acceleration_limits)
      .def_property_readonly("sample_lower", &JointGroup::sample_lower, "Finite bounds to sample from.")
      .def_property_readonly("sample_upper", &JointGroup::sample_upper)
      .def_property_readonly("T_world_root", [](const JointGroup& g) { return to_array(g.T_world_root()); })
      .def(
          "at", [](const JointGroup& g, const ArrayLike& T) { return g.at(pose_argument(T, "T_world_root")); },
          py::arg("T_world_root"), "The same group with the robot's root standing elsewhere.")
      .def(
          "with_reference",
          [](const JointGroup& g, const std::map<std::string, double>& joints) {
            return g.with_reference(g.robot().values(joints));
          },
          py::arg("joints"), "The same group with the named other joints held at these values, the rest at default.")
      .def(
          "with_acceleration_limits",
          [](const JointGroup& g, const ArrayLike& limits) {
            return g.with_acceleration_limits(vector_argument(limits, "limits", g.size()));
          },
          py::arg("limits"))
      .def(
          "within_limits",
          [](const JointGroup& g, const ArrayLike& q, double slack) {
            return g.within_limits(configuration(g, q), slack);
          },
          py::arg("q"), py::arg("slack") = 0.0)
      .def(
          "fk", [](const JointGroup& g, const ArrayLike& q) { return to_array(g.fk(configuration(g, q))); },
          py::arg("q"), "T_world_tip, (4, 4), of a configuration (n,).")
      .def(
          "fk_batch",
          [](const JointGroup& g, const ArrayLike& Q) {
            const Eigen::MatrixXd columns = matrix_argument(Q, "Q", g.size()).transpose();
            Poses poses(columns.cols());
            {
              py::gil_scoped_release release;
              for (Eigen::Index i = 0; i < columns.cols(); ++i) poses[i] = g.fk(columns.col(i));
            }
            return to_array(poses);
          },
          py::arg("Q"), "(m, 4, 4) for configurations (m, n).")
      .def(
          "jacobian",
          [](const JointGroup& g, const ArrayLike& q) { return Eigen::MatrixXd(g.jacobian(configuration(g, q))); },
          py::arg("q"), "(6, n), world-aligned at the tip's origin: linear rows, then angular.")
      .def(
          "link_poses",
          [](const JointGroup& g, const ArrayLike& q) {
            Poses poses;
            g.link_poses(configuration(g, q), poses);
            py::dict out;
            for (std::size_t i = 0; i < poses.size(); ++i) out[g.robot().links()[i].name.c_str()] = to_array(poses[i]);
            return out;
          },
          py::arg("q"), "World pose (4, 4) of every link of the robot.")
      .def(
          "manipulability",
          [](const JointGroup& g, const ArrayLike& q) { return g.manipulability(configuration(g, q)); }, py::arg("q"))
      .def("__repr__", [](const JointGroup& g) {
        std::string names;
        for (const std::string& name : g.names()) names += (names.empty() ? "" : ", ") + name;
        return "JointGroup('" + g.name() + "', [" + names + "], tip '" + g.robot().links()[g.tip_link()].name + "')";
      });
}

}  // namespace

void bind_group(py::module_& m) {
  bind_ik(m);
  bind_group_class(m);
  bind_trajectory(m);
}

}  // namespace mmgrasp::python
