#include <pybind11/typing.h>

#include "bindings.hpp"
#include "ids.hpp"
#include "mmgrasp/task/base_route.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "mmgrasp/task/fingers_meet.hpp"
#include "mmgrasp/task/part_supply.hpp"
#include "mmgrasp/task/pick.hpp"
#include "mmgrasp/task/plan_file.hpp"
#include "mmgrasp/task/problem.hpp"
#include "option_bounds.hpp"
#include "place_regions.hpp"
#include "plan_arguments.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;
using Options = PartSupplyOptions;

const std::vector<OptionField<Options>>& supply_fields() {
  static const std::vector<OptionField<Options>> fields{
      option<Options>("grid_resolution", &Options::grid, &BaseGridOptions::resolution,
                      "cell edge of the base grid [m]"),
      option<Options>("grid_max_distance", &Options::grid, &BaseGridOptions::max_distance,
                      "cells farther from the tray's middle are not tried [m]; 0: the arm's reach"),
      option<Options>("ik_seeds", &Options::grid, &BaseGridOptions::ik_seeds,
                      "database configurations refined for each grasp and base pose, more where a part has fewer than "
                      "128 / ik_seeds grasps; arms with closed-form IK take all branches"),
      option<Options>("positioning_uncertainty", &Options::positioning_uncertainty,
                      "radius of the disc in which the base may come to stand [m]"),
      option<Options>("approach_distance", &Options::approach_distance, "straight move from pre-grasp to grasp [m]"),
      option<Options>("lift_height", &Options::lift_height, "straight upward move after closing [m]"),
      option<Options>("motion_time_limit", &Options::motion_time_limit, "for each planned motion [s]"),
      option<Options>(
          "route_resolution", &Options::route_resolution,
          "smallest cell edge of the base route's search [m]; cells of 0.1 m are tried before smaller ones"),
      option<Options>("robustness_samples", &Options::robustness_samples,
                      "base poses drawn at each stop for the check before returning"),
      option<Options>("seed", &Options::seed, "same seed, same plan"),
      option<Options>("threads", &Options::threads, "0: all; does not change the answer")};
  return fields;
}

const BoundedOptions<Options>& supply_options() {
  static const BoundedOptions<Options> options(supply_fields(), {{"grid_resolution", {0.001, 10, "m"}},
                                                                 {"grid_max_distance", {0, 1000, "m"}},
                                                                 {"ik_seeds", {1, 1000, "configurations"}},
                                                                 {"positioning_uncertainty", {0, 100, "m"}},
                                                                 {"approach_distance", {0.001, 10, "m"}},
                                                                 {"lift_height", {0.01, 10, "m"}},
                                                                 {"motion_time_limit", {1e-6, 86400, "s"}},
                                                                 {"route_resolution", {0.001, 100, "m"}},
                                                                 {"robustness_samples", {0, 1e6, "base poses"}},
                                                                 {"seed", {0, kMostSeed, ""}},
                                                                 {"threads", {0, 1024, "(0: all)"}}});
  return options;
}

Eigen::Matrix3d covariance_argument(const ArrayLike& value) {
  const Eigen::MatrixXd rows = matrix_argument(value, "arrival_covariance", 3);
  require(rows.rows() == 3, "arrival_covariance", std::to_string(rows.rows()) + " rows", "must have shape (3, 3)");
  return rows;
}

const std::vector<OptionField<PickOptions>>& pick_fields() {
  static const std::vector<OptionField<PickOptions>> fields{
      option<PickOptions>("approach_distance", &PickOptions::approach_distance,
                          "straight move from pre-grasp to grasp [m]"),
      option<PickOptions>("lift_height", &PickOptions::lift_height, "straight upward move after closing [m]"),
      option<PickOptions>("motion_time_limit", &PickOptions::motion_time_limit, "for each planned motion [s]"),
      option<PickOptions>("ik_seeds", &PickOptions::ik_seeds, "database configurations refined for each grasp"),
      option<PickOptions>("seed", &PickOptions::seed, "same seed, same pick")};
  return fields;
}

