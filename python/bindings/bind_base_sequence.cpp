#include "bindings.hpp"
#include "ids.hpp"
#include "mmgrasp/task/base_route.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "mmgrasp/task/part_supply.hpp"
#include "mmgrasp/task/policies.hpp"

namespace mmgrasp::python {
namespace {

constexpr char kOneRegionATray[] = "collections.abc.Sequence[mmgrasp._core.BaseRegion | numpy.typing.ArrayLike]";
using OneRegionATray = ShownSequence<kOneRegionATray>;
constexpr char kPlacesOfTrays[] = "collections.abc.Sequence[numpy.typing.ArrayLike]";
using PlacesOfTrays = ShownSequence<kPlacesOfTrays>;
constexpr char kPartMasks[] = "collections.abc.Sequence[collections.abc.Sequence[numpy.typing.ArrayLike]]";
using PartMasks = ShownSequence<kPartMasks>;
constexpr char kRegionsOfRound[] =
    "collections.abc.Callable[[int], collections.abc.Sequence[mmgrasp._core.BaseRegion | numpy.typing.ArrayLike]] | "
    "None";
using RegionsOfRound = Shown<kRegionsOfRound>;

using namespace py::literals;

CellMask mask_of(const BaseGrid& grid, const py::handle& cells) {
  const auto flags = flags_argument(
      cells, "cells", {static_cast<py::ssize_t>(grid.headings.size()), py::ssize_t{grid.ny}, py::ssize_t{grid.nx}});
  return CellMask(flags.begin(), flags.end());
}

/// Regions, or bitmaps (headings, ny, nx) of such.
std::vector<BaseRegion> regions_argument(const BaseGrid& grid, const py::sequence& given) {
  std::vector<BaseRegion> regions;
  for (const py::handle& item : given) {
    if (py::isinstance<BaseRegion>(item)) {
      regions.push_back(item.cast<BaseRegion>());
      regions.back().has_targets = true;  // what is given is to be served
      continue;
    }
    regions.emplace_back();
    regions.back().tray = std::to_string(regions.size() - 1);
    regions.back().cells = mask_of(grid, item);
  }
  return regions;
}

PartRegions part_regions_argument(const BaseGrid& grid, const py::sequence& cells) {
  PartRegions parts;
  parts.grid = grid;
  for (const py::handle& tray : cells) {
    parts.cells.emplace_back();
    for (const py::handle& mask : tray) parts.cells.back().push_back(mask_of(grid, mask));
  }
  return parts;
}

py::dict intersection_dict(const Intersection& i) {
  return py::dict("trays"_a = i.trays, "heading"_a = i.heading, "centre"_a = py::make_tuple(i.centre.x(), i.centre.y()),
                  "radius"_a = i.radius, "cells"_a = i.cells);
}

void bind_stops(py::module_& m) {
  py::class_<Intersection>(m, "Intersection", "Cells that several regions share, with their largest disc.")
      .def_readonly("trays", &Intersection::trays, "Indices of the regions that share them, ascending.")
      .def_readonly("heading", &Intersection::heading, "Index of the heading's layer.")
      .def_readonly("centre", &Intersection::centre, "Centre of the largest disc (2,) [m].")
      .def_readonly("radius", &Intersection::radius, "Radius of the largest disc of shared cells [m].")
      .def_readonly("cells", &Intersection::cells, "How many cells are shared.")
      .def("to_dict", &intersection_dict, "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const Intersection& i) {
        return "Intersection(trays " + std::string(py::repr(py::cast(i.trays))) + ", radius " +
               std::string(py::repr(py::float_(i.radius))) + ")";
      });
  py::class_<Intersections>(m, "Intersections",
                            "Sets of regions whose shared cells hold a disc that is large enough (P1 3.4.2).")
      .def_readonly("robust", &Intersections::robust, "The sets whose disc is large enough.")
      .def_readonly("too_small", &Intersections::too_small, "Shared cells whose disc is too small, largest first.")
      .def_readonly("sets_tried", &Intersections::sets_tried, "Sets checked.")
      .def_readonly("complete", &Intersections::complete, "False when the search ended early.")
      .def_readonly("sets_too_small", &Intersections::sets_too_small,
                    "Sets that share cells, but with too small a disc.")
      .def("__repr__", [](const Intersections& i) {
        return "Intersections(" + std::to_string(i.robust.size()) + " robust, " + std::to_string(i.sets_too_small) +
               " too small, " + std::to_string(i.sets_tried) + " tried)";
      });
  m.def(
      "robust_intersections",
      [](const BaseGrid& grid, const OneRegionATray& regions, double min_radius, std::size_t max_sets) {
        const std::vector<BaseRegion> given = regions_argument(grid, regions);
        return interruptible([&] { return robust_intersections(grid, given, min_radius, max_sets); });
      },
      py::arg("grid"), py::arg("regions"), py::arg("min_radius"), py::arg("max_sets") = std::size_t{200000},
      "Every set of trays whose shared cells hold a disc of at least `min_radius` [m] (P1 3.4.2).");
  m.def(
      "maximal_intersections",
      [](const BaseGrid& grid, const OneRegionATray& given, double min_radius, std::size_t max_boxes,
         const Progress& progress) {
        const std::vector<BaseRegion> regions = regions_argument(grid, given);
        return LongCall(progress).run([&](const Monitor& monitor) {
          return maximal_intersections(grid, regions, min_radius, max_boxes, monitor);
        });
      },
      py::arg("grid"), py::arg("regions"), py::arg("min_radius"), py::kw_only(),
      py::arg("max_boxes") = std::size_t{50'000'000}, py::arg("progress") = py::none(),
      "Those of the robust sets that are part of no other one: enough to prove a least number of stops.");
  py::class_<Stop>(m, "Stop", "Where the base stops and which trays it serves there.")
      .def_readonly("pose", &Stop::pose, "x, y, theta.")
      .def_readonly("radius", &Stop::radius, "Radius of the disc in which every target part stays graspable [m].")
      .def_readonly("trays", &Stop::trays, "Indices of the trays picked here; each tray has one stop.")
      .def_readonly("intersection", &Stop::intersection, "Index into the robust intersections.")
      .def_readonly("arrivals", &Stop::arrivals, "Arrivals drawn by the problem's arrival_covariance; 0: none.")
      .def_readonly("arrivals_served", &Stop::arrivals_served,
                    "Those of them from which all parts of its trays can be grasped.")
      .def("__repr__", [](const Stop& s) {
        return "Stop(" + text(s.pose) + ", trays " + std::string(py::repr(py::cast(s.trays))) + ")";
      });
  py::class_<StopSet>(m, "StopSet", "Stops that serve all trays.")
      .def_readonly("outcome", &StopSet::outcome,
                    "`solved`: proven least; `approximate`: a cover that may have too many stops.")
      .def_readonly("stops", &StopSet::stops, "The stops, in no order yet.")
      .def_readonly("lower_bound", &StopSet::lower_bound, "Proven least number of stops.")
      .def_readonly("unreachable_trays", &StopSet::unreachable_trays,
                    "Indices of trays that no disc of the asked radius serves.")
      .def_readonly("candidates", &StopSet::candidates, "What plan_stops_exact chose from.")
      .def("__repr__", [](const StopSet& s) {
        return std::string("StopSet(") + to_string(s.outcome) + ", " + std::to_string(s.stops.size()) + " stops)";
      });
  m.def(
      "cover_from_intersections",
      [](const BaseGrid& grid, const std::vector<Intersection>& intersections, int trays) {
        return interruptible([&] { return cover_from_intersections(grid, intersections, trays); });
      },
      py::arg("grid"), py::arg("intersections"), py::arg("trays"),
      "The least number of intersections that cover all trays (P1 equation 3.1), with proof. Raises InvalidInput where "
      "one\nnames a tray twice, out of order or not there, or a heading that the grid lacks.");
  m.def(
      "plan_stops_exact",
      [](const BaseGrid& grid, const OneRegionATray& given, double min_radius, double time_limit, double tie_time_limit,
         const OptionalArray& start, const OptionalArray& goal, const Progress& progress) {
        const std::vector<BaseRegion> regions = regions_argument(grid, given);
        StopOptions options;
        options.min_radius = min_radius;
        options.time_limit = time_limit;
        options.tie_time_limit = tie_time_limit;
        if (start.is_none() != goal.is_none()) throw InvalidInput("start and goal: give both or neither");
        if (!start.is_none()) {
          options.route_length = [from = Eigen::Vector2d(vector2_argument(start, "start")),
                                  to = Eigen::Vector2d(vector2_argument(goal, "goal"))](
                                     const std::vector<Stop>& stops) { return straight_route_length(stops, from, to); };
        }
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return plan_stops_exact(grid, regions, options, monitor); });
      },
      py::arg("grid"), py::arg("regions"), py::arg("min_radius") = StopOptions{}.min_radius, py::kw_only(),
      py::arg("time_limit") = StopOptions{}.time_limit, py::arg("tie_time_limit") = StopOptions{}.tie_time_limit,
      py::arg("start") = py::none(), py::arg("goal") = py::none(), py::arg("progress") = py::none(),
      "The least number of stops over regions (or masks), with proof; among equally few the widest discs, then, with "
      "`start` and `goal` (x, y), the shortest route as the crow flies.");
}

