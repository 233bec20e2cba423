#include "bindings.hpp"
#include "mmgrasp/verify/path_check.hpp"
#include "mmgrasp/verify/plan_check.hpp"

namespace mmgrasp::python {
namespace {

using namespace mmgrasp::verify;
using namespace py::literals;

const std::vector<OptionField<PlanCheckOptions>>& check_fields() {
  using O = PlanCheckOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("joint_step", &O::joint_step, "arm paths are checked at least this finely [rad or m]"),
      option<O>("base_step", &O::base_step, "the route [m, and rad x 2]"),
      option<O>("position_tolerance", &O::position_tolerance, "of a grasp [m]"),
      option<O>("rotation_tolerance", &O::rotation_tolerance, "of a grasp [rad]"),
      option<O>("samples", &O::samples, "base poses drawn in the uncertainty disc of each stop"),
      option<O>("required_rate", &O::required_rate, "share of them from which every target part has a grasp"),
      option<O>("seed", &O::seed, "of the base poses drawn"),
      option<O>("threads", &O::threads, "0: all")};
  return fields;
}

CheckedBody body(const std::string& name, std::vector<LinkShape> shapes, const ArrayLike& pose) {
  return {name, std::move(shapes), pose_argument(pose, "pose of " + name)};
}

void bind_checked_parts(py::module_& m) {
  py::class_<CheckedBody>(m, "CheckedBody").def(py::init(&body), py::arg("name"), py::arg("shapes"), py::arg("pose"));
  py::class_<CheckedGrasp>(m, "CheckedGrasp")
      .def(py::init([](const ArrayLike& pose, double width) {
             return CheckedGrasp{pose_argument(pose, "grasp pose"), width};
           }),
           py::arg("pose"), py::arg("width"));
  py::class_<CheckedPart>(m, "CheckedPart")
      .def(py::init([](CheckedBody b, std::string tray, bool target, std::vector<CheckedGrasp> grasps) {
             return CheckedPart{std::move(b), std::move(tray), target, std::move(grasps)};
           }),
           py::arg("body"), py::arg("tray"), py::arg("target"), py::arg("grasps"));
  py::class_<CheckedFinger>(m, "CheckedFinger")
      .def(py::init([](std::string joint, double closed, double open) {
             return CheckedFinger{std::move(joint), closed, open};
           }),
           py::arg("joint"), py::arg("closed"), py::arg("open"));
  py::class_<CheckedMotion>(m, "CheckedMotion")
      .def(py::init([](std::string kind, double opening, bool holding, std::vector<double> times,
                       const ArrayLike& positions, const ArrayLike& velocities, const OptionalArray& accelerations) {
             return CheckedMotion{std::move(kind),
                                  opening,
                                  holding,
                                  std::move(times),
                                  rows_argument(positions, "positions"),
                                  rows_argument(velocities, "velocities"),
                                  accelerations.is_none()
                                      ? std::vector<Eigen::VectorXd>{}
                                      : rows_argument(accelerations.cast<ArrayLike>(), "accelerations")};
           }),
           py::arg("kind"), py::arg("opening"), py::arg("holding"), py::arg("times"), py::arg("positions"),
           py::arg("velocities"), py::arg("accelerations") = py::none());
  py::class_<CheckedPick>(m, "CheckedPick")
      .def(py::init([](int stop, std::string tray, std::string part, int grasp, std::vector<CheckedMotion> motions) {
             return CheckedPick{stop, std::move(tray), std::move(part), grasp, std::move(motions)};
           }),
           py::arg("stop"), py::arg("tray"), py::arg("part"), py::arg("grasp"), py::arg("motions"));
  py::class_<CheckedDriveBy>(m, "CheckedDriveBy")
      .def(py::init([](int pick, double close_at, double closed_at, CheckedMotion motion) {
             return CheckedDriveBy{pick, close_at, closed_at, std::move(motion)};
           }),
           py::arg("pick"), py::arg("close_at"), py::arg("closed_at"), py::arg("motion"));
  py::class_<CheckedStop>(m, "CheckedStop")
      .def(py::init([](const ArrayLike& pose, double radius, std::vector<std::string> trays) {
             return CheckedStop{vector3_argument(pose, "stop pose"), radius, std::move(trays)};
           }),
           py::arg("pose"), py::arg("radius"), py::arg("trays"));
  py::class_<CheckedRegion>(m, "CheckedRegion")
      .def(py::init([](std::string tray, const ArrayLike& cells) {
             return CheckedRegion{std::move(tray), flags_argument(cells, "cells")};
           }),
           py::arg("tray"), py::arg("cells"));
  py::class_<CheckedLegFigures>(m, "CheckedLegFigures")
      .def(py::init([](double length, double turning, double duration) {
             return CheckedLegFigures{length, turning, duration};
           }),
           py::arg("length"), py::arg("turning"), py::arg("duration"));
  py::class_<CheckedIntersection>(m, "CheckedIntersection")
      .def(py::init([](std::vector<std::string> trays, double heading, const ArrayLike& centre, double radius) {
             return CheckedIntersection{std::move(trays), heading, vector2_argument(centre, "centre"), radius};
           }),
           py::arg("trays"), py::arg("heading"), py::arg("centre"), py::arg("radius"));
  py::class_<CheckedGrid>(m, "CheckedGrid")
      .def(py::init([](const ArrayLike& origin, double resolution, int nx, int ny, std::vector<double> headings) {
             return CheckedGrid{vector2_argument(origin, "grid origin"), resolution, nx, ny, std::move(headings)};
           }),
           py::arg("origin"), py::arg("resolution"), py::arg("nx"), py::arg("ny"), py::arg("headings"));
}

void bind_plan_to_check(py::module_& m) {
  py::class_<PlanToCheck>(m, "PlanToCheck", "A whole plan as read from plan.json.")
      .def(py::init([](const Robot& robot) {
             PlanToCheck plan{robot};
             return plan;
           }),
           py::arg("robot"))
      .def_readwrite("arm_joints", &PlanToCheck::arm_joints)
      .def_readwrite("velocity_limits", &PlanToCheck::velocity_limits)
      .def_readwrite("acceleration_limits", &PlanToCheck::acceleration_limits)
      .def_readwrite("tip_link", &PlanToCheck::tip_link)
      .def_readwrite("other_joints", &PlanToCheck::other_joints)
      .def_readwrite("max_opening", &PlanToCheck::max_opening)
      .def_readwrite("clearance", &PlanToCheck::clearance)
      .def_readwrite("approach", &PlanToCheck::approach)
      .def_readwrite("fingers", &PlanToCheck::fingers)
      .def_readwrite("finger_links", &PlanToCheck::finger_links)
      .def_readwrite("home", &PlanToCheck::home)
      .def_readwrite("start", &PlanToCheck::start)
      .def_readwrite("goal", &PlanToCheck::goal)
      .def_readwrite("positioning_uncertainty", &PlanToCheck::positioning_uncertainty)
      .def_property(
          "T_base_bin", [](const PlanToCheck& p) { return to_array(p.T_base_bin); },
          [](PlanToCheck& p, const ArrayLike& T) { p.T_base_bin = pose_argument(T, "T_base_bin"); })
      .def_readwrite("bin_size", &PlanToCheck::bin_size)
      .def_readwrite("drop_gap", &PlanToCheck::drop_gap)
      .def_readwrite("obstacles", &PlanToCheck::obstacles)
      .def_readwrite("parts", &PlanToCheck::parts)
      .def_readwrite("trays", &PlanToCheck::trays)
      .def_readwrite("grid", &PlanToCheck::grid)
      .def_readwrite("regions", &PlanToCheck::regions)
      .def_readwrite("stops", &PlanToCheck::stops)
      .def_readwrite("route", &PlanToCheck::route)
      .def_readwrite("picks", &PlanToCheck::picks)
      .def_readwrite("drive_by", &PlanToCheck::drive_by)
      .def_readwrite("closing_speed", &PlanToCheck::closing_speed)
      .def_readwrite("lower_bound", &PlanToCheck::lower_bound)
      .def_readwrite("route_figures", &PlanToCheck::route_figures)
      .def_readwrite("intersections", &PlanToCheck::intersections)
      .def_readwrite("robustness_rate", &PlanToCheck::robustness_rate);
}

void bind_path_check(py::module_& m) {
  py::class_<PathCheckResult>(m, "PathCheckResult", "What check_path found.")
      .def_readonly("free", &PathCheckResult::free)
      .def_readonly("where", &PathCheckResult::where, "Where and what is wrong; empty when free.")
      .def_readonly("configurations_checked", &PathCheckResult::configurations_checked)
      .def("to_dict",
           [](const PathCheckResult& r) {
             return py::dict("free"_a = r.free, "where"_a = r.where,
                             "configurations_checked"_a = r.configurations_checked);
           })
      .def("__repr__", [](const PathCheckResult& r) {
        return "PathCheckResult(" + (r.free ? std::string("free") : r.where) + ")";
      });
  m.def(
      "check_path",
      [](const Robot& robot, const std::vector<std::string>& joints, const ArrayLike& path,
         const std::vector<CheckedBody>& bodies, const std::map<std::string, double>& other_joints, double joint_step) {
        PathToCheck check{robot};
        check.joints = joints;
        check.waypoints = rows_argument(path, "path", static_cast<Eigen::Index>(joints.size()));
        check.bodies = bodies;
        check.other_joints = other_joints;
        py::gil_scoped_release release;
        return verify::check_path(check, joint_step);
      },
      py::arg("robot"), py::arg("joints"), py::arg("path"), py::arg("bodies"), py::kw_only(),
      py::arg("other_joints") = std::map<std::string, double>{}, py::arg("joint_step") = 0.005,
      "Looks at waypoints (k, n) joined by straight lines, in steps of joint_step [rad or m]: limits, self-collisions "
      "and\ncollisions with the bodies, by KDL and FCL called directly.");
}

}  // namespace

