#include "mmgrasp/task/fingers_meet.hpp"

#include <algorithm>
#include <map>
#include <string>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
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
        checker_(arm_, world_of(part), only_scene()) {
    find_sides();
  }

  bool meets(const Grasp& grasp, double slack) {
    const auto meets_at = [&](double beside) {
      return meets_from(grasp.T_object_hand * Eigen::Translation3d(beside * hand_.closing), grasp.opening);
    };
    return meets_at(-slack) && meets_at(slack);
  }
  /// Whether no finger link is in the part where the pads are still `play` off it on either side.
  bool fits(const Grasp& grasp, double slack, double play) {
    CollisionChecker& checker = at_opening(std::min(grasp.opening + 2 * play, hand_.max_opening));
    const auto touches_at = [&](double beside) {
      checker.set_root(grasp.T_object_hand * Eigen::Translation3d(beside * hand_.closing) * T_tool_root_);
      return sides_touching(checker) > 0;
    };
    return !touches_at(-slack) && !touches_at(slack);
  }

 private:
  bool meets_from(const Pose& T_part_tool, double opening) {
    const Pose T_world_root = T_part_tool * T_tool_root_;
    const double narrowest = verify::narrowest_grip(opening);
    for (int i = 0; i <= kSteps; ++i) {  // The farther they are closed, the more fingers meet, for most parts.
      CollisionChecker& checker = at_opening(narrowest + (opening - narrowest) * i / kSteps);
      checker.set_root(T_world_root);
      if (sides_touching(checker) == 2) return true;
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
  /// Finger links on either side of the middle between the outermost ones, along the closing axis of the open hand.
  void find_sides() {
    const Robot& robot = arm_.robot();
    Poses poses;
    const JointGroup opened = detail::arm_with_opening(arm_, hand_, hand_.max_opening);
    opened.link_poses(q_, poses);
    const Pose T_tool_world = poses[arm_.tip_link()].inverse(Eigen::Isometry);
    std::map<std::string, double> place;
    double low = detail::kInfinity, high = -detail::kInfinity;
    for (const std::string& finger : hand_.finger_links) {
      const int link = robot.link_index(finger);
      Eigen::AlignedBox3d bounds;
      for (const LinkShape& shape : robot.links()[link].collisions)
        bounds.extend(shape_bounds(shape.shape, T_tool_world * poses[link] * shape.T_link_shape));
      const double at = bounds.isEmpty() ? 0 : hand_.closing.dot(bounds.center());
      place[finger] = at;
      low = std::min(low, at);
      high = std::max(high, at);
    }
    for (const auto& [finger, at] : place) side_[finger] = at > (low + high) / 2;
  }
  int sides_touching(CollisionChecker& checker) const {
    bool touched[2] = {false, false};
    for (const Contact& contact : checker.contacts(q_)) {
      if (const auto found = side_.find(contact.a); found != side_.end()) touched[found->second] = true;
    }
    return touched[0] + touched[1];
  }

  const Hand& hand_;
  JointGroup arm_;
  Eigen::VectorXd q_;
  Pose T_tool_root_;
  CollisionChecker checker_;
  std::map<std::string, bool> side_;         ///< On which side each finger link is.
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

/// Asks of each grasp by a hand with fingers; those of cups are fine.
template <typename Ask>
std::vector<bool> asked(const JointGroup& arm, const Hand& hand, const std::vector<LinkShape>& part,
                        const std::vector<Grasp>& grasps, double mesh_tolerance, const Ask& ask) {
  if (hand.suction) return std::vector<bool>(grasps.size(), true);
  check_grasps(arm, hand, grasps, mesh_tolerance);
  if (grasps.empty()) return {};
  ClosingHand closing(arm, hand, part);
  std::vector<bool> answers;
  for (const Grasp& grasp : grasps) {
    detail::throw_if_interrupted();
    answers.push_back(ask(closing, grasp));
  }
  return answers;
}

}  // namespace

std::vector<bool> fingers_meet(const JointGroup& arm, const Hand& hand, const std::vector<LinkShape>& part,
                               const std::vector<Grasp>& grasps, double mesh_tolerance) {
  return asked(arm, hand, part, grasps, mesh_tolerance, [&](ClosingHand& closing, const Grasp& grasp) {
    return closing.meets(grasp, kGraspSlack + mesh_tolerance);
  });
}

std::vector<bool> fingers_fit(const JointGroup& arm, const Hand& hand, const std::vector<LinkShape>& part,
                              const std::vector<Grasp>& grasps, double mesh_tolerance) {
  return asked(arm, hand, part, grasps, mesh_tolerance, [&](ClosingHand& closing, const Grasp& grasp) {
    return closing.fits(grasp, kGraspSlack, verify::grip_play(grasp.opening) + mesh_tolerance);
  });
}

}  // namespace mmgrasp
