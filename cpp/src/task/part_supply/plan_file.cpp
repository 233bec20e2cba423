#include "mmgrasp/task/plan_file.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/file_content.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/task/plan_to_check.hpp"
#include "task/part_supply/json_text.hpp"
#include "task/part_supply/scenario_json.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp {
namespace {

using detail::json_array;
using detail::json_array_of;
using detail::json_bool;
using detail::json_number;
using detail::json_numbers;
using detail::json_object;
using detail::json_quoted;
using detail::json_texts;
using detail::JsonMember;
using verify::PlanToCheck;

constexpr int kVersion = 4;  // of the format, as part_supply/plan_file.py

std::string count(std::size_t value) {
  return std::to_string(value);
}

std::vector<std::string> tray_names(const PartSupplyProblem& problem, const std::vector<TrayId>& trays) {
  std::vector<std::string> names;
  for (const TrayId tray : trays) names.push_back(problem.trays[tray].name);
  return names;
}

std::string grid_json(const BaseGrid& grid) {
  return json_object({{"origin", json_numbers(grid.origin)},
                      {"resolution", json_number(grid.resolution)},
                      {"nx", std::to_string(grid.nx)},
                      {"ny", std::to_string(grid.ny)},
                      {"headings", json_numbers(grid.headings)}});
}

/// Cells of a layer as [iy, first ix, one past the last ix].
std::vector<std::string> runs_of(const BaseGrid& grid, const CellMask& cells, int heading) {
  std::vector<std::string> runs;
  for (int iy = 0; iy < grid.ny; ++iy) {
    const auto row = cells.begin() + static_cast<std::ptrdiff_t>(grid.index(heading, 0, iy));
    const auto is_set = [](std::uint8_t cell) { return cell != 0; };
    for (auto first = std::find_if(row, row + grid.nx, is_set); first != row + grid.nx;) {
      const auto last = std::find_if_not(first, row + grid.nx, is_set);
      runs.push_back(json_array({std::to_string(iy), std::to_string(first - row), std::to_string(last - row)}));
      first = std::find_if(last, row + grid.nx, is_set);
    }
  }
  return runs;
}

std::string explanation_json(const PartExplanation& part) {
  const Rejections& why = part.rejections;
  return json_object({{"part", json_quoted(part.part)},
                      {"grasps", std::to_string(part.grasps)},
                      {"base_poses_tried", count(part.base_poses_tried)},
                      {"base_poses_feasible", count(part.base_poses_feasible)},
                      {"rejections", json_object({{"unreachable", count(why.unreachable)},
                                                  {"limits", count(why.limits)},
                                                  {"self_collision", count(why.self_collision)},
                                                  {"scene", count(why.scene)},
                                                  {"grasp_filter", count(why.grasp_filter)}})}});
}

std::string region_json(const BaseRegion& region, const BaseGrid& grid) {
  std::vector<JsonMember> layers;
  for (std::size_t k = 0; k < grid.headings.size() && !region.cells.empty(); ++k) {
    const std::vector<std::string> runs = runs_of(grid, region.cells, static_cast<int>(k));
    if (!runs.empty()) layers.emplace_back(count(k), json_array(runs));
  }
  return json_object({{"tray", json_quoted(region.tray)},
                      {"cells", json_object(layers)},
                      {"explanations", json_array_of(region.explanations, explanation_json)}});
}

std::string intersections_json(const PartSupplyProblem& problem, const std::vector<Intersection>& sets) {
  return json_array_of(sets, [&](const Intersection& set) {
    return json_object({{"trays", json_texts(tray_names(problem, set.trays))},
                        {"heading", std::to_string(set.heading)},
                        {"centre", json_numbers(set.centre)},
                        {"radius", json_number(set.radius)},
                        {"cells", count(set.cells)}});
  });
}

std::string stop_json(const PartSupplyProblem& problem, const Stop& stop) {
  std::vector<JsonMember> members = {{"pose", json_numbers(stop.pose)},
                                     {"radius", json_number(stop.radius)},
                                     {"trays", json_texts(tray_names(problem, stop.trays))},
                                     {"intersection", std::to_string(stop.intersection)}};
  if (stop.arrivals > 0) {
    members.emplace_back("arrivals",
                         json_object({{"drawn", count(stop.arrivals)}, {"served", count(stop.arrivals_served)}}));
  }
  return json_object(members);
}

std::string leg_json(const std::vector<Eigen::Vector3d>& poses, const verify::CheckedLegValues& values) {
  return json_object({{"poses", json_array_of(poses, [](const Eigen::Vector3d& pose) { return json_numbers(pose); })},
                      {"length", json_number(values.length)},
                      {"turning", json_number(values.turning)},
                      {"duration", json_number(values.duration)}});
}

std::string route_json(const PlanToCheck& check) {
  std::vector<std::string> legs;
  for (std::size_t i = 0; i < check.route.size(); ++i) legs.push_back(leg_json(check.route[i], check.leg_values[i]));
  return json_array(legs);
}

std::string unloading_json(const verify::CheckedUnloading& unloading) {
  std::vector<JsonMember> members = {{"after_pick", std::to_string(unloading.after_pick)},
                                     {"to_goal", leg_json(unloading.to_goal, unloading.to_goal_values)}};
  if (!unloading.back.empty()) members.emplace_back("back", leg_json(unloading.back, unloading.back_values));
  return json_object(members);
}

std::string motion_json(const verify::CheckedMotion& motion) {
  const auto rows = [](const std::vector<Eigen::VectorXd>& values) {
    return json_array_of(values, [](const Eigen::VectorXd& row) { return json_numbers(row); });
  };
  return json_object({{"kind", json_quoted(motion.kind)},
                      {"opening", json_number(motion.opening)},
                      {"attached", json_bool(motion.attached)},
                      {"times", json_numbers(motion.times)},
                      {"positions", rows(motion.positions)},
                      {"velocities", rows(motion.velocities)},
                      {"accelerations", rows(motion.accelerations)}});
}

std::string pick_json(const verify::CheckedPick& pick) {
  return json_object({{"stop", std::to_string(pick.stop)},
                      {"tray", json_quoted(pick.tray)},
                      {"part", json_quoted(pick.part)},
                      {"grasp", std::to_string(pick.grasp)},
                      {"motions", json_array_of(pick.motions, motion_json)}});
}

std::string obstruction_json(const Obstruction& what) {
  return json_object({{"tray", json_quoted(what.tray)},
                      {"part", json_quoted(what.part)},
                      {"stage", json_quoted(what.stage)},
                      {"message", json_quoted(what.message)},
                      {"largest_uncertainty", json_number(what.largest_uncertainty)},
                      {"reach_deficit", json_number(what.reach_deficit)},
                      {"advised_move", json_numbers(what.advised_move)},
                      {"move_trays", json_texts(what.move_trays)},
                      {"move_objects", json_texts(what.move_objects)},
                      {"needed_opening", json_number(what.needed_opening)}});
}

/// What a proven least number of stops rests on.
std::string premises_json(const PartSupplyProblem& problem, const ReachDatabase& database, const PartSupplyPlan& plan,
                          const PlanToCheck& check) {
  std::vector<JsonMember> headings;
  std::size_t grasps = 0;
  bool shared = false;
  for (const Tray& tray : problem.trays) {
    const verify::CheckedTray& searched = check.searched.at(tray.name);
    headings.emplace_back(tray.name, json_numbers(searched.headings));
    shared = shared || searched.shares_headings;
    for (const Part& part : tray.parts) grasps += part.target ? part.grasps.size() : 0;
  }
  return json_object({{"headings", json_object(headings)},
                      {"shared_headings", json_bool(shared)},
                      {"positioning_uncertainty", json_number(problem.options.positioning_uncertainty)},
                      {"cell", json_number(plan.grid.resolution)},
                      {"max_distance", json_number(problem.options.grid.max_distance)},
                      {"grasps", count(grasps)},
                      {"ik_seeds", std::to_string(detail::ik_seeds_of_a_grasp(problem))},
                      {"database", detail::reach_json(database)},
                      {"search_finished", json_bool(plan.proven_minimal)}});
}

}  // namespace

