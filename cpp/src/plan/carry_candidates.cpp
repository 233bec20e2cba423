#include "plan/carry_candidates.hpp"

#include <atomic>
#include <chrono>
#include <limits>

#include "mmgrasp/core/parallel.hpp"
#include "plan/arm_configurations.hpp"

namespace mmgrasp::detail {

namespace {

Pose pose_of_tool(const ManipulationProblem& problem, int grasp, bool at_goal) {
  const Pose& T_world_object = at_goal ? problem.T_world_goal : problem.T_world_start;
  return T_world_object * problem.grasps[static_cast<std::size_t>(grasp)].T_object_tool;
}

IkOptions ik_of(const ManipulationOptions& options, int grasp) {
  IkOptions ik = options.ik;
  ik.seed = options.ik.seed + static_cast<unsigned>(grasp);
  return ik;
}

}  // namespace

double CarryCandidate::straight_cost() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::VectorXd& s : starts)
    for (const Eigen::VectorXd& g : goals) least = std::min(least, (g - s).norm());
  return least + cost;
}

bool find_candidates(const ManipulationProblem& problem, const ManipulationOptions& options, CarryChecks& checks,
                     std::vector<CarryCandidate>& candidates, std::vector<GraspReport>& reports,
                     const Monitor& monitor) {
  const std::size_t count = problem.grasps.size();
  reports.assign(count, {});
  std::vector<CarryCandidate> found(count);
  const auto begin = std::chrono::steady_clock::now();
  std::atomic<bool> late{false};
  const auto solve = [&](std::size_t index, int worker) {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    if (spent.count() > options.time_limit) {
      late = true;
      return;
    }
    const int grasp = static_cast<int>(index);
    const CandidateGrasp& candidate = problem.grasps[index];
    CarryCandidate& out = found[index];
    out.grasp = grasp;
    out.opening = checks.opening_of(grasp);
    out.cost = candidate.cost;
    const auto one_end = [&](bool at_goal, Rejections& rejections, int& left) {
      const auto valid = [&](const Eigen::VectorXd& q) {
        // What is held first: there is less of it, and it hits the scene in any configuration or in none.
        ReachVerdict verdict{checks.held_rejection(worker, grasp, q), false};
        if (verdict.cause == Rejection::scene) {
          verdict.final = true;
        } else if (verdict.cause == Rejection::none) {
          verdict.cause = checks.robot_rejection(worker, out.opening, q);
          verdict.final = verdict.cause == Rejection::scene && checks.tool_hits_scene(worker, out.opening, q);
        }
        return verdict;
      };
      std::vector<Eigen::VectorXd> solutions =
          arm_configurations(checks.group(out.opening), pose_of_tool(problem, grasp, at_goal), options.ik_solutions,
                             ik_of(options, grasp), valid, rejections);
      left = static_cast<int>(solutions.size());
      return solutions;
    };
    out.starts = one_end(false, reports[index].start, reports[index].start_solutions);
    if (!out.starts.empty()) out.goals = one_end(true, reports[index].goal, reports[index].goal_solutions);
  };
  if (!parallel_for(count, options.threads, solve, monitor, "grasps") || late) return false;
  candidates.clear();
  for (CarryCandidate& candidate : found)
    if (!candidate.starts.empty() && !candidate.goals.empty()) candidates.push_back(std::move(candidate));
  return true;
}

std::vector<Contact> first_contacts(CarryChecks& checks, const ManipulationOptions& options,
                                    const std::vector<GraspReport>& reports, bool at_goal) {
  const ManipulationProblem& problem = checks.problem();
  for (std::size_t i = 0; i < reports.size(); ++i) {
    const Rejections& seen = at_goal ? reports[i].goal : reports[i].start;
    if (seen.scene + seen.self_collision == 0) continue;
    const int grasp = static_cast<int>(i);
    std::vector<Contact> contacts;
    CollisionChecker checker = checks.whole(grasp);
    Rejections unused;
    const auto look = [&](const Eigen::VectorXd& q) {
      if (contacts.empty()) contacts = checker.contacts(q);
      return ReachVerdict{Rejection::none, true};
    };
    arm_configurations(checks.group(checks.opening_of(grasp)), pose_of_tool(problem, grasp, at_goal),
                       options.ik_solutions, ik_of(options, grasp), look, unused);
    if (!contacts.empty()) return contacts;
  }
  return {};
}

}  // namespace mmgrasp::detail
