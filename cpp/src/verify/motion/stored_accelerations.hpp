#pragma once

#include <string>
#include <vector>

#include "verify/context.hpp"

namespace mmgrasp::verify::detail {

/// "acceleration": positions and velocities prescribe a cubic between samples, and with it the acceleration at which
/// each interval begins and ends. A stored one must be that of the interval before or after it, which differ where the
/// acceleration jumps, or the mean of one of them. One fault, at the worst place. The first columns are looked at, as
/// many as there are names.
void check_accelerations_fit(const CheckedMotion& motion, const std::vector<double>& limits,
                             const std::vector<std::string>& names, const std::string& where, Faults& faults);

}  // namespace mmgrasp::verify::detail
