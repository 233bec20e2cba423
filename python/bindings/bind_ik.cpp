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

void bind_result(py::module_& m) {
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

void bind_group_methods(py::module_& m) {
  declared<JointGroup>(m, "JointGroup")
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
              .c_str());
}

}  // namespace

void bind_ik(py::module_& m) {
  bind_result(m);
  bind_group_methods(m);
}

}  // namespace mmgrasp::python
