#include "mmgrasp/robot/planar_base.hpp"

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {

const char* to_string(BaseKind kind) {
  switch (kind) {
    case BaseKind::fixed:
      return "fixed";
    case BaseKind::diff_drive:
      return "diff_drive";
    case BaseKind::omni:
      return "omni";
  }
  return "unknown";
}

BaseKind base_kind_from_string(const std::string& name) {
  for (const BaseKind kind : {BaseKind::fixed, BaseKind::diff_drive, BaseKind::omni})
    if (name == to_string(kind)) return kind;
  throw InvalidInput("base = \"" + name + "\": must be fixed, diff_drive or omni");
}

void BaseLimits::check() const {
  const auto positive = [](double value, const char* field) {
    require_positive(value, std::string("base_limits.") + field);
  };
  positive(linear_velocity, "linear_velocity");
  positive(angular_velocity, "angular_velocity");
  positive(linear_acceleration, "linear_acceleration");
  positive(angular_acceleration, "angular_acceleration");
  positive(workspace, "workspace");
  require(wheel_velocity > 0, "base_limits.wheel_velocity", wheel_velocity, "must be positive (infinite: no limit)");
  positive(wheel_separation, "wheel_separation");
  require(wheelbase >= 0 && std::isfinite(wheelbase), "base_limits.wheelbase", wheelbase,
          "must not be negative (0: no Mecanum wheels)");
}

}  // namespace mmgrasp
