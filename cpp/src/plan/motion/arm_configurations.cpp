#include "plan/motion/arm_configurations.hpp"

#include <algorithm>

#include "mmgrasp/robot/detail/ik_candidates.hpp"
#include "mmgrasp/robot/detail/ik_failure.hpp"
#include "mmgrasp/robot/ik_branches.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kFewRedundantValues = 8, kManyRedundantValues = 32;  // Values of a redundant joint that are tried.
constexpr int kMaxNumericalSolutions = 8;                          // Tried for arms with a closed form.

}  // namespace

ArmConfigurations arm_configurations(const JointGroup& group, const Pose& T_world_tip, int count,
                                     const IkOptions& options, const ReachFilter& valid, Rejections& rejections) {
  ArmConfigurations out;
  std::vector<Eigen::VectorXd>& solutions = out.q;
  Rejections seen;
  if (!maybe_in_reach(group, T_world_tip.translation(), options.position_tolerance)) {
    rejections.add(Rejection::unreachable);
    out.all = true;
    return out;
  }
  IkOptions numerical = options;
  for (const int values : {kFewRedundantValues, kManyRedundantValues}) {
    const Candidates candidates = closed_form_candidates(group, T_world_tip, values);
    if (!candidates.known_form) break;
    seen = {};
    std::vector<Eigen::VectorXd> reaching;
    for (const Eigen::VectorXd& q : candidates.q) {
      double position_error = 0, rotation_error = 0;
      if (!group.within_limits(q))
        seen.add(Rejection::limits);
      else if (!confirm(group, T_world_tip, q, options, position_error, rotation_error))
        seen.add(Rejection::unreachable);
      else
        reaching.push_back(q);
    }
    spread_apart(group, reaching);
    bool final = false;
    std::size_t looked_at = 0;
    for (; looked_at < reaching.size() && !final && static_cast<int>(solutions.size()) < count; ++looked_at) {
      const ReachVerdict verdict = valid(reaching[looked_at]);
      seen.add(verdict.cause);
      if (verdict.cause == Rejection::none) solutions.push_back(reaching[looked_at]);
      final = verdict.final;
    }
    const bool finite = candidates.redundant_joint < 0 && !candidates.free, all_seen = final || finite;
    out.all = final || (finite && looked_at == reaching.size());
    if (all_seen || !solutions.empty()) {
      if (candidates.q.empty()) seen.add(Rejection::unreachable);
      rejections += seen;
      return out;
    }
    numerical.restarts = std::min(options.restarts, (kMaxNumericalSolutions + count - 1) / count - 1);
  }
  bool any = seen.total() > 0;
  solutions = solve_ik_all(group, T_world_tip, count, numerical, [&](const Eigen::VectorXd& q) {
    any = true;
    if (out.all) return Rejection::scene;
    const ReachVerdict verdict = valid(q);
    seen.add(verdict.cause);
    out.all = verdict.final;
    return verdict.cause;
  });
  if (!any && solutions.empty()) seen.add(Rejection::unreachable);
  rejections += seen;
  return out;
}

}  // namespace mmgrasp::detail
