#include <optional>

#include "bindings.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/verify/path_check.hpp"
#include "mmgrasp/verify/plan_check.hpp"
#include "mmgrasp/verify/schedule_check.hpp"

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
      option<O>("region_samples", &O::region_samples,
                "base poses drawn in each region, cells drawn beside it, and poses in the radius a stop claims"),
      option<O>("seed", &O::seed, "of the base poses drawn"),
      option<O>("threads", &O::threads, "0: all")};
  return fields;
}

CheckedBody body(const std::string& name, std::vector<LinkShape> shapes, const ArrayLike& pose) {
  return {name, std::move(shapes), pose_argument(pose, "pose of " + name)};
}

void bind_checked_parts(py::module_& m) {
  py::class_<CheckedBody>(m, "CheckedBody", "A body of the scene as the plan file describes it.")
      .def(py::init(&body), py::arg("name"), py::arg("shapes"), py::arg("pose"),
           "`pose` (4, 4): T_world_body; `shapes` in its frame.");
  py::class_<CheckedGrasp>(m, "CheckedGrasp", "A grasp of a part as the plan file describes it.")
      .def(py::init([](const ArrayLike& pose, double opening) {
             return CheckedGrasp{pose_argument(pose, "grasp pose"), opening};
           }),
           py::arg("pose"), py::arg("opening"),
           "`pose` (4, 4): T_object_hand; `opening`: between the pads while holding [m].");
  py::class_<CheckedPart>(m, "CheckedPart", "A part and the grasps that a plan may use.")
      .def(py::init([](CheckedBody b, std::string tray, bool target, std::vector<CheckedGrasp> grasps, double mass,
                       bool scanned) {
             return CheckedPart{std::move(b), std::move(tray), target, std::move(grasps), mass, scanned};
           }),
           py::arg("body"), py::arg("tray"), py::arg("target"), py::arg("grasps"), py::arg("mass") = 0.0,
           py::arg("scanned") = false,
           "`tray`: name of the tray it lies in; a part that is no `target` stays; `mass` [kg], 0: not known; "
           "`scanned`: "
           "its\nbody is a cover around what sensors saw, from which the widths of its grasps are not to be told.");
  py::class_<CheckedCup>(m, "CheckedCup", "A suction cup as the plan file describes it.")
      .def(py::init([](const ArrayLike& position, double radius) {
             return CheckedCup{vector3_argument(position, "position"), radius};
           }),
           py::arg("position"), py::arg("radius"), "Middle of the rim in the tool frame (3,) and its radius [m].");
  py::class_<CheckedSuction>(m, "CheckedSuction", "Suction cups of a hand as the plan file describes them.")
      .def(py::init([](std::vector<CheckedCup> cups, double max_gap, double vacuum, double friction, double safety) {
             return CheckedSuction{std::move(cups), max_gap, vacuum, friction, safety};
           }),
           py::arg("cups"), py::kw_only(), py::arg("max_gap"), py::arg("vacuum"), py::arg("friction"),
           py::arg("safety"), "As Suction has them.");
  py::class_<CheckedFinger>(m, "CheckedFinger", "A finger joint, linear in the opening.")
      .def(py::init([](std::string joint, double closed, double open) {
             return CheckedFinger{std::move(joint), closed, open};
           }),
           py::arg("joint"), py::arg("closed"), py::arg("open"),
           "Values of the joint with the fingers `closed` and fully `open` [rad or m].");
  py::class_<CheckedMotion>(m, "CheckedMotion", "One timed arm motion of a pick.")
      .def(py::init([](std::string kind, double opening, bool attached, std::vector<double> times,
                       const ArrayLike& positions, const ArrayLike& velocities, const OptionalArray& accelerations) {
             return CheckedMotion{std::move(kind),
                                  opening,
                                  attached,
                                  std::move(times),
                                  rows_argument(positions, "positions"),
                                  rows_argument(velocities, "velocities"),
                                  accelerations.is_none()
                                      ? std::vector<Eigen::VectorXd>{}
                                      : rows_argument(accelerations.cast<ArrayLike>(), "accelerations")};
           }),
           py::arg("kind"), py::arg("opening"), py::arg("attached"), py::arg("times"), py::arg("positions"),
           py::arg("velocities"), py::arg("accelerations") = py::none(),
           "`kind`: transit, approach, lift, stow, transfer or retreat; `opening` of the fingers [m]; `attached`: the "
           "part "
           "is; "
           "`times` "
           "(k,) [s];\n`positions`, `velocities` and, where given, `accelerations` (k, n) of the arm's joints.");
  py::class_<CheckedPick>(m, "CheckedPick", "One pick of a plan.")
      .def(py::init([](int stop, std::string tray, std::string part, int grasp, std::vector<CheckedMotion> motions) {
             return CheckedPick{stop, std::move(tray), std::move(part), grasp, std::move(motions)};
           }),
           py::arg("stop"), py::arg("tray"), py::arg("part"), py::arg("grasp"), py::arg("motions"),
           "Index of its stop, names of tray and part, index into the part's grasps, motions in order.");
  py::class_<CheckedDriveBy>(
      m, "CheckedDriveBy",
      "A pick in one motion of base and arm, with the drive to its stop where it is the first one there.")
      .def(py::init([](int pick, double close_at, double closed_at, CheckedMotion motion, bool from_release,
                       bool to_release) {
             return CheckedDriveBy{pick, close_at, closed_at, std::move(motion), from_release, to_release};
           }),
           py::arg("pick"), py::arg("close_at"), py::arg("closed_at"), py::arg("motion"),
           py::arg("from_release") = false, py::arg("to_release") = false,
           "`pick`: index into the plan's picks; the fingers begin to close at `close_at` [s] and hold the part from "
           "`closed_at`\n[s] on; rows of `motion` hold x, y, theta, then the arm's joints. `from_release`: it begins "
           "where the pick before\nlets its part go, else at home; `to_release`: it ends where the part is let go, "
           "else once it is lifted.");
  py::class_<CheckedStop>(m, "CheckedStop", "A stop of the base.")
      .def(py::init([](const ArrayLike& pose, double radius, std::vector<std::string> trays, int arrivals,
                       int arrivals_served) {
             return CheckedStop{vector3_argument(pose, "stop pose"), radius, std::move(trays), arrivals,
                                arrivals_served};
           }),
           py::arg("pose"), py::arg("radius"), py::arg("trays"), py::kw_only(), py::arg("arrivals") = 0,
           py::arg("arrivals_served") = 0,
           "`pose` (3,): x, y, theta [m, m, rad]; `radius` of the disc in which every target part stays graspable [m]; "
           "names of\nthe trays served; how many arrivals were drawn, and how many serve all parts.");
  py::class_<CheckedRegion>(m, "CheckedRegion", "Base poses that a plan says serve a tray.")
      .def(py::init([](std::string tray, const ArrayLike& cells) {
             return CheckedRegion{std::move(tray), flags_argument(cells, "cells")};
           }),
           py::arg("tray"), py::arg("cells"), "`cells`: zeros and ones, (headings, ny, nx) flattened.");
  py::class_<CheckedLegValues>(m, "CheckedLegValues", "What a plan says about a leg of its route.")
      .def(py::init([](double length, double turning, double duration) {
             return CheckedLegValues{length, turning, duration};
           }),
           py::arg("length"), py::arg("turning"), py::arg("duration"),
           "Length [m], sum of absolute heading changes [rad], duration [s].");
  py::class_<CheckedIntersection>(m, "CheckedIntersection",
                                  "A place that a plan says lies in the regions of several trays.")
      .def(py::init([](std::vector<std::string> trays, double heading, const ArrayLike& centre, double radius) {
             return CheckedIntersection{std::move(trays), heading, vector2_argument(centre, "centre"), radius};
           }),
           py::arg("trays"), py::arg("heading"), py::arg("centre"), py::arg("radius"),
           "Names of the trays, heading [rad], centre (2,) and radius of the disc [m].");
  py::class_<CheckedUnloading>(m, "CheckedUnloading", "A drive to the goal with a full bin, as the plan file has it.")
      .def(
          py::init([](int after_pick, const ArrayLike& to_goal, const CheckedLegValues& to_goal_values,
                      const OptionalArray& back, const std::optional<CheckedLegValues>& back_values) {
            const auto poses = [](const ArrayLike& rows, const char* name) {
              std::vector<Eigen::Vector3d> out;
              for (const Eigen::VectorXd& row : rows_argument(rows, name, 3)) out.emplace_back(row);
              return out;
            };
            CheckedUnloading unloading{after_pick, poses(to_goal, "to_goal"), {}, to_goal_values};
            if (!back.is_none()) unloading.back = poses(back.cast<ArrayLike>(), "back");
            if (back_values) unloading.back_values = *back_values;
            return unloading;
          }),
          py::arg("after_pick"), py::arg("to_goal"), py::arg("to_goal_values"), py::arg("back") = py::none(),
          py::arg("back_values") = py::none(),
          "Index of the pick that filled the bin; base poses (k, 3) to the goal and, where parts are left at the stop, "
          "back, and what is\nsaid about both.");
  py::class_<CheckedUnloadRegion>(m, "CheckedUnloadRegion",
                                  "Where parts are let go at the goal, as the plan file has it.")
      .def(py::init([](const ArrayLike& T_world_region, const ArrayLike& size, double drop_height) {
             return CheckedUnloadRegion{pose_argument(T_world_region, "T_world_region"), vector2_argument(size, "size"),
                                        finite_argument(drop_height, "drop_height")};
           }),
           py::arg("T_world_region"), py::arg("size"), py::arg("drop_height"),
           "Middle of the rectangle (4, 4), z up, its x and y (2,) [m], and how far above it parts are let go [m].");
  py::class_<CheckedGrid>(m, "CheckedGrid", "The grid of a plan's regions.")
      .def(py::init([](const ArrayLike& origin, double resolution, int nx, int ny, std::vector<double> headings) {
             return CheckedGrid{vector2_argument(origin, "grid origin"), resolution, nx, ny, std::move(headings)};
           }),
           py::arg("origin"), py::arg("resolution"), py::arg("nx"), py::arg("ny"), py::arg("headings"),
           "Lower corner of cell (0, 0) (2,) [m], edge of a cell [m], cells along x and y, headings [rad].");
}

