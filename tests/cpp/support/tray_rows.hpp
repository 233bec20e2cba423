#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "mmgrasp/collision/disabled_pairs.hpp"
#include "mmgrasp/task/problem.hpp"

/// Rows of trays in front of whole mobile manipulators, as P1 3.6 sets them up (figure 3.12). Paths are those of the
/// shipped assets and of the shared data.
namespace mmgrasp::testing_support {

struct MobileManipulator {
  std::string name;
  JointGroup arm;
  Hand gripper;
  Eigen::VectorXd home;
};

inline Eigen::VectorXd home_of(const JointGroup& arm, const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), arm.size());
}

inline MobileManipulator fetchlike(const std::string& assets) {
  RobotOptions options;
  options.base = BaseKind::diff_drive;
  const Robot robot =
      Robot::load(assets + "/robots/fetchlike/fetchlike.urdf", assets + "/robots/fetchlike/fetchlike.srdf", options);
  Hand gripper;
  gripper.tool_link = "gripper_tcp";
  gripper.max_opening = 0.10;
  gripper.finger_depth = 0.04;
  gripper.finger_width = 0.022;
  gripper.clearance = 0.01;
  gripper.joints = {{"left_gripper_finger_joint", 0.0, 0.05}, {"right_gripper_finger_joint", 0.0, 0.05}};
  gripper.finger_links = {"left_gripper_finger_link", "right_gripper_finger_link"};
  const JointGroup arm =
      robot.group("arm_with_torso", "gripper_tcp").with_reference(robot.values({{"head_tilt_joint", 0.4}}));
  return {"Fetch-like", arm, gripper, home_of(arm, {0.05, 1.2, -1.2, -0.2, -1.3, 0.0, -1.6, 0.0})};
}

/// The Robotiq 2F-85 with the tool centre point between its pads.
inline Robot with_two_finger_gripper(const Robot& robot, const std::string& data, const std::string& link,
                                     const Pose& T_link_gripper) {
  RobotOptions options;
  options.package_dirs["robotiq_arg85_description"] = data + "/robots/robotiq_2f85/robotiq_arg85_description";
  const Robot hand = Robot::load(
      data + "/robots/robotiq_2f85/robotiq_arg85_description/robots/robotiq_arg85_description.URDF", "", options);
  Pose T = Pose::Identity();
  T.translation().z() = 0.146;
  const Robot whole =
      robot.mount(hand, link, T_link_gripper, "gripper_").with_link("tcp", "gripper_robotiq_85_base_link", T);
  DisabledPairsOptions pairs;
  pairs.samples = 2000;
  return compute_disabled_pairs(whole, pairs);
}

inline Hand two_finger_gripper() {
  Hand gripper;
  gripper.tool_link = "tcp";
  gripper.approach = Eigen::Vector3d::UnitZ();
  gripper.closing = Eigen::Vector3d::UnitX();
  gripper.max_opening = 0.078;
  gripper.finger_depth = 0.05;
  gripper.finger_width = 0.022;
  gripper.clearance = 0.008;
  gripper.joints = {{"gripper_finger_joint", 0.725, 0.0}};
  for (const char* side : {"left", "right"}) {
    for (const char* piece : {"inner_finger", "outer_finger", "inner_knuckle", "outer_knuckle"})
      gripper.finger_links.push_back(std::string("gripper_") + side + "_" + piece);
  }
  return gripper;
}

inline MobileManipulator tiago_with_gripper(const std::string& data) {
  RobotOptions options;
  options.base = BaseKind::diff_drive;
  options.package_dirs["example-robot-data"] = data + "/robots/tiago/example-robot-data";
  const Robot bare =
      Robot::load(data + "/robots/tiago/example-robot-data/robots/tiago_description/robots/tiago_no_hand.urdf",
                  data + "/robots/tiago/tiago_moveit_config/config/srdf/tiago_no-ee.srdf", options);
  Pose T = Pose::Identity();
  T.linear() = Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitY()).toRotationMatrix();
  T.translation().x() = 0.004;
  const Robot robot = with_two_finger_gripper(bare, data, "wrist_ft_tool_link", T);
  const JointGroup arm = robot.group("arm_torso", "tcp").with_reference(robot.values({{"head_2_joint", -0.6}}));
  return {"TIAGo", arm, two_finger_gripper(), home_of(arm, {0.3, 0.3, -1.47, -0.23, 2.25, 0.52, -0.8, 1.93})};
}

