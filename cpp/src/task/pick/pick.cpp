#include "mmgrasp/task/pick.hpp"

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "task/pick/search_pick.hpp"

namespace mmgrasp {

const char* to_string(MotionKind kind) {
  switch (kind) {
    case MotionKind::transit:
      return "transit";
    case MotionKind::approach:
      return "approach";
    case MotionKind::lift:
      return "lift";
    case MotionKind::stow:
      return "stow";
    case MotionKind::transfer:
      return "transfer";
    case MotionKind::retreat:
      return "retreat";
  }
  return "unknown";
}

double Pick::duration() const {
  double sum = 0;
  for (const PickMotion& motion : motions) sum += motion.trajectory.duration();
  return sum;
}

void PickOptions::check() const {
  require_positive(approach_distance, "approach_distance");
  require_positive(lift_height, "lift_height");
  require_positive(motion_time_limit, "motion_time_limit");
  require_count(ik_seeds, "ik_seeds", 1, 1'000'000);
}

void PickProblem::check() const {
  options.check();
  gripper.check();
  require(!arm.has_base(), "arm", "'" + arm.name() + "'", "must be a group without base joints");
  arm.check_configuration(home, "home");
  require(arm.robot().link_index(gripper.tool_link) == arm.tip_link(), "gripper.tool_link",
          "'" + gripper.tool_link + "'", "must be the arm's tip");
  require(world.objects().count(object) > 0, "object", "'" + object + "'",
          "must be an object of the world that nothing holds");
  for (std::size_t i = 0; i < grasps.size(); ++i) {
    const std::string field = "grasps[" + std::to_string(i) + "]";
    checked_pose(grasps[i].T_object_hand.matrix(), field + " pose");
    require(grasps[i].opening >= 0 && grasps[i].opening <= gripper.max_opening + 1e-9, field + " opening",
            grasps[i].opening, "must lie in [0, gripper.max_opening = " + std::to_string(gripper.max_opening) + "]");
  }
  require_not_negative(mass, "mass", "kg");
  require(mass <= gripper.payload, "mass", mass, "must be from 0 to gripper.payload [kg]");
  require(!gripper.suction || mass > 0, "mass", mass, "must be positive: suction cups hold by force [kg]");
  if (T_world_root_at_place) {
    checked_pose(T_world_root_at_place->matrix(), "T_world_root_at_place");
    require(!places.empty(), "places", 0.0, "must hold a pose with a T_world_root_at_place");
    require(!gripper.suction, "T_world_root_at_place", "with suction cups",
            "must be left out: what the base's acceleration pulls at them is not known");
  }
  for (std::size_t i = 0; i < places.size(); ++i) checked_pose(places[i].matrix(), "places[" + std::to_string(i) + "]");
}

Pick plan_object_pick(const PickProblem& problem, const ReachDatabase& database, const Monitor& monitor) {
  problem.check();
  const std::string difference = database.difference(problem.arm.at(Pose::Identity()));
  if (!difference.empty()) throw InvalidInput("database: was built for another arm than the problem's: " + difference);
  return detail::search_pick(problem, database, monitor);
}

}  // namespace mmgrasp