void bind_problem(py::module_& m) {
  m.def("_ik_seeds_of_a_grasp", &ik_seeds_of_a_grasp, py::arg("asked"), py::arg("grasps_of_parts"));
  m.def("_supply_option_table", [] { return option_table(supply_fields()); });
  m.def("_supply_option_bounds", [] { return supply_options().bounds(); });
  m.def(
      "_check_arrival_covariance",
      [](const ArrayLike& covariance) { check_arrival_covariance(covariance_argument(covariance)); },
      py::arg("covariance"), "Raises InvalidInput when this is no covariance (3, 3) of x, y and theta.");
  m.def(
      "_check_options",
      [](const std::string& section, const py::kwargs& options) {
        if (section == "reach") {
          check_reach_options(options);
        } else {
          supply_options().read(options, section.c_str());
        }
      },
      py::arg("section"), "Raises InvalidInput when an option of a scenario's section is out of range.");
  py::class_<Part>(m, "Part", "One part in a tray.")
      .def(py::init([](std::string name, std::vector<LinkShape> shapes, const ArrayLike& T_world_part,
                       std::vector<Grasp> grasps, bool target, int grasps_too_wide, double mass, bool grasps_sampled) {
             return Part{std::move(name),
                         std::move(shapes),
                         pose_argument(T_world_part, "T_world_part"),
                         target,
                         std::move(grasps),
                         grasps_too_wide,
                         finite_argument(mass, "mass"),
                         grasps_sampled};
           }),
           py::arg("name"), py::arg("shapes"), py::arg("T_world_part"), py::arg("grasps") = std::vector<Grasp>{},
           py::kw_only(), py::arg("target") = true, py::arg("grasps_too_wide") = 0, py::arg("mass") = 0.0,
           py::arg("grasps_sampled") = false,
           "`shapes` in the part's frame, `T_world_part` (4, 4), candidate `grasps` best first. A part that is no "
           "`target`\nstays where it is; `grasps_too_wide` says how many candidates were left out because the gripper "
           "does not open so far.\n`mass` [kg]; 0: not known. `grasps_sampled`: others may exist, so that nothing is "
           "proven of the part where these are impossible.")
      .def_readonly("name", &Part::name, "Unique over the problem.")
      .def_readonly("shapes", &Part::shapes, "Its body, in the part's frame.")
      .def_property_readonly(
          "T_world_part", [](const Part& p) { return to_array(p.T_world_part); }, "Pose of the part (4, 4).")
      .def_readonly("target", &Part::target, "To be picked; otherwise an obstacle that stays.")
      .def_readonly("grasps", &Part::grasps, "Candidates, best first.")
      .def_readonly("grasps_too_wide", &Part::grasps_too_wide,
                    "Candidates left out because the gripper does not open so far.")
      .def_readonly("mass", &Part::mass, "[kg]; 0: not known.")
      .def_readonly("grasps_sampled", &Part::grasps_sampled, "Others may exist.")
      .def("__repr__", [](const Part& p) {
        return "Part('" + p.name + "', " + std::to_string(p.grasps.size()) + " grasps" + (p.target ? ")" : ", stays)");
      });
  py::class_<Tray>(m, "Tray", "A tray and the parts in it; its walls are scene objects.")
      .def(py::init([](std::string name, const ArrayLike& T_world_tray, const ArrayLike& size, std::vector<Part> parts,
                       const ArrayLike& headings) {
             return Tray{std::move(name), pose_argument(T_world_tray, "T_world_tray"), vector3_argument(size, "size"),
                         std::move(parts), list_argument(headings, "headings")};
           }),
           py::arg("name"), py::arg("T_world_tray"), py::arg("size"), py::arg("parts"),
           py::arg("headings") = py::tuple(),
           "`T_world_tray` (4, 4): middle of the tray's floor, a robot in front of it looks along its +x; `size` (3,): "
           "depth,\nwidth, height [m]; `headings` of the base that are tried [rad], none given: the one that faces the "
           "tray.")
      .def_readonly("name", &Tray::name, "Unique over the problem.")
      .def_property_readonly(
          "T_world_tray", [](const Tray& t) { return to_array(t.T_world_tray); },
          "Middle of the tray's floor (4, 4); a robot in front of it looks along its +x.")
      .def_readonly("size", &Tray::size, "Depth, width, height [m].")
      .def_readonly("parts", &Tray::parts, "The parts in it.")
      .def_readonly("headings", &Tray::headings,
                    "Headings of the base that are tried [rad]; empty: the one that faces the tray.")
      .def("__repr__",
           [](const Tray& t) { return "Tray('" + t.name + "', " + std::to_string(t.parts.size()) + " parts)"; });
  bind_place_regions(m);
  py::class_<PartSupplyProblem>(m, "PartSupplyProblem",
                                "Everything the part-supply planner needs: the robot and its hand, the room, the trays "
                                "with their parts, and where parts\n"
                                "go. `mmgrasp.load_scenario(path).problem()` makes one of a scenario file.\n"
                                "\n"
                                "    problem = mg.load_scenario(\"storeroom.yaml\").problem()\n"
                                "    database = mg.ReachDatabase.build(problem.arm)\n"
                                "    plan = mg.base.plan_part_supply(problem, database)")
      .def(
          py::init([](const Robot& robot, const JointGroup& arm, const Hand& gripper, const World& world,
                      std::vector<Tray> trays, const ArrayLike& home, const ArrayLike& start, const ArrayLike& goal,
                      const std::optional<PlaceRegion>& place_region, const OptionalArray& arrival_covariance,
                      double drive_clearance, const std::optional<UnloadRegion>& unload_region,
                      const py::kwargs& options) {
            if (place_region.has_value() == unload_region.has_value())
              throw InvalidInput(place_region ? "unload_region: parts go into the bin, place_region: give one of both"
                                              : "place_region = None: a robot without a bin needs an unload_region");
            PartSupplyProblem problem{robot,
                                      arm,
                                      gripper,
                                      world,
                                      std::move(trays),
                                      vector_argument(home, "home", arm.size()),
                                      vector3_argument(start, "start"),
                                      vector3_argument(goal, "goal"),
                                      place_region.value_or(PlaceRegion()),
                                      supply_options().read(options, "PartSupplyProblem")};
            if (!arrival_covariance.is_none())
              problem.arrival_covariance = covariance_argument(py::reinterpret_borrow<ArrayLike>(arrival_covariance));
            problem.drive_clearance = drive_clearance;
            problem.unload_region = unload_region;
            problem.check();
            return problem;
          }),
          py::arg("robot"), py::arg("arm"), py::arg("gripper"), py::arg("world"), py::arg("trays"), py::arg("home"),
          py::arg("start"), py::arg("goal"), py::arg("place_region"), py::kw_only(),
          py::arg("arrival_covariance") = py::none(), py::arg("drive_clearance") = 0.0,
          py::arg("unload_region") = py::none(),
          ("`world` is without the parts; `home` (n,) is the arm's configuration while driving; `start` and `goal` "
           "(3,) are base\nposes x, y, theta [m, m, rad]. `arrival_covariance` (3, 3) of x, y [m^2] and theta [rad^2] "
           "in the world's axes says how far\nfrom a stop the base comes to stand; stops then are where most arrivals "
           "serve all their parts. Drives keep\n`drive_clearance` [m] to all but the ground, but within 1 m of their "
           "ends. A robot without a bin\n(`place_region` None) brings each part to the goal in its hand and lets it go "
           "over the `unload_region` there. Raises InvalidInput naming the field that breaks its rule." +
           option_help(supply_fields()))
              .c_str())
      .def_readonly("robot", &PartSupplyProblem::robot, "The robot.")
      .def_readonly("arm", &PartSupplyProblem::arm, "The arm, without base joints.")
      .def_readonly("gripper", &PartSupplyProblem::gripper, "The gripper of the arm.")
      .def_readonly("world", &PartSupplyProblem::world, "Obstacles, tables and trays, without the parts.")
      .def_readonly("trays", &PartSupplyProblem::trays, "The trays with their parts.")
      .def_readonly("home", &PartSupplyProblem::home, "Arm configuration while driving (n,), fingers closed.")
      .def_readonly("start", &PartSupplyProblem::start, "Base pose at the beginning (3,): x, y, theta [m, m, rad].")
      .def_readonly("goal", &PartSupplyProblem::goal, "Base pose at the end (3,): x, y, theta [m, m, rad].")
      .def_property_readonly(
          "place_region",
          [](const PartSupplyProblem& p) -> std::optional<PlaceRegion> {
            if (p.unload_region) return std::nullopt;
            return p.place_region;
          },
          "The bin on the robot, where picked parts go; None: there is none.")
      .def_readonly("unload_region", &PartSupplyProblem::unload_region,
                    "Where parts are let go at the goal that the hand brings there; None: they go into the bin.")
      .def_readonly("arrival_covariance", &PartSupplyProblem::arrival_covariance,
                    "Covariance of x, y [m^2] and theta [rad^2] about a stop (3, 3); zeros: not asked for.")
      .def_readonly("drive_clearance", &PartSupplyProblem::drive_clearance,
                    "Kept by drives farther than 1 m from both their ends [m]; 0: not asked for.")
      .def_property_readonly(
          "options",
          [](const PartSupplyProblem& p) -> NamedOptions {
            py::dict out;
            for (const auto& field : supply_fields()) out[field.name.c_str()] = field.get(p.options);
            return out;
          },
          "Every keyword option with its value.");
}