void bind_routes(py::module_& m) {
  py::class_<BasePath>(m, "BasePath", "A drive of the base.")
      .def_readonly("outcome", &BasePath::outcome, "How it ended; `solved` alone comes with an answer.")
      .def_property_readonly(
          "poses", [](const BasePath& p) { return rows_to_array(p.poses); }, "(k, 3): x, y, theta.")
      .def_readonly("length", &BasePath::length, "Driven distance [m].")
      .def_readonly("turning", &BasePath::turning, "Sum of absolute heading changes [rad].")
      .def(
          "duration",
          [](const BasePath& p, const Robot& robot) {
            return base_path_duration(p, robot.base(), robot.base_limits());
          },
          py::arg("robot"), "Time the robot's base takes for it within its speed and acceleration limits [s].")
      .def("__repr__", [](const BasePath& p) {
        return std::string("BasePath(") + to_string(p.outcome) + ", " + std::string(py::repr(py::float_(p.length))) +
               " m)";
      });
  m.def(
      "plan_base_route",
      [](const JointGroup& arm, const World& world, const ArrayLike& home, const ArrayLike& from, const ArrayLike& to,
         double resolution, double clearance) {
        BaseRouteOptions options;
        options.base = arm.robot().base();
        options.resolution = resolution;
        options.clearance = clearance;
        CollisionChecker checker(with_sampled_pairs(arm), world);
        const Eigen::VectorXd q = vector_argument(home, "home", arm.size());
        const Eigen::Vector3d a = vector3_argument(from, "start"), b = vector3_argument(to, "goal");
        return LongCall(py::none()).run([&](const Monitor& monitor) {
          return plan_base_route(checker, q, a, b, options, monitor);
        });
      },
      py::arg("arm"), py::arg("world"), py::kw_only(), py::arg("home"), py::arg("start"), py::arg("goal"),
      py::arg("resolution") = BaseRouteOptions{}.resolution, py::arg("clearance") = BaseRouteOptions{}.clearance,
      "A driveable, collision-free way of the whole robot with its arm at `home`; poses are x, y, theta. `clearance` "
      "[m]\nis kept to all but horizontal planes wherever the base is farther than 1 m from both ends.");
  m.def(
      "route_lengths",
      [](const JointGroup& arm, const World& world, const ArrayLike& home, const ArrayLike& positions,
         double resolution, int threads, const Progress& progress) {
        BaseRouteOptions options;
        options.base = arm.robot().base();
        options.resolution = resolution;
        const CollisionChecker checker(with_sampled_pairs(arm), world);
        const Eigen::VectorXd q = vector_argument(home, "home", arm.size());
        const Eigen::MatrixXd rows = matrix_argument(positions, "positions", 3);
        std::vector<Eigen::Vector3d> poses;
        for (Eigen::Index i = 0; i < rows.rows(); ++i) poses.emplace_back(rows.row(i));
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return route_lengths(checker, q, poses, options, threads, monitor); });
      },
      py::arg("arm"), py::arg("world"), py::kw_only(), py::arg("home"), py::arg("positions"),
      py::arg("resolution") = BaseRouteOptions{}.resolution, py::arg("threads") = 0, py::arg("progress") = py::none(),
      "(m, m): how far it is to drive between base poses (m, 3), around what stands in the way; infinite: no way "
      "found.");
}

