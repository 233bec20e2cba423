#pragma once

#include <string>

#include "verify/context.hpp"

namespace mmgrasp::verify::detail {

/// "not-straight": the tool comes to its final pose along an axis of the world, without turning or going back.
class StraightnessCheck {
 public:
  StraightnessCheck(const Eigen::Vector3d& axis, const Pose& T_world_end) : axis_(axis), T_world_end_(T_world_end) {}
  /// The next pose of the tool, in order; false when a fault was added.
  bool check(const Pose& T_world_tip, const std::string& where, Faults& faults);

 private:
  Eigen::Vector3d axis_;
  Pose T_world_end_;
  double farthest_ = -1e9;  ///< Largest progress so far along the axis, 0 at the end [m].
};

/// "grasp-missed".
void check_grasp_reached(const Context& context, const Pose& T_world_wanted, const Pose& T_world_tip,
                         const std::string& where, Faults& faults);

/// "short-approach": the tool begins as far before the grasp as the approach is long.
void check_approach(const Context& context, const Pose& T_world_start, const Pose& T_world_end,
                    const std::string& where, Faults& faults);

/// "no-lift".
void check_lift(const Context& context, const Pose& T_world_start, const Pose& T_world_end, const std::string& where,
                Faults& faults);

/// "release-outside", "release-tilted", "release-height".
void check_release(const Context& context, const CheckedPart& part, const Pose& T_world_root,
                   const Pose& T_world_released, const std::string& where, Faults& faults);

}  // namespace mmgrasp::verify::detail
