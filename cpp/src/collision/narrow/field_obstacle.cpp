#include "mmgrasp/collision/field_obstacle.hpp"

#include <cmath>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {

void FieldObstacle::check() const {
  require(field != nullptr, "field", "none", "must be a distance field");
  require(std::isfinite(resolution) && resolution > 0, "resolution", resolution, "must be finite and > 0 [m]");
  const DistanceFieldProperties properties = field->properties();
  require(properties.error >= 0 && std::isfinite(properties.error), "field error", properties.error,
          "must be finite and not negative [m]");
  require(!properties.domain.isEmpty(), "field domain", "empty", "must hold a point");
  checked_pose(T_world_field.matrix(), "field pose");
}

}  // namespace mmgrasp
