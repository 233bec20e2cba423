#include "mmgrasp/gripper_design/segment_requirement.hpp"

#include <cmath>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {

std::string SegmentRequirement::name() const {
  return segment.empty() ? part : part + ", " + segment;
}

void SegmentRequirement::check() const {
  if (part.empty()) throw InvalidInput("part = '': a segment must name its part");
  const std::string of = " of '" + name() + "'";
  require(fingers == 2 || fingers == 3, "fingers" + of, fingers, "must be 2 or 3");
  require(std::isfinite(opening) && opening > 0, "opening" + of, opening, "must be a positive length [m]");
  require(std::isfinite(min_finger_length) && min_finger_length >= 0, "min_finger_length" + of, min_finger_length,
          "must be a length of at least 0 [m]");
  require(max_finger_length >= min_finger_length, "max_finger_length" + of, max_finger_length,
          "must be at least min_finger_length [m]");
}

}  // namespace mmgrasp
