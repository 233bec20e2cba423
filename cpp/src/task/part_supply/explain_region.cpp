// explain_region(): why a tray cannot be served, and what would help.
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "task/base_region/search_area.hpp"
#include "task/part_supply/advised_move.hpp"
#include "task/part_supply/hand_obstacles.hpp"
#include "task/part_supply/obstructions.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp::detail {
namespace {

std::string metres(double value) {
  std::ostringstream out;
  out.precision(3);
  out << value << " m";
  return out.str();
}

constexpr double kAdviceStep = 1e-5;  // Advised lengths are whole steps [m], so that texts and fields tell the same.
constexpr double kHeightPlay = 0.02;  // Arm postures are samples: so much higher there may be others [m].
constexpr double kDiscMargin = 2e-6;  // An advised disc is smaller than the largest one by this much at least [m].

/// A multiple of kAdviceStep with all its digits.
std::string advised_metres(double value) {
  std::ostringstream out;
  out.precision(9);
  out << value << " m";
  return out.str();
}

/// Rounded towards the side on which it works.
double advised_below(double value) {
  return std::max(0.0, std::floor(value / kAdviceStep) / std::round(1 / kAdviceStep));
}
double advised_above(double value) {
  return std::ceil(value / kAdviceStep) / std::round(1 / kAdviceStep);
}

/// The target part that blocks: no feasible base pose, else the smallest region of its own.
int blocking_part(const BaseRegion& region) {
  int worst = 0;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (int p = 0; p < static_cast<int>(region.part_cells.size()); ++p) {
    const std::size_t feasible = region.explanations[p].base_poses_feasible;
    const std::size_t size = feasible == 0 ? 0 : 1 + region.part_cells[p].count();
    if (size < least) {
      least = size;
      worst = p;
    }
  }
  return worst;
}

const char* main_cause(const Rejections& r) {
  const std::size_t most = std::max({r.unreachable, r.limits, r.self_collision, r.scene, r.grasp_filter});
  if (most == 0) return "nothing";
  if (most == r.grasp_filter) return "the open hand touching the scene or a neighbour";
  if (most == r.unreachable) return "poses out of reach";
  if (most == r.limits) return "joint limits";
  if (most == r.self_collision) return "self-collision";
  return "collisions with the scene";
}

/// Shortfall of reach from the best cell centre at which the robot may stand.
double reach_deficit(const PartSupplyProblem& problem, const ReachDatabase& database, BasePoseEvaluator& evaluator,
                     const BaseGrid& grid, PartRef part) {
  const Tray& where = tray_of(problem, part.tray);
  const double radius = base_search_radius(problem, where, database);
  std::vector<std::pair<double, Eigen::Vector3d>> poses;
  for (double wanted : tray_headings(where)) {
    for (int h = 0; h < static_cast<int>(grid.headings.size()); ++h) {
      if (std::abs(wrap_angle(grid.headings[h] - wanted)) >= kSameHeading) continue;
      for (int iy = 0; iy < grid.ny; ++iy) {
        for (int ix = 0; ix < grid.nx; ++ix) {
          const Eigen::Vector3d pose = grid.centre(h, ix, iy);
          if ((pose.head<2>() - where.T_world_tray.translation().head<2>()).norm() > radius) continue;
          poses.emplace_back(evaluator.reach_deficit(pose, part), pose);
        }
      }
    }
  }
  std::stable_sort(poses.begin(), poses.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [deficit, pose] : poses) {
    if (evaluator.home(pose) == Rejection::none) return deficit;
  }
  return 0;
}

std::string listed(const std::vector<std::string>& names, std::size_t first) {
  std::string text;
  for (std::size_t i = first; i < names.size(); ++i) text += (text.empty() ? "'" : ", '") + names[i] + "'";
  return text;
}

std::string move_advice(const Obstruction& o) {
  std::vector<std::string> others;
  for (const std::string& name : o.move_objects) {
    if (name != "tray " + o.move_trays.front()) others.push_back(name);  // its body
  }
  others.insert(others.end(), o.move_trays.begin() + 1, o.move_trays.end());
  std::ostringstream text;
  text.precision(4);
  text << "move the tray" << (others.empty() ? "" : " together with " + listed(others, 0)) << " by ("
       << o.advised_move.x() << ", " << o.advised_move.y() << ") m";
  return text.str();
}

std::string hand_touches(const PartSupplyProblem& problem, PartRef ref) {
  return (problem.gripper.suction ? "the hand touches " : "the open hand touches ") + hand_obstacles(problem, ref);
}

/// The open hand is blocked at every grasp.
std::string hand_advice(const PartSupplyProblem& problem, PartRef ref, int too_wide) {
  std::string text = hand_touches(problem, ref) +
                     ": give grasps from above, give the tray lower walls or a higher roof, leave more room between "
                     "the parts, or hold "
                     "them higher above what they stand on";
  if (problem.gripper.suction) return text;
  if (problem.trays[ref.tray].parts[ref.part].grasps_sampled)
    text += " (a standoff in grasp_options holds parts with the tips of the pads: up to " +
            advised_metres(advised_below(problem.gripper.finger_depth / 2)) + ")";
  text += " (gripper opens to " + metres(problem.gripper.max_opening);
  return text + (too_wide > 0 ? ", " + std::to_string(too_wide) + " grasps were too wide)" : ")");
}

std::string advice(const PartExplanation& part, const Obstruction& o, std::size_t in_collision,
                   const PartSupplyProblem& problem, PartRef ref, int too_wide, double height) {
  const Rejections& r = part.rejections;
  const std::size_t collisions = r.scene + r.self_collision;
  const bool hand_blocked = r.grasp_filter > 0 && r.grasp_filter == r.total();
  if (!o.move_trays.empty()) return (hand_blocked ? hand_touches(problem, ref) + ": " : "") + move_advice(o);
  if (std::abs(height) > kHeightPlay) {
    return "its grasps lie " + metres(std::abs(height)) + (height > 0 ? " above" : " below") +
           " all that was found in the arm's reach, wherever the base stands: " + (height > 0 ? "lower" : "raise") +
           " the tray";
  }
  if (o.reach_deficit > 0) {
    return "the nearest base pose at which the robot may stand falls " + metres(o.reach_deficit) +
           " short and no move of the tray alone was found that helps: lower obstacles under it or clear more floor";
  }
  if (part.base_poses_tried == 0) {
    if (in_collision == 0) {
      return "no base pose of the grid lies within the arm's reach of the tray: use a finer grid_resolution, a larger "
             "grid_max_distance, or more samples in the section reach";
    }
    return "the robot at home touches the scene or leaves base_limits.workspace (" +
           metres(problem.robot.base_limits().workspace) + ") at all " + std::to_string(in_collision) +
           " base poses around it: clear the floor in front of the tray, widen the workspace or choose another home "
           "configuration";
  }
  if (hand_blocked) return hand_advice(problem, ref, too_wide);
  if (r.unreachable + r.limits >= collisions) {
    return "bring the part nearer to where the robot can stand, allow other base headings, or give grasps from other "
           "directions";
  }
  return "move obstacles away from the part, allow other base headings, or give grasps from other directions";
}

/// Narrowest extent that a gripper with a larger opening could span; fingers above and below a lying part have no room.
double needed_opening(const Part& part, const Hand& gripper) {
  Eigen::AlignedBox3d bounds;
  for (const LinkShape& shape : part.shapes) bounds.extend(shape_bounds(shape.shape, shape.T_link_shape));
  double narrowest = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    const bool upright = std::abs(part.T_world_part.linear()(2, axis)) > 0.7;
    const double extent = bounds.sizes()[axis];
    if (!upright && extent > gripper.max_opening) narrowest = std::min(narrowest, extent);
  }
  return std::isfinite(narrowest) ? advised_above(narrowest + 2 * gripper.clearance) : 0;
}

