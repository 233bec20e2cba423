#include "verify/base/grasp_search.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::verify::detail {
namespace {

constexpr std::size_t kPool = 24;    // Configurations remembered for a part.
constexpr int kSecondLook = 15'000;  // IK solutions tried before a verdict against a plan.

}  // namespace

Pools planned_holds(const Context& context) {
  Pools pools(context.plan.parts.size());
  const Eigen::Index joints = context.plan.home.size();
  for (std::size_t i = 0; i < context.plan.picks.size(); ++i) {
    const CheckedPick& pick = context.plan.picks[i];
    const int part = context.pick_part[i];
    if (part < 0 || pick.grasp < 0 || pick.grasp >= static_cast<int>(context.plan.parts[part].grasps.size())) continue;
    for (const CheckedMotion& motion : pick.motions) {
      if (motion.kind != "approach" || motion.positions.empty()) continue;
      const Eigen::VectorXd& arm = motion.positions.back();
      if (arm.size() == joints && arm.allFinite()) pools[part].push_front({pick.grasp, arm});
    }
  }
  return pools;
}

std::vector<int> wanted_parts(const PlanToCheck& plan, const std::vector<std::string>& trays) {
  std::vector<int> wanted;
  for (std::size_t part = 0; part < plan.parts.size(); ++part) {
    const bool here = std::find(trays.begin(), trays.end(), plan.parts[part].tray) != trays.end();
    if (here && plan.parts[part].target) wanted.push_back(static_cast<int>(part));
  }
  return wanted;
}

GraspSearch::GraspSearch(const Context& context, Judge& judge, Pools pools, Rng rng, int tries)
    : context_(context), judge_(judge), pools_(std::move(pools)), rng_(rng), tries_(tries) {
  tolerance_.position = context.options.position_tolerance;
  tolerance_.rotation = context.options.rotation_tolerance;
}

bool GraspSearch::find(int part) {
  std::deque<Hold>& pool = pools_[part];
  for (std::size_t i = 0; i < pool.size(); ++i) {
    Hold hold = pool[i];
    if (!try_hold(part, hold)) continue;
    pool.erase(pool.begin() + static_cast<std::ptrdiff_t>(i));
    pool.push_front(std::move(hold));
    return true;
  }
  return search(part, tries_);
}

bool GraspSearch::find_thoroughly(int part) {
  return find(part) || search(part, kSecondLook);
}

bool GraspSearch::serves(const Eigen::Vector3d& base_pose, const std::vector<int>& parts, Effort effort) {
  judge_.set_base(base_pose);
  if (judge_.touch(context_.plan.home, 0)) return false;
  clearance_ = effort == Effort::without_ties ? 2 * tolerance_.position : 0;
  const bool all = std::all_of(parts.begin(), parts.end(), [&](int part) {
    return effort == Effort::thorough ? find_thoroughly(part) : find(part);
  });
  clearance_ = 0;
  return all;
}

/// Moves the hold's configuration onto its grasp from the present base pose, and checks it.
bool GraspSearch::try_hold(int part, Hold& hold) {
  const CheckedPart& p = context_.plan.parts[part];
  const CheckedGrasp& grasp = p.grasps[hold.grasp];
  if (grasp.opening > context_.plan.max_opening + 1e-6) return false;
  const Pose T_root_tip = judge_.T_world_root().inverse() * p.body.T_world_body * grasp.T_object_hand;
  if (!solve_tip_pose(judge_.kinematics(), T_root_tip, tolerance_, hold.arm)) return false;
  const double opening = context_.pregrasp_opening(grasp.opening);
  return !judge_.touch(hold.arm, opening) && !(clearance_ > 0 && judge_.comes_near(hold.arm, opening, clearance_));
}

/// Other grasps from what the pools know, then from anywhere.
bool GraspSearch::search(int part, int tries) {
  const int grasps = static_cast<int>(context_.plan.parts[part].grasps.size());
  for (int i = 0; grasps > 0 && i < std::max(tries, 3 * grasps); ++i) {
    Hold hold{i < grasps ? i : static_cast<int>(rng_.index(grasps)), i % 2 ? random_arm() : known_arm(part)};
    if (!try_hold(part, hold)) continue;
    pools_[part].push_front(std::move(hold));
    if (pools_[part].size() > kPool) pools_[part].pop_back();
    return true;
  }
  return false;
}

Eigen::VectorXd GraspSearch::known_arm(int part) {
  const std::deque<Hold>* pool = &pools_[part];
  if (pool->empty()) pool = &pools_[rng_.index(pools_.size())];
  return pool->empty() ? random_arm() : (*pool)[rng_.index(pool->size())].arm;
}

Eigen::VectorXd GraspSearch::random_arm() {
  const Kinematics& kinematics = judge_.kinematics();
  Eigen::VectorXd arm(kinematics.arm_size());
  for (Eigen::Index j = 0; j < arm.size(); ++j) {
    const bool bounded = std::isfinite(kinematics.lower()[j]) && std::isfinite(kinematics.upper()[j]);
    arm[j] = bounded ? rng_.uniform(kinematics.lower()[j], kinematics.upper()[j])
                     : rng_.uniform(-mmgrasp::detail::kPi, mmgrasp::detail::kPi);
  }
  return arm;
}

}  // namespace mmgrasp::verify::detail
