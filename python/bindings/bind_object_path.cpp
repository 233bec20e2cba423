// Carrying an object along given poses with one grasp: what it costs and how the arm moves.
#include <optional>

#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/structure/object_path.hpp"
#include "mmgrasp/structure/optimize_grasp.hpp"
#include "option_bounds.hpp"
#include "plan_arguments.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;
using LinkNames = std::vector<std::string>;

const std::vector<OptionField<ObjectPathOptions>>& object_path_fields() {
  using O = ObjectPathOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("motion_weight", &O::motion_weight, "weight of O1, the joints' motion"),
      option<O>("deflection_weight", &O::deflection_weight, "weight of O2, the largest displacements"),
      option<O>("manipulability_weight", &O::manipulability_weight, "weight of O3, the force manipulability"),
      option<O>("motion_scale", &O::motion_scale, "O1 is divided by it [rad or m]"),
      option<O>("deflection_scale", &O::deflection_scale, "O2 is divided by it [m]"),
      option<O>("manipulability_scale", &O::manipulability_scale, "O3 is divided by it"),
      option<O>("max_joint_step", &O::max_joint_step, "more from pose to pose is a jump, refused [rad or m]"),
      option<O>("position_tolerance", &O::position_tolerance, "of the object half way between poses [m]"),
      option<O>("rotation_tolerance", &O::rotation_tolerance, "of the object half way between poses [rad]"),
      option<O>("edge_step", &O::edge_step, "largest joint step between collision checks [rad or m]"),
      option<O>("check_edges", &O::check_edges, "check motions between poses for collisions"),
      option<O>("single_configuration", &O::single_configuration, "one arm configuration a pose (P2's single IK)"),
      option<O>("all_turns", &O::all_turns, "joints that may turn more than once come in every turn"),
      option<O>("redundant_values", &O::redundant_values, "samples of a seventh joint, evenly over its range; 0: 24"),
      option<O>("base_spacing", &O::base_spacing, "grid of the places where a moving base may stand [m]"),
      option<O>("base_headings", &O::base_headings, "headings of the base at each place, evenly over a turn"),
      option<O>("gravity", &O::gravity, "along the world's -z [m/s2]"),
      option<O>("max_sag", &O::max_sag, "largest displacement allowed at any pose [m]; 0: any")};
  return fields;
}

const BoundedOptions<ObjectPathOptions>& object_path_options() {
  const Bounds weight{0, 1e6, ""}, scale{1e-9, 1e9, ""}, tolerance{1e-9, 1000, "rad or m"};
  static const BoundedOptions<ObjectPathOptions> options(object_path_fields(),
                                                         {{"motion_weight", weight},
                                                          {"deflection_weight", weight},
                                                          {"manipulability_weight", weight},
                                                          {"motion_scale", scale},
                                                          {"deflection_scale", scale},
                                                          {"manipulability_scale", scale},
                                                          {"max_joint_step", {1e-6, 1e6, "rad or m"}},
                                                          {"position_tolerance", tolerance},
                                                          {"rotation_tolerance", tolerance},
                                                          {"edge_step", {1e-6, 1000, "rad or m"}},
                                                          {"redundant_values", {0, 100000, "samples"}},
                                                          {"base_spacing", {0.001, 1000, "m"}},
                                                          {"base_headings", {1, 3600, "headings"}},
                                                          {"gravity", {0, 1000, "m/s2"}},
                                                          {"max_sag", {0, 1000, "m"}}});
  return options;
}

const std::vector<OptionField<PopulationOptions>>& population_fields() {
  using O = PopulationOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("population", &O::population, "points a round"),
      option<O>("max_evaluations", &O::max_evaluations, "budget in grasps"),
      option<O>("target", &O::target, "ends as solved once a grasp costs no more"),
      option<O>("seed", &O::seed, "same seed, same answer"),
      option<O>("elite_sites", &O::elite_sites, "bees: P2's ne"),
      option<O>("best_sites", &O::best_sites, "bees: P2's nb"),
      option<O>("elite_recruits", &O::elite_recruits, "bees: P2's nre"),
      option<O>("recruits", &O::recruits, "bees: P2's nrb"),
      option<O>("stagnation_limit", &O::stagnation_limit, "bees: rounds without progress until a site is abandoned"),
      option<O>("neighbourhood", &O::neighbourhood, "bees: its width as a share of each range at first"),
      option<O>("shrinking", &O::shrinking, "bees: its factor after a round without progress"),
      option<O>("mutation_rate", &O::mutation_rate, "ga: chance of each variable"),
      option<O>("mutation_size", &O::mutation_size, "ga: half width as a share of the range"),
      option<O>("connectivity", &O::connectivity, "pso: share of the others each particle hears of"),
      option<O>("inertia", &O::inertia, "pso: of velocity"),
      option<O>("acceleration", &O::acceleration, "pso: P2's c1 and c2")};
  return fields;
}