Obstruction without_grasps(Obstruction obstruction, const Part& part, const Hand& gripper) {
  obstruction.stage = "grasp";
  obstruction.message = "part '" + part.name + "' has no grasp";
  if (part.grasps_too_wide == 0) {
    obstruction.message += ": give it a list of grasps or shapes that can be held between two fingers";
    return obstruction;
  }
  obstruction.needed_opening = needed_opening(part, gripper);
  obstruction.message += ": all " + std::to_string(part.grasps_too_wide) +
                         " candidates are wider than the gripper opens (" + metres(gripper.max_opening) + ")";
  if (obstruction.needed_opening > 0)
    obstruction.message += ": take a gripper that opens to " + advised_metres(obstruction.needed_opening);
  return obstruction;
}

void add_advised_move(Obstruction& obstruction, const PartSupplyProblem& problem, const ReachDatabase& database,
                      const BaseGrid& grid, TrayId tray, const std::vector<Obstruction>& earlier) {
  for (const Obstruction& other : earlier) {
    if (std::count(other.move_trays.begin(), other.move_trays.end(), obstruction.tray) == 0) continue;
    obstruction.advised_move = other.advised_move;
    obstruction.move_objects = other.move_objects;
    obstruction.move_trays = other.move_trays;
    const auto own = std::find(obstruction.move_trays.begin(), obstruction.move_trays.end(), obstruction.tray);
    std::rotate(obstruction.move_trays.begin(), own, own + 1);
    return;
  }
  if (const std::optional<TrayMove> move = advise_move(problem, database, grid, tray)) {
    obstruction.advised_move = move->by;
    obstruction.move_trays = move->trays;
    obstruction.move_objects = move->objects;
  }
}

