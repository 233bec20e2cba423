#include "task/pick/pick_scene.hpp"

#include <algorithm>
#include <cmath>

#include "task/problem/scene.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kOpeningStep = 0.004;  // [m] between two checks of moving fingers
constexpr double kRaised = 2e-6;        // [m] beyond what keeps a held object from what it rests on.

}  // namespace

PickScene::PickScene(const PickProblem& problem) : problem_(problem), removed_(problem.world) {
  removed_.remove(problem.object);
}

JointGroup PickScene::arm(double opening) const {
  return arm_with_opening(problem_.arm, problem_.gripper, opening);
}

CollisionChecker& PickScene::kept(Checkers& checkers, const World& world, double opening) {
  std::unique_ptr<CollisionChecker>& slot = checkers[std::lround(opening * 1e9)];
  if (!slot) {
    if (checkers.size() > 1) {
      for (const auto& [key, other] : checkers) {
        if (other) slot = std::make_unique<CollisionChecker>(other->with_group(arm(opening)));
        if (slot) break;
      }
    } else {
      slot = std::make_unique<CollisionChecker>(arm(opening), world);
    }
  }
  return *slot;
}

CollisionChecker& PickScene::before(double opening) {
  return kept(before_, problem_.world, opening);
}
CollisionChecker& PickScene::after(double opening) {
  return kept(after_, removed_, opening);
}

CollisionChecker PickScene::holding(double opening, const Pose& T_hand_object) const {
  return CollisionChecker(arm(opening),
                          world_holding(problem_.world, problem_.gripper, problem_.object, T_hand_object));
}

CollisionChecker PickScene::lifting(double opening, const Pose& T_world_hand, const Pose& T_world_object) const {
  return holding(opening, T_world_hand.inverse() * Eigen::Translation3d(0, 0, kRaised) * T_world_object);
}

bool PickScene::fingers_free(const CollisionChecker& checker, const Eigen::VectorXd& q, double from, double to) const {
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(to - from) / kOpeningStep)));
  for (int i = 0; i <= steps; ++i) {
    if (!checker.with_group(arm(from + (to - from) * i / steps)).is_free(q)) return false;
  }
  return true;
}

}  // namespace mmgrasp::detail
