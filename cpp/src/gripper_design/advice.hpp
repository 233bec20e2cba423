#pragma once

#include <string>
#include <vector>

#include "gripper_design/segment_judgement.hpp"

namespace mmgrasp::detail {

/// Single changes each of which gives an operation its grasp, for one of which no grasp is free. Each was tried with
/// the numbers that it names, rounded as they are printed.
std::vector<std::string> advice_without_grasp(const Judgement& by, const Remedy& remedy, const Monitor& monitor);

/// The same for one whose grasps no drive takes.
std::vector<std::string> advice_without_drive(const Judgement& by, const Monitor& monitor);

}  // namespace mmgrasp::detail
