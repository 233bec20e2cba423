#include <cmath>
#include <optional>

#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/plan/manipulation.hpp"

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
  return {name, [=](O& o, const py::handle& v) { convert(v, name, o.prm.roadmap.*member); },
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
                 "likewise: vertices nearer than gamma (log n / n)^(1/d) are joined [rad or m]"),
      of_roadmap("neighbours", &RoadmapOptions::neighbours, "likewise: > 0: join that many nearest ones instead"),
      of_roadmap("roadmap_seed", &RoadmapOptions::seed, "likewise: same seed, same roadmap")};
  return fields;
}

const Fields& rrt_fields() {
  static const Fields fields{
      of_rrt("max_samples", &RrtStarMgOptions::max_samples, "rrt_star_mg: budget in samples"),
      of_rrt("step", &RrtStarMgOptions::step, "rrt_star_mg: longest edge grown towards a sample [rad or m]"),
      of_rrt("rrt_gamma", &RrtStarMgOptions::gamma,
             "rrt_star_mg: vertices nearer than gamma (log n / n)^(1/(d+1)) are joined; 0: as optimality asks"),
      of_rrt("exploration", &RrtStarMgOptions::exploration,
             "rrt_star_mg: once solved, chance to grow the drawn grasp's own tree (P2's p_blt)"),
      of_rrt("bidirectional", &RrtStarMgOptions::bidirectional, "rrt_star_mg: trees from both ends"),
      of_rrt("informed", &RrtStarMgOptions::informed, "rrt_star_mg: draw only where a better path can pass"),
      {"goal_cost", convert_goal_cost, [](const O& o) { return py::cast(o.rrt.goal_cost); },
       "rrt_star_mg: ends with the first path that costs no more; inf: the first at all"},
      of_rrt("keep_trees", &RrtStarMgOptions::keep_trees, "rrt_star_mg: hand over the trees with the result")};
  return fields;
}

