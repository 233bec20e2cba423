#pragma once

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/robot.hpp"
#include "mmgrasp/verify/plan_check.hpp"

/// A world small enough to plan by hand: a gantry on wheels, two tables, four cubes, every motion in closed form.
namespace tiny {

using mmgrasp::Pose;
using namespace mmgrasp::verify;

constexpr double kCube = 0.04;  // Edge of a part [m].
constexpr double kTableTop = 0.50;
constexpr double kPartZ = kTableTop + 0.001 + 0.5 * kCube;
constexpr double kBinTop = 0.40;
constexpr double kDropHeight = 0.03;
constexpr double kHandAbove = 0.02;  // Origin of the hand over the tcp [m].

/// Joints z, x, y (prismatic), tilt (about y), yaw (about z): the hand's origin lies at (0.1 + x, y, 0.9 + z) in the
/// root frame. The z joint's frame is turned so that a wrong frame order shows. The right finger follows the left one.
inline std::string urdf(double x_upper = 0.8) {
  return R"(<robot name="gantry">
  <link name="base"><collision><origin xyz="0 0 0.2"/><geometry><box size="0.4 0.4 0.3"/></geometry></collision></link>
  <link name="mast"/><link name="boom"/><link name="slide"/><link name="wrist"/>
  <link name="hand"><collision><origin xyz="0 0 0.08"/><geometry><box size="0.08 0.12 0.06"/></geometry></collision></link>
  <link name="left"><collision><origin xyz="0 0.005 0"/><geometry><box size="0.02 0.01 0.08"/></geometry></collision></link>
  <link name="right"><collision><origin xyz="0 -0.005 0"/><geometry><box size="0.02 0.01 0.08"/></geometry></collision></link>
  <link name="tcp"/>
  <joint name="z" type="prismatic"><parent link="base"/><child link="mast"/><origin xyz="0.1 0 0.9" rpy="0 1.5707963267948966 0"/>
    <axis xyz="-1 0 0"/><limit lower="-0.7" upper="0.5" velocity="1" effort="1"/></joint>
  <joint name="x" type="prismatic"><parent link="mast"/><child link="boom"/><origin rpy="0 -1.5707963267948966 0"/>
    <axis xyz="1 0 0"/><limit lower="-0.2" upper=")" +
         std::to_string(x_upper) + R"(" velocity="1" effort="1"/></joint>
  <joint name="y" type="prismatic"><parent link="boom"/><child link="slide"/><axis xyz="0 1 0"/>
    <limit lower="-0.5" upper="0.5" velocity="1" effort="1"/></joint>
  <joint name="tilt" type="revolute"><parent link="slide"/><child link="wrist"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
  <joint name="yaw" type="revolute"><parent link="wrist"/><child link="hand"/><axis xyz="0 0 1"/>
    <limit lower="-3.1" upper="3.1" velocity="1" effort="1"/></joint>
  <joint name="finger" type="prismatic"><parent link="hand"/><child link="left"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.05" velocity="1" effort="1"/></joint>
  <joint name="finger_mirror" type="prismatic"><parent link="hand"/><child link="right"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="0.05" velocity="1" effort="1"/><mimic joint="finger"/></joint>
  <joint name="to_tcp" type="fixed"><parent link="hand"/><child link="tcp"/><origin xyz="0 0 -0.02"/></joint>
</robot>)";
}

inline std::string srdf() {
  return R"(<robot name="gantry"><disable_collisions link1="left" link2="right" reason="Adjacent"/></robot>)";
}

inline mmgrasp::LinkShape box_shape(double x, double y, double z) {
  mmgrasp::LinkShape shape;
  shape.shape = mmgrasp::Box{Eigen::Vector3d(x, y, z)};
  return shape;
}

inline Pose at(double x, double y, double z) {
  Pose T = Pose::Identity();
  T.translation() = Eigen::Vector3d(x, y, z);
  return T;
}

inline CheckedBody box(const std::string& name, const Eigen::Vector3d& size, const Pose& T) {
  return {name, {box_shape(size.x(), size.y(), size.z())}, T};
}

