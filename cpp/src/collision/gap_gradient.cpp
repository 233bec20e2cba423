#include "collision/gap_gradient.hpp"

#include "robot/joint_group_data.hpp"

namespace mmgrasp::detail {

void add_point_speed(const JointGroup& group, const Poses& links, int link, const Eigen::Vector3d& p,
                     const Eigen::Vector3d& n, double sign, Eigen::VectorXd& row) {
  const GroupModel& model = *group.data().model;
  const Robot& robot = model.robot;
  const auto speed_about = [&](const Eigen::Vector3d& axis, const Eigen::Vector3d& origin) {
    return n.dot(axis.cross(p - origin));
  };
  for (int at = link; robot.links()[at].parent_joint >= 0;) {
    const int j = robot.links()[at].parent_joint;
    const Joint& joint = robot.joints()[j];
    const int leader = joint.mimic_joint >= 0 ? joint.mimic_joint : j;
    for (std::size_t i = 0; i < model.joints.size(); ++i) {
      if (model.joints[i] != leader) continue;
      // The child's frame sits on the joint's axis, and turning about the axis leaves the axis where it is.
      const Eigen::Vector3d axis = links[at].linear() * joint.axis;
      const double speed =
          joint.type == JointType::prismatic ? n.dot(axis) : speed_about(axis, links[at].translation());
      const double rate = joint.mimic_joint >= 0 ? joint.mimic_multiplier : 1;
      row[model.base_columns() + static_cast<Eigen::Index>(i)] += sign * rate * speed;
    }
    at = joint.parent_link;
  }
  if (!model.has_base) return;
  row[0] += sign * n[0];
  row[1] += sign * n[1];
  row[2] += sign * speed_about(Eigen::Vector3d::UnitZ(), links[0].translation());
}

}  // namespace mmgrasp::detail
