#pragma once

#include <vector>

#include "mmgrasp/task/drive_by.hpp"

namespace mmgrasp::detail {

/// What the tool does at one waypoint. A task is one step, a push-grasp three: before the object, closing begins, both
/// fingers touch.
struct DriveByStep : DriveByTask {
  std::size_t task = 0;           ///< Index of the task that it is a step of.
  bool begins = true;             ///< It is the first step of its task.
  bool closes = true;             ///< The gripper begins to close here.
  double duration = 0;            ///< Time from the step before to this one [s]; 0: free.
  double way = 0;                 ///< > 0: length of the straight way from the step before, along the approach [m].
  int axis = 0;                   ///< Axis of the tip's frame that the approach follows.
  double sign = 1;                ///< Sign of the approach along the axis.
  double insertion_distance = 0;  ///< The object comes this much nearer to the hand before it moves with it [m].
};

std::vector<DriveByStep> steps_of(const std::vector<DriveByTask>& tasks);

/// Throws InvalidInput naming task, field and rule.
void check_tasks(const std::vector<DriveByTask>& tasks, const World& world);

/// T_tip_object of the step's object once it moves with the tip, which is at T_world_tip at the step.
Pose attached_pose(const DriveByStep& step, const Pose& T_world_tip, const Pose& T_world_object);

/// Bounds on the tool at the step's own waypoint.
ToolConstraint constraint_at(const DriveByStep& step, int candidate, int waypoint);
/// Bounds on a straight way to the step, at a waypoint before it.
ToolConstraint constraint_before(const DriveByStep& step, int candidate, int waypoint);

}  // namespace mmgrasp::detail