/// Straight in joint space along 3 u^2 - 2 u^3: at rest at both ends, and a cubic, so that interpolation is exact.
inline CheckedMotion straight(const std::string& kind, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                              double opening, bool holding) {
  CheckedMotion motion{kind, opening, holding, {}, {}, {}};
  const Eigen::VectorXd d = to - from;
  const double length = d.cwiseAbs().maxCoeff();
  const double T = std::max(1.5 * length / 0.9, std::sqrt(6 * length / 1.8));  // limits are 1 and 2
  constexpr int kSamples = 20;
  for (int i = 0; i <= kSamples; ++i) {
    const double u = static_cast<double>(i) / kSamples;
    motion.times.push_back(u * T);
    motion.positions.push_back(from + (3 * u * u - 2 * u * u * u) * d);
    motion.velocities.push_back((6 * u - 6 * u * u) / T * d);
  }
  return motion;
}

/// What a test may do differently from the good plan.
struct Variation {
  double x_upper = 0.8;     // Upper limit of joint x.
  double grasp_height = 0;  // The tcp stays this far over the part's middle.
  double lift = 0.12;
  double release_dx = 0, release_dz = 0, release_tilt = 0;
  double approach_dx = 0;  // The pre-grasp is this far aside.
};

inline Eigen::VectorXd joints(double z, double x, double y, double tilt = 0, double yaw = 0) {
  Eigen::VectorXd q(5);
  q << z, x, y, tilt, yaw;
  return q;
}

/// The arm with its tcp at a world point, upright, for a base at heading 0.
inline Eigen::VectorXd over(const Eigen::Vector3d& base, const Eigen::Vector3d& point) {
  return joints(point.z() + kHandAbove - 0.9, point.x() - base.x() - 0.1, point.y() - base.y());
}

inline CheckedPick make_pick(const PlanToCheck& plan, int stop, int part_index, const Variation& how) {
  const CheckedPart& part = plan.parts[part_index];
  const Eigen::Vector3d& base = plan.stops[stop].pose;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d grasp = part.body.T_world_body.translation() + how.grasp_height * up;
  const Eigen::VectorXd at_grasp = over(base, grasp), lifted = over(base, grasp + how.lift * up);
  const Eigen::VectorXd above = over(base, grasp + 0.08 * up + how.approach_dx * Eigen::Vector3d::UnitX());
  Eigen::VectorXd release = joints(kBinTop + kDropHeight + 0.5 * kCube + how.grasp_height + kHandAbove - 0.9, 0, 0);
  release += joints(how.release_dz, how.release_dx, 0, how.release_tilt);
  const double width = part.grasps[0].opening, wide = width + 0.02;
  return {stop,
          part.tray,
          part.body.name,
          0,
          {straight("transit", plan.home, above, wide, false), straight("approach", above, at_grasp, wide, false),
           straight("lift", at_grasp, lifted, width, true), straight("transfer", lifted, release, width, true),
           straight("retreat", release, plan.home, wide, false)}};
}

inline CheckedPart make_part(const std::string& name, const std::string& tray, double x, double y, bool target,
                             double grasp_height) {
  CheckedPart part;
  part.body = box(name, Eigen::Vector3d::Constant(kCube), at(x, y, kPartZ));
  part.tray = tray;
  part.target = target;
  Pose turned = at(0, 0, grasp_height);
  turned.rotate(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  part.grasps = {{at(0, 0, grasp_height), kCube}, {turned, kCube}};
  return part;
}

/// Cells of one tray: the square of 0.4 m around (0.4, y).
inline CheckedRegion square_region(const CheckedGrid& grid, const std::string& tray, double y) {
  CheckedRegion region{tray, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.nx) * grid.ny, 0)};
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      const Eigen::Vector2d c = grid.origin + grid.resolution * Eigen::Vector2d(ix + 0.5, iy + 0.5);
      if (std::abs(c.x() - 0.4) < 0.2 && std::abs(c.y() - y) < 0.2) region.cells[iy * grid.nx + ix] = 1;
    }
  }
  return region;
}