/// Keywords of optimize_grasp: those of the path, and those of the search.
struct OptimizeGraspOptions {
  ObjectPathOptions path;
  PopulationOptions population;
  GraspSearchOptions search;
  void check() const {
    path.check();
    population.check();
    search.check();
  }
};

const std::vector<OptionField<GraspSearchOptions>>& grasp_search_fields() {
  using O = GraspSearchOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("front_searches", &O::front_searches,
                "further searches, each for another mix of the objectives: the Pareto front is searched"),
      option<O>("max_gap", &O::max_gap, "branch_and_bound: ends once no grasp can be cheaper by this share"),
      option<O>("max_boxes", &O::max_boxes, "branch_and_bound: budget in boxes of grasps"),
      option<O>("time_limit", &O::time_limit, "Wall-clock cap of all searches together [s]"),
      option<O>("threads", &O::threads, "branch_and_bound: 0: all; the answer does not depend on it")};
  return fields;
}

const std::vector<OptionField<OptimizeGraspOptions>>& optimize_grasp_fields() {
  using O = OptimizeGraspOptions;
  static const std::vector<OptionField<O>> fields = [] {
    std::vector<OptionField<O>> out;
    const auto add = [&](const auto& inner, auto member) {
      for (const auto& f : inner) {
        out.push_back({f.name, f.type, [f, member](O& o, const py::handle& v) { f.set(o.*member, v); },
                       [f, member](const O& o) { return f.get(o.*member); }, f.help});
      }
    };
    add(object_path_fields(), &O::path);
    add(population_fields(), &O::population);
    add(grasp_search_fields(), &O::search);
    return out;
  }();
  return fields;
}

const BoundedOptions<OptimizeGraspOptions>& optimize_grasp_options() {
  static const BoundedOptions<OptimizeGraspOptions> options = [] {
    const Bounds count{1, 10000, ""}, share{1e-9, 1, ""};
    std::map<std::string, Bounds> bounds = object_path_options().all();
    bounds.insert({{"population", {4, 1e6, "points"}},
                   {"max_evaluations", {1, 1e9, "grasps"}},
                   {"target", {-detail::kInfinity, 1e300, ""}},
                   {"seed", {0, kMostSeed, ""}},
                   {"elite_sites", {0, 10000, "sites"}},
                   {"best_sites", count},
                   {"elite_recruits", count},
                   {"recruits", count},
                   {"stagnation_limit", {1, 1e9, "rounds"}},
                   {"neighbourhood", share},
                   {"shrinking", share},
                   {"mutation_rate", {0, 1, ""}},
                   {"mutation_size", share},
                   {"connectivity", share},
                   {"inertia", {0, 100, ""}},
                   {"acceleration", {1e-9, 100, ""}},
                   {"front_searches", {0, 10000, "searches"}},
                   {"max_gap", {1e-12, 0.999, ""}},
                   {"max_boxes", {1, 1e9, "boxes"}},
                   {"time_limit", {1e-9, 1e6, "s"}},
                   {"threads", {0, 1024, "(0: all)"}}});
    return BoundedOptions<OptimizeGraspOptions>(optimize_grasp_fields(), std::move(bounds));
  }();
  return options;
}

GraspNeighbourhood neighbourhood_argument(const std::string& name) {
  std::string known;
  for (const auto kind :
       {GraspNeighbourhood::independent, GraspNeighbourhood::same_section, GraspNeighbourhood::connected_sections}) {
    if (name == to_string(kind)) return kind;
    known += std::string(known.empty() ? "" : ", ") + to_string(kind);
  }
  throw InvalidInput("neighbourhood_kind = " + name + ": must be one of " + known);
}