void bind_checked_tray(py::module_& m) {
  py::class_<CheckedTray>(m, "CheckedTray", "How base poses for a tray were searched.")
      .def(py::init([](std::vector<double> headings, const ArrayLike& middle, double max_distance,
                       bool shares_headings) {
             return CheckedTray{std::move(headings), vector2_argument(middle, "middle"), max_distance, shares_headings};
           }),
           py::arg("headings"), py::arg("middle"), py::arg("max_distance"), py::arg("shares_headings") = false,
           "Base headings tried [rad], the tray's middle (2,), the distance from it beyond which none were tried [m], "
           "and whether other trays' headings were tried where one of these can be served.");
}

void bind_plan_to_check(py::module_& m) {
  py::class_<PlanToCheck>(m, "PlanToCheck",
                          "A whole plan as read from plan.json: what the checker needs to know, and what is claimed. "
                          "`mmgrasp.verify_plan` makes\n"
                          "one of a file.\n"
                          "\n"
                          "    verdict = mg.verify_plan(\"out/storeroom/plan.json\")\n"
                          "    for fault in verdict.faults:\n"
                          "        print(fault.code, fault.where, fault.message)")
      .def(py::init<RobotSource>(), py::arg("robot"), "A plan for this robot; everything else is set afterwards.")
      .def_readwrite("robot", &PlanToCheck::robot, "What the robot really is: its URDFs as they were given.")
      .def_readwrite("planned_robot", &PlanToCheck::planned_robot,
                     "As the planners understood it; without URDFs: not compared.")
      .def_readwrite("arm_joints", &PlanToCheck::arm_joints, "Names of the columns of the motions.")
      .def_readwrite("velocity_limits", &PlanToCheck::velocity_limits, "One an arm joint [rad/s or m/s].")
      .def_readwrite("acceleration_limits", &PlanToCheck::acceleration_limits, "One an arm joint [rad/s^2 or m/s^2].")
      .def_readwrite("tip_link", &PlanToCheck::tip_link, "Link of the tool centre point.")
      .def_readwrite("other_joints", &PlanToCheck::other_joints, "Values of joints outside the arm [rad or m].")
      .def_readwrite("max_opening", &PlanToCheck::max_opening, "Largest opening of the gripper [m].")
      .def_readwrite("clearance", &PlanToCheck::clearance, "Opening beyond the part's width before grasping [m].")
      .def_readwrite("approach", &PlanToCheck::approach,
                     "Unit vector (3,) in the tip's frame along which the hand comes.")
      .def_readwrite("closing", &PlanToCheck::closing,
                     "Unit vector (3,) in the tip's frame along which the pads close.")
      .def_readwrite("finger_depth", &PlanToCheck::finger_depth,
                     "Size of a pad along the approach [m]; 0: widths are not compared with the parts.")
      .def_readwrite("finger_width", &PlanToCheck::finger_width, "Size of a pad across approach and closing [m].")
      .def_readwrite("approach_distance", &PlanToCheck::approach_distance, "Least straight way to a grasp [m].")
      .def_readwrite("lift_height", &PlanToCheck::lift_height, "Least straight way up after closing [m].")
      .def_readwrite("searched", &PlanToCheck::searched, "How base poses for each tray were searched, by its name.")
      .def_readwrite("fingers", &PlanToCheck::fingers, "Finger joints.")
      .def_readwrite("openings", &PlanToCheck::openings,
                     "Openings at equal steps of the finger joints from closed to open [m]; empty: linear from 0.")
      .def_readwrite("finger_links", &PlanToCheck::finger_links, "Links that may touch the part that is held.")
      .def_readwrite("home", &PlanToCheck::home, "Arm configuration while driving (n,).")
      .def_readwrite("start", &PlanToCheck::start, "Base pose at the beginning (3,): x, y, theta [m, m, rad].")
      .def_readwrite("goal", &PlanToCheck::goal, "Base pose at the end (3,): x, y, theta [m, m, rad].")
      .def_readwrite("positioning_uncertainty", &PlanToCheck::positioning_uncertainty,
                     "Radius of the disc in which the base may come to stand [m].")
      .def_readwrite("drive_clearance", &PlanToCheck::drive_clearance,
                     "Kept by drives farther than 1 m from both their ends [m]; 0: not asked for.")
      .def_readwrite("arrival_covariance", &PlanToCheck::arrival_covariance,
                     "Covariance of x, y [m^2] and theta [rad^2] about a stop (3, 3); zeros: arrivals are not judged.")
      .def_property(
          "T_base_bin", [](const PlanToCheck& p) { return to_array(p.T_base_bin); },
          [](PlanToCheck& p, const ArrayLike& T) { p.T_base_bin = pose_argument(T, "T_base_bin"); },
          "Middle of the bin's top plane in the robot's root frame (4, 4), z up.")
      .def_readwrite("bin_size", &PlanToCheck::bin_size, "Inner x and y (2,) [m].")
      .def_readwrite("drop_height", &PlanToCheck::drop_height,
                     "Height above the bin's top plane at which parts are released [m].")
      .def_readwrite("unload_region", &PlanToCheck::unload_region,
                     "Where parts are let go at the goal that the hand brings there; None: they go into the bin.")
      .def_readwrite("floor", &PlanToCheck::floor,
                     "Everything below this height is ground [m], which links that the arm joints move, and what they "
                     "hold, must not\ntouch; -inf: there is none.")
      .def_readwrite("obstacles", &PlanToCheck::obstacles, "Bodies of the scene.")
      .def_readwrite("parts", &PlanToCheck::parts, "All parts, targets and others.")
      .def_readwrite("padded", &PlanToCheck::padded,
                     "Bodies were kept apart by more than touching: cells beside a region prove nothing.")
      .def_readwrite("allowed_collisions", &PlanToCheck::allowed_collisions,
                     "Pairs of names (links, obstacles, parts) that may touch.")
      .def_readwrite("trays", &PlanToCheck::trays, "Names of the trays.")
      .def_readwrite("grid", &PlanToCheck::grid, "Grid of the regions.")
      .def_readwrite("regions", &PlanToCheck::regions, "One a tray.")
      .def_readwrite("stops", &PlanToCheck::stops, "The stops in the order in which they are visited.")
      .def_readwrite("route", &PlanToCheck::route, "Legs of base poses (3,), one more than stops.")
      .def_readwrite("unloadings", &PlanToCheck::unloadings, "Drives to the goal with a full bin, in order.")
      .def_readwrite("capacity", &PlanToCheck::capacity, "So many parts fill the bin; 0: it takes all.")
      .def_readwrite("picks", &PlanToCheck::picks, "The picks in order.")
      .def_readwrite("drive_by", &PlanToCheck::drive_by, "What of route and picks is done in passing.")
      .def_readwrite("closing_speed", &PlanToCheck::closing_speed, "How fast the opening shrinks [m/s], for drive_by.")
      .def_readwrite("suction", &PlanToCheck::suction, "What holds parts in place of fingers; no cups: fingers do.")
      .def_readwrite("payload", &PlanToCheck::payload, "Heaviest part that may be picked [kg].")
      .def_readwrite("lower_bound", &PlanToCheck::lower_bound, "Least number of stops, as the plan says.")
      .def_readwrite("leg_values", &PlanToCheck::leg_values, "One a leg; empty: not given.")
      .def_readwrite("intersections", &PlanToCheck::intersections, "Places that the plan says lie in several regions.")
      .def_readwrite("robustness_rate", &PlanToCheck::robustness_rate, "As the plan says; NaN: not given.");
}

