#include "mmgrasp/task/fingers_meet.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/verify/plan_check.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp {
namespace {

constexpr int kSteps = 20;
constexpr std::size_t kMostKept = 64;
constexpr char kPart[] = "part";

/// The hand at the part, which lies at the world's origin; whatever carries the hand stands where it may.
class ClosingHand {
 public:
  ClosingHand(const JointGroup& arm, const Hand& hand, const std::vector<LinkShape>& part)
      : hand_(hand),
        arm_(arm.at(Pose::Identity())),
        q_(0.5 * (arm_.sample_lower() + arm_.sample_upper())),
        T_tool_root_(arm_.fk(q_).inverse()),
        checker_(arm_, world_of(part), only_scene()) {}

  bool meets(const Grasp& grasp, double slack) {
    const auto meets_at = [&](double beside) {
      return meets_from(grasp.T_object_hand * Eigen::Translation3d(beside * hand_.closing), grasp.opening);
    };
    return meets_at(-slack) && meets_at(slack);
  }

 private:
  bool meets_from(const Pose& T_part_tool, double opening) {
    const Pose T_world_root = T_part_tool * T_tool_root_;
    const double narrowest = verify::narrowest_grip(opening);
    for (int i = 0; i <= kSteps; ++i) {  // The farther they are closed, the more fingers meet, for most parts.
      CollisionChecker& checker = at_opening(narrowest + (opening - narrowest) * i / kSteps);
      checker.set_root(T_world_root);
      if (fingers_touching(checker) >= 2) return true;
    }
    return false;
  }
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
  /// Kept, for many grasps of a part have one opening.
  CollisionChecker& at_opening(double opening) {
    if (const auto found = kept_.find(opening); found != kept_.end()) return found->second;
    if (kept_.size() >= kMostKept) kept_.clear();
    const JointGroup opened = detail::arm_with_opening(arm_, hand_, opening);
    return kept_.emplace(opening, checker_.with_group(opened)).first->second;
  }
  std::size_t fingers_touching(CollisionChecker& checker) {
    std::set<std::string> touching;
    for (const Contact& contact : checker.contacts(q_)) {
      if (std::count(hand_.finger_links.begin(), hand_.finger_links.end(), contact.a) > 0) touching.insert(contact.a);
    }
    return touching.size();
  }

  const Hand& hand_;
  JointGroup arm_;
  Eigen::VectorXd q_;
  Pose T_tool_root_;
  CollisionChecker checker_;
  std::map<double, CollisionChecker> kept_;  ///< Openings of the fingers [m] and checkers of them.
};

void check_grasps(const JointGroup& arm, const Hand& hand, const std::vector<Grasp>& grasps, double mesh_tolerance) {
  hand.check_fingers();
  require(arm.robot().link_index(hand.tool_link) == arm.tip_link(), "hand.tool_link", "'" + hand.tool_link + "'",
          "must be the arm's tip");
  for (const std::string& finger : hand.finger_links) arm.robot().link_index(finger);  // says which there is none of
  require_not_negative(mesh_tolerance, "mesh_tolerance");
  for (std::size_t i = 0; i < grasps.size(); ++i) {
    const double opening = grasps[i].opening;
    require(opening >= 0 && opening <= hand.max_opening, "grasps[" + std::to_string(i) + "].opening", opening,
            "must be in [0, max_opening] of the hand [m]");
  }
}

}  // namespace

std::vector<bool> fingers_meet(const JointGroup& arm, const Hand& hand, const std::vector<LinkShape>& part,
                               const std::vector<Grasp>& grasps, double mesh_tolerance) {
  if (hand.suction) return std::vector<bool>(grasps.size(), true);
  check_grasps(arm, hand, grasps, mesh_tolerance);
  if (grasps.empty()) return {};
  ClosingHand closing(arm, hand, part);
  std::vector<bool> meet;
  for (const Grasp& grasp : grasps) {
    detail::throw_if_interrupted();
    meet.push_back(closing.meets(grasp, kGraspSlack + mesh_tolerance));
  }
  return meet;
}

}  // namespace mmgrasp
