#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp::test {

/// A chain of revolute joints about z with these limits; `more` is added to the URDF.
inline JointGroup limited_arm(const std::vector<std::pair<double, double>>& limits, const std::string& more = "") {
  std::string urdf = "<robot name=\"limited\"><link name=\"l0\"/>\n";
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const std::string n = std::to_string(i + 1), before = std::to_string(i);
    urdf += "<link name=\"l" + n + "\"/><joint name=\"j" + n + "\" type=\"revolute\"><parent link=\"l" + before +
            "\"/><child link=\"l" + n + "\"/><origin xyz=\"" + (i == 0 ? "0" : "0.4") +
            " 0 0\"/><axis xyz=\"0 0 1\"/><limit effort=\"1\" velocity=\"2\" lower=\"" +
            std::to_string(limits[i].first) + "\" upper=\"" + std::to_string(limits[i].second) + "\"/></joint>\n";
  }
  return Robot::from_strings(urdf + more + "</robot>").chain("l0", "l" + std::to_string(limits.size()));
}

}  // namespace mmgrasp::test
