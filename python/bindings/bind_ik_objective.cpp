#include "bindings.hpp"
#include "mmgrasp/collision/collision_objective.hpp"
#include "mmgrasp/robot/ik_objective.hpp"

namespace mmgrasp::python {
namespace {

using Handle = std::shared_ptr<IkObjective>;

Handle handle(const std::shared_ptr<const IkObjective>& objective) {
  return std::const_pointer_cast<IkObjective>(objective);  // Python sees no member that changes it
}

}  // namespace

void bind_ik_objectives(py::module_& m) {
  py::class_<IkObjective, Handle>(m, "IkObjective",
                                  "A cost of configurations that inverse kinematics lowers with the freedom that the "
                                  "pose leaves: pass a list as ik(..., objectives=[...]).")
      .def_property_readonly("name", &IkObjective::name, "Which objective it is.")
      .def(
          "evaluate",
          [](const IkObjective& o, const ArrayLike& q) {
            Eigen::VectorXd gradient;
            const double cost = o.evaluate(vector_argument(q, "q", o.size()), gradient);
            return py::make_tuple(cost, gradient);
          },
          py::arg("q"), "(cost, gradient (n,)).")
      .def("__repr__", [](const IkObjective& o) { return "IkObjective('" + o.name() + "')"; });
  m.def(
      "joint_limit_objective",
      [](const JointGroup& group, double soft_fraction, double weight) {
        return handle(make_joint_limit_objective(group, soft_fraction, weight));
      },
      py::arg("group"), py::arg("soft_fraction") = 0.1, py::arg("weight") = 1.0,
      "Weight times the squared depth inside the outer `soft_fraction` of each joint's range, at both ends.");
  m.def(
      "singularity_objective",
      [](const JointGroup& group, double threshold, double weight) {
        return handle(make_singularity_objective(group, threshold, weight));
      },
      py::arg("group"), py::arg("threshold"), py::arg("weight") = 1.0,
      "Weight times max(0, 1 - M / threshold)^2, M the manipulability of the arm's joints (without the base).");
  m.def(
      "camera_view_objective",
      [](const JointGroup& group, const std::string& camera_link, const ArrayLike& point,
         const OptionalArray& T_link_camera, double weight) {
        return handle(make_camera_view_objective(group, group.robot().link_index(camera_link),
                                                 pose_argument(T_link_camera, "T_link_camera"),
                                                 vector3_argument(point, "point"), weight));
      },
      py::arg("group"), py::arg("camera_link"), py::arg("point"), py::arg("T_link_camera") = py::none(),
      py::arg("weight") = 1.0,
      "Weight times the squared distance [m] of a world point from the optical axis (+z) of a camera on a link, plus "
      "the\nsquared depth by which it lies behind the camera.");
  m.def(
      "self_distance_objective",
      [](const CollisionChecker& checker, double margin, double weight) {
        return handle(make_self_distance_objective(checker, margin, weight));
      },
      py::arg("checker"), py::arg("margin") = 0.05, py::arg("weight") = 1.0,
      "Weight times the sum of (1 - distance / margin)^2 over pairs of the robot's own links nearer than `margin` "
      "[m].");
}

}  // namespace mmgrasp::python