void PlanFileOptions::check() const {
  require(!name.empty(), "name", "''", "must not be empty");
  require(!source.empty(), "source", "''", "must not be empty");
  require(std::isfinite(closing_speed) && closing_speed > 0 && closing_speed <= 10, "closing_speed", closing_speed,
          "must be in (0, 10] m/s");
}

std::string plan_json(const PartSupplyProblem& problem, const ReachDatabase& database, const PartSupplyPlan& plan,
                      const PlanFileOptions& options) {
  options.check();
  const PlanToCheck check = plan_to_check(problem, plan);
  std::vector<JsonMember> members = {
      {"format", json_quoted("mmgrasp-plan")},
      {"version", std::to_string(kVersion)},
      {"mmgrasp", json_quoted(MMGRASP_VERSION)},
      {"outcome", json_quoted(to_string(plan.outcome))},
      {"scenario", detail::scenario_json(problem, database, check, options)},
      {"grid", grid_json(plan.grid)},
      {"regions", json_array_of(plan.regions, [&](const BaseRegion& r) { return region_json(r, plan.grid); })},
      {"intersections", intersections_json(problem, plan.intersections.robust)},
      {"too_small_intersections", intersections_json(problem, plan.intersections.too_small)},
      {"stops", json_array_of(plan.stops, [&](const Stop& stop) { return stop_json(problem, stop); })},
      {"lower_bound", std::to_string(plan.lower_bound)},
      {"proven_minimal", json_bool(plan.proven_minimal)},
      {"route", route_json(check)},
      {"picks", json_array_of(check.picks, pick_json)},
      {"robustness_rate", json_number(plan.robustness_rate)},
      {"obstructions", json_array_of(plan.obstructions, obstruction_json)},
      {"premises", premises_json(problem, database, plan, check)}};
  if (!check.unloadings.empty()) members.emplace_back("unloadings", json_array_of(check.unloadings, unloading_json));
  return json_object(members);
}

void write_plan(const PartSupplyProblem& problem, const ReachDatabase& database, const PartSupplyPlan& plan,
                const std::string& path, const PlanFileOptions& options) {
  const std::string text = plan_json(problem, database, plan, options);
  detail::write_file(path, "plan", {text, "\n"});
}

}  // namespace mmgrasp
