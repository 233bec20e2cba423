// make_arm_reach: inverse kinematics as grasp synthesis asks for it.
#include <memory>
#include <string>
#include <utility>

#include "mmgrasp/collision/collision_ik.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/grasp/synthesize_grasps.hpp"

namespace mmgrasp {
namespace {

/// What most descents of a failed solve ended on.
Rejection main_cause(const Rejections& rejections) {
  std::size_t most = 0;
  Rejection cause = Rejection::unreachable;
  for (const auto& [count, of] : {std::pair{rejections.scene, Rejection::scene},
                                  {rejections.self_collision, Rejection::self_collision},
                                  {rejections.limits, Rejection::limits}}) {
    if (count <= most) continue;
    most = count;
    cause = of;
  }
  return rejections.scene + rejections.self_collision > 0 || most > rejections.unreachable ? cause
                                                                                           : Rejection::unreachable;
}

}  // namespace

ArmReach make_arm_reach(const JointGroup& arm, const Eigen::VectorXd& seed, const World* world,
                        const IkOptions& options) {
  options.check();
  require(seed.size() == arm.size(), "seed", std::to_string(seed.size()) + " values",
          "must be one for each of the arm's " + std::to_string(arm.size()) + " joints");
  if (world == nullptr) {
    return [arm, seed, options](const Pose& T_world_hand, Eigen::VectorXd& q) {
      const IkResult found = solve_ik(arm, T_world_hand, seed, options);
      if (found.outcome != Outcome::solved) return main_cause(found.rejections);
      q = found.q;
      return Rejection::none;
    };
  }
  const auto checker = std::make_shared<CollisionChecker>(arm, *world);
  return [checker, seed, options](const Pose& T_world_hand, Eigen::VectorXd& q) {
    const IkResult found = solve_collision_free_ik(*checker, T_world_hand, seed, options);
    if (found.outcome != Outcome::solved) return main_cause(found.rejections);
    q = found.q;
    return Rejection::none;
  };
}

}  // namespace mmgrasp
