#include "bindings.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "plan_arguments.hpp"

namespace mmgrasp::python {
namespace {

constexpr char kStageRows[] = "dict[str, mmgrasp.records.StageRow]";
using StageRows = Shown<kStageRows>;

using namespace py::literals;

StageRows stages_dict(const std::vector<StageReport>& stages) {
  py::dict out;
  for (const StageReport& r : stages) {
    out[to_string(r.stage)] = py::dict("improvements"_a = r.improvements, "first_seconds"_a = r.first_seconds,
                                       "last_seconds"_a = r.last_seconds, "cost"_a = r.cost);
  }
  return out;
}

py::dict stats_dict(const ManipulationStats& s) {
  return py::dict(
      "ik_seconds"_a = s.ik_seconds, "roadmap_seconds"_a = s.roadmap_seconds, "search_seconds"_a = s.search_seconds,
      "graph_searches"_a = s.graph_searches, "nodes_opened"_a = s.nodes_opened, "grasps_searched"_a = s.grasps_searched,
      "roadmap_cost"_a = s.roadmap_cost, "roadmap_bound"_a = s.roadmap_bound, "postures_bound"_a = s.postures_bound,
      "edges_checked_robot"_a = s.edges_checked_robot, "edges_checked_attached"_a = s.edges_checked_attached,
      "samples"_a = s.samples, "vertices"_a = s.vertices, "stages"_a = stages_dict(s.stages));
}

py::dict report_dict(const GraspReport& r) {
  return py::dict("start"_a = to_dict(r.start), "goal"_a = to_dict(r.goal), "start_solutions"_a = r.start_solutions,
                  "goal_solutions"_a = r.goal_solutions, "searched"_a = r.searched);
}

py::dict improvement_dict(const Improvement& i) {
  return py::dict("seconds"_a = i.seconds, "cost"_a = i.cost, "grasp"_a = i.grasp, "stage"_a = to_string(i.stage),
                  "path"_a = rows_to_array(i.path.waypoints).attr("tolist")());
}

py::dict result_dict(const ManipulationResult& r) {
  py::list improvements, grasps, contacts;
  for (const Improvement& i : r.improvements) improvements.append(improvement_dict(i));
  for (const GraspReport& g : r.grasps) grasps.append(report_dict(g));
  for (const Contact& c : r.contacts) contacts.append(py::cast(c).attr("to_dict")());
  return py::dict("outcome"_a = to_string(r.outcome), "grasp_index"_a = r.grasp_index, "path"_a = path_list(r.path),
                  "cost"_a = r.cost, "lower_bound"_a = r.lower_bound, "improvements"_a = improvements,
                  "grasps"_a = grasps, "rejections"_a = to_dict(r.rejections), "contacts"_a = contacts,
                  "warnings"_a = r.warnings, "stats"_a = stats_dict(r.stats));
}

std::string result_text(const ManipulationResult& r) {
  std::string out = std::string("ManipulationResult(") + to_string(r.outcome);
  if (r.path) {
    out += ", grasp " + std::to_string(r.grasp_index) + " of " + std::to_string(r.grasps.size()) + ", " +
           std::to_string(r.path->waypoints.size()) + " waypoints, cost " + std::string(py::repr(py::float_(r.cost)));
  } else {
    out += ", rejected: " + r.rejections.summary();
  }
  for (const Contact& c : r.contacts) out += ", " + describe(c);
  for (const std::string& warning : r.warnings) out += ", warning: " + warning;
  return out + ")";
}

void bind_tree(py::module_& m) {
  py::class_<SearchTree>(m, "SearchTree",
                         "One tree of RRT*-MG as it stood at the end: of one grasp, from its starts or its goals.")
      .def_readonly("grasp", &SearchTree::grasp, "Index of its grasp.")
      .def_readonly("from_goal", &SearchTree::from_goal, "It grew from the goals; otherwise from the starts.")
      .def_property_readonly(
          "vertices", [](const SearchTree& t) { return Eigen::MatrixXd(t.vertices.transpose()); }, "(n, joints)")
      .def_readonly("parents", &SearchTree::parents, "Parent of each vertex, or -1 for the grasp's arm configurations.")
      .def_readonly("costs", &SearchTree::costs, "Length of the way from the root, (n,).")
      .def(
          "to_dict",
          [](const SearchTree& t) {
            return py::dict("grasp"_a = t.grasp, "from_goal"_a = t.from_goal,
                            "vertices"_a = py::cast(Eigen::MatrixXd(t.vertices.transpose())).attr("tolist")(),
                            "parents"_a = t.parents, "costs"_a = py::cast(t.costs).attr("tolist")());
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const SearchTree& t) {
        return "SearchTree(grasp " + std::to_string(t.grasp) + ", from its " + (t.from_goal ? "goals, " : "starts, ") +
               std::to_string(t.parents.size()) + " vertices)";
      });
}

void bind_result_parts(py::module_& m) {
  py::class_<Improvement>(m, "Improvement", "A better solution on the way, as planners report it to `on_solution`.")
      .def_readonly("seconds", &Improvement::seconds, "Since the call began, the first roadmap's building left out.")
      .def_readonly("cost", &Improvement::cost,
                    "Length of the path in joint space, plus the grasp's cost where there are grasps.")
      .def_readonly("grasp", &Improvement::grasp, "Index of its grasp; -1: the motion has none.")
      .def_property_readonly(
          "stage", [](const Improvement& i) { return to_string(i.stage); },
          "What found it: search (plan_motion), first_grasps, straight_lines, roadmap, refinement, trees or "
          "shortening.")
      .def_property_readonly(
          "path", [](const Improvement& i) { return rows_to_array(i.path.waypoints); }, "Waypoints (k, n).")
      .def("to_dict", &improvement_dict, "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const Improvement& i) {
        const std::string grasp = i.grasp < 0 ? "" : ", grasp " + std::to_string(i.grasp);
        return "Improvement(cost " + std::string(py::repr(py::float_(i.cost))) + grasp + ", by " + to_string(i.stage) +
               " after " + std::string(py::repr(py::float_(i.seconds))) + " s)";
      });
  py::class_<GraspReport>(m, "GraspReport", "What became of one grasp.")
      .def_readonly("start", &GraspReport::start, "Arm configurations rejected at the start, by cause.")
      .def_readonly("goal", &GraspReport::goal, "Likewise at the goal; not checked when none is left at the start.")
      .def_readonly("start_solutions", &GraspReport::start_solutions, "Arm configurations left at the start.")
      .def_readonly("goal_solutions", &GraspReport::goal_solutions, "Arm configurations left at the goal.")
      .def_readonly("searched", &GraspReport::searched, "Its paths were looked for over a roadmap.")
      .def("to_dict", &report_dict, "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const GraspReport& r) {
        return "GraspReport(start: " + std::to_string(r.start_solutions) + " left, rejected " + r.start.summary() +
               "; goal: " + std::to_string(r.goal_solutions) + " left, rejected " + r.goal.summary() + ")";
      });
}

