#pragma once

namespace mmgrasp {

/// Time limit of calls that their iterations end [s]: a busy machine must not change a plan.
constexpr double kNoClock = 1e6;

}  // namespace mmgrasp
