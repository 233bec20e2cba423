#include "mmgrasp/task/fingers_meet.hpp"

#include <set>
#include <string>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/verify/plan_check.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp {
namespace {

constexpr int kSteps = 20;
constexpr char kPart[] = "part";

/// The hand at the part, which lies at the world's origin; whatever carries the hand stands where it may.
class ClosingHand {
 public:
  ClosingHand(const Robot& robot, const Hand& hand, const std::vector<LinkShape>& part)
      : hand_(hand),
        arm_(robot.chain(robot.links()[robot.root_link()].name, hand.tool_link)),
        q_(0.5 * (arm_.sample_lower() + arm_.sample_upper())),
        T_tool_root_((arm_.T_world_root().inverse() * arm_.fk(q_)).inverse()),
        checker_(arm_, world_of(part), only_scene()) {}

  bool meets(const Grasp& grasp) {
    const Pose T_world_root = grasp.T_object_hand * T_tool_root_;
    const double narrowest = verify::narrowest_grip(grasp.opening);
    for (int i = 0; i <= kSteps; ++i) {  // The farther they are closed, the more fingers meet, for most parts.
      CollisionChecker& checker = at_opening(narrowest + (grasp.opening - narrowest) * i / kSteps);
      checker.set_root(T_world_root);
      if (fingers_touching(checker) >= 2) return true;
    }
    return false;
  }

 private:
  static World world_of(const std::vector<LinkShape>& part) {
    World world;
    world.add(kPart, WorldObject{part});
    return world;
  }
  static CheckerOptions only_scene() {
    CheckerOptions options;
    options.check_self = false;
    return options;
  }
  CollisionChecker& at_opening(double opening) {
    if (opening != opening_) {
      checker_ = checker_.with_group(detail::arm_with_opening(arm_, hand_, opening));
      opening_ = opening;
    }
    return checker_;
  }
  std::size_t fingers_touching(CollisionChecker& checker) {
    std::set<std::string> touching;
    for (const Contact& contact : checker.contacts(q_)) {
      for (const std::string& finger : hand_.finger_links) {
        if (contact.a == finger || contact.b == finger) touching.insert(finger);
      }
    }
    return touching.size();
  }

  const Hand& hand_;
  JointGroup arm_;
  Eigen::VectorXd q_;
  Pose T_tool_root_;
  CollisionChecker checker_;
  double opening_ = -1;  ///< The fingers of checker_ stand so; -1: as the robot has them.
};

}  // namespace

std::vector<bool> fingers_meet(const Robot& robot, const Hand& hand, const std::vector<LinkShape>& part,
                               const std::vector<Grasp>& grasps) {
  if (hand.suction || grasps.empty()) return std::vector<bool>(grasps.size(), true);
  ClosingHand closing(robot, hand, part);
  std::vector<bool> meet;
  for (const Grasp& grasp : grasps) {
    detail::throw_if_interrupted();
    meet.push_back(closing.meets(grasp));
  }
  return meet;
}

}  // namespace mmgrasp
