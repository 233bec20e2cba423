#pragma once

#include <string>

#include "verify/context.hpp"
#include "verify/robot/kinematics.hpp"

namespace mmgrasp::verify::detail {

/// Lengths and finite numbers ("motion-shape") and the clock ("times"); false when the motion cannot be evaluated.
bool check_motion_shape(const CheckedMotion& motion, int joints, const std::string& where, Faults& faults);

/// Position, velocity and acceleration limits between all samples; one fault a kind, at the worst place.
void check_motion_limits(const Context& context, const Kinematics& kinematics, const CheckedMotion& motion,
                         const std::string& where, Faults& faults);

}  // namespace mmgrasp::verify::detail
