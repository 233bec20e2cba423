#pragma once

#include <string>

#include "robot/model/robot_data.hpp"

namespace mmgrasp::detail {

/// Adds what an SRDF says (groups, states, end effectors, disabled pairs) to a robot already read. Names that the robot
/// lacks become warnings, since SRDFs are often shared by variants of a robot; malformed XML throws InvalidInput.
void read_srdf(const std::string& text, const std::string& origin, Robot::Data& data);

}  // namespace mmgrasp::detail
