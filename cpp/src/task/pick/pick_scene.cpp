#include "task/pick/pick_scene.hpp"

#include <cmath>

namespace mmgrasp {
namespace {

constexpr double kOpeningStep = 0.004;  // [m] between two looks at moving fingers

}  // namespace

PickScene::PickScene(const PartSupplyProblem& problem, const Eigen::Vector3d& base_pose, int tray, int part,
                     const std::vector<std::pair<int, int>>& remaining)
    : problem_(problem),
      T_world_root_(pose_from_planar(base_pose)),
      part_name_(part_of(problem, tray, part).name),
      in_place_(world_with_parts(problem, remaining)),
      gone_(in_place_) {
  gone_.remove(part_name_);
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
  return kept(before_, in_place_, opening);
}
CollisionChecker& PickScene::after(double opening) {
  return kept(after_, gone_, opening);
}

CollisionChecker PickScene::holding(double opening, const Pose& T_tcp_part) const {
  World world = in_place_;
  const std::vector<std::string>& fingers = problem_.gripper.finger_links;
  world.attach(part_name_, problem_.gripper.tool_link, T_tcp_part,
               std::set<std::string>(fingers.begin(), fingers.end()));
  return CollisionChecker(arm(opening), world);
}

bool PickScene::fingers_free(const PartSupplyProblem& problem, const Pose& T_world_root,
                             const CollisionChecker& checker, const Eigen::VectorXd& q, double from, double to) {
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(to - from) / kOpeningStep)));
  for (int i = 0; i <= steps; ++i) {
    const JointGroup arm = arm_with_opening(problem, from + (to - from) * i / steps).at(T_world_root);
    if (!checker.with_group(arm).is_free(q)) return false;
  }
  return true;
}

}  // namespace mmgrasp
