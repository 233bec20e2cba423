#pragma once

namespace mmgrasp::detail {

/// How far beyond a limit still counts as on it: URDF files and recorded configurations are printed to five digits.
constexpr double kLimitSlack = 1e-5;

}  // namespace mmgrasp::detail
