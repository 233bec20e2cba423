#include "mmgrasp/task/plan_to_check.hpp"

#include <cmath>
#include <set>
#include <variant>

#include "mmgrasp/collision/detail/named_bodies.hpp"
#include "mmgrasp/collision/floor.hpp"
#include "mmgrasp/core/error.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp {
namespace {

using verify::CheckedPart;
using verify::PlanToCheck;

void set_hand(const Hand& hand, PlanToCheck& check) {
  check.tip_link = hand.tool_link;
  check.approach = hand.approach;
  check.closing = hand.closing;
  check.max_opening = hand.max_opening;
  check.clearance = hand.clearance;
  check.finger_depth = hand.finger_depth;
  check.finger_width = hand.finger_width;
  check.finger_links = hand.finger_links;
  for (const HandJoint& joint : hand.joints) {
    const auto spread = hand.preshape.find(joint.group);
    if (spread == hand.preshape.end()) {
      check.fingers.push_back({joint.name, joint.closed, joint.open});
    } else {
      const double value = joint.closed + spread->second * (joint.open - joint.closed);
      check.fingers.push_back({joint.name, value, value});
    }
  }
  check.openings = hand.openings;
  check.payload = hand.payload;
  if (hand.suction) {
    const Suction& own = *hand.suction;
    check.suction = {{}, own.max_gap, own.vacuum, own.friction, own.safety};
    for (const SuctionCup& cup : own.cups) check.suction.cups.push_back({cup.position, cup.radius});
  }
  if (hand.openings.empty() && hand.min_opening > 0) check.openings = {hand.min_opening, hand.max_opening};
}

/// Where the joints stand that neither the arm nor the hand moves.
std::map<std::string, double> other_joints(const PartSupplyProblem& problem) {
  std::set<std::string> moved(problem.arm.names().begin(), problem.arm.names().end());
  for (const HandJoint& joint : problem.gripper.joints) moved.insert(joint.name);
  std::map<std::string, double> others;
  for (const Joint& joint : problem.robot.joints()) {
    if (joint.value_index >= 0 && joint.value_count() == 1 && moved.count(joint.name) == 0)
      others[joint.name] = problem.arm.reference()[joint.value_index];
  }
  return others;
}

void set_arm(const PartSupplyProblem& problem, PlanToCheck& check) {
  check.arm_joints = problem.arm.names();
  for (int i = 0; i < problem.arm.size(); ++i) {
    check.velocity_limits.push_back(problem.arm.velocity_limits()[i]);
    check.acceleration_limits.push_back(problem.arm.acceleration_limits()[i]);
  }
  check.other_joints = other_joints(problem);
  check.home = problem.home;
}

void set_room(const World& world, PlanToCheck& check) {
  if (!world.attached().empty()) throw InvalidInput("world: attached objects cannot be checked: leave them out of it");
  if (!world.fields().empty())
    throw InvalidInput("world: distance fields cannot be checked: add what they hold as shapes");
  for (const auto& [name, object] : world.objects()) {
    const auto* ground =
        name == kFloor && object.shapes.size() == 1 ? std::get_if<Plane>(&object.shapes[0].shape) : nullptr;
    if (ground != nullptr) {
      check.floor = ground->offset + object.T_world_object.translation().z();
    } else {
      check.obstacles.push_back({name, object.shapes, object.T_world_object});
    }
  }
  check.padded = world.padding().most() > 0;
}

/// Pairs that may touch, groups taken apart; links on the ground are the checker's own rule.
void set_allowed(const PartSupplyProblem& problem, PlanToCheck& check) {
  const World whole = detail::world_with_parts(problem, detail::all_parts(problem));
  const detail::AllowedPairs allowed(problem.robot, whole);
  for (const auto& [a, b] : allowed.pairs()) {
    if (a != kFloor && b != kFloor) check.allowed_collisions.emplace_back(a, b);
  }
}

double own_heading(const Tray& tray) {
  const Eigen::Vector3d front = tray.T_world_tray.linear().col(0);
  return std::atan2(front.y(), front.x());
}

void set_trays(const PartSupplyProblem& problem, PlanToCheck& check) {
  const double farthest = problem.options.grid.max_distance;
  for (const Tray& tray : problem.trays) {
    check.trays.push_back(tray.name);
    verify::CheckedTray& searched = check.searched[tray.name];
    searched.headings = tray.headings.empty() ? std::vector<double>{own_heading(tray)} : tray.headings;
    searched.middle = tray.T_world_tray.translation().head<2>();
    if (farthest > 0) searched.max_distance = farthest;
    searched.shares_headings = tray.headings.empty();
    for (const Part& part : tray.parts) {
      CheckedPart checked{{part.name, part.shapes, part.T_world_part}, tray.name, part.target, {}, part.mass};
      if (part.target) {
        for (const Grasp& grasp : part.grasps) checked.grasps.push_back({grasp.T_object_hand, grasp.opening});
      }
      check.parts.push_back(std::move(checked));
    }
  }
}

void set_task(const PartSupplyProblem& problem, PlanToCheck& check) {
  check.start = problem.start;
  check.goal = problem.goal;
  check.positioning_uncertainty = problem.options.positioning_uncertainty;
  check.arrival_covariance = problem.arrival_covariance;
  check.drive_clearance = problem.drive_clearance;
  check.approach_distance = problem.options.approach_distance;
  check.lift_height = problem.options.lift_height;
  check.T_base_bin = problem.place_region.T_base_bin;
  check.bin_size = problem.place_region.size;
  check.drop_height = problem.place_region.drop_height;
  check.capacity = problem.place_region.capacity;
  if (problem.unload_region) {
    const UnloadRegion& region = *problem.unload_region;
    check.unload_region = {region.T_world_region, region.size, region.drop_height};
  }
}

std::vector<std::string> tray_names(const PartSupplyProblem& problem, const std::vector<TrayId>& trays) {
  std::vector<std::string> names;
  for (const TrayId tray : trays) names.push_back(problem.trays[tray].name);
  return names;
}

void set_stops(const PartSupplyProblem& problem, const PartSupplyPlan& plan, PlanToCheck& check) {
  check.grid = {plan.grid.origin, plan.grid.resolution, plan.grid.nx, plan.grid.ny, plan.grid.headings};
  for (const BaseRegion& region : plan.regions) check.regions.push_back({region.tray, region.cells});
  for (const auto* sets : {&plan.intersections.robust, &plan.intersections.too_small}) {
    for (const Intersection& set : *sets) {
      check.intersections.push_back(
          {tray_names(problem, set.trays), plan.grid.headings[set.heading], set.centre, set.radius});
    }
  }
  for (const Stop& stop : plan.stops) {
    verify::CheckedStop checked{stop.pose, stop.radius, tray_names(problem, stop.trays)};
    checked.arrivals = static_cast<int>(stop.arrivals);
    checked.arrivals_served = static_cast<int>(stop.arrivals_served);
    check.stops.push_back(std::move(checked));
  }
  check.lower_bound = plan.lower_bound;
  check.robustness_rate = plan.robustness_rate;
}

verify::CheckedPick checked_pick(const PartSupplyProblem& problem, const Pick& pick) {
  const Tray& tray = problem.trays[pick.part.tray];
  verify::CheckedPick checked{pick.stop, tray.name, tray.parts[pick.part.part].name, pick.grasp, {}};
  for (const PickMotion& motion : pick.motions) {
    const JointTrajectory& t = motion.trajectory;
    checked.motions.push_back(
        {to_string(motion.kind), motion.opening, motion.attached, t.times, t.positions, t.velocities, t.accelerations});
  }
  return checked;
}

void set_motions(const PartSupplyProblem& problem, const PartSupplyPlan& plan, PlanToCheck& check) {
  const auto values = [&](const BasePath& leg) {
    const double seconds = base_path_duration(leg, problem.robot.base(), problem.robot.base_limits());
    return verify::CheckedLegValues{leg.length, leg.turning, seconds};
  };
  for (const BasePath& leg : plan.route) {
    check.route.push_back(leg.poses);
    check.leg_values.push_back(values(leg));
  }
  for (const Unloading& unloading : plan.unloadings) {
    verify::CheckedUnloading checked{unloading.after_pick, unloading.to_goal.poses, unloading.back.poses,
                                     values(unloading.to_goal)};
    if (!unloading.back.poses.empty()) checked.back_values = values(unloading.back);
    check.unloadings.push_back(std::move(checked));
  }
  for (const Pick& pick : plan.picks) check.picks.push_back(checked_pick(problem, pick));
}

/// Throws InvalidInput unless every tray, part and heading that the plan names by its index is there.
void check_indices(const PartSupplyProblem& problem, const PartSupplyPlan& plan) {
  const auto require_index = [](int index, std::size_t size, const char* field) {
    require(index >= 0 && index < static_cast<int>(size), field, index, "must be of this problem");
  };
  for (const Stop& stop : plan.stops) {
    for (const TrayId tray : stop.trays) require_index(tray, problem.trays.size(), "plan.stops.trays");
  }
  for (const auto* sets : {&plan.intersections.robust, &plan.intersections.too_small}) {
    for (const Intersection& set : *sets) {
      require_index(set.heading, plan.grid.headings.size(), "plan.intersections.heading");
      for (const TrayId tray : set.trays) require_index(tray, problem.trays.size(), "plan.intersections.trays");
    }
  }
  for (const Pick& pick : plan.picks) {
    require_index(pick.part.tray, problem.trays.size(), "plan.picks.part.tray");
    require_index(pick.part.part, problem.trays[pick.part.tray].parts.size(), "plan.picks.part.part");
  }
}

}  // namespace

PlanToCheck plan_to_check(const PartSupplyProblem& problem, const PartSupplyPlan& plan) {
  check_indices(problem, plan);
  PlanToCheck check{source_of(problem.robot)};
  check.planned_robot = written_source(problem.robot);
  set_arm(problem, check);
  set_hand(problem.gripper, check);
  set_room(problem.world, check);
  set_allowed(problem, check);
  set_trays(problem, check);
  set_task(problem, check);
  set_stops(problem, plan, check);
  set_motions(problem, plan, check);
  return check;
}

}  // namespace mmgrasp
