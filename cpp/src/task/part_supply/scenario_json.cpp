#include "task/part_supply/scenario_json.hpp"

#include <cmath>
#include <set>

#include "task/part_supply/json_text.hpp"

namespace mmgrasp::detail {
namespace {

using verify::PlanToCheck;

std::string urdf_json(const UrdfSource& source) {
  std::vector<JsonMember> files;
  for (const auto& [name, file] : source.mesh_files) files.emplace_back(name, json_quoted(file));
  return json_object({{"urdf", json_quoted(source.urdf)},
                      {"origin", json_quoted(source.origin)},
                      {"prefix", json_quoted(source.prefix)},
                      {"parent_link", json_quoted(source.parent_link)},
                      {"pose", json_pose(source.T_parent_root)},
                      {"mesh_files", json_object(files)}});
}

std::string link_json(const AddedLink& link) {
  return json_object({{"name", json_quoted(link.name)},
                      {"parent_link", json_quoted(link.parent_link)},
                      {"pose", json_pose(link.T_parent_link)},
                      {"shapes", json_shapes(link.shapes, "link " + link.name)}});
}

std::string limits_json(const BaseLimits& limits) {
  std::vector<JsonMember> members = {{"linear_velocity", json_number(limits.linear_velocity)},
                                     {"angular_velocity", json_number(limits.angular_velocity)},
                                     {"linear_acceleration", json_number(limits.linear_acceleration)},
                                     {"angular_acceleration", json_number(limits.angular_acceleration)},
                                     {"workspace", json_number(limits.workspace)}};
  if (std::isfinite(limits.wheel_velocity)) members.emplace_back("wheel_velocity", json_number(limits.wheel_velocity));
  members.emplace_back("wheel_separation", json_number(limits.wheel_separation));
  if (limits.wheelbase > 0) members.emplace_back("wheelbase", json_number(limits.wheelbase));
  return json_object(members);
}

std::string robot_json(const PartSupplyProblem& problem, const PlanToCheck& check) {
  std::set<std::string> files;
  for (const UrdfSource& source : check.robot.urdfs) {
    for (const auto& [name, file] : source.mesh_files) files.insert(file);
  }
  for (const Link& link : problem.robot.links()) {
    for (const LinkShape& shape : link.collisions) files.insert(shape.mesh_path);
  }
  files.erase("");
  return json_object({{"urdf", json_quoted(check.planned_robot.urdfs.at(0).urdf)},
                      {"srdf", json_quoted(check.planned_robot.srdf)},
                      {"urdfs", json_array_of(check.robot.urdfs, urdf_json)},
                      {"links", json_array_of(check.robot.added_links, link_json)},
                      {"base", json_quoted(to_string(problem.robot.base()))},
                      {"base_limits", limits_json(problem.robot.base_limits())},
                      {"meshes", json_array_of(files, [](const std::string& file) {
                         return json_object({{"file", json_quoted(file)}, {"sha256", json_file_sha256(file)}});
                       })}});
}

std::string suction_json(const verify::CheckedSuction& suction) {
  const auto cup_json = [](const verify::CheckedCup& cup) {
    return json_object({{"xyz", json_numbers(cup.position)}, {"radius", json_number(cup.radius)}});
  };
  return json_object({{"cups", json_array_of(suction.cups, cup_json)},
                      {"max_gap", json_number(suction.max_gap)},
                      {"vacuum", json_number(suction.vacuum)},
                      {"friction", json_number(suction.friction)},
                      {"safety", json_number(suction.safety)}});
}

std::string gripper_json(const PlanToCheck& check, double closing_speed) {
  std::vector<JsonMember> members = {
      {"tool_link", json_quoted(check.tip_link)},
      {"approach", json_numbers(check.approach)},
      {"closing", json_numbers(check.closing)},
      {"max_opening", json_number(check.max_opening)},
      {"finger_depth", json_number(check.finger_depth)},
      {"finger_width", json_number(check.finger_width)},
      {"clearance", json_number(check.clearance)},
      {"closing_speed", json_number(closing_speed)},
      {"joints", json_array_of(check.fingers,
                               [](const verify::CheckedFinger& finger) {
                                 return json_object({{"name", json_quoted(finger.joint)},
                                                     {"closed", json_number(finger.closed)},
                                                     {"open", json_number(finger.open)}});
                               })},
      {"finger_links", json_texts(check.finger_links)}};
  if (!check.openings.empty()) members.emplace_back("openings", json_numbers(check.openings));
  if (!check.suction.cups.empty()) members.emplace_back("suction", suction_json(check.suction));
  if (std::isfinite(check.payload)) members.emplace_back("payload", json_number(check.payload));
  return json_object(members);
}

/// Walls are objects of the world, so that every tray has a body of its own.
std::string trays_json(const PartSupplyProblem& problem, const PlanToCheck& check) {
  return json_array_of(problem.trays, [&](const Tray& tray) {
    const verify::CheckedTray& searched = check.searched.at(tray.name);
    return json_object({{"name", json_quoted(tray.name)},
                        {"pose", json_pose(tray.T_world_tray)},
                        {"size", json_numbers(tray.size)},
                        {"own_body", "true"},
                        {"headings", json_numbers(searched.headings)},
                        {"shares_headings", json_bool(searched.shares_headings)}});
  });
}

std::string part_json(const Part& part, const std::string& tray) {
  const auto grasp_json = [](const Grasp& grasp) {
    return json_object({{"pose", json_pose(grasp.T_object_hand)},
                        {"opening", json_number(grasp.opening)},
                        {"quality", json_number(grasp.quality)}});
  };
  std::vector<JsonMember> members = {{"name", json_quoted(part.name)},
                                     {"tray", json_quoted(tray)},
                                     {"target", json_bool(part.target)},
                                     {"pose", json_pose(part.T_world_part)},
                                     {"shapes", json_shapes(part.shapes, "part " + part.name)},
                                     {"grasps", part.target ? json_array_of(part.grasps, grasp_json) : "[]"}};
  if (part.mass > 0) members.emplace_back("mass", json_number(part.mass));
  return json_object(members);
}

std::string parts_json(const PartSupplyProblem& problem) {
  std::vector<std::string> rows;
  for (const Tray& tray : problem.trays) {
    for (const Part& part : tray.parts) rows.push_back(part_json(part, tray.name));
  }
  return json_array(rows);
}

std::string options_json(const PartSupplyOptions& options) {
  return json_object({{"grid_resolution", json_number(options.grid.resolution)},
                      {"grid_max_distance", json_number(options.grid.max_distance)},
                      {"ik_seeds", json_number(options.grid.ik_seeds)},
                      {"positioning_uncertainty", json_number(options.positioning_uncertainty)},
                      {"approach_distance", json_number(options.approach_distance)},
                      {"lift_height", json_number(options.lift_height)},
                      {"motion_time_limit", json_number(options.motion_time_limit)},
                      {"route_resolution", json_number(options.route_resolution)},
                      {"robustness_samples", json_number(options.robustness_samples)},
                      {"seed", json_number(options.seed)}});
}

std::string padding_json(const Padding& padding) {
  std::vector<JsonMember> names;
  for (const auto& [name, value] : padding.by_name) names.emplace_back(name, json_number(value));
  return json_object({{"links", json_number(padding.links)},
                      {"attached", json_number(padding.attached)},
                      {"objects", json_number(padding.objects)},
                      {"by_name", json_object(names)}});
}

std::string others_json(const std::map<std::string, double>& joints) {
  std::vector<JsonMember> members;
  for (const auto& [name, value] : joints) members.emplace_back(name, json_number(value));
  return json_object(members);
}

/// The bin, or where parts are let go at the goal.
JsonMember place_json(const PlanToCheck& check) {
  if (check.unload_region) {
    const verify::CheckedUnloadRegion& region = *check.unload_region;
    return {"unload_region", json_object({{"pose", json_pose(region.T_world_region)},
                                          {"size", json_numbers(region.size)},
                                          {"drop_height", json_number(region.drop_height)}})};
  }
  std::vector<JsonMember> members = {{"pose", json_pose(check.T_base_bin)},
                                     {"size", json_numbers(check.bin_size)},
                                     {"drop_height", json_number(check.drop_height)}};
  if (check.capacity > 0) members.emplace_back("capacity", std::to_string(check.capacity));
  return {"place_region", json_object(members)};
}

std::string obstacle_json(const verify::CheckedBody& body) {
  return json_object({{"name", json_quoted(body.name)},
                      {"pose", json_pose(body.T_world_body)},
                      {"shapes", json_shapes(body.shapes, "obstacle " + body.name)}});
}

/// What is left out where there is none.
void add_rules(const PartSupplyProblem& problem, const PlanToCheck& check, std::vector<JsonMember>& members) {
  if (!check.arrival_covariance.isZero(0)) {
    std::vector<std::string> rows;
    for (int i = 0; i < 3; ++i) rows.push_back(json_numbers(Eigen::Vector3d(check.arrival_covariance.row(i))));
    members.emplace_back("arrival_covariance", json_array(rows));
  }
  if (check.drive_clearance > 0) members.emplace_back("drive_clearance", json_number(check.drive_clearance));
  if (!check.allowed_collisions.empty()) {
    members.emplace_back("allowed_collisions", json_array_of(check.allowed_collisions, [](const auto& pair) {
                           return json_texts({pair.first, pair.second});
                         }));
  }
  if (check.padded) members.emplace_back("padding", padding_json(problem.world.padding()));
}

}  // namespace

std::string reach_json(const ReachDatabase& database) {
  const ReachOptions& options = database.options();
  return json_object({{"samples", json_number(static_cast<double>(options.samples))},
                      {"position_cell", json_number(options.position_cell)},
                      {"rotation_cell", json_number(options.rotation_cell)},
                      {"max_per_cell", json_number(options.max_per_cell)},
                      {"min_manipulability", json_number(options.min_manipulability)},
                      {"thinning", json_number(options.thinning)},
                      {"seed", json_number(options.seed)}});
}

std::string scenario_json(const PartSupplyProblem& problem, const ReachDatabase& database, const PlanToCheck& check,
                          const PlanFileOptions& options) {
  std::vector<JsonMember> members = {
      {"name", json_quoted(options.name)},
      {"source", json_quoted(options.source)},
      {"robot", robot_json(problem, check)},
      {"arm", json_object({{"joints", json_texts(check.arm_joints)},
                           {"tip_link", json_quoted(check.tip_link)},
                           {"velocity_limits", json_numbers(check.velocity_limits)},
                           {"acceleration_limits", json_numbers(check.acceleration_limits)}})},
      {"gripper", gripper_json(check, options.closing_speed)},
      {"other_joints", others_json(check.other_joints)},
      {"home", json_numbers(check.home)},
      {"start", json_numbers(check.start)},
      {"goal", json_numbers(check.goal)},
      {"positioning_uncertainty", json_number(check.positioning_uncertainty)},
      place_json(check),
      {"floor", std::isfinite(check.floor) ? json_number(check.floor) : "null"},
      {"obstacles", json_array_of(check.obstacles, obstacle_json)},
      {"trays", trays_json(problem, check)},
      {"parts", parts_json(problem)},
      {"options", options_json(problem.options)},
      {"reach", reach_json(database)}};
  add_rules(problem, check, members);
  return json_object(members);
}

}  // namespace mmgrasp::detail
