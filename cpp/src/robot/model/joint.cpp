#include "mmgrasp/robot/joint.hpp"

#include "robot/model/robot_data.hpp"

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

std::vector<std::string> detail::value_names(const Joint& joint) {
  if (joint.value_count() == 1) return {joint.name};
  std::vector<std::string> names;
  const std::vector<const char*> parts = joint.type == JointType::planar
                                             ? std::vector<const char*>{"x", "y", "theta"}
                                             : std::vector<const char*>{"x", "y", "z", "rx", "ry", "rz"};
  for (int i = 0; i < joint.value_count(); ++i) names.push_back(joint.name + "/" + parts[i]);
  return names;
}

}  // namespace mmgrasp
