#include "task/part_supply/impossible.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kTolerance = 1e-3;  // [m] More than inverse kinematics may miss a pose by.

/// A sphere that holds the tool in every arm configuration: around the first joint of the arm, seen from the base.
struct Reach {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// Consecutive joints keep their distance, but for what slides between them.
Reach longest_reach(const JointGroup& arm, const Eigen::VectorXd& q) {
  const Poses links = arm.robot().link_poses(arm.full_values(q));
  Reach reach;
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (int column = 0; column < arm.size(); ++column) {
    const Joint& joint = arm.robot().joints()[arm.joints()[column]];
    const Eigen::Vector3d origin = (links[joint.parent_link] * joint.T_parent_joint).translation();
    if (column == 0) {
      reach.centre = origin;
    } else {
      reach.radius += (origin - last).norm();
    }
    if (joint.type == JointType::planar || joint.type == JointType::floating) reach.radius = kInfinity;
    if (joint.type == JointType::prismatic) reach.radius += arm.upper()[column] - arm.lower()[column];
    last = origin;
  }
  reach.radius += (links[arm.tip_link()].translation() - last).norm();
  for (const Joint& joint : arm.robot().joints()) {
    const auto followed = std::find(arm.joints().begin(), arm.joints().end(), joint.mimic_joint);
    if (joint.mimic_joint >= 0 && followed != arm.joints().end()) reach.radius = kInfinity;
  }
  return reach;
}

/// Wherever the base stands in its workspace, and however it is turned.
bool beyond(const Reach& reach, double workspace, const Eigen::Vector3d& tool) {
  const double aside =
      std::hypot(std::max(std::abs(tool.x()) - workspace, 0.0), std::max(std::abs(tool.y()) - workspace, 0.0)) -
      reach.centre.head<2>().norm();
  return std::hypot(std::max(aside, 0.0), tool.z() - reach.centre.z()) > reach.radius + kTolerance;
}

/// How far from the part's origin any hand that holds it may have its tool: its surface lies between the pads. The
/// grasps that were drawn, perhaps with a standoff, are not farther.
double farthest_tool(const PartSupplyProblem& problem, const Part& part) {
  double around = 0, drawn = 0;
  for (const LinkShape& shape : part.shapes) {
    const Eigen::AlignedBox3d box = shape_bounds(shape.shape, shape.T_link_shape);
    around = std::max(around, box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm());
  }
  for (const Grasp& grasp : part.grasps) drawn = std::max(drawn, grasp.T_object_hand.translation().norm());
  return std::max(drawn, around + problem.gripper.max_opening + problem.gripper.finger_depth);
}

}  // namespace

bool grasp_is_impossible(const PartSupplyProblem& problem, const BasePoseEvaluator& evaluator, TrayId tray) {
  const Reach reach = longest_reach(problem.arm, problem.home);
  const double workspace = problem.robot.base_limits().workspace;
  for (const PartRef& target : target_parts(problem, tray)) {
    std::vector<PartRef> others = all_parts(problem);
    others.erase(std::remove(others.begin(), others.end(), target), others.end());
    const BasePoseEvaluator alone = evaluator.without(others);
    const Part& part = part_of(problem, target);
    if (part.grasps_sampled) {
      Reach farther = reach;
      farther.radius += farthest_tool(problem, part);
      if (beyond(farther, workspace, part.T_world_part.translation())) return true;
      continue;
    }
    bool possible = false;
    for (int g = 0; g < static_cast<int>(part.grasps.size()) && !possible; ++g) {
      const Eigen::Vector3d tool = (part.T_world_part * part.grasps[g].T_object_hand).translation();
      possible = !beyond(reach, workspace, tool) && !alone.hand_blocked(target, g);
    }
    if (!possible) return true;
  }
  return false;
}

}  // namespace mmgrasp::detail
