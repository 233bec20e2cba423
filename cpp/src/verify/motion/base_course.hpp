#pragma once

#include <string>

#include "verify/context.hpp"

namespace mmgrasp::verify::detail {

/// Faults of a motion whose rows begin with x, y, theta: "base-limit" (speeds and accelerations of the base, one fault
/// a kind, at the worst place), "wheel-limit" (the fastest rim of its wheels), "acceleration" (stored ones that its
/// velocities do not have) and "base-off-course" (a base that only knows its velocities, linear between samples, ends
/// elsewhere; a diff-drive base slides sideways).
void check_base_course(const PlanToCheck& plan, const CheckedMotion& motion, const std::string& where, Faults& faults);

}  // namespace mmgrasp::verify::detail