/// Largest disc in any layer of the region [m]; 0 when it is empty.
double largest_radius(const BaseGrid& grid, const BaseRegion& region) {
  double largest = 0;
  for (int h = 0; h < static_cast<int>(grid.headings.size()); ++h) {
    largest = std::max(largest, inscribed_circle(grid, region.cells, h).radius);
  }
  return largest;
}

}  // namespace

Obstruction explain_region(const PartSupplyProblem& problem, const ReachDatabase& database,
                           BasePoseEvaluator& evaluator, const BaseGrid& grid, TrayId tray, const BaseRegion& region,
                           const std::vector<Obstruction>& earlier) {
  Obstruction obstruction;
  obstruction.tray = region.tray;
  const double radius = largest_radius(grid, region);
  if (radius > 0) {
    obstruction.stage = "robustness";
    obstruction.largest_uncertainty = advised_below(radius - kDiscMargin);
    obstruction.part = region.explanations[blocking_part(region)].part;
    obstruction.message =
        "tray '" + region.tray +
        "': the largest disc of base poses from which every part can be grasped has a radius of " +
        advised_metres(obstruction.largest_uncertainty) + ", positioning_uncertainty is " +
        six_digits(problem.options.positioning_uncertainty) +
        " m: lower it to that radius or position the base better (the part with the smallest region is '" +
        obstruction.part + "')";
    return obstruction;
  }
  const int blocking = blocking_part(region);
  const PartExplanation& explanation = region.explanations[blocking];
  obstruction.part = explanation.part;
  int index = 0;
  const std::vector<Part>& parts = tray_of(problem, tray).parts;
  while (parts[index].name != explanation.part) ++index;
  const Part& part = parts[index];
  if (part.grasps.empty()) return without_grasps(std::move(obstruction), part, problem.gripper);
  bool all_blocked = true;
  for (int g = 0; g < explanation.grasps; ++g) all_blocked = all_blocked && evaluator.hand_blocked({tray, index}, g);
  obstruction.stage = all_blocked ? "grasp" : "region";
  if (!all_blocked) obstruction.reach_deficit = reach_deficit(problem, database, evaluator, grid, {tray, index});
  add_advised_move(obstruction, problem, database, grid, tray, earlier);
  const std::string fix = advice(explanation, obstruction, region.base_poses_in_collision, problem, {tray, index},
                                 part.grasps_too_wide, evaluator.height_deficit({tray, index}));
  if (explanation.base_poses_tried == 0) {
    obstruction.message = "part '" + part.name + "': no base pose could be tried: " + fix;
  } else if (explanation.base_poses_feasible > 0) {
    obstruction.message = "tray '" + region.tray + "': no cell of base poses serves all its parts; part '" + part.name +
                          "' can be grasped from the fewest: " + fix;
  } else {
    obstruction.message = "part '" + part.name + "' cannot be grasped from any of " +
                          std::to_string(explanation.base_poses_tried) + " base poses, mostly for " +
                          main_cause(explanation.rejections) + " (" + explanation.rejections.summary() + "): " + fix;
  }
  return obstruction;
}

}  // namespace mmgrasp::detail