using AskedOfGrasps = std::vector<bool> (*)(const JointGroup&, const Hand&, const std::vector<LinkShape>&,
                                            const std::vector<Grasp>&, double);

void def_asked_of_grasps(py::module_& m, const char* name, AskedOfGrasps ask, const char* doc) {
  m.def(
      name,
      [ask](const JointGroup& arm, const Hand& hand, const std::vector<LinkShape>& part,
            const std::vector<Grasp>& grasps, double mesh_tolerance) {
        return interruptible([&] { return ask(arm, hand, part, grasps, mesh_tolerance); });
      },
      py::arg("arm"), py::arg("hand"), py::arg("part"), py::arg("grasps"), py::kw_only(),
      py::arg("mesh_tolerance") = 0.0, doc);
}

void bind_picks(py::module_& m) {
  py::class_<PickMotion>(m, "PickMotion", "One timed arm motion at a stop.")
      .def_property_readonly(
          "kind", [](const PickMotion& p) { return to_string(p.kind); },
          "transit, approach, lift, transfer or retreat; stow where the hand carries the part to the goal.")
      .def_readonly("opening", &PickMotion::opening, "Opening of the fingers during the motion [m].")
      .def_readonly("attached", &PickMotion::attached, "The part is attached during the motion.")
      .def_readonly("trajectory", &PickMotion::trajectory, "The arm on its clock, from 0.")
      .def("__repr__", [](const PickMotion& p) {
        return std::string("PickMotion(") + to_string(p.kind) + ", " +
               std::string(py::repr(py::float_(p.trajectory.duration()))) + " s)";
      });
  py::class_<Pick>(m, "Pick", "Home, pre-grasp, grasp, lift, transfer, home.")
      .def_readonly("outcome", &Pick::outcome, "How it ended; `solved` alone comes with an answer.")
      .def_readonly("stop", &Pick::stop, "Index of the stop.")
      .def_property_readonly(
          "tray", [](const Pick& p) { return p.part.tray; }, "Index of the tray.")
      .def_property_readonly(
          "part", [](const Pick& p) { return p.part.part; }, "Index into the tray's parts.")
      .def_readonly("grasp", &Pick::grasp, "Index into the part's grasps.")
      .def_readonly("motions", &Pick::motions,
                    "transit, approach, lift, transfer, retreat; stow after lift without a bin.")
      .def_readonly("rejections", &Pick::rejections, "Grasps and their configurations rejected on the way, by cause.")
      .def_readonly("failed_at", &Pick::failed_at, "Without a solution: the stage at which most candidates fell.")
      .def_property_readonly("duration", &Pick::duration, "Duration of all its motions [s].")
      .def("__repr__", [](const Pick& p) {
        return std::string("Pick(") + to_string(p.outcome) + ", tray " + std::to_string(p.part.tray) + ", part " +
               std::to_string(p.part.part) + ")";
      });
  m.def(
      "plan_pick",
      [](const PartSupplyProblem& problem, const ReachDatabase& database, const ArrayLike& base_pose, int tray,
         int part, const std::vector<std::pair<int, int>>& remaining) {
        const Eigen::Vector3d base = vector3_argument(base_pose, "base_pose");
        const std::vector<PartRef> left = parts_argument(remaining);
        return LongCall(py::none()).run([&](const Monitor& monitor) {
          return plan_pick(problem, database, base, {TrayId(tray), part}, left, monitor);
        });
      },
      py::arg("problem"), py::arg("database"), py::arg("base_pose"), py::arg("tray"), py::arg("part"),
      py::arg("remaining"),
      "One pick from a base pose; `remaining` are the (tray, part) still in place, the picked one among them.");
  m.def(
      "plan_stop_picks",
      [](const PartSupplyProblem& problem, const ReachDatabase& database, const ArrayLike& base_pose,
         const std::vector<int>& trays, const std::vector<std::pair<int, int>>& remaining, const Progress& progress) {
        const Eigen::Vector3d base = vector3_argument(base_pose, "base_pose");
        const std::vector<PartRef> left = parts_argument(remaining);
        const std::vector<TrayId> served(trays.begin(), trays.end());
        StopPicks found = LongCall(progress).run(
            [&](const Monitor& monitor) { return plan_stop_picks(problem, database, base, served, left, monitor); });
        return std::pair(found.outcome, std::move(found.picks));
      },
      py::arg("problem"), py::arg("database"), py::arg("base_pose"), py::arg("trays"), py::arg("remaining"),
      py::kw_only(), py::arg("progress") = py::none(),
      "Every pick of a stop from where the base really stands: the target parts of these trays among `remaining`, the\n"
      "(tray, part) still in place. Returns how it ended and the picks in order; without a solution those that "
      "failed.\n"
      "InvalidInput when the robot at home is not free there.");
  def_asked_of_grasps(
      m, "fingers_meet", &fingers_meet,
      "Tells of each grasp of a part whether finger links of both sides meet the part at once, closing from the\n"
      "grasp's opening by at most 10 mm or a quarter of it, whichever is more, wherever within 0.2 mm along the\n"
      "closing axis the hand stands: a plan's own check asks for that. Fingers that leave a gap when they are closed\n"
      "cannot hold what is thinner. `arm`, whose tip carries the hand, says how all other joints stand; its robot's\n"
      "meshes may stick out by `mesh_tolerance` [m] beyond those of the check. Cups have no\n"
      "fingers to close: all True. InvalidInput where its robot lacks a link or joint of the hand, or an opening is\n"
      "beyond the hand's.");
  def_asked_of_grasps(
      m, "fingers_fit", &fingers_fit,
      "Tells of each grasp of a part whether its finger links keep out of the part until they are as near as its\n"
      "opening says, or 1.5 mm or a twentieth of it on either side: where a part is wider beside the pads than "
      "between\n"
      "them, fingers would stand in it. Arguments and errors as fingers_meet.");
  m.def(
      "plan_object_pick",
      [](const JointGroup& arm, const Hand& gripper, const World& world, const std::string& object,
         std::vector<Grasp> grasps, const ReachDatabase& database, const ArrayLike& home, const ArrayLike& base_pose,
         const OptionalArray& places, double mass, const py::kwargs& options) {
        const Pose T_world_root = pose_from_planar(vector3_argument(base_pose, "base_pose"));
        PickProblem problem{arm.at(T_world_root),
                            gripper,
                            world,
                            object,
                            std::move(grasps),
                            vector_argument(home, "home", arm.size()),
                            {},
                            read_options(pick_fields(), options, "plan_object_pick"),
                            mass};
        if (!places.is_none()) problem.places = poses_argument(py::reinterpret_borrow<ArrayLike>(places), "places");
        problem.check();
        return LongCall(py::none()).run([&](const Monitor& monitor) {
          return plan_object_pick(problem, database, monitor);
        });
      },
      py::arg("arm"), py::arg("gripper"), py::arg("world"), py::arg("object"), py::arg("grasps"), py::kw_only(),
      py::arg("database"), py::arg("home"), py::arg("base_pose"), py::arg("places") = py::none(), py::arg("mass") = 0.0,
      ("Picks any object of a world: the first of the grasps with a collision-free configuration, straight approach "
       "and\n"
       "lift, and motions from `home` (m,) and to one of `places`, (k, 4, 4) world poses of the object; without "
       "places\n"
       "the object stays in the hand. The robot stands at `base_pose` (x, y, theta); hands of suction cups need the "
       "object's\n`mass` [kg].\n\n" +
       option_help(pick_fields()))
          .c_str());
}