void bind_verify(py::module_& top) {
  py::module_ m = top.def_submodule("verify", "Checks finished plans; shares no code with the planners.");
  bind_checked_parts(m);
  bind_plan_to_check(m);
  bind_path_check(m);
  py::class_<Fault>(m, "Fault", "One thing that is physically wrong with a plan.")
      .def(py::init([](std::string code, std::string where, std::string message) {
             return Fault{std::move(code), std::move(where), std::move(message)};
           }),
           py::arg("code"), py::arg("where"), py::arg("message"))
      .def_readonly("code", &Fault::code)
      .def_readonly("where", &Fault::where)
      .def_readonly("message", &Fault::message)
      .def("to_dict",
           [](const Fault& f) { return py::dict("code"_a = f.code, "where"_a = f.where, "message"_a = f.message); })
      .def("__repr__", [](const Fault& f) { return "Fault(" + f.code + " at " + f.where + ": " + f.message + ")"; });
  py::class_<StopRate>(m, "StopRate", "How often every target part stayed graspable around a stop.")
      .def_readonly("stop", &StopRate::stop)
      .def_readonly("samples", &StopRate::samples)
      .def_readonly("good", &StopRate::good)
      .def_readonly("worst_part", &StopRate::worst_part)
      .def("to_dict",
           [](const StopRate& r) {
             return py::dict("stop"_a = r.stop, "samples"_a = r.samples, "good"_a = r.good,
                             "worst_part"_a = r.worst_part);
           })
      .def("__repr__", [](const StopRate& r) {
        return "StopRate(stop " + std::to_string(r.stop) + ": " + std::to_string(r.good) + " of " +
               std::to_string(r.samples) + ")";
      });
  py::class_<PlanCheckResult>(m, "PlanCheckResult", "What the check of a plan found.")
      .def_readonly("faults", &PlanCheckResult::faults, "Empty: the plan holds.")
      .def_readonly("rates", &PlanCheckResult::rates)
      .def_readonly("minimal_stops", &PlanCheckResult::minimal_stops)
      .def_readonly("configurations_checked", &PlanCheckResult::configurations_checked)
      .def_property_readonly("ok", [](const PlanCheckResult& r) { return r.faults.empty(); })
      .def("to_dict",
           [](const PlanCheckResult& r) {
             py::list faults, rates;
             for (const Fault& f : r.faults) faults.append(py::cast(f).attr("to_dict")());
             for (const StopRate& s : r.rates) rates.append(py::cast(s).attr("to_dict")());
             return py::dict("faults"_a = faults, "rates"_a = rates, "minimal_stops"_a = r.minimal_stops,
                             "configurations_checked"_a = r.configurations_checked);
           })
      .def("__repr__", [](const PlanCheckResult& r) {
        return "PlanCheckResult(" + std::to_string(r.faults.size()) + " faults, " +
               std::to_string(r.configurations_checked) + " configurations)";
      });
  m.def(
      "check_plan",
      [](const PlanToCheck& plan, const Progress& progress, const py::kwargs& options) {
        const PlanCheckOptions read = read_options(check_fields(), options, "check_plan");
        return LongCall(progress).run([&](const Monitor& monitor) { return check_plan(plan, read, monitor); });
      },
      py::arg("plan"), py::kw_only(), py::arg("progress") = py::none(),
      ("Checks a finished plan against its scenario." + option_help(check_fields())).c_str());
}

}  // namespace mmgrasp::python
