#include "mmgrasp/plan/manipulation.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "mmgrasp/collision/detail/checker_difference.hpp"
#include "mmgrasp/core/detail/near_name.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "plan/manipulation/common/manipulation_planner.hpp"
#include "plan/manipulation/least_grasp_cost.hpp"
#include "plan/motion/steered_base.hpp"
#include "plan/roadmap/roadmap_data.hpp"

namespace mmgrasp {
namespace {

void check_touch_link(const Robot& robot, const std::string& link) {
  if (robot.has_link(link)) return;
  std::vector<std::string> names;
  for (const Link& known : robot.links()) names.push_back(known.name);
  throw InvalidInput("touch_links = " + link + ": robot '" + robot.name() + "' has no such link" +
                     detail::near_miss(link, names));
}

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

std::string listed(const Eigen::VectorXd& weights) {
  std::ostringstream out;
  for (Eigen::Index i = 0; i < weights.size(); ++i) out << (i > 0 ? ", " : "") << weights[i];
  return weights.size() > 0 ? "joint_weights " + out.str() : "all joint_weights 1";
}

void check_roadmap(const Roadmap& roadmap, const JointGroup& group, const detail::JointMetric& metric) {
  const JointGroup& own = roadmap.group();
  if (detail::kinematics_key(own) == detail::kinematics_key(group)) {
    const Eigen::VectorXd weights = roadmap.options().joint_weights.of(own);
    if (weights.size() == metric.weights().size() && weights == metric.weights()) return;
    throw InvalidInput("roadmap: was built with " + listed(weights) + ", not with " + listed(metric.weights()));
  }
  const std::string given = listed(own.names()), wanted = listed(group.names());
  throw InvalidInput("roadmap: was built for another robot or other joints than the problem's group: " +
                     (given == wanted ? "joints of the robot have other origins, axes or limits"
                                      : "for " + given + ", not for " + wanted));
}

void check_checker(const CollisionChecker& checker, const ManipulationProblem& problem) {
  World world = problem.world;
  world.forget(problem.object_name);  // No checker without the object knows of it.
  const std::string why = detail::checker_difference(checker, problem.group, world);
  if (!why.empty()) throw InvalidInput("checker: is not of the problem's group and world: " + why);
  require(!checker.options().attached_only, "checker: attached_only", "true", "must check the robot itself, too");
}

Outcome outcome_of(const detail::ManipulationInput& input, bool exhausted, const ManipulationResult& result) {
  if (input.candidates.complete() && input.candidates.found().empty()) {
    const bool any_start = std::any_of(result.grasps.begin(), result.grasps.end(),
                                       [](const GraspReport& report) { return report.start_solutions > 0; });
    return any_start ? Outcome::invalid_goal : Outcome::invalid_start;
  }
  if (result.path) return Outcome::solved;
  if (input.monitor.stopped()) return Outcome::stopped;
  return exhausted ? Outcome::not_found : Outcome::timeout;
}

}  // namespace

const char* to_string(PlanStage stage) {
  switch (stage) {
    case PlanStage::search:
      return "search";
    case PlanStage::first_grasps:
      return "first_grasps";
    case PlanStage::straight_lines:
      return "straight_lines";
    case PlanStage::roadmap:
      return "roadmap";
    case PlanStage::refinement:
      return "refinement";
    case PlanStage::trees:
      return "trees";
    case PlanStage::shortening:
      return "shortening";
  }
  return "?";
}

void ManipulationProblem::check() const {
  detail::refuse_steered_base(group, "plan_manipulation");
  require(!object.empty(), "object", "[]", "must have at least one shape");
  require(!grasps.empty(), "grasps", "[]", "must hold at least one grasp");
  checked_pose(T_world_start.matrix(), "T_world_start");
  checked_pose(T_world_goal.matrix(), "T_world_goal");
  if (gripper) gripper->check();
  for (const std::string& link : touch_links) check_touch_link(group.robot(), link);
  const double widest = gripper ? gripper->max_opening : 1e9;
  for (std::size_t i = 0; i < grasps.size(); ++i) {
    const Grasp& grasp = grasps[i];
    const bool good_cost = std::isfinite(grasp.cost) && grasp.cost >= 0;
    const bool good_opening = grasp.opening >= 0 && grasp.opening <= widest;
    const std::string name = "grasps[" + std::to_string(i) + "].";
    checked_pose(grasp.T_object_hand.matrix(), name + "T_object_hand");
    if (gripper && !grasp.posture.empty()) gripper->joint_values(grasp.posture);
    if (good_cost && good_opening) continue;
    require(good_cost, name + "cost", grasp.cost, "must be finite and >= 0");
    require(good_opening, name + "opening", grasp.opening, "must be in [0, the gripper's max_opening]");
  }
  if (!world.attached().empty())
    throw InvalidInput("world: holds '" + world.attached().begin()->first + "': must hold nothing yet");
  if (world.has(object_name)) throw InvalidInput("object_name = " + object_name + ": is a name of the world already");
}

void PrmStarMgOptions::check() const {
  require_count(batch, "batch", 0, 10'000'000);
  require(max_vertices >= 0 && max_vertices <= 10'000'000, "max_vertices", max_vertices, "must be in [0, 10000000]");
  require_count(refinements, "refinements", 0);
  roadmap.check();
}

void ManipulationOptions::check() const {
  detail::manipulation_planner(planner);
  require_count(ik_solutions, "ik_solutions", 1, 1'000'000);
  require_count(first_grasps, "first_grasps", 0, 1'000'000);
  require(time_limit > 0, "time_limit", time_limit, "must be > 0 [s]");
  require_not_negative(max_length, "max_length");
  require(max_length == 0 || !(rrt.goal_cost > 0), "goal_cost", rrt.goal_cost, "must be left out with max_length");
  require(prm.roadmap.joint_weights.empty(), "prm.roadmap.joint_weights", "given",
          "must be left out: joint_weights of all hold");
  edge.check();
  ik.check();
  prm.check();
  rrt.check();
}

ManipulationResult detail::plan_manipulation_with(const ManipulationPlanner& planner,
                                                  const ManipulationProblem& problem,
                                                  const ManipulationOptions& options, const Roadmap* roadmap,
                                                  const Monitor& monitor, const ImprovementCallback& on_improvement,
                                                  const CollisionChecker* checker) {
  problem.check();
  options.check();
  if (checker) check_checker(*checker, problem);
  const JointMetric metric(problem.group.wraps(), options.joint_weights.of(problem.group));
  if (roadmap) check_roadmap(*roadmap, problem.group, metric);
  ManipulationResult result;
  Stopwatch clock;
  TransferChecks checks(problem, options.edge, resolve_threads(options.threads), checker);
  GraspCandidates candidates(problem, options, metric, checks, clock, monitor, result);
  ManipulationInput input{problem, options, metric, roadmap, checks, candidates, on_improvement, monitor, clock};
  const bool exhausted = planner.run(input, result);
  result.stats.search_seconds = clock.seconds() - result.stats.ik_seconds;
  for (const GraspReport& report : result.grasps) {
    result.rejections += report.start;
    result.rejections += report.goal;
  }
  result.stats.postures_bound = std::min(result.path ? result.cost : kInfinity, candidates.least_cost());
  result.lower_bound = std::min(result.stats.postures_bound, candidates.least_cost_elsewhere());
  result.outcome = outcome_of(input, exhausted, result);
  if (result.outcome == Outcome::invalid_start) result.contacts = candidates.first_contacts(false);
  if (result.outcome == Outcome::invalid_goal) result.contacts = candidates.first_contacts(true);
  return result;
}

ManipulationResult plan_manipulation(const ManipulationProblem& problem, const ManipulationOptions& options,
                                     const Roadmap* roadmap, const Monitor& monitor,
                                     const ImprovementCallback& on_improvement, const CollisionChecker* checker) {
  if (options.max_length > 0) {
    return detail::plan_least_grasp_cost(problem, options, roadmap, monitor, on_improvement, checker);
  }
  return detail::plan_manipulation_with(detail::manipulation_planner(options.planner), problem, options, roadmap,
                                        monitor, on_improvement, checker);
}

}  // namespace mmgrasp