const Fields& manipulation_fields() {
  static const Fields fields = [] {
    Fields all{
        option<O>("planner", &O::planner, "a name of manipulation_planner_names()"),
        option<O>("ik_solutions", &O::ik_solutions, "arm configurations tried for each grasp at each end"),
        option<O>("first_grasps", &O::first_grasps,
                  "grasps looked at, one by one, before those without a first path are searched again, then twice as "
                  "many; 0: all before any search"),
        option<O>("straight", &O::straight, "try straight joint lines from start to goal"),
        option<O>("ik_restarts", &O::ik, &IkOptions::restarts, "random starts of arms without a closed form"),
        option<O>("joint_step", &O::edge, &EdgeOptions::joint_step,
                  "no joint moves more between two checks of an edge [rad or m]"),
        option<O>("workspace_step", &O::edge, &EdgeOptions::workspace_step,
                  "no point of the robot or the object moves more between two checks [m]"),
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

/// A list of CandidateGrasp, or poses as (m, 4, 4).
std::vector<CandidateGrasp> grasps_argument(const py::object& value) {
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    const auto items = py::reinterpret_borrow<py::sequence>(value);
    std::vector<CandidateGrasp> out;
    bool all = true;
    for (const py::handle& item : items) {
      all = all && py::isinstance<CandidateGrasp>(item);
      if (all) out.push_back(py::cast<CandidateGrasp>(item));
    }
    if (all) return out;
  }
  py::array array;
  try {
    array = py::module_::import("numpy").attr("asarray")(value, "dtype"_a = "float64");
  } catch (const py::error_already_set&) {
    refuse_value("grasps", value, "a list of CandidateGrasp or an array (m, 4, 4)");
  }
  if (array.ndim() != 3 || array.shape(1) != 4 || array.shape(2) != 4) {
    throw InvalidInput("grasps has shape " + std::string(py::str(array.attr("shape"))) +
                       ": must be a list of CandidateGrasp or an array (m, 4, 4)");
  }
  std::vector<CandidateGrasp> out;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const py::object pose = array[py::int_(i)];
    out.push_back({pose_argument(pose, "grasps[" + std::to_string(i) + "]"), 0, 0});
  }
  return out;
}

std::vector<LinkShape> object_argument(const py::object& value) {
  if (py::isinstance<LinkShape>(value)) return {py::cast<LinkShape>(value)};
  try {
    return py::cast<std::vector<LinkShape>>(value);
  } catch (const py::cast_error&) {
    refuse_value("object", value, "a LinkShape or a list of them");
  }
}

using Strings = std::vector<std::string>;

void refuse_unknown(const py::kwargs& unknown, const Strings& known) {
  for (const auto& [key, value] : unknown) {
    const std::string name = py::cast<std::string>(key);
    throw InvalidInput("ManipulationProblem(" + name + "=...): unknown keyword" + nearest_name(name, known));
  }
}

/// Calls Python's `improved` from the planning thread; what it raises ends the run and is raised again.
class Improved {
 public:
  explicit Improved(py::object callback) : callback_(std::move(callback)) {}
  std::function<void(const Improvement&)> function(const Monitor& monitor) {
    if (callback_.is_none()) return {};
    return [this, stop = monitor.stop](const Improvement& improvement) mutable {
      const py::gil_scoped_acquire gil;
      if (error_) return;
      try {
        callback_(improvement);
      } catch (py::error_already_set& error) {
        error_.emplace(std::move(error));
        stop.stop();
      }
    };
  }
  void raise() {
    if (error_) throw std::move(*error_);
  }

 private:
  py::object callback_;
  std::optional<py::error_already_set> error_;
};

py::object path_array(const ManipulationResult& result) {
  if (!result.path) return py::none();
  return rows_to_array(result.path->waypoints);
}

py::dict stats_dict(const ManipulationStats& s) {
  return py::dict("ik_seconds"_a = s.ik_seconds, "roadmap_seconds"_a = s.roadmap_seconds,
                  "search_seconds"_a = s.search_seconds, "graph_searches"_a = s.graph_searches,
                  "ways_opened"_a = s.ways_opened, "grasps_searched"_a = s.grasps_searched,
                  "roadmap_cost"_a = s.roadmap_cost, "edges_checked_robot"_a = s.edges_checked_robot,
                  "edges_checked_held"_a = s.edges_checked_held, "samples"_a = s.samples, "vertices"_a = s.vertices);
}

py::dict report_dict(const GraspReport& r) {
  return py::dict("start"_a = to_dict(r.start), "goal"_a = to_dict(r.goal), "start_solutions"_a = r.start_solutions,
                  "goal_solutions"_a = r.goal_solutions, "searched"_a = r.searched);
}

py::dict improvement_dict(const Improvement& i) {
  return py::dict("seconds"_a = i.seconds, "cost"_a = i.cost, "grasp"_a = i.grasp,
                  "path"_a = rows_to_array(i.path.waypoints).attr("tolist")());
}

py::dict result_dict(const ManipulationResult& r) {
  py::object path = path_array(r);
  if (!path.is_none()) path = path.attr("tolist")();
  py::list improvements, grasps, contacts;
  for (const Improvement& i : r.improvements) improvements.append(improvement_dict(i));
  for (const GraspReport& g : r.grasps) grasps.append(report_dict(g));
  for (const Contact& c : r.contacts) contacts.append(py::cast(c).attr("to_dict")());
  return py::dict("outcome"_a = to_string(r.outcome), "grasp_index"_a = r.grasp_index, "path"_a = path,
                  "cost"_a = r.cost, "lower_bound"_a = r.lower_bound, "improvements"_a = improvements,
                  "grasps"_a = grasps, "rejections"_a = to_dict(r.rejections), "contacts"_a = contacts,
                  "stats"_a = stats_dict(r.stats));
}

std::string result_text(const ManipulationResult& r) {
  std::string out = std::string("ManipulationResult(") + to_string(r.outcome);
  if (r.path) {
    out += ", grasp " + std::to_string(r.grasp_index) + " of " + std::to_string(r.grasps.size()) + ", " +
           std::to_string(r.path->waypoints.size()) + " waypoints, cost " + std::string(py::repr(py::float_(r.cost)));
  } else {
    out += ", turned down: " + r.rejections.summary();
  }
  for (const Contact& c : r.contacts) out += ", '" + c.a + "' touches '" + c.b + "'";
  return out + ")";
}

void bind_problem(py::module_& m) {
  py::class_<CandidateGrasp>(m, "CandidateGrasp", "One way to hold the object while it is carried.")
      .def(py::init([](const ArrayLike& T_object_tool, const Given<double>& opening, const Given<double>& cost) {
             return CandidateGrasp{pose_argument(T_object_tool, "T_object_tool"), taken(opening, "opening"),
                                   taken(cost, "cost")};
           }),
           "T_object_tool"_a, "opening"_a = 0.0, "cost"_a = 0.0,
           "Pose of the group's tip in the object's frame (4, 4); opening of the fingers while holding [m], used when "
           "the problem has a gripper; cost added to the path's length.")
      .def_property_readonly("T_object_tool", [](const CandidateGrasp& g) { return to_array(g.T_object_tool); })
      .def_readonly("opening", &CandidateGrasp::opening)
      .def_readonly("cost", &CandidateGrasp::cost)
      .def("to_dict",
           [](const CandidateGrasp& g) {
             return py::dict("T_object_tool"_a = to_array(g.T_object_tool).attr("tolist")(), "opening"_a = g.opening,
                             "cost"_a = g.cost);
           })
      .def("__repr__",
           [](const CandidateGrasp& g) { return "CandidateGrasp(at " + text(g.T_object_tool.translation()) + ")"; });
  py::class_<ManipulationProblem>(m, "ManipulationProblem",
                                  "Carry an object from one pose to another with any of many grasps (P2 4.2).")
      .def(py::init([](const Given<JointGroup>& group, const Given<World>& world, const py::object& object,
                       const ArrayLike& T_world_start, const ArrayLike& T_world_goal, const py::object& grasps,
                       const std::optional<Given<Gripper>>& gripper, const Given<Strings>& touch_links,
                       const Given<std::string>& object_name, const py::kwargs& unknown) {
             refuse_unknown(unknown, {"group", "world", "object", "T_world_start", "T_world_goal", "grasps", "gripper",
                                      "touch_links", "object_name"});
             ManipulationProblem problem{with_sampled_pairs(taken(group, "group")),
                                         taken(world, "world"),
                                         object_argument(object),
                                         pose_argument(T_world_start, "T_world_start"),
                                         pose_argument(T_world_goal, "T_world_goal"),
                                         grasps_argument(grasps)};
             if (gripper) problem.gripper = taken(*gripper, "gripper");
             const Strings links = taken(touch_links, "touch_links", "names of links");
             problem.touch_links = {links.begin(), links.end()};
             problem.object_name = taken(object_name, "object_name");
             problem.check();
             return problem;
           }),
           "group"_a, "world"_a, "object"_a, "T_world_start"_a, "T_world_goal"_a, "grasps"_a, py::kw_only(),
           "gripper"_a = py::none(), "touch_links"_a = Strings{}, "object_name"_a = "object",
           "`object` is a LinkShape or a list of them, in its own frame; `world` is without it. `grasps` are "
           "CandidateGrasp, or poses of the tool in the object's frame as (m, 4, 4). With `gripper` the fingers are "
           "set to each grasp's opening. Links in `touch_links` may touch the object; none given: those of the end "
           "effector. The group may be an arm or an arm on an omni base; a diff_drive base is refused, since it could "
           "not drive the paths.")
      .def_property_readonly("T_world_start", [](const ManipulationProblem& p) { return to_array(p.T_world_start); })
      .def_property_readonly("T_world_goal", [](const ManipulationProblem& p) { return to_array(p.T_world_goal); })
      .def_readonly("group", &ManipulationProblem::group)
      .def_readonly("world", &ManipulationProblem::world)
      .def_readonly("object", &ManipulationProblem::object)
      .def_readonly("grasps", &ManipulationProblem::grasps)
      .def_readonly("object_name", &ManipulationProblem::object_name)
      .def("__repr__", [](const ManipulationProblem& p) {
        return "ManipulationProblem('" + p.object_name + "', " + std::to_string(p.grasps.size()) + " grasps, '" +
               p.group.name() + "')";
      });
}

void bind_result(py::module_& m) {
  py::class_<SearchTree>(m, "SearchTree",
                         "One tree of RRT*-MG as it stood at the end: of one grasp, from its starts or its goals.")
      .def_readonly("grasp", &SearchTree::grasp)
      .def_readonly("from_goal", &SearchTree::from_goal)
      .def_property_readonly(
          "vertices", [](const SearchTree& t) { return Eigen::MatrixXd(t.vertices.transpose()); }, "(n, joints)")
      .def_readonly("parents", &SearchTree::parents,
                    "Of each vertex: another one, or -1 for the grasp's arm configurations.")
      .def_readonly("costs", &SearchTree::costs, "Length of the way from the root, (n,).")
      .def("to_dict",
           [](const SearchTree& t) {
             return py::dict("grasp"_a = t.grasp, "from_goal"_a = t.from_goal,
                             "vertices"_a = py::cast(Eigen::MatrixXd(t.vertices.transpose())).attr("tolist")(),
                             "parents"_a = t.parents, "costs"_a = py::cast(t.costs).attr("tolist")());
           })
      .def("__repr__", [](const SearchTree& t) {
        return "SearchTree(grasp " + std::to_string(t.grasp) + ", from its " + (t.from_goal ? "goals, " : "starts, ") +
               std::to_string(t.parents.size()) + " vertices)";
      });
  py::class_<Improvement>(m, "Improvement", "A better solution on the way.")
      .def_readonly("seconds", &Improvement::seconds, "Since the call began, the first roadmap's building left out.")
      .def_readonly("cost", &Improvement::cost)
      .def_readonly("grasp", &Improvement::grasp)
      .def_property_readonly(
          "path", [](const Improvement& i) { return rows_to_array(i.path.waypoints); }, "Waypoints (k, n).")
      .def("to_dict", &improvement_dict)
      .def("__repr__", [](const Improvement& i) {
        return "Improvement(cost " + std::string(py::repr(py::float_(i.cost))) + ", grasp " + std::to_string(i.grasp) +
               ", after " + std::string(py::repr(py::float_(i.seconds))) + " s)";
      });
  py::class_<GraspReport>(m, "GraspReport", "What became of one grasp.")
      .def_readonly("start", &GraspReport::start, "Arm configurations turned down at the start, by cause.")
      .def_readonly("goal", &GraspReport::goal, "Likewise at the goal; not looked at when none is left at the start.")
      .def_readonly("start_solutions", &GraspReport::start_solutions)
      .def_readonly("goal_solutions", &GraspReport::goal_solutions)
      .def_readonly("searched", &GraspReport::searched, "Its paths were looked for over a roadmap.")
      .def("to_dict", &report_dict)
      .def("__repr__", [](const GraspReport& r) {
        return "GraspReport(start: " + std::to_string(r.start_solutions) + " left, turned down " + r.start.summary() +
               "; goal: " + std::to_string(r.goal_solutions) + " left, turned down " + r.goal.summary() + ")";
      });
  py::class_<ManipulationResult>(m, "ManipulationResult", "What plan_manipulation found.")
      .def_readonly("outcome", &ManipulationResult::outcome)
      .def_readonly("grasp_index", &ManipulationResult::grasp_index, "Of the problem's grasps; -1 unless solved.")
      .def_property_readonly("path", &path_array, "Waypoints (k, n), joined by straight lines; None unless solved.")
      .def_readonly("cost", &ManipulationResult::cost, "Length of the path in joint space plus the grasp's cost.")
      .def_readonly("lower_bound", &ManipulationResult::lower_bound,
                    "No path costs less: with prm_star_mg none over this roadmap and these arm configurations.")
      .def_readonly("improvements", &ManipulationResult::improvements)
      .def_readonly("grasps", &ManipulationResult::grasps, "A GraspReport for each grasp.")
      .def_readonly("rejections", &ManipulationResult::rejections, "Sum over all grasps and both ends.")
      .def_readonly("contacts", &ManipulationResult::contacts,
                    "With invalid_start or invalid_goal: what touches there with the first grasp in collision.")
      .def_readonly("trees", &ManipulationResult::trees,
                    "With keep_trees: a SearchTree for each grasp still in the race and each end.")
      .def_property_readonly("stats", [](const ManipulationResult& r) { return stats_dict(r.stats); })
      .def("to_dict", &result_dict)
      .def("__repr__", &result_text);
}

}  // namespace

