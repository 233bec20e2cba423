#include <cmath>
#include <optional>

#include "bindings.hpp"
#include "given.hpp"
#include "joint_weights.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "padding.hpp"
#include "plan_arguments.hpp"
#include "solution_callback.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;
using O = ManipulationOptions;

template <typename Value>
OptionField<O> of_prm(const char* name, Value PrmStarMgOptions::*member, const char* help) {
  return option<O>(name, &O::prm, member, help);
}

template <typename Value>
OptionField<O> of_rrt(const char* name, Value RrtStarMgOptions::*member, const char* help) {
  return option<O>(name, &O::rrt, member, help);
}

template <typename Value>
OptionField<O> of_roadmap(const char* name, Value RoadmapOptions::*member, const char* help) {
  return {name, annotation<Value>(), [=](O& o, const py::handle& v) { convert(v, name, o.prm.roadmap.*member); },
          [=](const O& o) { return py::cast(o.prm.roadmap.*member); }, help};
}

/// May be infinite, which other numbers may not.
void convert_goal_cost(O& options, const py::handle& value) {
  const bool infinite = PyFloat_Check(value.ptr()) && PyFloat_AS_DOUBLE(value.ptr()) == HUGE_VAL;
  if (infinite)
    options.rrt.goal_cost = HUGE_VAL;
  else
    convert(value, "goal_cost", options.rrt.goal_cost);
}

using Fields = std::vector<OptionField<O>>;

const Fields& prm_fields() {
  static const Fields fields{
      of_prm("batch", &PrmStarMgOptions::batch,
             "prm_star_mg: grasps searched together before paths are checked; 1: naive, 0: all"),
      of_prm("lazy_grasps", &PrmStarMgOptions::lazy_grasps,
             "prm_star_mg: search a grasp only when its straight line could still win"),
      of_prm("max_vertices", &PrmStarMgOptions::max_vertices,
             "prm_star_mg: once the roadmap's best path is found, double its vertices up to this; 0: never"),
      of_prm("shorten", &PrmStarMgOptions::shorten, "prm_star_mg: shorten the roadmap's best path at the end"),
      of_prm("refinements", &PrmStarMgOptions::refinements,
             "prm_star_mg: then search so many small roadmaps drawn where a cheaper path can pass"),
      of_roadmap("vertices", &RoadmapOptions::vertices, "prm_star_mg without a roadmap given: configurations drawn"),
      of_roadmap("gamma", &RoadmapOptions::gamma,
                 "likewise: > 0: vertices nearer than gamma (log n / n)^(1/d) are joined (P2: 4) [rad or m]; 0: the "
                 "e (1 + 1/d) log n nearest ones"),
      of_roadmap("neighbours", &RoadmapOptions::neighbours, "likewise: > 0: that many nearest ones are joined instead"),
      of_roadmap("roadmap_seed", &RoadmapOptions::seed, "likewise: same seed, same roadmap")};
  return fields;
}

const Fields& rrt_fields() {
  static const Fields fields{
      of_rrt("max_iterations", &RrtStarMgOptions::max_iterations, "rrt_star_mg: budget in samples"),
      of_rrt("range", &RrtStarMgOptions::range,
             "rrt_star_mg: longest edge grown towards a sample [rad or m, times the weights' root mean square]"),
      of_rrt("rrt_gamma", &RrtStarMgOptions::gamma,
             "rrt_star_mg: vertices nearer than gamma (log n / n)^(1/(d+1)) are joined; 0: about (d + 1) / 2 "
             "n^(1/(d+1)) log n of n"),
      of_rrt("exploration", &RrtStarMgOptions::exploration,
             "rrt_star_mg: once solved, chance to grow the drawn grasp's own tree (P2's p_blt)"),
      of_rrt("bidirectional", &RrtStarMgOptions::bidirectional, "rrt_star_mg: trees from both ends"),
      of_rrt("informed", &RrtStarMgOptions::informed, "rrt_star_mg: draw only where a better path can pass"),
      {"goal_cost", "float", convert_goal_cost, [](const O& o) { return py::cast(o.rrt.goal_cost); },
       "rrt_star_mg: ends with the first path that costs no more; inf: the first at all"},
      of_rrt("keep_trees", &RrtStarMgOptions::keep_trees, "rrt_star_mg: hand over the trees with the result")};
  return fields;
}

