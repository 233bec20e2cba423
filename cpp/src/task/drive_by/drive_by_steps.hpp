#pragma once

#include <vector>

#include "mmgrasp/task/drive_by.hpp"

namespace mmgrasp::detail {

/// What the tool does at one waypoint. A task is one step, a push-grasp three: before the object, closing begins, both
/// fingers touch.
struct DriveByStep : DriveByTask {
  std::size_t task = 0;  ///< Which one it is a step of.
  bool begins = true;    ///< First step of its task.
  bool closes = true;    ///< The gripper begins to close here.
  double duration = 0;   ///< Of the way from the step before [s]; 0: free.
  double way = 0;        ///< > 0: from the step before straight along the approach, so far [m].
  int axis = 0;          ///< Of the tip's frame: the approach.
  double sign = 1;       ///< Of the approach along it.
  double slides_in = 0;  ///< The object comes this much nearer to the hand before it moves with it [m].
};

std::vector<DriveByStep> steps_of(const std::vector<DriveByTask>& tasks);

/// Throws InvalidInput naming task, field and rule.
void check_tasks(const std::vector<DriveByTask>& tasks, const World& world);

/// T_tip_object of the step's object once it moves with the tip, which is at T_world_tip at the step.
Pose held_pose(const DriveByStep& step, const Pose& T_world_tip, const Pose& T_world_object);

/// Bounds on the tool at the step's own waypoint.
ToolConstraint constraint_at(const DriveByStep& step, int candidate, int waypoint);
/// On a straight way to the step, at a waypoint before it.
ToolConstraint constraint_before(const DriveByStep& step, int candidate, int waypoint);

}  // namespace mmgrasp::detail