void bind_roadmap(py::module_& m);

void bind_manipulation(py::module_& m) {
  bind_roadmap(m);
  bind_problem(m);
  bind_result(m);
  m.def("_manipulation_option_table", [] { return option_table(manipulation_fields()); });
  m.def("manipulation_planner_names", &manipulation_planner_names, "Names that plan_manipulation's `planner` takes.");
  m.def(
      "plan_manipulation",
      [](const Given<ManipulationProblem>& given_problem, const std::optional<Given<Roadmap>>& given_roadmap,
         const py::object& progress, const py::object& improved, const py::kwargs& options) {
        const ManipulationProblem& problem = taken(given_problem, "problem");
        const Roadmap* roadmap = given_roadmap ? &taken(*given_roadmap, "roadmap") : nullptr;
        const ManipulationOptions read = read_options(manipulation_fields(), options, "plan_manipulation");
        refuse_options_of_others(options, roadmap != nullptr, read.planner);
        Improved callback(improved);
        ManipulationResult result = LongCall(progress).run([&](const Monitor& monitor) {
          return plan_manipulation(problem, read, roadmap, monitor, callback.function(monitor));
        });
        callback.raise();
        return result;
      },
      "problem"_a, py::kw_only(), "roadmap"_a = py::none(), "progress"_a = py::none(), "improved"_a = py::none(),
      ("Collision-free path of the group that carries the object from start to goal with the best of the grasps (P2 "
       "chapters 4 and 5). Every grasp is looked at. `improved` is called with every better solution (an Improvement); "
       "what "
       "it raises ends the call." +
       option_help(manipulation_fields()))
          .c_str());
}

}  // namespace mmgrasp::python
