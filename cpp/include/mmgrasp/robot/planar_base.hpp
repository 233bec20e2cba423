#pragma once

#include <limits>
#include <string>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// How the root link may move over the floor: three virtual joints x, y, theta (P3 section 3.8), or none.
enum class BaseKind { fixed, diff_drive, omni };

MMGRASP_EXPORT const char* to_string(BaseKind kind);
/// "fixed", "diff_drive", "omni"; throws InvalidInput listing these otherwise.
MMGRASP_EXPORT BaseKind base_kind_from_string(const std::string& name);

/// Limits of the virtual base joints.
struct MMGRASP_EXPORT BaseLimits {
  double linear_velocity = 0.6;       ///< [m/s], > 0
  double angular_velocity = 1.0;      ///< [rad/s], > 0
  double linear_acceleration = 0.5;   ///< [m/s^2], > 0
  double angular_acceleration = 1.0;  ///< [rad/s^2], > 0
  double workspace = 100.0;           ///< x and y lie in [-workspace, workspace] [m], > 0
  /// Fastest a driven wheel's rim may go [m/s], > 0; infinite: wheels set no limit of their own.
  double wheel_velocity = std::numeric_limits<double>::infinity();
  double wheel_separation = 0.5;  ///< Between left and right wheels [m], > 0 (P1 4.11).
  /// Between front and rear ones [m], >= 0. An omni base with a positive one has four Mecanum wheels, which
  /// wheel_velocity bounds; with 0 its wheels set no limit. A diff-drive has none.
  double wheelbase = 0;
  void check() const;
};

}  // namespace mmgrasp
