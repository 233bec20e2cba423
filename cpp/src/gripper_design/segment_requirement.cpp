#include "mmgrasp/gripper_design/segment_requirement.hpp"

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {

std::string SegmentRequirement::name() const {
  return segment.empty() ? part : part + ", " + segment;
}

void SegmentRequirement::check() const {
  if (part.empty()) throw InvalidInput("part = '': a segment must name its part");
  const std::string of = " of '" + name() + "'";
  require(fingers == 2 || fingers == 3, "fingers" + of, fingers, "must be 2 or 3");
  require_positive(opening, "opening" + of, "m");
  require_not_negative(min_finger_length, "min_finger_length" + of, "m");
  require(max_finger_length >= min_finger_length, "max_finger_length" + of, max_finger_length,
          "must be at least min_finger_length [m]");
  require_not_negative(clearance, "clearance" + of, "m");
  require_not_negative(least_min_opening, "least_min_opening" + of, "m");
  require(least_min_opening <= opening, "least_min_opening" + of, least_min_opening, "must be at most opening [m]");
  require(max_stroke > 0, "max_stroke" + of, max_stroke, "must be positive [m]");
}

}  // namespace mmgrasp
