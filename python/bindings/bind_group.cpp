#include <map>

#include "bindings.hpp"
#include "mmgrasp/collision/collision_ik.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

const std::vector<OptionField<IkOptions>>& ik_fields() {
  static const std::vector<OptionField<IkOptions>> fields{
      option<IkOptions>("position_tolerance", &IkOptions::position_tolerance, "[m]"),
      option<IkOptions>("rotation_tolerance", &IkOptions::rotation_tolerance, "[rad]"),
      option<IkOptions>("max_iterations", &IkOptions::max_iterations, "per descent"),
      option<IkOptions>("restarts", &IkOptions::restarts, "random restarts after the seed"),
      option<IkOptions>("time_limit", &IkOptions::time_limit, "wall-clock cap [s]"),
      option<IkOptions>("rng_seed", &IkOptions::seed, "same seed, same answer")};
  return fields;
}

IkResult solve(const JointGroup& group, const Pose& T, const Eigen::VectorXd& seed, const World* world,
               const IkOptions& options) {
  if (!world) {
    return LongCall(py::none()).run([&](const Monitor& monitor) {
      return solve_ik(group, T, seed, options, {}, monitor);
    });
  }
  CollisionChecker checker(with_sampled_pairs(group), *world);
  return LongCall(py::none()).run([&](const Monitor& monitor) {
    return solve_collision_free_ik(checker, T, seed, options, monitor);
  });
}

void bind_ik(py::module_& m) {
  py::class_<IkResult>(m, "IkResult", "Answer of inverse kinematics.")
      .def_readonly("outcome", &IkResult::outcome)
      .def_property_readonly(
          "q",
          [](const IkResult& r) -> py::object {
            if (r.outcome != Outcome::solved) return py::none();
            return py::cast(r.q);
          },
          "The configuration, inside limits and checked by forward kinematics; None unless solved.")
      .def_readonly("position_error", &IkResult::position_error, "[m] of q, or of the best attempt.")
      .def_readonly("rotation_error", &IkResult::rotation_error, "[rad]")
      .def_readonly("rejections", &IkResult::rejections)
      .def_readonly("iterations", &IkResult::iterations)
      .def("to_dict",
           [](const IkResult& r) {
             py::object q = py::none();
             if (r.outcome == Outcome::solved) q = py::cast(r.q).attr("tolist")();
             return py::dict("outcome"_a = to_string(r.outcome), "q"_a = q, "position_error"_a = r.position_error,
                             "rotation_error"_a = r.rotation_error, "rejections"_a = to_dict(r.rejections),
                             "iterations"_a = r.iterations);
           })
      .def("__repr__", [](const IkResult& r) {
        return std::string("IkResult(") + to_string(r.outcome) +
               (r.outcome == Outcome::solved ? ", q=" + text(r.q) : ", rejected: " + r.rejections.summary()) + ")";
      });
}

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
      .def(
          "ik",
          [](const JointGroup& g, const ArrayLike& T_world_tip, const py::object& seed, const World* world,
             const py::kwargs& options) {
            const Eigen::VectorXd q0 = seed.is_none() ? Eigen::VectorXd(0.5 * (g.sample_lower() + g.sample_upper()))
                                                      : vector_argument(seed, "seed", g.size());
            return solve(g, pose_argument(T_world_tip, "T_world_tip"), q0, world,
                         read_options(ik_fields(), options, "ik"));
          },
          py::arg("T_world_tip"), py::arg("seed") = py::none(), py::arg("world") = py::none(),
          ("Inverse kinematics from `seed` (default: middle of the limits), then random restarts. With a world the "
           "answer is\n"
           "free of collisions with it and of self-collision; without one, collisions are not looked at." +
           option_help(ik_fields()))
              .c_str())
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
