#include "plan/manipulation/common/first_transfer.hpp"

#include <algorithm>
#include <utility>

#include "mmgrasp/robot/detail/joint_metric.hpp"
#include "plan/motion/rrt_connect.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kFirstIterations = 64;    // RRT-Connect's budget per grasp in the first round; doubled every round.
constexpr int kTotalIterations = 4096;  // Budget for all grasps before the planner takes over.
constexpr double kNoTimeLimit = 1e7;    // Limit of one RRT-Connect [s]: the call's own time limit ends it.

/// Finds any first path: RRT-Connect for one grasp after the other, with budgets that double from round to round.
class FirstTransfer {
 public:
  FirstTransfer(const ManipulationInput& input, ManipulationResult& result)
      : input_(input), result_(result), metric_(input.metric) {
    const JointGroup& group = input.problem.group;
    query_.lower = group.sample_lower();
    query_.upper = group.sample_upper();
    query_.metric = metric_;
    query_.time_limit = kNoTimeLimit;
    query_.stopped = [this] { return input_.out_of_time(); };
    query_.edge_is_free = [this](const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return edge_is_free(a, b); };
  }

  TransferPath run() {
    GraspCandidates& candidates = input_.candidates;
    std::size_t next_grasps = input_.options.first_grasps;
    for (int budget = kFirstIterations; unfinished(); budget *= 2, next_grasps *= 2, ++round_) {
      const std::size_t earlier = candidates.found().size();
      for (std::size_t i = 0; i < next_grasps && unfinished() && candidates.find_more(1); ++i)
        if (candidates.found().size() > tried_) search(candidates.found()[tried_++], budget);
      for (std::size_t i = 0; i < earlier && unfinished(); ++i) search(candidates.found()[i], budget);
      if (candidates.complete() && candidates.found().empty()) break;
    }
    return std::move(found_);
  }

 private:
  bool unfinished() const { return found_.grasp < 0 && left_ > 0 && !input_.out_of_time(); }

  /// Searches from another start each round to any of the goals.
  void search(const GraspCandidate& candidate, int budget) {
    grasp_ = candidate.grasp;
    query_.start = metric_.wrapped(candidate.starts[round_ % candidate.starts.size()]);
    query_.goals.clear();
    for (const Eigen::VectorXd& goal : candidate.goals) query_.goals.push_back(metric_.wrapped(goal));
    query_.turned_goals = candidate.turned_goals;
    if (static_cast<std::size_t>(round_) < candidate.starts.size() && try_straight(candidate)) return;
    query_.seed = input_.options.seed + static_cast<unsigned>(grasp_) + 7919u * static_cast<unsigned>(round_);
    query_.max_iterations = std::min(budget, left_);
    left_ -= query_.max_iterations;
    PlannerAnswer answer = rrt_connect(query_);
    if (answer.solved) take(candidate, std::move(answer.waypoints), PlanStage::first_grasps);
  }

  bool try_straight(const GraspCandidate& candidate) {
    for (const Eigen::VectorXd& goal : query_.goals)
      if (edge_is_free(query_.start, goal) && take(candidate, {query_.start, goal}, PlanStage::straight_lines))
        return true;
    return false;
  }

  /// False when the path does not pass the final check.
  bool take(const GraspCandidate& candidate, std::vector<Eigen::VectorXd> waypoints, PlanStage stage) {
    JointPath path{std::move(waypoints)};
    metric_.unroll(path.waypoints);
    if (input_.checks.blocked_edge(grasp_, path) >= 0) return false;
    const double cost = metric_.length(path.waypoints) + candidate.cost;
    found_ = {grasp_, cost, std::move(path), stage};
    take_path(input_, found_, result_);
    return true;
  }

  bool edge_is_free(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    ++result_.stats.edges_checked_robot;
    ++result_.stats.edges_checked_attached;
    return input_.checks.edge_is_free(grasp_, a, metric_.nearest(a, b));
  }

  const ManipulationInput& input_;
  ManipulationResult& result_;
  const JointMetric& metric_;
  PlannerQuery query_;
  TransferPath found_;
  int grasp_ = -1, round_ = 0, left_ = kTotalIterations;
  std::size_t tried_ = 0;  ///< How many of the candidates found were tried.
};

}  // namespace

TransferPath find_first_transfer(const ManipulationInput& input, ManipulationResult& result) {
  return input.options.first_grasps > 0 ? FirstTransfer(input, result).run() : TransferPath{};
}

}  // namespace mmgrasp::detail
