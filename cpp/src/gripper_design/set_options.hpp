#pragma once

#include "mmgrasp/gripper_design/plan_grippers.hpp"

namespace mmgrasp::detail {

/// What of a plan's options the search for the least set asks for.
MinimalGrippersOptions set_options(const PlanGrippersOptions& options);

}  // namespace mmgrasp::detail
