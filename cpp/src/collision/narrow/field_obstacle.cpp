#include "mmgrasp/collision/field_obstacle.hpp"

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {

void FieldObstacle::check() const {
  require(field != nullptr, "field", "none", "must be a distance field");
  require_length(resolution, "resolution");
  const DistanceFieldProperties properties = field->properties();
  require_within(properties.error, 0, kLargestLength, "field error", "m");
  require(!properties.domain.isEmpty(), "field domain", "empty", "must hold a point");
  checked_pose(T_world_field.matrix(), "field pose");
}

}  // namespace mmgrasp
