#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp {

const char* to_string(JointType type) {
  switch (type) {
    case JointType::fixed:
      return "fixed";
    case JointType::revolute:
      return "revolute";
    case JointType::continuous:
      return "continuous";
    case JointType::prismatic:
      return "prismatic";
    case JointType::planar:
      return "planar";
    case JointType::floating:
      return "floating";
  }
  return "unknown";
}

int Joint::value_count() const {
  switch (type) {
    case JointType::fixed:
      return 0;
    case JointType::planar:
      return 3;
    case JointType::floating:
      return 6;
    default:
      return 1;
  }
}

}  // namespace mmgrasp
