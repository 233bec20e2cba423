#include "mmgrasp/task/problem.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <set>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

constexpr std::size_t kMostHeadings = 360;  // of a tray
constexpr int kPosturesOfPart = 128;        // tried at a part at least

void check_part(const Part& part, const std::string& tray) {
  const std::string field = "part '" + part.name + "' in tray '" + tray + "'";
  require(!part.shapes.empty(), field + " shapes", "0", "must hold at least one");
  for (std::size_t i = 0; i < part.shapes.size(); ++i) {
    check_shape(part.shapes[i].shape, field + " shape " + std::to_string(i));
  }
  checked_pose(part.T_world_part.matrix(), field + " pose");
  require_within(part.mass, 0, 1e6, field + " mass", "kg");
  for (std::size_t i = 0; i < part.grasps.size(); ++i) {
    const std::string grasp = field + " grasp " + std::to_string(i);
    checked_pose(part.grasps[i].T_object_hand.matrix(), grasp + " pose");
    require_not_negative(part.grasps[i].opening, grasp + " width");
    require(part.grasps[i].posture.empty(), grasp + " posture",
            std::to_string(part.grasps[i].posture.size()) + " numbers", "must be empty: fingers pick by their opening");
  }
}

/// What hand and arm may carry; cups must know what they lift.
void check_load(const Hand& hand, const Part& part) {
  if (!part.target) return;
  const std::string field = "part '" + part.name + "' mass";
  require(part.mass <= hand.payload, field, part.mass,
          "must not exceed gripper.payload (" + std::to_string(hand.payload) + " kg)");
  require(!hand.suction || part.mass > 0, field, part.mass, "must be positive: suction cups hold by force");
}

void check_trays(const PartSupplyProblem& problem) {
  std::set<std::string> tray_names, part_names;
  for (const Tray& tray : problem.trays) {
    require(!tray.name.empty() && tray_names.insert(tray.name).second, "tray name", "'" + tray.name + "'",
            "must not be empty or used twice");
    const std::string field = "tray '" + tray.name + "'";
    checked_pose(tray.T_world_tray.matrix(), field + " pose");
    for (double length : tray.size) require_length(length, field + " size");
    require(tray.headings.size() <= kMostHeadings, field + " headings", static_cast<double>(tray.headings.size()),
            "must be at most 360: each is a layer of the base grid");
    for (double heading : tray.headings) require_number(heading, field + " headings");
    for (const Part& part : tray.parts) {
      require(!part.name.empty() && part_names.insert(part.name).second, "part name", "'" + part.name + "'",
              "must not be empty or used twice");
      require(!problem.world.has(part.name), "part name", "'" + part.name + "'",
              "is in use for an object of the scene");
      check_part(part, tray.name);
      check_load(problem.gripper, part);
      for (const Grasp& grasp : part.grasps) {
        require(grasp.opening <= problem.gripper.max_opening + 1e-9, "part '" + part.name + "' grasp width",
                grasp.opening,
                "must not exceed gripper.max_opening (" + std::to_string(problem.gripper.max_opening) + " m)");
      }
    }
  }
}

void check_place(const PartSupplyProblem& problem) {
  checked_pose(problem.place_region.T_base_bin.matrix(), "place_region.pose");
  for (double length : problem.place_region.size) require_length(length, "place_region.size");
  require_not_negative(problem.place_region.drop_height, "place_region.drop_height");
  require_within(problem.place_region.capacity, 0, 1e6, "place_region.capacity", "parts (0: all)");
  if (!problem.unload_region) return;
  const UnloadRegion& region = *problem.unload_region;
  checked_pose(region.T_world_region.matrix(), "unload_region.pose");
  require(region.T_world_region.linear()(2, 2) > 1 - 1e-9, "unload_region.pose", region.T_world_region.linear()(2, 2),
          "must be level: so much of its z axis points up");
  for (double length : region.size) require_length(length, "unload_region.size");
  require_not_negative(region.drop_height, "unload_region.drop_height");
  require(problem.place_region.capacity == 0, "place_region.capacity", problem.place_region.capacity,
          "must be 0 with an unload_region: the hand carries one part at a time");
  require(!problem.gripper.suction, "unload_region", "with suction cups",
          "must be left out: what the base's acceleration pulls at them is not known");
}

}  // namespace

