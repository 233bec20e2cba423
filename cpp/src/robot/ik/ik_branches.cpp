#include "mmgrasp/robot/ik_branches.hpp"

#include <algorithm>
#include <limits>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/robot/detail/ik_candidates.hpp"
#include "mmgrasp/robot/detail/ik_failure.hpp"
#include "mmgrasp/robot/detail/ik_starts.hpp"
#include "mmgrasp/robot/detail/whole_turns.hpp"

namespace mmgrasp {
namespace {

constexpr int kRedundantValues = 24;
constexpr double kDistinct = 0.1;  // [rad] Between solutions that random descents find.

/// Random descents until `count` distinct solutions are found, the budget is spent or the monitor says stop.
void search(const JointGroup& group, const Pose& T_world_tip, int count, const IkOptions& options,
            const ConfigurationFilter& valid, const Monitor& monitor, IkBranches& branches) {
  detail::IkStarts starts(group, T_world_tip, options.seed);
  const detail::TimeLimit time_limit(options.time_limit);
  IkWorkspace workspace;
  detail::FailureCause cause;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(group.size());
  const Eigen::VectorXd middle = 0.5 * (group.sample_lower() + group.sample_upper());
  const detail::WholeTurns turns(group);
  std::vector<Eigen::VectorXd> seen;
  const long budget = (static_cast<long>(options.restarts) + 1) * count;
  for (long i = 0; i < budget && static_cast<int>(branches.solutions.size()) < count; ++i) {
    if (time_limit.expired() || monitor.stopped()) return;
    Eigen::VectorXd q = starts.next();
    if (!detail::descend(group, T_world_tip, q, options, workspace, true).converged) {
      branches.rejections.add(cause.of(group, T_world_tip, q, options, workspace));
      continue;
    }
    detail::unwind(group, zero, q);
    // Descents end in any turn: one posture, one solution.
    if (turns.any()) q = turns.of(q, middle, 1).at(0);
    bool known = false;
    for (const Eigen::VectorXd& other : seen) known = known || detail::joint_distance(group, q, other) <= kDistinct;
    if (known) continue;
    seen.push_back(q);
    const Rejection verdict = valid ? valid(q) : Rejection::none;
    double position_error = 0, rotation_error = 0;
    if (verdict != Rejection::none)
      branches.rejections.add(verdict);
    else if (detail::confirm(group, T_world_tip, q, options, position_error, rotation_error))
      branches.solutions.push_back(std::move(q));
  }
}

/// Branches in closed form; false when the group has none.
bool enumerate(const JointGroup& group, const Pose& T_world_tip, int redundant_values, const IkOptions& options,
               const ConfigurationFilter& valid, const Monitor& monitor, IkBranches& branches) {
  const detail::Candidates candidates = detail::closed_form_candidates(group, T_world_tip, redundant_values);
  if (!candidates.known_form) return false;
  branches.complete = !candidates.free;
  branches.redundant_joint = candidates.redundant_joint;
  branches.rejections.add(Rejection::unreachable, candidates.without);
  for (const Eigen::VectorXd& q : candidates.q) {
    if (monitor.stopped()) break;
    double position_error = 0, rotation_error = 0;
    Rejection verdict = group.within_limits(q) ? Rejection::none : Rejection::limits;
    if (verdict == Rejection::none && valid) verdict = valid(q);
    if (verdict == Rejection::none && !detail::confirm(group, T_world_tip, q, options, position_error, rotation_error))
      verdict = Rejection::unreachable;
    if (verdict == Rejection::none)
      branches.solutions.push_back(q);
    else
      branches.rejections.add(verdict);
  }
  return true;
}

IkBranches branches_of(const JointGroup& group, const Pose& T_world_tip, int count, int redundant_values,
                       const IkOptions& options, const ConfigurationFilter& valid, const Monitor& monitor) {
  detail::check_target(group, T_world_tip, options);
  IkBranches branches;
  if (!detail::maybe_in_reach(group, T_world_tip.translation(), options.position_tolerance)) {
    branches.complete = true;
    branches.rejections.add(Rejection::unreachable);
    return branches;
  }
  const bool enumerated = enumerate(group, T_world_tip, redundant_values, options, valid, monitor, branches);
  // A redundant joint's sampled values may all miss what little room its limits leave; so may the one split of a
  // singularity that the closed form keeps.
  const bool partial = branches.redundant_joint >= 0 || !branches.complete;
  if (!enumerated || (partial && branches.solutions.empty())) {
    branches.complete = false;
    search(group, T_world_tip, count, options, valid, monitor, branches);
  }
  spread_apart(group, branches.solutions);
  return branches;
}

}  // namespace

IkBranches solve_ik_branches(const JointGroup& group, const Pose& T_world_tip, const IkOptions& options,
                             const ConfigurationFilter& valid, int redundant_values, const Monitor& monitor,
                             bool all_turns) {
  require_count(redundant_values, "redundant_values", 0, 10'000);
  constexpr int kSearched = 16;
  IkBranches branches = branches_of(group, T_world_tip, kSearched,
                                    redundant_values ? redundant_values : kRedundantValues, options, valid, monitor);
  if (all_turns) branches.solutions = detail::all_whole_turns(group, branches.solutions);
  return branches;
}

std::vector<Eigen::VectorXd> solve_ik_all(const JointGroup& group, const Pose& T_world_tip, int count,
                                          const IkOptions& options, const ConfigurationFilter& valid, bool all_turns,
                                          const Monitor& monitor) {
  require_count(count, "count", 0, 1'000'000);
  const int values = std::clamp(count, 8, 10'000);  // of a redundant joint, where `count` asks for many
  std::vector<Eigen::VectorXd> solutions =
      branches_of(group, T_world_tip, count, values, options, valid, monitor).solutions;
  if (static_cast<int>(solutions.size()) > count) solutions.resize(count);
  return all_turns ? detail::all_whole_turns(group, solutions) : solutions;
}

void spread_apart(const JointGroup& group, std::vector<Eigen::VectorXd>& solutions) {
  if (solutions.size() < 2) return;
  const Eigen::VectorXd middle = 0.5 * (group.sample_lower() + group.sample_upper());
  std::vector<double> distance(solutions.size());
  for (std::size_t i = 0; i < solutions.size(); ++i) distance[i] = -(solutions[i] - middle).norm();
  for (std::size_t done = 0; done < solutions.size(); ++done) {
    detail::throw_if_interrupted();
    const auto farthest = std::max_element(distance.begin() + static_cast<long>(done), distance.end());
    const std::size_t at = farthest - distance.begin();
    std::swap(solutions[done], solutions[at]);
    std::swap(distance[done], distance[at]);
    for (std::size_t i = done + 1; i < solutions.size(); ++i) {
      const double from_new = detail::joint_distance(group, solutions[done], solutions[i]);
      distance[i] = done == 0 ? from_new : std::min(distance[i], from_new);
    }
  }
}

}  // namespace mmgrasp
