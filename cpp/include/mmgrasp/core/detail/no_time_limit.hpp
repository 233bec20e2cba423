#pragma once

namespace mmgrasp::detail {

/// Time limit of calls that their iterations end [s]: a busy machine must not change a plan.
constexpr double kNoTimeLimit = 1e6;

}  // namespace mmgrasp::detail
