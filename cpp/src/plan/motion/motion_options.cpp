// Rules for the options of plan_motion.
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/plan/motion.hpp"

namespace mmgrasp {

void OrientationConstraint::check() const {
  require_numbers(tool_axis, "orientation_constraint.tool_axis");
  require(tool_axis.norm() > 1e-9, "orientation_constraint.tool_axis", tool_axis.norm(), "must be longer than 0");
  require_numbers(world_axis, "orientation_constraint.world_axis");
  require(world_axis.norm() > 1e-9, "orientation_constraint.world_axis", world_axis.norm(), "must be longer than 0");
  require(half_angle > 0 && half_angle <= detail::kPi, "orientation_constraint.half_angle", half_angle,
          "must be in (0, pi] [rad]");
}

void ToolRegion::check(const std::string& field) const {
  checked_pose(T_world_region.matrix(), field + ".T_world_region");
  for (double half : position) require_not_negative(half, field + ".position", "m");
  for (double half : rotation) require_within(half, 0, detail::kPi, field + ".rotation", "rad");
}

void MotionOptions::check() const {
  require(time_limit > 0, "time_limit", time_limit, "must be > 0");
  require_count(max_iterations, "max_iterations");
  require_not_negative(range, "range");
  require_within(joint_step, 1e-9, kLargestLength, "joint_step", "rad or m");
  require(workspace_step > 0, "workspace_step", workspace_step, "must be > 0 [m]");
  require_positive(base_margin, "base_margin");
  require(near_end_probability >= 0 && near_end_probability < 1, "near_end_probability", near_end_probability,
          "must be in [0, 1)");
  require_count(shorten_iterations, "shorten_iterations", 0);
  require_count(ik_solutions, "ik_solutions", 1, 1'000'000);
  require_count(region_samples, "region_samples", 1, 1'000'000);
  if (orientation_constraint) orientation_constraint->check();
}

}  // namespace mmgrasp
