#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "mmgrasp/task/base_region.hpp"
#include "mmgrasp/task/part_supply.hpp"

namespace mmgrasp::test {

/// A robot made of boxes and cylinders: a diff-drive base with a bin, six joints, two fingers; the tcp's z is the
/// approach.
inline std::string small_robot_urdf() {
  const auto link = [](const std::string& name, const std::string& geometry, const std::string& xyz) {
    return "<link name='" + name + "'><collision><origin xyz='" + xyz + "'/><geometry>" + geometry +
           "</geometry></collision></link>";
  };
  const auto box = [](const std::string& size) { return "<box size='" + size + "'/>"; };
  const auto joint = [](const std::string& name, const std::string& type, const std::string& parent,
                        const std::string& child, const std::string& xyz, const std::string& axis,
                        const std::string& lower, const std::string& upper) {
    return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent + "'/><child link='" + child +
           "'/><origin xyz='" + xyz + "'/><axis xyz='" + axis + "'/><limit lower='" + lower + "' upper='" + upper +
           "' velocity='1.5' effort='50'/></joint>";
  };
  return "<robot name='small'>" + link("base_link", box("0.40 0.40 0.30"), "0 0 0.20") +
         link("bin", box("0.20 0.24 0.10"), "0 0 -0.05") +
         link("shoulder", "<cylinder radius='0.05' length='0.10'/>", "0 0 0.06") +
         link("upper", box("0.06 0.06 0.30"), "0 0 0.17") + link("fore", box("0.05 0.05 0.26"), "0 0 0.14") +
         link("wrist", box("0.05 0.05 0.06"), "0 0 0.03") + link("knuckle", box("0.05 0.05 0.05"), "0 0 0.03") +
         link("hand", box("0.05 0.12 0.03"), "0 0 0.02") + link("left_finger", box("0.02 0.01 0.05"), "0 0.006 0.065") +
         link("right_finger", box("0.02 0.01 0.05"), "0 -0.006 0.065") + "<link name='tcp'/>" +
         "<joint name='bin_mount' type='fixed'><parent link='base_link'/><child link='bin'/><origin xyz='-0.10 0 "
         "0.46'/></joint>" +
         joint("pan", "revolute", "base_link", "shoulder", "0.10 0 0.35", "0 0 1", "-2.9", "2.9") +
         joint("lift", "revolute", "shoulder", "upper", "0 0 0.14", "0 1 0", "-1.8", "1.8") +
         joint("elbow", "revolute", "upper", "fore", "0 0 0.35", "0 1 0", "-2.5", "2.5") +
         joint("roll", "revolute", "fore", "wrist", "0 0 0.30", "0 0 1", "-2.9", "2.9") +
         joint("pitch", "revolute", "wrist", "knuckle", "0 0 0.08", "0 1 0", "-1.9", "1.9") +
         joint("twist", "continuous", "knuckle", "hand", "0 0 0.07", "0 0 1", "0", "0") +
         joint("left", "prismatic", "hand", "left_finger", "0 0 0", "0 1 0", "0", "0.04") +
         joint("right", "prismatic", "hand", "right_finger", "0 0 0", "0 -1 0", "0", "0.04") +
         "<joint name='tcp_mount' type='fixed'><parent link='hand'/><child link='tcp'/><origin xyz='0 0 "
         "0.075'/></joint></robot>";
}

inline Shape box_shape(double x, double y, double z) {
  return Box{Eigen::Vector3d(x, y, z)};
}

inline Pose at(double x, double y, double z) {
  Pose T = Pose::Identity();
  T.translation() = Eigen::Vector3d(x, y, z);
  return T;
}

/// Grasps from above, turned about the vertical, upright and tilted.
inline std::vector<Grasp> grasps_from_above(double width) {
  std::vector<Grasp> grasps;
  for (double tilt : {0.0, 0.5, -0.5}) {
    for (int quarter = 0; quarter < 4; ++quarter) {
      Grasp grasp;
      grasp.opening = width;
      grasp.T_object_hand.linear() = (Eigen::AngleAxisd(0.5 * M_PI * quarter, Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(M_PI + tilt, Eigen::Vector3d::UnitY()))
                                         .toRotationMatrix();
      grasp.T_object_hand.translation().z() = 0.01;
      grasp.quality = tilt == 0 ? 1 : 0.5;
      grasps.push_back(grasp);
    }
  }
  return grasps;
}

inline Tray small_tray(const std::string& name, double x, double y, int parts) {
  Tray tray;
  tray.name = name;
  tray.T_world_tray = at(x, y, 0.44);
  tray.size = Eigen::Vector3d(0.2, 0.2, 0.05);
  for (int i = 0; i < parts; ++i) {
    Part part;
    part.name = name + "/block_" + std::to_string(i);
    LinkShape shape;
    shape.shape = box_shape(0.03, 0.03, 0.06);
    part.shapes = {shape};
    part.T_world_part = at(x, y + 0.12 * (i - 0.5 * (parts - 1)), 0.471);
    part.grasps = grasps_from_above(0.03);
    tray.parts.push_back(part);
  }
  return tray;
}

/// A table along x = 0.9 with trays A and B on it, 0.3 m apart.
inline PartSupplyProblem small_storeroom(int parts_per_tray = 2) {
  RobotOptions options;
  options.base = BaseKind::diff_drive;
  const Robot robot = Robot::from_strings(small_robot_urdf(), "", options, "small");
  Hand gripper;
  gripper.tool_link = "tcp";
  gripper.approach = Eigen::Vector3d::UnitZ();
  gripper.closing = Eigen::Vector3d::UnitY();
  gripper.max_opening = 0.08;
  gripper.joints = {{"left", 0.0, 0.04}, {"right", 0.0, 0.04}};
  gripper.finger_links = {"left_finger", "right_finger"};
  Eigen::VectorXd home(6);
  home << 0.0, -0.9, 2.2, 0.0, 0.9, 0.0;
  PartSupplyProblem problem{robot,
                            robot.chain("base_link", "tcp"),
                            gripper,
                            World(),
                            {},
                            home,
                            Eigen::Vector3d::Zero(),
                            Eigen::Vector3d::Zero(),
                            PlaceRegion(),
                            PartSupplyOptions()};
  problem.world.add("table", box_shape(0.30, 1.2, 0.04), at(0.9, 0.0, 0.42));
  problem.trays = {small_tray("A", 0.88, -0.15, parts_per_tray), small_tray("B", 0.88, 0.15, parts_per_tray)};
  problem.start = Eigen::Vector3d(-0.8, 0.5, 0);
  problem.goal = Eigen::Vector3d(-0.8, -0.5, 3.0);
  problem.place_region.T_base_bin = at(-0.10, 0, 0.46);
  problem.place_region.size = Eigen::Vector2d(0.18, 0.22);
  problem.options.grid.resolution = 0.05;
  problem.options.positioning_uncertainty = 0.04;
  problem.options.approach_distance = 0.05;
  problem.options.lift_height = 0.08;
  problem.options.robustness_samples = 200;
  return problem;
}

inline ReachDatabase small_database(const PartSupplyProblem& problem) {
  ReachOptions options;
  options.samples = 300000;
  return ReachDatabase::build(problem.arm, options);
}

/// The small storeroom's regions on a grid of 8 cm, computed once for all tests of a suite.
class SmallRegions : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { set_up(small_storeroom()); }
  static void set_up(const PartSupplyProblem& problem) {
    problem_ = new PartSupplyProblem(problem);
    problem_->options.grid.resolution = 0.08;
    database_ = new ReachDatabase(small_database(*problem_));
    grid_ = new BaseGrid(make_base_grid(*problem_, *database_));
    regions_ = new std::vector<BaseRegion>(compute_base_regions(*problem_, *database_, *grid_));
  }
  static void TearDownTestSuite() {
    delete regions_;
    delete grid_;
    delete database_;
    delete problem_;
  }

  inline static PartSupplyProblem* problem_ = nullptr;
  inline static ReachDatabase* database_ = nullptr;
  inline static BaseGrid* grid_ = nullptr;
  inline static std::vector<BaseRegion>* regions_ = nullptr;
};

}  // namespace mmgrasp::test
