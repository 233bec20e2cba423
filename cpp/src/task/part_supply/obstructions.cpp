#include "task/part_supply/obstructions.hpp"

#include <sstream>

#include "task/problem/scene.hpp"

namespace mmgrasp::detail {
namespace {

/// What may help against candidates that fell at this stage of a pick.
std::string motion_advice(const std::string& stage, bool carries) {
  if (stage == "approach") return "shorten approach_distance or make room in front of the part";
  if (stage == "lift") return "lower lift_height or make room above the part";
  if (stage == "release" && carries)
    return "move unload_region or the goal to where the arm can hold a part level over it";
  if (stage == "release") return "move the bin (place_region) to where the arm can hold a part level over it";
  if (stage == "close") return "leave room for the fingers beside the part";
  return "raise motion_time_limit, or choose another home configuration";
}

/// Where a drive begins and ends, in words.
std::string ends_of_drive(const Eigen::Vector3d& from, bool from_stop, const std::string& verb,
                          const Eigen::Vector3d& to, const std::string& tray) {
  return (from_stop ? "the stop at " + pose_text(from) : std::string("the start")) + verb +
         (tray.empty() ? "the goal at " : "the stop at ") + pose_text(to);
}

}  // namespace

Obstruction explain_robustness(const RobustnessResult& check, const std::vector<Stop>& stops) {
  Obstruction obstruction;
  obstruction.stage = "robustness";
  const std::size_t worst = check.worst_stop();
  obstruction.part = check.worst_part[worst];
  std::ostringstream message;
  message << "only " << check.stops[worst].good << " of " << check.stops[worst].samples
          << " base poses drawn in the uncertainty disc of the stop at " << pose_text(stops[worst].pose)
          << " reach every part (worst: '" << obstruction.part
          << "'): use a finer grid_resolution or a smaller positioning_uncertainty";
  obstruction.message = message.str();
  return obstruction;
}

Obstruction explain_route(const Eigen::Vector3d& from, bool from_stop, const Eigen::Vector3d& to,
                          const std::string& tray, const BasePath& searched, double smaller_clearance) {
  Obstruction obstruction;
  obstruction.stage = "route";
  obstruction.tray = tray;
  const std::string cells = searched.cell > 0 ? " in cells of " + six_digits(searched.cell) + " m" : "";
  if (smaller_clearance >= 0) {
    const bool gave_up = searched.outcome == Outcome::timeout;
    obstruction.message =
        (gave_up ? "the search gave up before it found a drive from " : "no drive was found from ") +
        ends_of_drive(from, from_stop, " to ", to, tray) +
        " that keeps drive_clearance: there is one with drive_clearance: " + six_digits(smaller_clearance);
  } else if (searched.outcome == Outcome::timeout) {
    obstruction.message = "the search for a drive from " + ends_of_drive(from, from_stop, " to ", to, tray) +
                          " gave up" + cells +
                          " before it had tried every way, and larger cells lead nowhere: widen the way or keep the "
                          "base to a smaller base_limits.workspace";
  } else if (searched.outcome == Outcome::infeasible) {
    obstruction.message =
        "no drive from " + ends_of_drive(from, from_stop, " leads to ", to, tray) + ": the base is fixed";
  } else {
    obstruction.message = "no drive from " + ends_of_drive(from, from_stop, " leads to ", to, tray) +
                          " with the arm at home" + (cells.empty() ? "" : ", not" + cells + " either") +
                          ": widen the way or choose a narrower home";
  }
  return obstruction;
}

Obstruction explain_held_drive(const PartSupplyProblem& problem, const Eigen::Vector3d& base_pose, PartRef part,
                               const BasePath& searched) {
  Obstruction obstruction;
  obstruction.tray = tray_of(problem, part.tray).name;
  obstruction.part = part_of(problem, part).name;
  obstruction.stage = "route";
  const std::string with = " with part '" + obstruction.part + "' in the hand";
  const std::string ends = ends_of_drive(base_pose, true, " to ", problem.goal, "");
  obstruction.message =
      (searched.outcome == Outcome::timeout ? "the search for a drive from " + ends + with + " gave up"
                                            : "no drive from " + ends + with + " was found") +
      ", by whichever of its grasps the part is held: widen the way, lower drive_clearance if one is asked for, or "
      "choose a home that holds parts nearer to the robot";
  return obstruction;
}

Obstruction explain_motion(const PartSupplyProblem& problem, const Eigen::Vector3d& base_pose, const Pick& failed,
                           const std::vector<std::string>& remedies) {
  Obstruction obstruction;
  const Part& part = part_of(problem, failed.part);
  obstruction.tray = tray_of(problem, failed.part.tray).name;
  obstruction.part = part.name;
  obstruction.stage = "motion";
  obstruction.message = "part '" + part.name + "' can be grasped from the stop at " + pose_text(base_pose) +
                        ", but no arm motion was found: most candidates fell at '" + failed.failed_at + "' (" +
                        failed.rejections.summary() + "): ";
  for (const std::string& remedy : remedies)
    obstruction.message += (&remedy == &remedies.front() ? "it is picked when you " : ", or ") + remedy;
  if (remedies.empty()) obstruction.message += motion_advice(failed.failed_at, problem.unload_region.has_value());
  return obstruction;
}

}  // namespace mmgrasp::detail