ObjectPathProblem object_path_problem(const Given<JointGroup>& group, const Given<World>& world,
                                      const Given<std::vector<LinkShape>>& object, const ArrayLike& T_world_object,
                                      const std::optional<Given<Hand>>& gripper, const Given<LinkNames>& touch_links,
                                      const std::optional<Given<BeamFrame>>& frame,
                                      const Given<std::string>& object_name) {
  ObjectPathProblem problem{with_sampled_pairs(taken(group, "group")),
                            taken(world, "world"),
                            taken(object, "object", "LinkShape"),
                            poses_argument(T_world_object, "T_world_object"),
                            {},
                            {},
                            {},
                            taken(object_name, "object_name")};
  if (gripper) problem.gripper = taken(*gripper, "gripper");
  if (frame) problem.frame = taken(*frame, "frame");
  const LinkNames links = taken(touch_links, "touch_links", "names of links");
  problem.touch_links = {links.begin(), links.end()};
  problem.check();
  return problem;
}

py::dict object_path_dict(const ObjectPathResult& r) {
  return py::dict("outcome"_a = to_string(r.outcome), "cost"_a = r.cost, "joint_motion"_a = r.joint_motion,
                  "deflection"_a = r.deflection, "force_manipulability"_a = r.force_manipulability,
                  "path"_a = path_list(r.outcome == Outcome::solved ? std::optional(r.path) : std::nullopt),
                  "sag"_a = r.sag, "overloaded"_a = r.overloaded, "violation"_a = r.violation,
                  "violations"_a = r.violations, "rejections"_a = to_dict(r.rejections), "gaps"_a = r.gaps,
                  "refused_edges"_a = r.refused_edges, "configurations"_a = r.configurations);
}

std::string object_path_text(const ObjectPathResult& r) {
  if (r.outcome == Outcome::solved) {
    return "ObjectPathResult(solved, cost " + std::string(py::repr(py::float_(r.cost))) + ", " +
           std::to_string(r.path.waypoints.size()) + " waypoints)";
  }
  int unreachable = 0, collide = 0, first = -1;
  for (std::size_t i = 0; i < r.violations.size(); ++i) {
    unreachable += r.violations[i] == 2;
    collide += r.violations[i] == 1;
    if (r.violations[i] && first < 0) first = static_cast<int>(i);
  }
  std::string out = "ObjectPathResult(not_found, violation " + std::to_string(r.violation);
  const std::string bent =
      r.overloaded.empty() ? "" : ", the object is overloaded at " + std::to_string(r.overloaded.size());
  if (first < 0) return out + ": every pose is reached" + (bent.empty() ? ", but no motion joins them)" : bent + ")");
  return out + ": " + std::to_string(unreachable) + " poses out of reach, " + std::to_string(collide) +
         " in collision, the first is " + std::to_string(first) + bent + ")";
}

void bind_object_path_result(py::module_& m) {
  using R = ObjectPathResult;
  py::class_<R>(m, "ObjectPathResult", "What one grasp costs along a path of the object, and the arm's motion.")
      .def_readonly("outcome", &R::outcome, "solved or not_found.")
      .def_readonly("cost", &R::cost, "Weighted sum of the objectives over their scales; 0 unless solved.")
      .def_readonly("joint_motion", &R::joint_motion, "O1: sum of joint-space distances [rad or m].")
      .def_readonly("deflection", &R::deflection, "O2: sum of the largest displacements after the first pose [m].")
      .def_readonly("force_manipulability", &R::force_manipulability, "O3: its sum along the tool's motion.")
      .def_property_readonly(
          "path",
          [](const R& r) { return path_array(r.outcome == Outcome::solved ? std::optional(r.path) : std::nullopt); },
          "(poses, n) configurations, or None.")
      .def_readonly("sag", &R::sag, "Largest displacement at each pose [m].")
      .def_readonly("overloaded", &R::overloaded, "Poses at which it bends or bears more than it may.")
      .def_readonly("violation", &R::violation, "P2's Cost(C); 0 if and only if solved.")
      .def_readonly("violations", &R::violations, "For each pose: 2 out of reach, 1 in collision, 0 neither.")
      .def_readonly(
          "gaps", &R::gaps,
          "When every pose is reached but there is no path: for each pose but the last how the next is missed.\n"
          "0 it is not, 1 every motion jumps to another posture, 2 those that do not collide or leave the path.")
      .def_readonly("rejections", &R::rejections, "Configurations rejected, by cause.")
      .def_readonly("refused_edges", &R::refused_edges, "Motions between poses that collide or leave the path.")
      .def_readonly("configurations", &R::configurations, "Arm configurations found over all poses.")
      .def("to_dict", &object_path_dict, "Everything as plain values.")
      .def("__repr__", &object_path_text);
}

