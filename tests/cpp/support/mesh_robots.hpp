#pragma once

#include <string>
#include <vector>

#include "mmgrasp/collision/disabled_pairs.hpp"
#include "mmgrasp/robot/joint_group.hpp"
#include "support/robot_support.hpp"

/// Arms with their collision meshes. Where no SRDF says which links never touch, the pairs are sampled.
namespace mmgrasp::testing_support {

struct MeshArm {
  std::string name;
  JointGroup group;
  double reach;      ///< Of the arm, from the root's z axis [m].
  double low, high;  ///< Where the arm works [m].
};

inline Robot sampled_pairs(const Robot& robot) {
  DisabledPairsOptions options;
  options.samples = 1000;
  return compute_disabled_pairs(robot, options);
}

inline MeshArm panda_arm() {
  RobotOptions options;
  options.package_dirs["moveit_resources_panda_description"] =
      shared("robots/panda/moveit_resources_panda_description");
  const Robot robot =
      Robot::load(shared("robots/panda/expanded/panda.urdf"),
                  shared("robots/panda/moveit_resources_panda_moveit_config/config/panda.srdf"), options);
  return {"Panda", robot.group("panda_arm"), 0.85, 0, 1.1};
}

inline MeshArm ur5_arm() {
  const Robot robot = Robot::load(shared("robots/ur5_vamp/ur5/ur5.urdf"), shared("robots/ur5_vamp/ur5/ur5.srdf"));
  return {"UR5", robot.group("manipulator"), 0.9, 0, 1.9};
}

inline MeshArm ur5e_arm() {
  RobotOptions options;
  options.package_dirs["ur_description"] = shared("robots/ur/ur_description");
  const Robot robot = Robot::load(shared("robots/ur/expanded/ur5e.urdf"),
                                  shared("robots/ur/ur5e_moveit_config/config/ur5e.srdf"), options);
  return {"UR5e", robot.group("manipulator"), 0.9, 0, 1.0};
}

inline MeshArm iiwa_arm() {
  RobotOptions options;
  options.package_dirs["kuka_lbr_iiwa_support"] = shared("robots/kuka_iiwa/kuka_lbr_iiwa_support");
  const Robot robot = sampled_pairs(
      Robot::load(shared("robots/kuka_iiwa/kuka_lbr_iiwa_support/urdf/lbr_iiwa_14_r820.urdf"), "", options));
  return {"iiwa", robot.chain("base_link", "tool0"), 0.9, 0, 1.2};
}

inline MeshArm tiago_arm(BaseKind base = BaseKind::fixed) {
  RobotOptions options;
  options.base = base;
  options.package_dirs["example-robot-data"] = shared("robots/tiago/example-robot-data");
  const Robot robot = sampled_pairs(Robot::load(
      shared("robots/tiago/example-robot-data/robots/tiago_description/robots/tiago_no_hand.urdf"), "", options));
  return {"TIAGo", robot.chain("torso_fixed_link", "arm_7_link", base != BaseKind::fixed), 1.0, 0.1, 1.4};
}

inline MeshArm omni6_arm() {
  RobotOptions options;
  options.base = BaseKind::omni;
  const std::string folder = std::string(MMGRASP_ASSETS) + "/robots/omni6/omni6";
  const Robot robot = Robot::load(folder + ".urdf", folder + ".srdf", options);
  return {"omni6", robot.group(robot.groups().front().name, "", true), 1.0, 0.1, 1.5};
}

}  // namespace mmgrasp::testing_support
