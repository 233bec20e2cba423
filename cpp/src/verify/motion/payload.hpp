#pragma once

#include <string>

#include "verify/context.hpp"

namespace mmgrasp::verify::detail {

/// Centre of mass of a body of uniform density, in its frame: shapes weighed by their volumes, open surfaces by area.
Eigen::Vector3d centre_of_mass(const std::vector<LinkShape>& shapes);

/// "payload": on this motion with the part attached the suction cups must hold it against gravity and acceleration.
/// `centre`: of its mass, in the tool frame.
void check_cups_hold(const Context& context, Judge& judge, const CheckedMotion& motion, double mass,
                     const Eigen::Vector3d& centre, const std::string& where, Faults& faults);

}  // namespace mmgrasp::verify::detail