const Fields& manipulation_fields() {
  static const Fields fields = [] {
    Fields all{
        option<O>("planner", &O::planner, "a name of manipulation_planner_names()"),
        option<O>("ik_solutions", &O::ik_solutions,
                  "arm postures tried for each grasp at each end, in all whole turns"),
        option<O>("first_grasps", &O::first_grasps,
                  "grasps checked, one by one, before those without a first path are searched again, then twice as "
                  "many; 0: all before any search"),
        option<O>("straight", &O::straight, "try straight joint lines from start to goal"),
        option<O>("ik_restarts", &O::ik, &IkOptions::restarts, "random starts of arms without a closed form"),
        option<O>("joint_step", &O::edge, &EdgeOptions::joint_step,
                  "no joint moves more between two checks of an edge [rad or m]"),
        option<O>("workspace_step", &O::edge, &EdgeOptions::workspace_step,
                  "no point of the robot or the object moves more between two checks [m]"),
        joint_weights_option<O>(&O::joint_weights),
        option<O>("max_length", &O::max_length, "the least grasp cost among paths no longer than this; 0: their sum"),
        option<O>("time_limit", &O::time_limit, "wall-clock cap on IK and search, without the roadmap's building [s]"),
        option<O>("seed", &O::seed, "same seed, same path"),
        option<O>("threads", &O::threads, "0: all; does not change the answer")};
    for (const Fields* own : {&prm_fields(), &rrt_fields()}) all.insert(all.end(), own->begin(), own->end());
    return all;
  }();
  return fields;
}

/// Options of the planner that is not taken would change nothing, which the caller should hear of.
void refuse_options_of_others(const py::kwargs& given, bool with_roadmap, const std::string& planner) {
  const bool prm = planner == "prm_star_mg";
  const std::string other = prm ? "rrt_star_mg" : "prm_star_mg";
  const std::string rule = " is an option of " + other + ", not of " + planner;
  for (const OptionField<O>& field : prm ? rrt_fields() : prm_fields())
    if (given.contains(field.name)) throw InvalidInput(field.name + ":" + rule);
  if (with_roadmap && !prm) throw InvalidInput("roadmap:" + rule);
}

}  // namespace

void bind_manipulation(py::module_& m) {
  bind_roadmap(m);
  bind_manipulation_problem(m);
  bind_manipulation_result(m);
  m.def("_manipulation_option_table", [] { return option_table(manipulation_fields()); });
  m.def("manipulation_planner_names", &manipulation_planner_names, "Names that plan_manipulation's `planner` takes.");
  m.def(
      "plan_manipulation",
      [](const Given<ManipulationProblem>& given_problem, const std::optional<Given<Roadmap>>& given_roadmap,
         const std::optional<Given<CollisionChecker>>& given_checker, const OptionalPadding& padding,
         const Progress& progress, const OnSolution& on_solution, const py::kwargs& options) {
        ManipulationProblem problem = taken(given_problem, "problem");
        if (given_checker && !padding.is_none())
          throw InvalidInput("padding: must be left out with a checker, which has its world's");
        problem.world = padded(problem.world, padding);
        std::optional<CollisionChecker> checker;
        if (given_checker) checker = taken(*given_checker, "checker").clone();
        const Roadmap* roadmap = given_roadmap ? &taken(*given_roadmap, "roadmap") : nullptr;
        const ManipulationOptions read = read_options(manipulation_fields(), options, "plan_manipulation");
        refuse_options_of_others(options, roadmap != nullptr, read.planner);
        SolutionCallback callback(on_solution);
        return callback.run(progress, [&](const Monitor& monitor, const ImprovementCallback& better) {
          return plan_manipulation(problem, read, roadmap, monitor, better, checker ? &*checker : nullptr);
        });
      },
      "problem"_a, py::kw_only(), "roadmap"_a = py::none(), "checker"_a = py::none(), "padding"_a = py::none(),
      "progress"_a = py::none(), "on_solution"_a = py::none(),
      ("Collision-free path of the group that carries the object from start to goal with the best of the grasps (P2 "
       "chapters 4 and 5). Every grasp is checked. `padding`: in place of that of the problem's world, see "
       "World.padding. `checker`: a prepared CollisionChecker of the problem's group and world. "
       "`on_solution` is called with every better solution (an "
       "Improvement); "
       "what "
       "it raises ends the call." +
       option_help(manipulation_fields()))
          .c_str());
}

}  // namespace mmgrasp::python