int ik_seeds_of_a_grasp(int asked, const std::vector<int>& grasps_of_parts) {
  int fewest = kPosturesOfPart;
  for (const int count : grasps_of_parts) {
    if (count > 0) fewest = std::min(fewest, count);
  }
  return std::max(asked, (kPosturesOfPart + fewest - 1) / fewest);
}

void check_arrival_covariance(const Eigen::Matrix3d& covariance) {
  const char* field = "arrival_covariance";
  require(covariance.allFinite(), field, "not finite", "must be finite");
  const double size = covariance.cwiseAbs().maxCoeff();
  const double skew = (covariance - covariance.transpose()).cwiseAbs().maxCoeff();
  require(skew <= 1e-9 * size, field, skew, "must be symmetric; by so much do two entries differ");
  require(covariance.diagonal().maxCoeff() <= 1, field, covariance.diagonal().maxCoeff(),
          "must hold variances of at most 1 m^2 and 1 rad^2");
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvalues()[0];
  require(least >= -1e-9 * size, field, least, "must have no negative eigenvalue, as no covariance has");
}

void PartSupplyOptions::check() const {
  require_within(grid.resolution, 1e-3, 10, "grid.resolution", "m");
  require_within(grid.max_distance, 0, 1000, "grid.max_distance", "m");
  require_within(grid.ik_seeds, 1, 1000, "grid.ik_seeds", "configurations");
  require_not_negative(positioning_uncertainty, "positioning_uncertainty");
  require_within(approach_distance, 1e-3, 10, "approach_distance", "m");
  require_within(lift_height, 0.01, 10, "lift_height", "m");
  require_positive(motion_time_limit, "motion_time_limit");
  require(motion_time_limit <= 86400, "motion_time_limit", motion_time_limit, "must be at most 86400 s");
  require_within(route_resolution, 1e-3, 100, "route_resolution", "m");
  require_within(robustness_samples, 0, 1e6, "robustness_samples", "base poses");
  require_within(threads, 0, 1024, "threads", "(0: all)");
}

void PartSupplyProblem::check() const {
  options.check();
  gripper.check();
  require(!arm.has_base(), "arm", "'" + arm.name() + "'", "must be a group without base joints");
  arm.check_configuration(home, "home");
  for (int i = 0; i < arm.size(); ++i) {
    require(home[i] >= arm.lower()[i] - 1e-9 && home[i] <= arm.upper()[i] + 1e-9, "home '" + arm.names()[i] + "'",
            home[i], "must lie in [" + std::to_string(arm.lower()[i]) + ", " + std::to_string(arm.upper()[i]) + "]");
  }
  require(robot.link_index(gripper.tool_link) == arm.tip_link(), "gripper.tool_link", "'" + gripper.tool_link + "'",
          "must be the arm's tip");
  for (const HandJoint& joint : gripper.joints) robot.joint_index(joint.name);
  for (const std::string& link : gripper.finger_links) robot.link_index(link);
  require_numbers(start, "start", "m, rad");
  require_numbers(goal, "goal", "m, rad");
  check_place(*this);
  require(world.attached().empty(), "world", "an attached object", "must hold nothing attached at the start");
  check_arrival_covariance(arrival_covariance);
  require(drive_clearance == 0 || (drive_clearance >= 1e-3 && drive_clearance <= 10), "drive_clearance",
          drive_clearance, "must be 0, or in [0.001, 10] m");
  require(arrival_covariance.isZero(0) || options.robustness_samples > 0, "robustness_samples", 0,
          "must be positive with an arrival_covariance: so many arrivals are drawn");
  check_trays(*this);
}

}  // namespace mmgrasp
