// make_arm_reach: inverse kinematics as grasp synthesis asks for it.
#include <memory>
#include <string>
#include <tuple>

#include "mmgrasp/collision/collision_ik.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/grasp/synthesize_grasps.hpp"

namespace mmgrasp {
namespace {

/// Why a solve failed: what most of the configurations that reach the pose touch, or else what most descents ended on.
Rejection main_cause(const Rejections& rejections) {
  const auto [scene, self, limits] = std::tuple(rejections.scene, rejections.self_collision, rejections.limits);
  if (scene + self > 0) return scene >= self ? Rejection::scene : Rejection::self_collision;
  return limits > rejections.unreachable ? Rejection::limits : Rejection::unreachable;
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
