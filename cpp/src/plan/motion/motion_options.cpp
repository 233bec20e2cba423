// Rules for the options of plan_motion.
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/plan/motion.hpp"

namespace mmgrasp {

void OrientationConstraint::check() const {
  require(tool_axis.allFinite() && tool_axis.norm() > 1e-9, "orientation_constraint.tool_axis", tool_axis.norm(),
          "must be finite and longer than 0");
  require(world_axis.allFinite() && world_axis.norm() > 1e-9, "orientation_constraint.world_axis", world_axis.norm(),
          "must be finite and longer than 0");
  require(half_angle > 0 && half_angle <= detail::kPi, "orientation_constraint.half_angle", half_angle,
          "must be in (0, pi] [rad]");
}

void ToolRegion::check(const std::string& field) const {
  checked_pose(T_world_region.matrix(), field + ".T_world_region");
  require(position.allFinite() && position.minCoeff() >= 0, field + ".position", position.minCoeff(),
          "must be finite and >= 0 [m]");
  require(rotation.allFinite() && rotation.minCoeff() >= 0 && rotation.maxCoeff() <= detail::kPi, field + ".rotation",
          rotation.minCoeff(), "must be in [0, pi] [rad]");
}

void MotionOptions::check() const {
  require(time_limit > 0, "time_limit", time_limit, "must be > 0");
  require(max_iterations > 0, "max_iterations", max_iterations, "must be > 0");
  require(std::isfinite(range) && range >= 0, "range", range, "must be finite and >= 0");
  require(std::isfinite(joint_step) && joint_step > 0, "joint_step", joint_step, "must be finite and > 0");
  require(workspace_step > 0, "workspace_step", workspace_step, "must be > 0 [m]");
  require(std::isfinite(base_margin) && base_margin > 0, "base_margin", base_margin, "must be finite and > 0");
  require(near_end_probability >= 0 && near_end_probability < 1, "near_end_probability", near_end_probability,
          "must be in [0, 1)");
  require(shorten_iterations >= 0, "shorten_iterations", shorten_iterations, "must be >= 0");
  require(ik_solutions > 0, "ik_solutions", ik_solutions, "must be > 0");
  require(region_samples > 0, "region_samples", region_samples, "must be > 0");
  if (orientation_constraint) orientation_constraint->check();
}

}  // namespace mmgrasp