inline MobileManipulator ur10e_on_ridgeback(const std::string& data) {
  RobotOptions options;
  options.base = BaseKind::omni;
  options.package_dirs["ridgeback_description"] = data + "/robots/ridgeback/ridgeback_description";
  options.package_dirs["ur_description"] = data + "/robots/ur/ur_description";
  const Robot platform = Robot::load(data + "/robots/ridgeback/expanded/ridgeback.urdf", "", options);
  const Robot ur = Robot::load(data + "/robots/ur/expanded/ur10e.urdf",
                               data + "/robots/ur/ur10e_moveit_config/config/ur10e.srdf", options);
  Pose T = Pose::Identity(), T_gripper = Pose::Identity();
  T.translation() = Eigen::Vector3d(0.20, 0, 0.005);
  T_gripper.translation().z() = 0.004;
  const Robot robot = with_two_finger_gripper(platform.mount(ur, "mid_mount", T, "ur_"), data, "ur_tool0", T_gripper);
  const JointGroup arm = robot.chain("ur_base_link", "tcp");
  return {"UR10e on Ridgeback", arm, two_finger_gripper(), home_of(arm, {0.0, -2.92, 2.35, -1.6, -1.58, 0.0})};
}

struct RowOptions {
  int trays = 1;
  double spacing = 0.6;       ///< Between the trays' middles [m].
  int rows = 1, columns = 1;  ///< Objects along the tray's depth and width.
  double floor = 0.706;       ///< Height of the trays' floor [m].
  int grasps = 1;             ///< From above, turned about the vertical.
  double tool_height = 0.05;  ///< Of the tool centre point over the trays' floor [m].
};

/// Trays of 30 x 40 cm side by side on one table, the robot looking along +x; one grasp from above for each object.
/// Objects are small enough that the densest grid of P1's table 3.1 fits, and tools stay above their neighbours.
inline PartSupplyProblem tray_row(const MobileManipulator& robot, const RowOptions& row) {
  constexpr double kDepth = 0.30, kWidth = 0.40, kWall = 0.03, kThick = 0.006, kMargin = 0.04, kPart = 0.008;
  const auto at = [](double x, double y, double z) {
    Pose T = Pose::Identity();
    T.translation() = Eigen::Vector3d(x, y, z);
    return T;
  };
  PartSupplyProblem problem{
      robot.arm.robot(),         robot.arm,     robot.gripper,      World(), {}, robot.home, Eigen::Vector3d(-3, 0, 0),
      Eigen::Vector3d(-3, 0, 0), PlaceRegion(), PartSupplyOptions()};
  const double length = (row.trays - 1) * row.spacing;
  problem.world.add("table", Box{Eigen::Vector3d(0.40, length + 0.60, 0.03)}, at(1.0, 0.5 * length, row.floor - 0.021));
  Eigen::Matrix3d tool, world;
  tool << robot.gripper.approach, robot.gripper.closing, robot.gripper.approach.cross(robot.gripper.closing);
  const auto spread = [](int i, int count, double size) {
    return count == 1 ? 0.0 : (static_cast<double>(i) / (count - 1) - 0.5) * (size - 2 * kMargin);
  };
  for (int t = 0; t < row.trays; ++t) {
    Tray tray;
    tray.name = "tray " + std::to_string(t);
    tray.T_world_tray = at(1.0, t * row.spacing, row.floor);
    tray.size = Eigen::Vector3d(kDepth, kWidth, kWall);
    WorldObject walls;
    const auto add = [&walls, &at](double x, double y, double z, double sx, double sy, double sz) {
      LinkShape shape;
      shape.shape = Box{Eigen::Vector3d(sx, sy, sz)};
      shape.T_link_shape = at(x, y, z);
      walls.shapes.push_back(shape);
    };
    add(0, 0, -0.5 * kThick, kDepth, kWidth, kThick);
    for (const double side : {-1.0, 1.0}) {
      add(0.5 * side * kDepth, 0, 0.5 * kWall, kThick, kWidth, kWall);
      add(0, 0.5 * side * kWidth, 0.5 * kWall, kDepth, kThick, kWall);
    }
    walls.T_world_object = tray.T_world_tray;
    problem.world.add(tray.name, walls);
    for (int i = 0; i < row.rows; ++i) {
      for (int j = 0; j < row.columns; ++j) {
        Part part;
        part.name = tray.name + "/" + std::to_string(i) + "," + std::to_string(j);
        LinkShape shape;
        shape.shape = Box{Eigen::Vector3d(kPart, kPart, 0.02)};
        part.shapes = {shape};
        part.T_world_part = tray.T_world_tray * at(spread(i, row.rows, kDepth), spread(j, row.columns, kWidth), 0.01);
        for (int g = 0; g < row.grasps; ++g) {
          const double turn = M_PI * g / row.grasps, c = std::cos(turn), s = std::sin(turn);
          world << 0, -s, c, 0, c, s, -1, 0, 0;  // down; along the closing; their cross product
          Grasp grasp;
          grasp.opening = kPart;
          grasp.T_object_hand.linear() = world * tool.transpose();
          grasp.T_object_hand.translation().z() = row.tool_height - 0.01;
          part.grasps.push_back(grasp);
        }
        tray.parts.push_back(part);
      }
    }
    problem.trays.push_back(tray);
  }
  return problem;
}

}  // namespace mmgrasp::testing_support
