#pragma once

#include <cmath>
#include <memory>
#include <string>

#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp::test {

/// An arm of equal links in the plane z = 0, built from text: thin capsule-like boxes of `length` along x, joints about
/// z; all of them, or the first `continuous_joints`, without limits. Kinematics have a closed form, and what its links
/// touch can be worked out with rulers.
class PlanarArm {
 public:
  explicit PlanarArm(int joints, double length = 0.5, double width = 0.02, bool continuous = false, double limit = 2.8,
                     int continuous_joints = 0)
      : joints_(joints), length_(length), width_(width) {
    std::string urdf = "<robot name=\"planar\"><link name=\"l0\"/>\n", srdf = "<robot name=\"planar\">\n";
    for (int i = 1; i <= joints; ++i) {
      const std::string link = "l" + std::to_string(i), parent = "l" + std::to_string(i - 1);
      const double origin = i == 1 ? 0 : length;
      // Boxes stop short of the joints, so that neighbours never touch.
      urdf += "<link name=\"" + link + "\"><collision><origin xyz=\"" + std::to_string(length / 2) +
              " 0 0\"/><geometry><box size=\"" + std::to_string(length) + " " + std::to_string(width) + " " +
              std::to_string(width) + "\"/></geometry></collision></link>\n";
      urdf += "<joint name=\"j" + std::to_string(i) + "\" type=\"" +
              (continuous || i <= continuous_joints ? "continuous" : "revolute") + "\"><parent link=\"" + parent +
              "\"/><child link=\"" + link + "\"/><origin xyz=\"" + std::to_string(origin) +
              " 0 0\"/><axis xyz=\"0 0 1\"/><limit effort=\"1\" velocity=\"2\" lower=\"" + std::to_string(-limit) +
              "\" upper=\"" + std::to_string(limit) + "\"/></joint>\n";
      for (int k = 0; k < i; ++k) {
        srdf += "<disable_collisions link1=\"l" + std::to_string(k) + "\" link2=\"" + link + "\" reason=\"User\"/>\n";
      }
    }
    const std::string last = "l" + std::to_string(joints);
    urdf += "<link name=\"tip\"/><joint name=\"tip_joint\" type=\"fixed\"><parent link=\"" + last +
            "\"/><child link=\"tip\"/><origin xyz=\"" + std::to_string(length) + " 0 0\"/></joint></robot>";
    robot_ = std::make_shared<Robot>(Robot::from_strings(urdf, srdf + "</robot>"));
    group_ = std::make_shared<JointGroup>(robot_->chain("l0", "tip"));
  }

  const Robot& robot() const { return *robot_; }
  const JointGroup& group() const { return *group_; }
  int joints() const { return joints_; }
  double width() const { return width_; }

  /// Position of the end of link `i` (1..joints) by trigonometry.
  Eigen::Vector3d joint_position(const Eigen::VectorXd& q, int i) const {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    double angle = 0;
    for (int k = 0; k < i; ++k) {
      angle += q[k];
      p += length_ * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
    }
    return p;
  }
  Eigen::Vector3d tip(const Eigen::VectorXd& q) const { return joint_position(q, joints_); }

 private:
  int joints_;
  double length_, width_;
  std::shared_ptr<Robot> robot_;
  std::shared_ptr<JointGroup> group_;
};

}  // namespace mmgrasp::test
