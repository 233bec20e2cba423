#include "mmgrasp/task/problem.hpp"

#include <cmath>
#include <set>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

void require_positive(double value, const std::string& field) {
  require(std::isfinite(value) && value > 0, field, value, "must be positive and finite");
}

void require_not_negative(double value, const std::string& field) {
  require(std::isfinite(value) && value >= 0, field, value, "must be finite and not negative");
}

void check_part(const Part& part, const std::string& tray) {
  const std::string field = "part '" + part.name + "' in tray '" + tray + "'";
  require(!part.shapes.empty(), field + " shapes", "0", "must hold at least one");
  for (std::size_t i = 0; i < part.shapes.size(); ++i) {
    check_shape(part.shapes[i].shape, field + " shape " + std::to_string(i));
  }
  checked_pose(part.T_world_part.matrix(), field + " pose");
  for (std::size_t i = 0; i < part.grasps.size(); ++i) {
    const std::string grasp = field + " grasp " + std::to_string(i);
    checked_pose(part.grasps[i].T_object_hand.matrix(), grasp + " pose");
    require_not_negative(part.grasps[i].opening, grasp + " width");
    require(part.grasps[i].posture.empty(), grasp + " posture",
            std::to_string(part.grasps[i].posture.size()) + " numbers", "must be empty: fingers pick by their opening");
  }
}

void check_trays(const PartSupplyProblem& problem) {
  std::set<std::string> tray_names, part_names;
  for (const Tray& tray : problem.trays) {
    require(!tray.name.empty() && tray_names.insert(tray.name).second, "tray name", "'" + tray.name + "'",
            "must not be empty or used twice");
    const std::string field = "tray '" + tray.name + "'";
    checked_pose(tray.T_world_tray.matrix(), field + " pose");
    require(tray.size.allFinite() && tray.size.minCoeff() > 0, field + " size", tray.size.minCoeff(),
            "must be positive");
    for (double heading : tray.headings)
      require(std::isfinite(heading), field + " headings", heading, "must be finite");
    for (const Part& part : tray.parts) {
      require(!part.name.empty() && part_names.insert(part.name).second, "part name", "'" + part.name + "'",
              "must not be empty or used twice");
      require(!problem.scene.has(part.name), "part name", "'" + part.name + "'",
              "is in use for an object of the scene");
      check_part(part, tray.name);
      for (const Grasp& grasp : part.grasps) {
        require(grasp.opening <= problem.gripper.max_opening + 1e-9, "part '" + part.name + "' grasp width",
                grasp.opening,
                "must not exceed gripper.max_opening (" + std::to_string(problem.gripper.max_opening) + " m)");
      }
    }
  }
}

}  // namespace

void PartSupplyOptions::check() const {
  require_positive(grid.resolution, "grid.resolution");
  require_not_negative(grid.max_distance, "grid.max_distance");
  require(grid.ik_seeds > 0, "grid.ik_seeds", grid.ik_seeds, "must be positive");
  require_not_negative(positioning_uncertainty, "positioning_uncertainty");
  require_positive(approach_distance, "approach_distance");
  require_positive(lift_height, "lift_height");
  require_positive(motion_time_limit, "motion_time_limit");
  require_positive(route_resolution, "route_resolution");
  require(robustness_samples >= 0, "robustness_samples", robustness_samples, "must not be negative");
  require(threads >= 0, "threads", threads, "must be 0 (all) or positive");
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
  require(start.allFinite(), "start", start.sum(), "must be finite");
  require(goal.allFinite(), "goal", goal.sum(), "must be finite");
  checked_pose(place_region.T_base_bin.matrix(), "place_region.pose");
  require(place_region.size.allFinite() && place_region.size.minCoeff() > 0, "place_region.size",
          place_region.size.minCoeff(), "must be positive");
  require_not_negative(place_region.drop_gap, "place_region.drop_gap");
  require(scene.attached().empty(), "scene", "an attached object", "must hold nothing attached at the start");
  check_trays(*this);
}

}  // namespace mmgrasp
