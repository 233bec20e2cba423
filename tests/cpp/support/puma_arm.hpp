#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp::test {

/// A six-axis arm with shoulder, elbow and a wrist whose axes meet, built from text; thin links as shapes.
class PumaArm {
 public:
  /// `elbow_limit` bounds the third joint from above; a base that moves is part of the group.
  explicit PumaArm(double elbow_limit = 2.6, BaseKind base = BaseKind::fixed) {
    std::string urdf = "<robot name=\"puma\"><link name=\"l0\"/>";
    const auto link = [&](int i, double length) {
      urdf += "<link name=\"l" + std::to_string(i) + "\">";
      if (length > 0) {
        urdf += "<collision><origin xyz=\"0 0 " + std::to_string(length / 2) + "\"/><geometry><box size=\"0.04 0.04 " +
                std::to_string(length) + "\"/></geometry></collision>";
      }
      urdf += "</link>";
    };
    const auto joint = [&](int i, const char* axis, double up, double lower, double upper) {
      urdf += "<joint name=\"j" + std::to_string(i) + "\" type=\"revolute\"><parent link=\"l" + std::to_string(i - 1) +
              "\"/><child link=\"l" + std::to_string(i) + "\"/><origin xyz=\"0 0 " + std::to_string(up) +
              "\"/><axis xyz=\"" + axis + "\"/><limit effort=\"1\" velocity=\"2\" lower=\"" + std::to_string(lower) +
              "\" upper=\"" + std::to_string(upper) + "\"/></joint>";
    };
    link(1, 0.3);
    link(2, kUpper);
    link(3, kFore);
    link(4, 0);
    link(5, kHand);
    link(6, 0);
    joint(1, "0 0 1", 0, -3.1, 3.1);
    joint(2, "0 1 0", 0.3, -2.2, 2.2);
    joint(3, "0 1 0", kUpper, -elbow_limit, elbow_limit);
    joint(4, "0 0 1", kFore, -3.1, 3.1);
    joint(5, "0 1 0", 0, -2.2, 2.2);
    joint(6, "0 0 1", kHand, -3.1, 3.1);
    std::string srdf = "<robot name=\"puma\">";
    for (int a = 0; a <= 6; ++a) {
      for (int b = a + 1; b <= std::min(6, a + 3); ++b) {
        srdf += "<disable_collisions link1=\"l" + std::to_string(a) + "\" link2=\"l" + std::to_string(b) +
                "\" reason=\"User\"/>";
      }
    }
    RobotOptions options;
    options.base = base;
    robot_ = std::make_shared<Robot>(Robot::from_strings(urdf + "</robot>", srdf + "</robot>", options));
    group_ = std::make_shared<JointGroup>(robot_->chain("l0", "l6", base != BaseKind::fixed));
  }

  const Robot& robot() const { return *robot_; }
  const JointGroup& group() const { return *group_; }
  double reach() const { return kUpper + kFore + kHand; }

 private:
  static constexpr double kUpper = 0.45, kFore = 0.4, kHand = 0.12;
  std::shared_ptr<Robot> robot_;
  std::shared_ptr<JointGroup> group_;
};

}  // namespace mmgrasp::test