inline void add_robot_data(PlanToCheck& plan) {
  plan.arm_joints = {"z", "x", "y", "tilt", "yaw"};
  plan.velocity_limits = std::vector<double>(5, 1.0);
  plan.acceleration_limits = std::vector<double>(5, 2.0);
  plan.tip_link = "tcp";
  plan.approach = -Eigen::Vector3d::UnitZ();
  plan.fingers = {{"finger", 0.0, 0.05}};
  plan.finger_links = {"left", "right"};
  plan.home = joints(0.3, 0, 0);
  plan.T_base_bin = at(0.1, 0, kBinTop);
  plan.drop_height = kDropHeight;
}

inline void add_scene(PlanToCheck& plan, const Variation& how) {
  plan.obstacles = {box("table A", {0.4, 0.8, 0.02}, at(0.9, 0, kTableTop - 0.01)),
                    box("table B", {0.4, 0.8, 0.02}, at(0.9, 3, kTableTop - 0.01)),
                    box("wall", {0.1, 6, 2}, at(2, 1.5, 1))};
  plan.trays = {"A", "B"};
  plan.parts = {make_part("A/cube_0", "A", 0.9, 0.1, true, how.grasp_height),
                make_part("A/cube_1", "A", 0.9, -0.1, true, how.grasp_height),
                make_part("A/stay_0", "A", 0.9, 0.25, false, how.grasp_height),
                make_part("B/cube_0", "B", 0.9, 3, true, how.grasp_height)};
}

inline void add_stops_and_route(PlanToCheck& plan) {
  plan.start = {-1, 0, 0};
  plan.goal = {-1, 3, 0};
  plan.grid = {Eigen::Vector2d(0, -0.5), 0.05, 20, 100, {0.0}};
  plan.regions = {square_region(plan.grid, "A", 0), square_region(plan.grid, "B", 3)};
  plan.stops = {{Eigen::Vector3d(0.4, 0, 0), 0.2, {"A"}}, {Eigen::Vector3d(0.4, 3, 0), 0.2, {"B"}}};
  plan.lower_bound = 2;
  const Eigen::Vector3d a = plan.stops[0].pose, b = plan.stops[1].pose, quarter(0, 0, M_PI / 2);
  plan.route = {{plan.start, a}, {a, a + quarter, b + quarter, b}, {b, plan.goal}};
}

inline PlanToCheck good_plan(const Variation& how = {}) {
  mmgrasp::RobotOptions options;
  options.base = mmgrasp::BaseKind::diff_drive;
  PlanToCheck plan{mmgrasp::source_of(mmgrasp::Robot::from_strings(urdf(how.x_upper), srdf(), options))};
  add_robot_data(plan);
  add_scene(plan, how);
  add_stops_and_route(plan);
  plan.picks = {make_pick(plan, 0, 0, how), make_pick(plan, 0, 1, how), make_pick(plan, 1, 3, how)};
  return plan;
}

/// The good plan's robot in an empty room, with a grid and nothing on it: for regions and stops alone.
inline PlanToCheck empty_plan(double uncertainty, const CheckedGrid& grid) {
  PlanToCheck plan = good_plan();
  plan.picks.clear();
  plan.parts.clear();
  plan.regions.clear();
  plan.trays.clear();
  plan.stops.clear();
  plan.route = {{plan.start}};
  plan.positioning_uncertainty = uncertainty;
  plan.grid = grid;
  return plan;
}

inline PlanCheckOptions quick() {
  PlanCheckOptions options;
  options.samples = 60;
  options.region_samples = 0;  // the regions are squares by hand, far smaller than what the arm reaches
  return options;
}

inline std::set<std::string> codes(const PlanCheckResult& result) {
  std::set<std::string> found;
  for (const Fault& fault : result.faults) found.insert(fault.code);
  return found;
}

inline std::set<std::string> codes_of(const PlanToCheck& plan) {
  return codes(check_plan(plan, quick()));
}

using Codes = std::set<std::string>;

}  // namespace tiny
