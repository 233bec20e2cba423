#pragma once

#include <string>
#include <vector>

#include "task/drive_by/drive_by_goals.hpp"
#include "task/drive_by/drive_by_steps.hpp"

namespace mmgrasp::detail {

/// What happens at the tasks of a motion whose steps configuration at these waypoints.
std::vector<DriveByEvent> events_of(const WholeBodyTrajectory& t, const World& world,
                                    const std::vector<DriveByStep>& steps, const std::vector<int>& waypoints,
                                    const ConfigurationSequence& sequence);

/// Outcome of a solve, and what is broken where, by how much.
std::string describe(const WholeBodyResult& r);
std::string number(double value);  ///< Three digits.

}  // namespace mmgrasp::detail