void bind_stats(py::module_& m) {
  using S = ManipulationStats;
  py::class_<S>(m, "ManipulationStats", "What a search of plan_manipulation took.")
      .def_readonly("ik_seconds", &S::ik_seconds, "Time for the arm configurations at start and goal [s].")
      .def_readonly("roadmap_seconds", &S::roadmap_seconds,
                    "Time for building a roadmap [s]; 0: it was given or not used.")
      .def_readonly("search_seconds", &S::search_seconds, "Time for all the rest [s].")
      .def_readonly("graph_searches", &S::graph_searches, "Searches of prm_star_mg's per-grasp graphs.")
      .def_readonly("nodes_opened", &S::nodes_opened,
                    "Nodes pushed to the open lists of graph searches (prm_star_mg without lazy_grasps).")
      .def_readonly("grasps_searched", &S::grasps_searched,
                    "Grasps for which prm_star_mg searched a roadmap; each counts once.")
      .def_readonly("roadmap_cost", &S::roadmap_cost,
                    "Cost of prm_star_mg's best path over the roadmap before shortening; 0: none is cheaper than the "
                    "first path.")
      .def_readonly("roadmap_bound", &S::roadmap_bound,
                    "No path over prm_star_mg's roadmap, or straight, costs less; infinite: there is none.")
      .def_readonly("postures_bound", &S::postures_bound,
                    "No path between the arm postures that were found costs less.")
      .def_readonly("edges_checked_robot", &S::edges_checked_robot,
                    "Edges checked for the robot alone, shared by all grasps of an opening.")
      .def_readonly("edges_checked_attached", &S::edges_checked_attached, "Edges checked for the attached object.")
      .def_readonly("samples", &S::samples, "Samples that rrt_star_mg drew or reassigned.")
      .def_readonly("vertices", &S::vertices, "Vertices of rrt_star_mg's trees, removed ones included.")
      .def_property_readonly(
          "stages", [](const S& s) { return stages_dict(s.stages); },
          "What each stage contributed, by its name, in the order of their first improvement.")
      .def("to_dict", &stats_dict, "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const S& s) {
        return "ManipulationStats(" + std::string(py::repr(py::float_(s.search_seconds))) + " s, " +
               std::to_string(s.graph_searches) + " graph searches, " + std::to_string(s.samples) + " samples)";
      });
}

}  // namespace

void bind_manipulation_result(py::module_& m) {
  bind_tree(m);
  bind_result_parts(m);
  bind_stats(m);
  py::class_<ManipulationResult>(m, "ManipulationResult", "What plan_manipulation found.")
      .def_readonly("outcome", &ManipulationResult::outcome, "How it ended; `solved` alone comes with an answer.")
      .def_readonly("grasp_index", &ManipulationResult::grasp_index,
                    "Index into the problem's grasps; -1 unless solved.")
      .def_property_readonly(
          "path", [](const ManipulationResult& r) { return path_array(r.path); },
          "Waypoints (k, n), joined by straight lines; None unless solved.")
      .def_readonly("cost", &ManipulationResult::cost, "Length of the path in joint space plus the grasp's cost.")
      .def_readonly("lower_bound", &ManipulationResult::lower_bound,
                    "No path with any grasp costs less: the least straight line where every arm posture was listed, "
                    "else also what the tool's way takes at the longest levers. Infinite: proven that there is none.")
      .def_readonly("improvements", &ManipulationResult::improvements, "Every better solution on the way, in order.")
      .def_readonly("grasps", &ManipulationResult::grasps, "A GraspReport for each grasp.")
      .def_readonly("rejections", &ManipulationResult::rejections, "Sum over all grasps and both ends.")
      .def_readonly("contacts", &ManipulationResult::contacts,
                    "With invalid_start or invalid_goal: what touches there with the first grasp in collision.")
      .def_readonly("warnings", &ManipulationResult::warnings,
                    "What may have kept paths from being found: a roadmap in pieces.")
      .def_readonly("trees", &ManipulationResult::trees,
                    "With keep_trees: a SearchTree for each grasp still a candidate and each end.")
      .def_readonly("stats", &ManipulationResult::stats,
                    "What the search took: seconds, searches, edges checked; what each stage found and when.")
      .def("to_dict", &result_dict, "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", &result_text);
}

}  // namespace mmgrasp::python