void bind_path_check(py::module_& m) {
  py::class_<PathCheckResult>(m, "PathCheckResult", "What check_path found.")
      .def_readonly("free", &PathCheckResult::free, "Nothing is wrong.")
      .def_readonly("where", &PathCheckResult::where, "Where and what is wrong; empty when free.")
      .def_readonly("configurations_checked", &PathCheckResult::configurations_checked, "How many were checked.")
      .def(
          "to_dict",
          [](const PathCheckResult& r) {
            return py::dict("free"_a = r.free, "where"_a = r.where,
                            "configurations_checked"_a = r.configurations_checked);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const PathCheckResult& r) {
        return "PathCheckResult(" + (r.free ? std::string("free") : r.where) + ")";
      });
  m.def(
      "check_path",
      [](const Robot& robot, const std::vector<std::string>& joints, const ArrayLike& path,
         const std::vector<CheckedBody>& bodies, const std::map<std::string, double>& other_joints,
         const std::vector<CheckedPair>& allowed_collisions, double joint_step) {
        PathToCheck check{source_of(robot)};
        check.joints = joints;
        check.waypoints = rows_argument(path, "path", static_cast<Eigen::Index>(joints.size()));
        check.bodies = bodies;
        for (const auto& [name, value] : other_joints) finite_argument(value, "other_joints['" + name + "']");
        check.other_joints = other_joints;
        check.allowed_collisions = allowed_collisions;
        return interruptible([&](const Monitor& monitor) { return verify::check_path(check, joint_step, monitor); });
      },
      py::arg("robot"), py::arg("joints"), py::arg("path"), py::arg("bodies"), py::kw_only(),
      py::arg("other_joints") = std::map<std::string, double>{},
      py::arg("allowed_collisions") = std::vector<CheckedPair>{}, py::arg("joint_step") = 0.005,
      "Looks at waypoints (k, n) joined by straight lines, in steps of joint_step [rad or m]: limits, self-collisions "
      "and\ncollisions with the bodies, by KDL and FCL called directly. Pairs of links or bodies in "
      "`allowed_collisions` may touch.");
}

}  // namespace

