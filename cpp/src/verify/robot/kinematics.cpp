#include "verify/robot/kinematics.hpp"

#include <algorithm>
#include <kdl/tree.hpp>

#include "verify/robot/kdl_pose.hpp"

namespace mmgrasp::verify::detail {
namespace {

/// Zero, moved into limits where zero is outside.
double rest_value(const ModelJoint& joint) {
  if (!joint.moves()) return 0;
  return std::min(std::max(0.0, joint.lower), std::max(joint.lower, joint.upper));
}

}  // namespace

Kinematics::Kinematics(const RobotModel& robot, const ArmSetup& setup) : setup_(setup) {
  for (const ModelJoint& joint : robot.joints) values_.push_back(rest_value(joint));
  for (const auto& [joint, value] : setup.others) values_[joint] = value;
  frames_.assign(robot.links.size(), KDL::Frame::Identity());
  poses_.assign(robot.links.size(), Pose::Identity());

  for (const ModelJoint& joint : robot.joints) elements_.push_back(make_element(robot, joint));
  for (int joint = robot.links[setup.tip_link].joint; joint >= 0; joint = robot.links[elements_[joint].parent].joint) {
    chain_.insert(chain_.begin(), joint);
  }

  lower_.resize(arm_size());
  upper_.resize(arm_size());
  for (int i = 0; i < arm_size(); ++i) {
    const ModelJoint& joint = robot.joints[setup.arm[i]];
    lower_[i] = joint.lower;
    upper_[i] = joint.upper;
    continuous_.push_back(joint.kind == JointKind::continuous);
  }
}

Kinematics::Element Kinematics::make_element(const RobotModel& robot, const ModelJoint& joint) const {
  Element element;
  element.parent = joint.parent;
  element.link = joint.child;
  element.segment = GetTreeElementSegment(robot.tree.getSegment(robot.links[joint.child].name)->second);
  element.source = joint.source;
  element.multiplier = joint.multiplier;
  element.offset = joint.offset;
  const auto driven = std::find(setup_.arm.begin(), setup_.arm.end(), element.source);
  if (joint.moves() && driven != setup_.arm.end()) element.column = static_cast<int>(driven - setup_.arm.begin());
  return element;
}

double ArmSetup::share_open(double opening) const {
  if (openings.back() <= 0) return 0;  // no fingers
  const std::size_t steps = openings.size() - 1;
  std::size_t i = 1;
  while (i < steps && openings[i] < opening) ++i;
  const double share = (opening - openings[i - 1]) / (openings[i] - openings[i - 1]);
  return (static_cast<double>(i - 1) + std::max(0.0, share)) / static_cast<double>(steps);
}

void Kinematics::set_arm(const Eigen::VectorXd& arm) {
  for (int i = 0; i < arm_size(); ++i) values_[setup_.arm[i]] = arm[i];
}

double Kinematics::value(const Element& element) const {
  return element.multiplier * values_[element.source] + element.offset;
}

const Poses& Kinematics::place(const Eigen::VectorXd& arm, double opening) {
  set_arm(arm);
  const double share = setup_.share_open(opening);
  for (const FingerMap& finger : setup_.fingers) {
    values_[finger.joint] = finger.closed + (finger.open - finger.closed) * share;
  }
  for (const Element& element : elements_) {
    frames_[element.link] = frames_[element.parent] * element.segment.pose(value(element));
    poses_[element.link] = from_kdl(frames_[element.link]);
  }
  return poses_;
}

Pose Kinematics::tip(const Eigen::VectorXd& arm) {
  set_arm(arm);
  KDL::Frame frame = KDL::Frame::Identity();
  for (const int index : chain_) frame = frame * elements_[index].segment.pose(value(elements_[index]));
  return from_kdl(frame);
}

void Kinematics::tip_and_jacobian(const Eigen::VectorXd& arm, Pose& T_root_tip, Matrix6Xd& J) {
  set_arm(arm);
  J.setZero(6, arm_size());
  KDL::Frame frame = KDL::Frame::Identity();
  for (const int index : chain_) {
    const Element& element = elements_[index];
    const KDL::Frame next = frame * element.segment.pose(value(element));
    if (element.column >= 0) {
      // KDL refers the twist to the segment's end; here first to the root's origin, where several joints' twists add
      // up.
      const KDL::Twist twist = (frame.M * element.segment.twist(value(element), element.multiplier)).RefPoint(-next.p);
      for (int row = 0; row < 6; ++row) J(row, element.column) += twist(row);
    }
    frame = next;
  }
  const Eigen::Vector3d tip(frame.p.x(), frame.p.y(), frame.p.z());
  for (int column = 0; column < arm_size(); ++column) {
    J.col(column).head<3>() += Eigen::Vector3d(J.col(column).tail<3>()).cross(tip);
  }
  T_root_tip = from_kdl(frame);
}

}  // namespace mmgrasp::verify::detail