/// Python counts the trays of a plan by the regions it lists, which are those of trays with targets.
class ListedRegions {
 public:
  explicit ListedRegions(const PartSupplyPlan& plan) : place_(plan.regions.size(), -1) {
    for (std::size_t tray = 0; tray < plan.regions.size(); ++tray) {
      if (!plan.regions[tray].has_targets) continue;
      place_[tray] = static_cast<int>(trays_.size());
      trays_.push_back(static_cast<int>(tray));
    }
  }
  const std::vector<int>& trays() const { return trays_; }
  /// A stop or an intersection with its trays counted so.
  template <class T>
  T counted(T served) const {
    for (TrayId& tray : served.trays) tray = TrayId(place_[tray]);
    return served;
  }
  template <class T>
  std::vector<T> counted(std::vector<T> all) const {
    for (T& one : all) one = counted(std::move(one));
    return all;
  }

 private:
  std::vector<int> place_, trays_;
};

void bind_plan_result(py::module_& m) {
  py::class_<Unloading>(m, "Unloading", "A drive to the goal with a full bin, which is emptied there.")
      .def_readonly("after_pick", &Unloading::after_pick, "Index of the plan's pick that filled the bin.")
      .def_readonly("to_goal", &Unloading::to_goal, "From the stop of that pick.")
      .def_property_readonly(
          "back",
          [](const Unloading& u) { return u.back.poses.empty() ? std::optional<BasePath>() : std::optional(u.back); },
          "To the same stop, where parts are left; None: the next leg of the route begins at the goal.")
      .def("__repr__", [](const Unloading& u) { return "Unloading(after pick " + std::to_string(u.after_pick) + ")"; });
  py::class_<Obstruction>(m, "Obstruction", "Why there is no plan, and what would help.")
      .def_readonly("tray", &Obstruction::tray, "Name of the tray.")
      .def_readonly("part", &Obstruction::part, "Name of the part that blocks; empty when the whole tray does.")
      .def_readonly("stage", &Obstruction::stage, "grasp, region, robustness, motion or route.")
      .def_readonly("message", &Obstruction::message, "One sentence that a person can act on.")
      .def_readonly("largest_uncertainty", &Obstruction::largest_uncertainty,
                    "Largest positioning uncertainty that still works [m]; < 0: none does.")
      .def_readonly("reach_deficit", &Obstruction::reach_deficit,
                    "How far the nearest base pose falls short of the part [m]; 0: reach is not it. `advised_move` is "
                    "what suffices.")
      .def_readonly("advised_move", &Obstruction::advised_move, "Translation of the tray in the world's x and y [m].")
      .def_readonly("move_trays", &Obstruction::move_trays, "Trays that move together by advised_move.")
      .def_readonly("move_objects", &Obstruction::move_objects, "Objects of the scene that move with them.")
      .def_readonly("needed_opening", &Obstruction::needed_opening, "Gripper opening that would do [m]; 0: not it.")
      .def(
          "to_dict",
          [](const Obstruction& o) {
            return py::dict("tray"_a = o.tray, "part"_a = o.part, "stage"_a = o.stage, "message"_a = o.message,
                            "largest_uncertainty"_a = o.largest_uncertainty, "reach_deficit"_a = o.reach_deficit,
                            "advised_move"_a = std::vector<double>{o.advised_move.x(), o.advised_move.y()},
                            "move_trays"_a = o.move_trays, "move_objects"_a = o.move_objects,
                            "needed_opening"_a = o.needed_opening);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const Obstruction& o) { return "Obstruction(" + o.stage + ": " + o.message + ")"; });
  py::class_<PartSupplyPlan>(m, "PartSupplyPlan", "The planner's answer; a ScenarioPlan joins it with its scenario.")
      .def_readonly("outcome", &PartSupplyPlan::outcome, "How it ended; `solved` alone comes with an answer.")
      .def_readonly("grid", &PartSupplyPlan::grid, "The grid that all regions share.")
      .def_property_readonly(
          "regions",
          [](const py::object& self) {
            const auto& plan = self.cast<const PartSupplyPlan&>();
            py::typing::List<BaseRegion> regions;
            const ListedRegions listed(plan);
            for (int tray : listed.trays())
              regions.append(py::cast(&plan.regions[tray], py::return_value_policy::reference_internal, self));
            return regions;
          },
          "One a tray that has target parts.")
      .def_property_readonly(
          "region_trays", [](const PartSupplyPlan& p) { return ListedRegions(p).trays(); },
          "Tray index of each region.")
      .def_property_readonly(
          "intersections",
          [](const PartSupplyPlan& p) {
            const ListedRegions listed(p);
            Intersections found = p.intersections;
            found.robust = listed.counted(std::move(found.robust));
            found.too_small = listed.counted(std::move(found.too_small));
            return found;
          },
          "What the stops were chosen from.")
      .def_property_readonly(
          "stops", [](const PartSupplyPlan& p) { return ListedRegions(p).counted(p.stops); },
          "The stops in the order in which they are visited.")
      .def_readonly("lower_bound", &PartSupplyPlan::lower_bound, "Proven least number of stops over the regions.")
      .def_readonly("proven_minimal", &PartSupplyPlan::proven_minimal, "No fewer stops can serve the regions.")
      .def_readonly("route", &PartSupplyPlan::route,
                    "Drives from start over the stops to the goal: one more than stops.")
      .def_readonly("unloadings", &PartSupplyPlan::unloadings, "Drives to the goal with a full bin, in order.")
      .def_readonly("picks", &PartSupplyPlan::picks, "The picks in the order in which they are done.")
      .def_readonly("robustness_rate", &PartSupplyPlan::robustness_rate,
                    "Least share over the stops of base poses drawn in the disc from which every part can be grasped.")
      .def_readonly("obstructions", &PartSupplyPlan::obstructions,
                    "Why there is no plan, and what would help; empty with a plan.")
      .def_property_readonly(
          "timings",
          [](const PartSupplyPlan& p) {
            std::vector<std::pair<std::string, double>> out;
            for (const StageTime& t : p.timings) out.emplace_back(t.stage, t.seconds);
            return out;
          },
          "Seconds of each stage, by name.")
      .def("__repr__", [](const PartSupplyPlan& p) {
        return std::string("PartSupplyPlan(") + to_string(p.outcome) + ", " + std::to_string(p.stops.size()) +
               " stops, " + std::to_string(p.picks.size()) + " picks)";
      });
  m.def(
      "plan_part_supply",
      [](const PartSupplyProblem& problem, const ReachDatabase& database, const Progress& progress) {
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return plan_part_supply(problem, database, monitor); });
      },
      py::arg("problem"), py::arg("database"), py::kw_only(), py::arg("progress") = py::none(),
      "The whole of P1's Algorithm 1 and the motions around it, for a problem given as objects.");
  m.def(
      "write_plan",
      [](const PartSupplyProblem& problem, const ReachDatabase& database, const PartSupplyPlan& plan,
         const PathLike& path, const std::string& name, const std::string& source, double closing_speed) {
        const std::string file = path_argument(path, "path");
        interruptible([&] { write_plan(problem, database, plan, file, {name, source, closing_speed}); });
      },
      py::arg("problem"), py::arg("database"), py::arg("plan"), py::arg("path"), py::kw_only(),
      py::arg("name") = PlanFileOptions().name, py::arg("source") = PlanFileOptions().source,
      py::arg("closing_speed") = PlanFileOptions().closing_speed,
      "Writes plan.json for a problem given as objects and the plan made with this database, so that `mmgrasp verify` "
      "and\n"
      "`mmgrasp view` take it; `closing_speed` of the gripper [m/s]. InvalidInput for shapes that a plan cannot hold\n"
      "(planes but for the floor, voxels, meshes without a file) and a plan of another problem.");
}

}  // namespace

void bind_task(py::module_& m) {
  bind_problem(m);
  bind_base_regions(m);
  bind_base_sequence(m);
  bind_picks(m);
  bind_plan_result(m);
}

}  // namespace mmgrasp::python
