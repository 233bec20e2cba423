#include "task/obstructions.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "task/base_grid.hpp"
#include "task/scene.hpp"

namespace mmgrasp {
namespace {

std::string metres(double value) {
  std::ostringstream out;
  out.precision(3);
  out << value << " m";
  return out.str();
}

/// The target part that blocks: no feasible base pose, else the smallest region of its own.
int blocking_part(const BaseRegion& region) {
  int worst = 0;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (int p = 0; p < static_cast<int>(region.part_cells.size()); ++p) {
    const CellMask& cells = region.part_cells[static_cast<std::size_t>(p)];
    const std::size_t feasible = region.explanations[static_cast<std::size_t>(p)].base_poses_feasible;
    const std::size_t size = feasible == 0 ? 0 : 1 + static_cast<std::size_t>(std::count(cells.begin(), cells.end(), std::uint8_t{1}));
    if (size < least) {
      least = size;
      worst = p;
    }
  }
  return worst;
}

const char* main_cause(const Rejections& r) {
  const std::size_t most = std::max({r.reach, r.limits, r.self_collision, r.scene, r.grasp_filter});
  if (most == 0) return "nothing";
  if (most == r.grasp_filter) return "the open hand touching the scene or a neighbour";
  if (most == r.reach) return "reach";
  if (most == r.limits) return "joint limits";
  if (most == r.self_collision) return "self-collision";
  return "collisions with the scene";
}

/// Shortfall of reach from the best cell centre at which the robot may stand.
double missing_reach(const PartSupplyProblem& problem, const ReachDatabase& database, BasePoseEvaluator& evaluator,
                     const BaseGrid& grid, int tray, int part) {
  const Tray& where = problem.trays[static_cast<std::size_t>(tray)];
  const double radius = base_search_radius(problem, where, database);
  std::vector<std::pair<double, Eigen::Vector3d>> poses;
  for (double wanted : tray_headings(where)) {
    for (int h = 0; h < static_cast<int>(grid.headings.size()); ++h) {
      if (std::abs(wrap_angle(grid.headings[static_cast<std::size_t>(h)] - wanted)) > 1e-9) continue;
      for (int iy = 0; iy < grid.ny; ++iy) {
        for (int ix = 0; ix < grid.nx; ++ix) {
          const Eigen::Vector3d pose = grid.centre(h, ix, iy);
          if ((pose.head<2>() - where.T_world_tray.translation().head<2>()).norm() > radius) continue;
          poses.emplace_back(evaluator.missing_reach(pose, tray, part), pose);
        }
      }
    }
  }
  std::stable_sort(poses.begin(), poses.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [missing, pose] : poses) {
    if (evaluator.home(pose) == Rejection::none) return missing;
  }
  return 0;
}

std::string advice(const PartExplanation& part, double missing, std::size_t in_collision, const PartSupplyProblem& problem,
                   int too_wide) {
  const Rejections& r = part.rejections;
  const std::size_t collisions = r.scene + r.self_collision;
  if (missing > 0) {
    return "the nearest base pose at which the robot may stand falls " + metres(missing) +
           " short: move the tray that much closer to free floor, or lower obstacles under it";
  }
  if (part.base_poses_tried == 0) {
    return "the robot at home touches the scene at all " + std::to_string(in_collision) +
           " base poses around it: clear the floor in front of the tray or choose another home configuration";
  }
  if (r.grasp_filter == r.total()) {
    return "give grasps from above, lower the tray's walls or leave more room between the parts (gripper opens to " +
           metres(problem.gripper.max_opening) + (too_wide > 0 ? ", " + std::to_string(too_wide) + " grasps were too wide)" : ")");
  }
  if (r.reach + r.limits >= collisions) {
    return "bring the part nearer to where the robot can stand, allow other base headings, or give grasps from other directions";
  }
  return "move obstacles away from the part, allow other base headings, or give grasps from other directions";
}

}  // namespace

double largest_radius(const BaseGrid& grid, const BaseRegion& region) {
  double largest = 0;
  for (int h = 0; h < static_cast<int>(grid.headings.size()); ++h) {
    largest = std::max(largest, inscribed_circle(grid, region.cells, h).radius);
  }
  return largest;
}

Obstruction explain_region(const PartSupplyProblem& problem, const ReachDatabase& database, BasePoseEvaluator& evaluator,
                           const BaseGrid& grid, int tray, const BaseRegion& region) {
  Obstruction obstruction;
  obstruction.tray = region.tray;
  const double radius = largest_radius(grid, region);
  if (radius > 0) {
    obstruction.stage = "robustness";
    obstruction.largest_uncertainty = radius;
    obstruction.part = region.explanations[static_cast<std::size_t>(blocking_part(region))].part;
    obstruction.message = "tray '" + region.tray + "': the largest disc of base poses from which every part can be grasped has a radius of " +
                          metres(radius) + ", positioning_uncertainty is " + metres(problem.options.positioning_uncertainty) +
                          ": lower it to that radius or position the base better (the part with the smallest region is '" + obstruction.part + "')";
    return obstruction;
  }
  const int blocking = blocking_part(region);
  const PartExplanation& explanation = region.explanations[static_cast<std::size_t>(blocking)];
  obstruction.part = explanation.part;
  int index = 0;
  const std::vector<Part>& parts = problem.trays[static_cast<std::size_t>(tray)].parts;
  while (parts[static_cast<std::size_t>(index)].name != explanation.part) ++index;
  const Part& part = parts[static_cast<std::size_t>(index)];
  if (part.grasps.empty()) {
    obstruction.stage = "grasp";
    obstruction.message = "part '" + part.name + "' has no grasp" +
                          (part.grasps_too_wide > 0 ? ": all " + std::to_string(part.grasps_too_wide) + " candidates are wider than the gripper opens (" +
                                                          metres(problem.gripper.max_opening) + ")"
                                                    : ": give it a list of grasps or shapes that can be held between two fingers");
    return obstruction;
  }
  bool all_blocked = true;
  for (int g = 0; g < explanation.grasps; ++g) all_blocked = all_blocked && evaluator.hand_blocked(tray, index, g);
  obstruction.stage = all_blocked ? "grasp" : "region";
  if (!all_blocked) obstruction.missing_reach = missing_reach(problem, database, evaluator, grid, tray, index);
  const std::string fix = advice(explanation, obstruction.missing_reach, region.base_poses_in_collision, problem, part.grasps_too_wide);
  if (explanation.base_poses_feasible > 0) {
    obstruction.message = "tray '" + region.tray + "': no cell of base poses serves all its parts; part '" + part.name +
                          "' can be grasped from the fewest: " + fix;
  } else {
    obstruction.message = "part '" + part.name + "' cannot be grasped from any of " + std::to_string(explanation.base_poses_tried) +
                          " base poses, mostly for " + main_cause(explanation.rejections) + " (" + explanation.rejections.summary() + "): " + fix;
  }
  return obstruction;
}

}  // namespace mmgrasp
