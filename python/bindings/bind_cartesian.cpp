#include <optional>

#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/plan/cartesian.hpp"
#include "mmgrasp/plan/straight_line.hpp"
#include "plan_arguments.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

const std::vector<OptionField<StraightLineOptions>>& line_fields() {
  using O = StraightLineOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("position_step", &O::position_step, "largest tool translation between two waypoints [m]"),
      option<O>("rotation_step", &O::rotation_step, "largest tool rotation between two waypoints [rad]"),
      option<O>("jump_threshold", &O::jump_threshold, "a larger joint motion between two waypoints is a jump"),
      option<O>("joint_step", &O::joint_step, "largest joint motion between two checks [rad or m]")};
  return fields;
}

std::string why(Rejection cause, const std::optional<Contact>& contact, const std::string& beyond_limits) {
  return (cause == Rejection::none ? "" : std::string(", cause ") + to_string(cause)) +
         (contact ? ", " + describe(*contact) : "") + (beyond_limits.empty() ? "" : ", " + beyond_limits);
}

void bind_line(py::module_& m) {
  py::class_<StraightLineResult>(m, "StraightLineResult", "What plan_straight_line found.")
      .def_readonly("outcome", &StraightLineResult::outcome, "`solved` when the whole line is followed.")
      .def_property_readonly(
          "path", [](const StraightLineResult& r) { return path_array(r.path); }, "(k, n) or None.")
      .def_readonly("fraction", &StraightLineResult::fraction, "How far along the line it came, in [0, 1].")
      .def_readonly("cause", &StraightLineResult::cause, "Why it ended there.")
      .def_readonly("contact", &StraightLineResult::contact, "What touches there, when something does, or None.")
      .def_readonly("beyond_limits", &StraightLineResult::beyond_limits,
                    "With invalid_start: which joint is outside of its limits, its value and these.")
      .def(
          "to_dict",
          [](const StraightLineResult& r) {
            return py::dict("outcome"_a = to_string(r.outcome), "path"_a = path_list(r.path), "fraction"_a = r.fraction,
                            "cause"_a = to_string(r.cause),
                            "contact"_a = r.contact ? py::cast(*r.contact).attr("to_dict")() : py::none(),
                            "beyond_limits"_a = r.beyond_limits);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const StraightLineResult& r) {
        return std::string("StraightLineResult(") + to_string(r.outcome) + ", fraction " +
               std::string(py::repr(py::float_(r.fraction))) + why(r.cause, r.contact, r.beyond_limits) + ")";
      });
  m.def(
      "plan_straight_line",
      [](const Given<CollisionChecker>& given_checker, const ArrayLike& start, const ArrayLike& T_world_to,
         const Progress& progress, const py::kwargs& options) {
        CollisionChecker checker = taken(given_checker, "checker").clone();
        const StraightLineOptions read = read_options(line_fields(), options, "plan_straight_line");
        const Eigen::VectorXd from = vector_argument(start, "start", checker.group().size());
        const Pose to = pose_argument(T_world_to, "T_world_to");
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return plan_straight_line(checker, from, to, read, monitor); });
      },
      py::arg("checker"), py::arg("start"), py::arg("T_world_to"), py::kw_only(), py::arg("progress") = py::none(),
      ("The tool moves on a straight line from the pose of `start` to T_world_to. A group that moves a diff_drive base "
       "is\nrefused: it could not follow such a path." +
       option_help(line_fields()))
          .c_str());
}

const std::vector<OptionField<CartesianOptions>>& cartesian_fields() {
  using O = CartesianOptions;
  using L = StraightLineOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("position_step", &O::line, &L::position_step, "largest tool translation between two waypoints [m]"),
      option<O>("rotation_step", &O::line, &L::rotation_step, "largest tool rotation between two waypoints [rad]"),
      option<O>("jump_threshold", &O::line, &L::jump_threshold, "a larger joint motion between waypoints is a jump"),
      option<O>("joint_step", &O::line, &L::joint_step, "largest joint motion between two checks [rad or m]"),
      option<O>("max_branches", &O::max_branches, "configurations of the first pose that are followed at most")};
  return fields;
}

