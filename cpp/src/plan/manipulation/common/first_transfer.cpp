#include "plan/manipulation/common/first_transfer.hpp"

#include <algorithm>
#include <utility>

#include "plan/motion/rrt_connect.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kIterations = 64;       // Of RRT-Connect for one grasp in the first round; doubled from round to round.
constexpr int kAllIterations = 4096;  // Spent on all grasps before the planner takes over.
constexpr double kNoLimit = 1e7;      // Of RRT-Connect's own clock [s]: that of the call ends it.

class FirstCarry {
 public:
  FirstCarry(const ManipulationInput& input, ManipulationResult& result) : input_(input), result_(result) {
    const JointGroup& group = input.problem.group;
    query_.lower = group.sample_lower();
    query_.upper = group.sample_upper();
    query_.wraps.assign(static_cast<std::size_t>(group.size()), false);  // Carries go the way the numbers say.
    query_.time_limit = kNoLimit;
    query_.stopped = [this] { return input_.out_of_time(); };
    query_.edge_is_free = [this](const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return edge_is_free(a, b); };
  }

  TransferPath run() {
    GraspCandidates& candidates = input_.candidates;
    auto coming = static_cast<std::size_t>(input_.options.first_grasps);
    for (int budget = kIterations; goes_on(); budget *= 2, coming *= 2, ++round_) {
      const std::size_t earlier = candidates.found().size();
      for (std::size_t i = 0; i < coming && goes_on() && candidates.find_more(1); ++i)
        if (candidates.found().size() > tried_) search(candidates.found()[tried_++], budget);
      for (std::size_t i = 0; i < earlier && goes_on(); ++i) search(candidates.found()[i], budget);
      if (candidates.complete() && candidates.found().empty()) break;
    }
    return std::move(found_);
  }

 private:
  bool goes_on() const { return found_.grasp < 0 && left_ > 0 && !input_.out_of_time(); }

  /// From another start each round, to any of the goals.
  void search(const GraspCandidate& candidate, int budget) {
    grasp_ = candidate.grasp;
    query_.start = candidate.starts[static_cast<std::size_t>(round_) % candidate.starts.size()];
    query_.goals = candidate.goals;
    if (static_cast<std::size_t>(round_) < candidate.starts.size() && try_straight(candidate)) return;
    query_.seed = input_.options.seed + static_cast<unsigned>(grasp_) + 7919u * static_cast<unsigned>(round_);
    query_.max_iterations = std::min(budget, left_);
    left_ -= query_.max_iterations;
    PlannerAnswer answer = rrt_connect(query_);
    if (answer.solved) take(candidate, std::move(answer.waypoints));
  }

  bool try_straight(const GraspCandidate& candidate) {
    for (const Eigen::VectorXd& goal : query_.goals)
      if (edge_is_free(query_.start, goal) && take(candidate, {query_.start, goal})) return true;
    return false;
  }

  /// False when the path does not pass a finer check.
  bool take(const GraspCandidate& candidate, std::vector<Eigen::VectorXd> waypoints) {
    JointPath path{std::move(waypoints)};
    if (input_.checks.blocked_edge(grasp_, path) >= 0) return false;
    const double cost = path.length() + candidate.cost;
    found_ = {grasp_, cost, std::move(path)};
    take_path(input_, found_, result_);
    return true;
  }

  bool edge_is_free(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    ++result_.stats.edges_checked_robot;
    ++result_.stats.edges_checked_held;
    return input_.checks.edge_is_free(grasp_, a, b);
  }

  const ManipulationInput& input_;
  ManipulationResult& result_;
  PlannerQuery query_;
  TransferPath found_;
  int grasp_ = -1, round_ = 0, left_ = kAllIterations;
  std::size_t tried_ = 0;  ///< Of the candidates found.
};

}  // namespace

TransferPath find_first_transfer(const ManipulationInput& input, ManipulationResult& result) {
  return input.options.first_grasps > 0 ? FirstCarry(input, result).run() : TransferPath{};
}

}  // namespace mmgrasp::detail