void bind_optimum(py::module_& m) {
  using F = FeasibleGrasp;
  py::class_<F>(m, "FeasibleGrasp", "A grasp with which the whole path can be followed.")
      .def_readonly("grasp", &F::grasp, "Its cost is that of the path.")
      .def_readonly("joint_motion", &F::joint_motion, "O1 [rad or m]")
      .def_readonly("deflection", &F::deflection, "O2 [m]")
      .def_readonly("force_manipulability", &F::force_manipulability, "O3");
  using R = GraspOptimum;
  py::class_<R>(m, "GraspOptimum", "The best grasp that a search found, and all others that will do.")
      .def_readonly("outcome", &R::outcome,
                    "solved: proven to the gap asked for, or it meets the target; approximate: the best seen;\n"
                    "infeasible: proven that no grasp can follow the path.")
      .def_readonly("lower_bound", &R::lower_bound, "No grasp costs less; 0 where nothing was proven.")
      .def_readonly("gap", &R::gap, "How much cheaper another could be at most, as a share of the cost; 1: unknown.")
      .def_property_readonly(
          "grasp",
          [](const R& r) { return r.feasible.empty() ? std::optional<Grasp>() : std::optional<Grasp>(r.grasp); },
          "The best grasp, or None.")
      .def_readonly("path", &R::path, "As follow_object_path gives it.")
      .def_readonly("feasible", &R::feasible, "Every feasible grasp seen, the cheapest first.")
      .def_readonly("front", &R::front, "The Pareto front among them, ascending in O1.")
      .def_readonly("evaluations", &R::evaluations, "Grasps tried.")
      .def_readonly("boxes", &R::boxes, "Boxes of grasps that branch_and_bound bounded.")
      .def_readonly("history", &R::history, "Best cost after each of them; infinite while none was feasible.")
      .def_readonly("unreachable", &R::unreachable, "For each pose how many of the grasps tried do not reach it.")
      .def_readonly("colliding", &R::colliding, "For each pose at how many all arm configurations collide.")
      .def("sag_candidates", &sag_candidates,
           "Every feasible grasp with its mean sag [m] as its cost: candidates for plan_manipulation, whose "
           "`max_length`\n"
           "then takes the one that sags least among those whose motion is short enough.")
      .def_readonly("overloaded", &R::overloaded,
                    "For each pose with how many the pipe bends or bears more than it may.")
      .def_readonly(
          "jumping_after", &R::jumping_after,
          "For each pose but the last: with how many grasps that reach every pose all motions to the next one\n"
          "jump to another posture of the arm.")
      .def_readonly("colliding_after", &R::colliding_after,
                    "The same where each motion that does not jump collides or leaves the path.")
      .def("__repr__", [](const R& r) {
        return std::string("GraspOptimum(") + to_string(r.outcome) + ", " + std::to_string(r.evaluations) +
               " grasps tried, " + std::to_string(r.feasible.size()) + " feasible" +
               (r.feasible.empty() ? "" : ", cost " + std::string(py::repr(py::float_(r.path.cost)))) +
               (r.lower_bound > 0 ? ", none below " + std::string(py::repr(py::float_(r.lower_bound))) : "") + ")";
      });
  m.def(
      "optimize_grasp",
      [](const Given<ObjectPathProblem>& given_problem, const Given<Pipe>& given_pipe,
         const std::optional<Given<Hand>>& gripper, const Given<std::string>& algorithm,
         const Given<std::string>& neighbourhood, const Progress& progress, const py::kwargs& keywords) {
        const ObjectPathProblem problem = taken(given_problem, "problem");
        const Pipe pipe = taken(given_pipe, "pipe");
        const OptimizeGraspOptions read = optimize_grasp_options().read(keywords, "optimize_grasp");
        GraspSearchOptions options = read.search;
        options.algorithm = taken(algorithm, "algorithm");
        options.neighbourhood = neighbourhood_argument(taken(neighbourhood, "neighbourhood_kind"));
        options.population = read.population;
        if (problem.gripper) options.grasp = pipe_grasp_options(*problem.gripper);
        if (gripper) options.grasp = pipe_grasp_options(taken(*gripper, "gripper"));
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return optimize_grasp(problem, pipe, read.path, options, monitor); });
      },
      "problem"_a, "pipe"_a, py::kw_only(), "gripper"_a = py::none(), "algorithm"_a = "bees",
      "neighbourhood_kind"_a = "connected_sections", "progress"_a = py::none(),
      ("The grasp of a pipe with the least cost along the path, by a population search: bees, ga or pso (P2 3.4),\n"
       "or with its optimum proven: branch_and_bound.\n"
       "`gripper`: axes and opening, the problem's when left out. `neighbourhood_kind` of bees: independent (Str1),\n"
       "same_section (Str2), connected_sections (Str3)." +
       option_help(optimize_grasp_fields()))
          .c_str());
  m.def("population_search_names", &population_search_names, "The population searches among grasp_search_names().");
  m.def(
      "default_grasp_search",
      [](const Given<JointGroup>& group) { return default_grasp_search(taken(group, "group")); }, "group"_a,
      "branch_and_bound for arms that it takes, else bees.");
  m.def("grasp_search_names", &grasp_search_names, "Names that optimize_grasp's `algorithm` takes.");
}

}  // namespace