void bind_cartesian(py::module_& m) {
  py::class_<CartesianResult>(m, "CartesianResult", "What plan_cartesian found.")
      .def_readonly("outcome", &CartesianResult::outcome, "`solved` when every pose is reached in order.")
      .def_property_readonly(
          "path", [](const CartesianResult& r) { return path_array(r.path); }, "(k, n) or None.")
      .def_readonly("corners", &CartesianResult::corners, "Waypoint at which each pose is reached.")
      .def_readonly("fraction", &CartesianResult::fraction, "How far the best branch came, in [0, 1].")
      .def_readonly("cause", &CartesianResult::cause, "Why it ended there.")
      .def_readonly("contact", &CartesianResult::contact, "What touches there, when something does, or None.")
      .def_readonly("branches", &CartesianResult::branches, "Allowed configurations of the first pose.")
      .def_readonly("tried", &CartesianResult::tried, "How many of these were followed.")
      .def_readonly("rejections", &CartesianResult::rejections,
                    "Configurations of the first pose that were rejected, by cause.")
      .def_readonly("beyond_limits", &CartesianResult::beyond_limits,
                    "With invalid_start: which joint of `near` is outside of its limits, its value and these.")
      .def(
          "to_dict",
          [](const CartesianResult& r) {
            return py::dict("outcome"_a = to_string(r.outcome), "path"_a = path_list(r.path), "corners"_a = r.corners,
                            "fraction"_a = r.fraction, "cause"_a = to_string(r.cause),
                            "contact"_a = r.contact ? py::cast(*r.contact).attr("to_dict")() : py::none(),
                            "branches"_a = r.branches, "tried"_a = r.tried, "rejections"_a = to_dict(r.rejections),
                            "beyond_limits"_a = r.beyond_limits);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const CartesianResult& r) {
        return std::string("CartesianResult(") + to_string(r.outcome) + ", fraction " +
               std::string(py::repr(py::float_(r.fraction))) + ", " + std::to_string(r.tried) + " of " +
               std::to_string(r.branches) + " branches tried" + why(r.cause, r.contact, r.beyond_limits) +
               (r.branches == 0 ? ", rejected: " + r.rejections.summary() : "") + ")";
      });
  m.def(
      "plan_cartesian",
      [](const Given<CollisionChecker>& given_checker, const ArrayLike& tool_poses, const OptionalArray& near,
         const Progress& progress, const py::kwargs& options) {
        CollisionChecker checker = taken(given_checker, "checker").clone();
        const CartesianOptions read = read_options(cartesian_fields(), options, "plan_cartesian");
        const Poses poses = poses_argument(tool_poses, "tool_poses");
        std::optional<Eigen::VectorXd> from;
        if (!near.is_none()) {
          from = vector_argument(py::reinterpret_borrow<ArrayLike>(near), "near", checker.group().size());
        }
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return plan_cartesian(checker, poses, from, read, monitor); });
      },
      py::arg("checker"), py::arg("tool_poses"), py::arg("near") = py::none(), py::kw_only(),
      py::arg("progress") = py::none(),
      ("The tip follows straight lines from pose to pose, from the inverse kinematics branch of the first pose that "
       "completes\nthem with the shortest way, counted from `near` (n,) when that is given. A group that moves a "
       "diff_drive base "
       "is\nrefused: it could not follow such a path." +
       option_help(cartesian_fields()))
          .c_str());
}

}  // namespace

void bind_cartesian_planning(py::module_& m) {
  m.def("_cartesian_option_table", [] { return option_table(cartesian_fields()); });
  bind_line(m);
  bind_cartesian(m);
}

}  // namespace mmgrasp::python
