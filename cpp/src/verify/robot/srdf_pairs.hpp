#pragma once

#include <string>

#include "verify/robot/robot_model.hpp"

namespace mmgrasp::verify::detail {

/// Sets `disabled` and `enabled` of a model whose links are there. Names that the robot lacks are left out. Throws
/// InvalidInput for a text that is no SRDF.
void read_srdf_pairs(const std::string& srdf, RobotModel& model);

}  // namespace mmgrasp::verify::detail