void bind_policies(py::module_& m) {
  py::class_<OptimisedOrder>(m, "OptimisedOrder",
                             "A picking order, and how large the discs are in which the base may stop for its rounds.")
      .def_readonly("order", &OptimisedOrder::order, "[tray][round]: index of the part.")
      .def_readonly("mean_radius", &OptimisedOrder::mean_radius, "Over rounds and groups [m].")
      .def_readonly("smallest_radius", &OptimisedOrder::smallest_radius, "Least radius over rounds and groups [m].")
      .def_readonly("proven", &OptimisedOrder::proven, "No other order is better for these groups.")
      .def("__repr__", [](const OptimisedOrder& o) {
        return "OptimisedOrder(mean radius " + std::string(py::repr(py::float_(o.mean_radius))) +
               (o.proven ? ", proven)" : ")");
      });
  py::class_<PolicyRound>(m, "PolicyRound", "One round of pick and place.")
      .def_readonly("outcome", &PolicyRound::outcome, "Outcome of the choice of stops.")
      .def_readonly("stops", &PolicyRound::stops,
                    "The stops of the round; their trays are indices into the picking order.")
      .def_readonly("mean_radius", &PolicyRound::mean_radius, "Over the stops [m].")
      .def_readonly("seconds", &PolicyRound::seconds, "Spent on regions and stops between the rounds.")
      .def_readonly("reliable", &PolicyRound::reliable,
                    "The parts picked can be grasped from everywhere in the discs of their stops.")
      .def("__repr__", [](const PolicyRound& r) {
        return std::string("PolicyRound(") + to_string(r.outcome) + ", " + std::to_string(r.stops.size()) +
               " stops, mean radius " + std::string(py::repr(py::float_(r.mean_radius))) + ")";
      });
  py::class_<PolicyResult>(m, "PolicyResult", "A row of P1 table 3.4.")
      .def_readonly("rounds", &PolicyResult::rounds, "The rounds in order.")
      .def_readonly("mean_radius", &PolicyResult::mean_radius, "P1 equation 3.2 [m].")
      .def_readonly("smallest_radius", &PolicyResult::smallest_radius, "Over all stops of all rounds [m].")
      .def_readonly("mean_stops", &PolicyResult::mean_stops, "Stops a round.")
      .def_readonly("solved", &PolicyResult::solved, "Every round has stops.")
      .def_readonly("reliable", &PolicyResult::reliable, "Every round is.")
      .def_readonly("online", &PolicyResult::online, "Every round's seconds are within the limit.")
      .def_readonly("feasible", &PolicyResult::feasible, "Solved, reliable and online.")
      .def(
          "to_dict",
          [](const PolicyResult& r) {
            py::list rounds;
            for (const PolicyRound& round : r.rounds) {
              rounds.append(py::dict("outcome"_a = to_string(round.outcome), "stops"_a = round.stops.size(),
                                     "mean_radius"_a = round.mean_radius, "seconds"_a = round.seconds,
                                     "reliable"_a = round.reliable));
            }
            return py::dict("mean_radius"_a = r.mean_radius, "smallest_radius"_a = r.smallest_radius,
                            "mean_stops"_a = r.mean_stops, "solved"_a = r.solved, "reliable"_a = r.reliable,
                            "online"_a = r.online, "feasible"_a = r.feasible, "rounds"_a = rounds);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const PolicyResult& r) {
        return "PolicyResult(" + std::to_string(r.rounds.size()) + " rounds, mean radius " +
               std::string(py::repr(py::float_(r.mean_radius))) + (r.feasible ? ", feasible)" : ", not feasible)");
      });
  m.def(
      "paired_order",
      [](const PlacesOfTrays& places) {
        std::vector<std::vector<Eigen::Vector2d>> points;
        for (const py::handle& tray : places) {
          const Eigen::MatrixXd rows = matrix_argument(tray, "places", 2);
          points.emplace_back();
          for (Eigen::Index i = 0; i < rows.rows(); ++i) points.back().emplace_back(rows.row(i));
        }
        return interruptible([&] { return paired_order(points); });
      },
      py::arg("places"),
      "P1's heuristic (figure 3.11): parts of neighbouring trays at nearly constant distances go together. `places` is "
      "one (m, 2) array of positions a tray; the answer is [tray][round].");
  m.def(
      "optimised_order",
      [](const BaseGrid& grid, const PartMasks& cells, const std::vector<std::vector<int>>& groups,
         const PickingOrder& order, bool smallest_first, int restarts, unsigned rng_seed) {
        const PartRegions parts = part_regions_argument(grid, cells);
        OrderOptions options;
        options.smallest_first = smallest_first;
        options.restarts = restarts;
        options.seed = rng_seed;
        return interruptible([&] { return optimised_order(parts, groups, order, options); });
      },
      py::arg("grid"), py::arg("cells"), py::arg("groups"), py::arg("order"), py::kw_only(),
      py::arg("smallest_first") = false, py::arg("restarts") = OrderOptions{}.restarts, py::arg("rng_seed") = 1,
      "The order in which parts are best picked when the trays of each group share a stop, never worse than `order`. "
      "`cells` is [tray][part], bitmaps (headings, ny, nx).");
  m.def(
      "run_policy",
      [](const BaseGrid& grid, const PartMasks& cells, const PickingOrder& order, const std::string& policy,
         double min_radius, double online_limit, double time_limit, double tie_time_limit,
         const RegionsOfRound& planned, const Progress& progress) {
        const PartRegions parts = part_regions_argument(grid, cells);
        PolicyOptions options;
        options.stops.min_radius = min_radius;
        options.stops.time_limit = time_limit;
        options.stops.tie_time_limit = tie_time_limit;
        options.online_limit = online_limit;
        RoundRegions regions = regions_for(make_update_policy(policy), parts, order);
        if (!planned.is_none()) {
          regions = [&](int round) {
            const py::gil_scoped_acquire acquire;
            return regions_argument(grid, py::sequence(planned(round)));
          };
        }
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return run_policy(regions, parts, order, options, monitor); });
      },
      py::arg("grid"), py::arg("cells"), py::arg("order"), py::arg("policy") = "all", py::kw_only(),
      py::arg("min_radius") = StopOptions{}.min_radius, py::arg("online_limit") = PolicyOptions{}.online_limit,
      py::arg("time_limit") = StopOptions{}.time_limit, py::arg("tie_time_limit") = StopOptions{}.tie_time_limit,
      py::arg("planned") = py::none(), py::arg("progress") = py::none(),
      "Plans the stops of every round for all parts, the `remaining` or the `targets` and holds them against the "
      "parts' "
      "bitmaps `cells` [tray][part]. `planned(round)` gives other regions to plan with, one a tray: what they cost "
      "counts as time between the rounds.");
}

}  // namespace

void bind_base_sequence(py::module_& m) {
  bind_stops(m);
  bind_routes(m);
  bind_policies(m);
}

}  // namespace mmgrasp::python
