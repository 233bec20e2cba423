#pragma once

#include <string>
#include <vector>

namespace mmgrasp::detail {

/// "; did you mean \"arm_1\"?" for the closest of `known`, or "" when nothing is close.
std::string near_miss(const std::string& name, const std::vector<std::string>& known);

}  // namespace mmgrasp::detail
