#include <memory>
#include <optional>

#include "bindings.hpp"
#include "mmgrasp/collision/collision_ik.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "mmgrasp/robot/ik_branches.hpp"
#include "mmgrasp/robot/ik_objective.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

/// Entries of weights; their number is checked against the group when the call runs.
void set_weights(IkOptions& options, const py::handle& value) {
  if (value.is_none()) return;
  const Eigen::VectorXd weights = vector_argument(value, "joint_weights");
  options.joint_weights.assign(weights.data(), weights.data() + weights.size());
}

void set_objectives(IkOptions& options, const py::handle& value) {
  if (!py::isinstance<py::sequence>(value)) refuse_value("objectives", value, "a list of IkObjective");
  for (const py::handle& entry : py::reinterpret_borrow<py::sequence>(value)) {
    if (!py::isinstance<IkObjective>(entry)) refuse_value("objectives", entry, "an IkObjective");
    options.objectives.push_back(py::cast<std::shared_ptr<IkObjective>>(entry));
  }
}

const std::vector<OptionField<IkOptions>>& ik_fields() {
  static const std::vector<OptionField<IkOptions>> fields{
      option<IkOptions>("position_tolerance", &IkOptions::position_tolerance, "[m]"),
      option<IkOptions>("rotation_tolerance", &IkOptions::rotation_tolerance, "[rad]"),
      option<IkOptions>("max_iterations", &IkOptions::max_iterations, "per descent"),
      option<IkOptions>("restarts", &IkOptions::restarts, "random restarts after the seed"),
      option<IkOptions>("time_limit", &IkOptions::time_limit, "wall-clock cap [s]"),
      option<IkOptions>("rng_seed", &IkOptions::seed, "same seed, same answer"),
      {"joint_weights", "numpy.typing.ArrayLike | None", set_weights,
       [](const IkOptions& o) { return py::cast(o.joint_weights); },
       "cost of moving each joint, > 0; empty: all the same"},
      {"objectives", "collections.abc.Sequence[IkObjective]", set_objectives,
       [](const IkOptions&) { return py::list(); },
       "costs (IkObjective) that the redundancy lowers once the pose is reached"},
      option<IkOptions>("objective_iterations", &IkOptions::objective_iterations, "steps along the solutions")};
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

void bind_ik_result(py::module_& m) {
  py::class_<IkResult>(m, "IkResult", "Answer of inverse kinematics.")
      .def_readonly("outcome", &IkResult::outcome, "How it ended; `solved` alone comes with an answer.")
      .def_property_readonly(
          "q",
          [](const IkResult& r) -> MaybeFloats {
            if (r.outcome != Outcome::solved) return py::none();
            return py::cast(r.q);
          },
          "The configuration, inside limits and checked by forward kinematics; None unless solved.")
      .def_readonly("position_error", &IkResult::position_error, "[m] of q, or of the best attempt.")
      .def_readonly("rotation_error", &IkResult::rotation_error, "[rad]")
      .def_readonly("rejections", &IkResult::rejections, "What the descents ended at: reach, limits or collisions.")
      .def_readonly("objective", &IkResult::objective, "Sum of the objectives' costs at q.")
      .def_readonly("iterations", &IkResult::iterations, "Steps of all descents.")
      .def(
          "to_dict",
          [](const IkResult& r) {
            py::object q = py::none();
            if (r.outcome == Outcome::solved) q = py::cast(r.q).attr("tolist")();
            return py::dict("outcome"_a = to_string(r.outcome), "q"_a = q, "position_error"_a = r.position_error,
                            "rotation_error"_a = r.rotation_error, "rejections"_a = to_dict(r.rejections),
                            "objective"_a = r.objective, "iterations"_a = r.iterations);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const IkResult& r) {
        return std::string("IkResult(") + to_string(r.outcome) +
               (r.outcome == Outcome::solved ? ", q=" + text(r.q) : ", rejected: " + r.rejections.summary()) + ")";
      });
}

/// What a world leaves of the configurations; all of them without one. The checker is made for it.
ConfigurationFilter free_of(const JointGroup& group, const World* world, std::optional<CollisionChecker>& checker) {
  if (!world) return {};
  checker.emplace(with_sampled_pairs(group), *world);
  return [&checker](const Eigen::VectorXd& q) { return checker->rejection(q); };
}

IkBranches branches(const JointGroup& group, const Pose& T, const World* world, const IkOptions& options,
                    int redundant_values, bool all_turns) {
  std::optional<CollisionChecker> checker;
  const ConfigurationFilter valid = free_of(group, world, checker);
  return LongCall(py::none()).run([&](const Monitor& monitor) {
    return solve_ik_branches(group, T, options, valid, redundant_values, monitor, all_turns);
  });
}

void bind_branches(py::module_& m) {
  py::class_<IkBranches>(m, "IkBranches", "Every arm configuration found for a pose, and why others were rejected.")
      .def_property_readonly(
          "solutions", [](const IkBranches& b) { return rows_to_array(b.solutions); },
          "(k, n), inside limits and checked; the first ones as different from each other as can be.")
      .def_readonly("complete", &IkBranches::complete, "True when every branch was computed, none searched.")
      .def_readonly("redundant_joint", &IkBranches::redundant_joint, "Joint that was sampled; -1 for none.")
      .def_readonly("rejections", &IkBranches::rejections, "Branches rejected, by cause.")
      .def("__len__", [](const IkBranches& b) { return b.solutions.size(); })
      .def(
          "to_dict",
          [](const IkBranches& b) {
            py::list solutions;
            for (const Eigen::VectorXd& q : b.solutions) solutions.append(py::cast(q).attr("tolist")());
            return py::dict("solutions"_a = solutions, "complete"_a = b.complete,
                            "redundant_joint"_a = b.redundant_joint, "rejections"_a = to_dict(b.rejections));
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const IkBranches& b) {
        return "IkBranches(" + std::to_string(b.solutions.size()) + " solutions" + (b.complete ? ", complete" : "") +
               ", rejected: " + b.rejections.summary() + ")";
      });
}

void bind_group_methods(py::module_& m) {
  declared<JointGroup>(m, "JointGroup")
      .def(
          "ik",
          [](const JointGroup& g, const ArrayLike& T_world_tip, const OptionalArray& seed, const World* world,
             const py::kwargs& options) {
            const Eigen::VectorXd q0 = seed.is_none() ? Eigen::VectorXd(0.5 * (g.sample_lower() + g.sample_upper()))
                                                      : vector_argument(seed, "seed", g.size());
            return solve(g, pose_argument(T_world_tip, "T_world_tip"), q0, world,
                         read_options(ik_fields(), options, "ik"));
          },
          py::arg("T_world_tip"), py::arg("seed") = py::none(), py::arg("world") = py::none(),
          ("Inverse kinematics from `seed` (default: middle of the limits), then random restarts. With a world the "
           "answer is\n"
           "free of collisions with it and of self-collision; without one, collisions are not checked." +
           option_help(ik_fields()))
              .c_str())
      .def(
          "ik_branches",
          [](const JointGroup& g, const ArrayLike& T_world_tip, const World* world, int redundant_values,
             bool all_turns, const py::kwargs& options) {
            return branches(g, pose_argument(T_world_tip, "T_world_tip"), world,
                            read_options(ik_fields(), options, "ik_branches"), redundant_values, all_turns);
          },
          py::arg("T_world_tip"), py::arg("world") = py::none(), py::arg("redundant_values") = 0,
          py::arg("all_turns") = false,
          ("Every branch of an arm of six turning joints, and of one of seven for `redundant_values` values of its\n"
           "redundant joint (0: 24); random descents search where no closed form fits. With a world, free ones only.\n"
           "A branch is an arm posture: joints whose limits leave more than one turn stand in the one nearest to the\n"
           "middle. `all_turns` lists every whole turn within limits, one branch after the other, of each the turns\n"
           "nearest to the middle first; up to 64 a branch where six joints have two turns." +
           option_help(ik_fields()))
              .c_str())
      .def(
          "ik_all",
          [](const JointGroup& g, const ArrayLike& T_world_tip, int count, const World* world, bool all_turns,
             const py::kwargs& options) {
            if (count <= 0) throw InvalidInput("count = " + std::to_string(count) + ": must be > 0");
            const Pose T = pose_argument(T_world_tip, "T_world_tip");
            const IkOptions read = read_options(ik_fields(), options, "ik_all");
            std::optional<CollisionChecker> checker;
            const ConfigurationFilter valid = free_of(g, world, checker);
            return rows_to_array(interruptible(
                [&](const Monitor& monitor) { return solve_ik_all(g, T, count, read, valid, all_turns, monitor); }));
          },
          py::arg("T_world_tip"), py::arg("count") = 16, py::arg("world") = py::none(), py::arg("all_turns") = false,
          ("Up to `count` solutions (k, n), the first ones farthest apart; ik_branches tells why others fell. They "
           "are\n"
           "arm postures, in one turn each; `all_turns` gives each of them in every whole turn within limits." +
           option_help(ik_fields()))
              .c_str());
}

}  // namespace

void bind_ik(py::module_& m) {
  m.def("_ik_option_table", [] { return option_table(ik_fields()); });
  bind_ik_result(m);
  bind_branches(m);
  bind_group_methods(m);
}

}  // namespace mmgrasp::python