void bind_object_path(py::module_& m) {
  m.def("_object_path_option_table", [] { return option_table(object_path_fields()); });
  m.def("_object_path_option_bounds", [] { return optimize_grasp_options().bounds(); });
  m.def("_population_option_table", [] { return option_table(population_fields()); });
  m.def("_grasp_search_option_table", [] { return option_table(grasp_search_fields()); });
  bind_object_path_result(m);
  using P = ObjectPathProblem;
  py::class_<P>(m, "ObjectPathProblem", "A robot that carries an object along given poses (P2 3.2.1).")
      .def(py::init(&object_path_problem), "group"_a, "world"_a, "object"_a, "T_world_object"_a, py::kw_only(),
           "gripper"_a = py::none(), "touch_links"_a = LinkNames{}, "frame"_a = py::none(), "object_name"_a = "object",
           "`object`: LinkShapes in its own frame; `world` is without it. `T_world_object` (m, 4, 4): where it lies,\n"
           "then where it goes. With `gripper` the fingers open as the grasp says; `frame`: how the object bends.")
      .def_readonly("group", &P::group, "Its tip is the tool frame of grasps.")
      .def_readonly("world", &P::world, "Without the object.")
      .def_property_readonly(
          "T_world_object", [](const P& p) { return to_array(p.T_world_object); }, "(m, 4, 4)")
      .def("__repr__", [](const P& p) {
        return "ObjectPathProblem('" + p.object_name + "', " + std::to_string(p.T_world_object.size()) + " poses, '" +
               p.group.name() + "')";
      });
  using E = ObjectPathEvaluator;
  py::class_<E>(m, "ObjectPathEvaluator",
                "Costs many grasps along one path: prepared once. Not for several threads at a time.")
      .def(py::init([](const Given<P>& problem, const py::kwargs& options) {
             return E(taken(problem, "problem"), object_path_options().read(options, "ObjectPathEvaluator"));
           }),
           "problem"_a, ("Prepares robot, world and object." + option_help(object_path_fields())).c_str())
      .def(
          "evaluate",
          [](E& evaluator, const Given<Grasp>& given) {
            const Grasp grasp = taken(given, "grasp");
            return interruptible([&] { return evaluator.evaluate(grasp); });
          },
          "grasp"_a, "The least cost over all arm configurations, or how far the grasp is from allowed.");
  m.def(
      "follow_object_path",
      [](const Given<P>& given_problem, const Given<Grasp>& given_grasp, const py::kwargs& options) {
        const P problem = taken(given_problem, "problem");
        const Grasp grasp = taken(given_grasp, "grasp");
        const ObjectPathOptions read = object_path_options().read(options, "follow_object_path");
        return interruptible([&] { return follow_object_path(problem, grasp, read); });
      },
      "problem"_a, "grasp"_a,
      ("The cheapest motion of the arm that carries the object through all poses with one grasp, over all arm\n"
       "configurations (P2 3.3.3, Algorithm 3.1), motions between poses checked finely." +
       option_help(object_path_fields()))
          .c_str());
  bind_optimum(m);
}

}  // namespace mmgrasp::python
