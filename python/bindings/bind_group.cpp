#include <map>
#include <optional>

#include "batch.hpp"
#include "bindings.hpp"
#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/robot/kinematics_batch.hpp"
#include "mmgrasp/robot/manipulability.hpp"
#include "mmgrasp/robot/named_configuration.hpp"

namespace mmgrasp::python {
namespace {

Eigen::VectorXd configuration(const JointGroup& g, const ArrayLike& q, const char* name = "q") {
  return vector_argument(q, name, g.size());
}

Eigen::VectorXd base_configuration(const JointGroup& g, const OptionalArray& base) {
  return base.is_none() ? Eigen::VectorXd() : vector_argument(base, "base", g.size());
}

/// The digits that fk_batch gives, which may differ from JointGroup::fk in the last one.
Pose fk_as_in_batches(const JointGroup& g, const Eigen::VectorXd& q) {
  Poses poses;
  fk_batch(g, q, poses);
  return poses.front();
}

Eigen::MatrixXd jacobian_at(const JointGroup& g, const ArrayLike& q, const std::optional<std::string>& link,
                            const std::optional<ArrayLike>& point) {
  const Eigen::VectorXd at = configuration(g, q);
  if (!link && !point) return g.jacobian(at);
  return g.jacobian(at, link ? g.robot().link_index(*link) : g.tip_link(),
                    point ? vector3_argument(*point, "point") : Eigen::Vector3d(0, 0, 0));
}

py::array_t<double> jacobian_batch(const JointGroup& g, const ArrayLike& Q) {
  const auto rows = batch_argument(Q, "Q", g.size());
  const py::ssize_t n = g.size();
  py::array_t<double> out({rows.shape(0), py::ssize_t{6}, n});
  auto to = out.mutable_unchecked<3>();
  Poses poses;
  Matrix6Xd J;
  in_pieces(rows.shape(0), [&](Eigen::Index first, Eigen::Index count) {
    fk_jacobian_batch(g, columns_of(rows, first, count), poses, J);
    for (py::ssize_t i = 0; i < count; ++i)
      for (py::ssize_t r = 0; r < 6; ++r)
        for (py::ssize_t c = 0; c < n; ++c) to(first + i, r, c) = J(r, i * n + c);
  });
  return out;
}

py::array_t<double> fk_batch_of_rows(const JointGroup& g, const ArrayLike& Q) {
  using RowMajor = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  const auto rows = batch_argument(Q, "Q", g.size());
  py::array_t<double> out({rows.shape(0), py::ssize_t{4}, py::ssize_t{4}});
  double* to = out.mutable_data();
  Poses poses;
  in_pieces(rows.shape(0), [&](Eigen::Index first, Eigen::Index count) {
    fk_batch(g, columns_of(rows, first, count), poses);
    for (Eigen::Index i = 0; i < count; ++i) Eigen::Map<RowMajor>(to + 16 * (first + i)) = poses[i].matrix();
  });
  return out;
}

Eigen::VectorXd manipulability_of_rows(const JointGroup& g, const ArrayLike& Q) {
  const auto rows = batch_argument(Q, "Q", g.size());
  Eigen::VectorXd values(rows.shape(0));
  in_pieces(rows.shape(0), [&](Eigen::Index first, Eigen::Index count) {
    values.segment(first, count) = manipulability_batch(g, columns_of(rows, first, count));
  });
  return values;
}

void bind_group_class(py::module_& m) {
  declared<JointGroup>(m, "JointGroup")
      .def_property_readonly("robot", &JointGroup::robot, "The robot it belongs to.")
      .def_property_readonly("name", &JointGroup::name, "Name of the SRDF group, or of the chain.")
      .def_property_readonly(
          "names", &JointGroup::names,
          "Names of the columns: joints, with x, y, theta first when the group has the base. A planar joint "
          "has three, \"<joint>/x\", \"/y\", \"/theta\"; a floating one six, \"/x\", \"/y\", \"/z\", \"/rx\", \"/ry\", "
          "\"/rz\" "
          "(a rotation vector).")
      .def_property_readonly("size", &JointGroup::size, "Number of columns of a configuration.")
      .def("__len__", &JointGroup::size)
      .def_property_readonly("has_base", &JointGroup::has_base, "x, y, theta come first.")
      .def_property_readonly(
          "tip", [](const JointGroup& g) { return g.robot().links()[g.tip_link()].name; },
          "Link whose pose fk() and ik() are about.")
      .def_property_readonly("lower", &JointGroup::lower, "[rad or m], -inf for continuous joints.")
      .def_property_readonly("upper", &JointGroup::upper, "[rad or m], inf for continuous joints.")
      .def_property_readonly("velocity_limits", &JointGroup::velocity_limits, "(n,) [rad/s or m/s].")
      .def_property_readonly(
          "acceleration_limits", &JointGroup::acceleration_limits,
          "(n,) [rad/s^2 or m/s^2]; URDF has none: 4 times the velocity limit per second unless set.")
      .def_property_readonly("sample_lower", &JointGroup::sample_lower, "Finite bounds to sample from.")
      .def_property_readonly("sample_upper", &JointGroup::sample_upper,
                             "Upper end of the finite bounds to sample from (n,).")
      .def_property_readonly(
          "T_world_root", [](const JointGroup& g) { return to_array(g.T_world_root()); },
          "Pose of the robot's root (4, 4); with the base in the group its joints come on top.")
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
          py::arg("limits"), "The same group with these limits (n,) [rad/s^2 or m/s^2], > 0.")
      .def(
          "within_limits",
          [](const JointGroup& g, const ArrayLike& q, double slack) {
            return g.within_limits(configuration(g, q), finite_argument(slack, "slack"));
          },
          py::arg("q"), py::arg("slack") = 0.0,
          "Whether a configuration (n,) lies inside the limits, each widened by `slack` [rad or m].")
      .def(
          "fk",
          [](const JointGroup& g, const ArrayLike& q) { return to_array(fk_as_in_batches(g, configuration(g, q))); },
          py::arg("q"), "T_world_tip, (4, 4), of a configuration (n,).")
      .def(
          "q",
          [](const JointGroup& g, const std::map<std::string, double>& values, const OptionalArray& base) {
            return named_configuration(g, values, base_configuration(g, base));
          },
          py::arg("values"), py::arg("base") = py::none(),
          "A configuration (n,) from values by joint name [rad or m]. What is not named is as in `base` (n,), or as "
          "the "
          "group\nholds its robot (0 for base joints). Raises InvalidInput for names it does not have, with the "
          "nearest.")
      .def(
          "state",
          [](const JointGroup& g, const std::string& name, const OptionalArray& base) {
            return state_configuration(g, name, base_configuration(g, base));
          },
          py::arg("name"), py::arg("base") = py::none(),
          "The SRDF's group state of this name as a configuration (n,); `base` as in q(). Raises InvalidInput, listing "
          "the\nstates there are, for others.")
      .def("fk_batch", &fk_batch_of_rows, py::arg("Q"), "(m, 4, 4) for configurations (m, n).")
      .def("jacobian", &jacobian_at, py::arg("q"), py::arg("link") = py::none(), py::arg("point") = py::none(),
           "(6, n), world-aligned: linear rows [m/rad, m/m], then angular. At the tip's origin, or at `point` [m] in "
           "the "
           "frame of\n`link` (default: the tip; point (0, 0, 0)), which moves with it. Columns of joints that do not "
           "move "
           "it are zero.")
      .def("jacobian_batch", &jacobian_batch, py::arg("Q"), "(m, 6, n) at the tip's origin, for configurations (m, n).")
      .def(
          "link_poses",
          [](const JointGroup& g, const ArrayLike& q) -> NamedPoses {
            Poses poses;
            g.link_poses(configuration(g, q), poses);
            py::dict out;
            for (std::size_t i = 0; i < poses.size(); ++i) out[g.robot().links()[i].name.c_str()] = to_array(poses[i]);
            return out;
          },
          py::arg("q"), "World pose (4, 4) of every link of the robot.")
      .def(
          "manipulability",
          [](const JointGroup& g, const ArrayLike& q) { return g.manipulability(configuration(g, q)); }, py::arg("q"),
          "sqrt(det(J J^T)) (Yoshikawa): 0 at singularities, and for groups of fewer than six joints.")
      .def("manipulability_batch", &manipulability_of_rows, py::arg("Q"), "(m,) for configurations (m, n).")
      .def(
          "velocity_manipulability",
          [](const JointGroup& g, const ArrayLike& q, const ArrayLike& direction) {
            return velocity_manipulability(g, configuration(g, q), vector_argument(direction, "direction"));
          },
          py::arg("q"), py::arg("direction"),
          "Length of the velocity ellipsoid along a direction (P2 equation 3.2): (3,) translation or (6,) twist, "
          "world-aligned.\n0 where the tool cannot move along it.")
      .def(
          "force_manipulability",
          [](const JointGroup& g, const ArrayLike& q, const ArrayLike& direction) {
            return force_manipulability(g, configuration(g, q), vector_argument(direction, "direction"));
          },
          py::arg("q"), py::arg("direction"),
          "Length of the force ellipsoid along a direction (P2 equation 3.3), as for "
          "velocity_manipulability;\ninfinite where no "
          "joint works against such a force.")
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