void bind_verify(py::module_& top) {
  py::module_ m = top.def_submodule("verify", "Checks finished plans; shares no code with the planners.");
  bind_checked_parts(m);
  bind_checked_tray(m);
  bind_plan_to_check(m);
  bind_path_check(m);
  py::class_<Fault>(m, "Fault", "One thing that is physically wrong with a plan.")
      .def(py::init([](std::string code, std::string where, std::string message) {
             return Fault{std::move(code), std::move(where), std::move(message)};
           }),
           py::arg("code"), py::arg("where"), py::arg("message"),
           "A fault found elsewhere, e.g. while reading the plan.")
      .def_readonly("code", &Fault::code, "Which rule is broken.")
      .def_readonly("where", &Fault::where, "E.g. pick, motion and time.")
      .def_readonly("message", &Fault::message, "What is wrong, with the value and the bound.")
      .def(
          "to_dict",
          [](const Fault& f) { return py::dict("code"_a = f.code, "where"_a = f.where, "message"_a = f.message); },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const Fault& f) { return "Fault(" + f.code + " at " + f.where + ": " + f.message + ")"; });
  py::class_<StopRate>(m, "StopRate", "How often every target part stayed graspable around a stop.")
      .def_readonly("stop", &StopRate::stop, "Index of the stop.")
      .def_readonly("samples", &StopRate::samples, "Draws checked; fewer than asked when the verdict was clear before.")
      .def_readonly("good", &StopRate::good, "Draws from which every target part could be grasped.")
      .def_readonly("worst_part", &StopRate::worst_part, "The part that was lost most often; empty: none.")
      .def(
          "to_dict",
          [](const StopRate& r) {
            return py::dict("stop"_a = r.stop, "samples"_a = r.samples, "good"_a = r.good,
                            "worst_part"_a = r.worst_part);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const StopRate& r) {
        return "StopRate(stop " + std::to_string(r.stop) + ": " + std::to_string(r.good) + " of " +
               std::to_string(r.samples) + ")";
      });
  py::class_<PlanCheckResult>(m, "PlanCheckResult", "What the check of a plan found.")
      .def_readonly("faults", &PlanCheckResult::faults, "Empty: the plan holds.")
      .def_readonly("rates", &PlanCheckResult::rates, "One a stop.")
      .def_readonly("minimal_stops", &PlanCheckResult::minimal_stops,
                    "So many stops are enough for the plan's regions: found again.")
      .def_readonly("lower_bound", &PlanCheckResult::lower_bound,
                    "Fewer stops are not enough: proven again. Below minimal_stops: the least number is not decided.")
      .def_readonly("search_cut", &PlanCheckResult::search_cut,
                    "The search for shared regions ended at its limit, which lower_bound allows for.")
      .def_readonly("regions_searched", &PlanCheckResult::regions_searched,
                    "Cells were looked for that the regions lack; without it the numbers of stops hold for the regions "
                    "as they stand.")
      .def_readonly("configurations_checked", &PlanCheckResult::configurations_checked, "How many were checked.")
      .def_property_readonly(
          "ok", [](const PlanCheckResult& r) { return r.faults.empty(); }, "There are no faults.")
      .def(
          "to_dict",
          [](const PlanCheckResult& r) {
            py::list faults, rates;
            for (const Fault& f : r.faults) faults.append(py::cast(f).attr("to_dict")());
            for (const StopRate& s : r.rates) rates.append(py::cast(s).attr("to_dict")());
            return py::dict("faults"_a = faults, "rates"_a = rates, "minimal_stops"_a = r.minimal_stops,
                            "lower_bound"_a = r.lower_bound, "search_cut"_a = r.search_cut,
                            "regions_searched"_a = r.regions_searched,
                            "configurations_checked"_a = r.configurations_checked);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const PlanCheckResult& r) {
        return "PlanCheckResult(" + std::to_string(r.faults.size()) + " faults, " +
               std::to_string(r.configurations_checked) + " configurations)";
      });
  m.def(
      "overlapping_bodies",
      [](const std::vector<CheckedBody>& bodies, const Progress& progress) {
        return LongCall(progress).run([&](const Monitor& monitor) { return overlapping_bodies(bodies, monitor); });
      },
      py::arg("bodies"), py::kw_only(), py::arg("progress") = py::none(),
      "Index pairs of the bodies that overlap by more than 1e-4 m; those that just touch do not. `progress(stage, "
      "fraction)`\nhears how far it is.");
  m.def(
      "pads_unlike_grasp",
      [](const Hand& hand, const std::vector<LinkShape>& part, const CheckedGrasp& grasp) {
        const CheckedPads pads{hand.approach,     hand.closing,      hand.max_opening,
                               hand.finger_depth, hand.finger_width, hand.clearance};
        return pads_unlike_grasp(pads, part, grasp);
      },
      py::arg("hand"), py::arg("part"), py::arg("grasp"),
      "How pads of the hand's size that close on the part otherwise meet it than the grasp says, '' where they do not: "
      "each\nmust stop half the opening from the hand's middle, within 1.5 mm or a twentieth of the opening.");
  m.def(
      "broken_seal",
      [](const Hand& hand, const std::vector<LinkShape>& part, const CheckedGrasp& grasp) {
        require(hand.suction.has_value(), "hand", "fingers", "must be a hand of suction cups");
        const Suction& own = *hand.suction;
        CheckedSuction checked{{}, own.max_gap, own.vacuum, own.friction, own.safety};
        for (const SuctionCup& cup : own.cups) checked.cups.push_back({cup.position, cup.radius});
        return broken_seal(checked, hand.approach, part, grasp);
      },
      py::arg("hand"), py::arg("part"), py::arg("grasp"),
      "What is wrong with the seal of the hand's suction cups at the grasp, by the rule of check_plan; '' where they "
      "seal.");
  m.def(
      "check_plan",
      [](const PlanToCheck& plan, const Progress& progress, const py::kwargs& options) {
        const PlanCheckOptions read = read_options(check_fields(), options, "check_plan");
        return LongCall(progress).run([&](const Monitor& monitor) { return check_plan(plan, read, monitor); });
      },
      py::arg("plan"), py::kw_only(), py::arg("progress") = py::none(),
      ("Checks a finished plan against its scenario." + option_help(check_fields())).c_str());
  m.def(
      "check_schedule",
      [](const std::vector<PlanToCheck>& plans, const std::vector<std::vector<double>>& starts,
         const std::vector<std::vector<double>>& durations, double clearance, const Progress& progress) {
        if (plans.size() != starts.size()) throw InvalidInput("starts: must be one list a plan");
        if (plans.size() != durations.size()) throw InvalidInput("durations: must be one list a plan");
        for (const auto* times : {&starts, &durations}) {
          const std::string name = times == &starts ? "starts" : "durations";
          for (const std::vector<double>& own : *times)
            for (const double time : own) require_number(time, name);
        }
        std::vector<ScheduledPlan> robots;
        for (std::size_t i = 0; i < plans.size(); ++i) robots.push_back({plans[i], starts[i], durations[i]});
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return check_schedule(robots, clearance, monitor); });
      },
      py::arg("plans"), py::arg("starts"), py::arg("durations"), py::arg("clearance"), py::kw_only(),
      py::arg("progress") = py::none(),
      "Faults of robots that carry out their plans on one clock and come closer to each other than `clearance` [m], "
      "less 1 mm, at any\nmoment. `starts`: when each piece of each plan begins [s]: straight sections of drives, "
      "motions "
      "of picks,\nclosings and openings of the hand; `durations`: how long they are said to take.");
}

}  // namespace mmgrasp::python
