#include "verify/kinematics.hpp"

#include <algorithm>
#include <kdl/frames.hpp>
#include <kdl/joint.hpp>
#include <limits>

namespace mmgrasp::verify {
namespace {

KDL::Vector to_kdl(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

KDL::Frame to_kdl(const Pose& T) {
  const Eigen::Matrix3d R = T.linear();
  return {KDL::Rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
          to_kdl(Eigen::Vector3d(T.translation()))};
}

Pose from_kdl(const KDL::Frame& frame) {
  Pose T = Pose::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) T(row, column) = frame.M(row, column);
    T(row, 3) = frame.p(row);
  }
  return T;
}

KDL::Joint kdl_joint(const Joint& joint) {
  const KDL::Vector origin = to_kdl(Eigen::Vector3d(joint.T_parent_joint.translation()));
  const KDL::Vector axis = to_kdl(Eigen::Vector3d(joint.T_parent_joint.linear() * joint.axis));
  switch (joint.type) {
    case JointType::revolute:
    case JointType::continuous:
      return {joint.name, origin, axis, KDL::Joint::RotAxis};
    case JointType::prismatic:
      return {joint.name, origin, axis, KDL::Joint::TransAxis};
    default:
      return KDL::Joint(joint.name, KDL::Joint::Fixed);
  }
}

bool moves(const Joint& joint) {
  return joint.type == JointType::revolute || joint.type == JointType::continuous || joint.type == JointType::prismatic;
}

/// Zero, moved into limits where zero is outside.
double rest_value(const Joint& joint) {
  if (!moves(joint) || joint.type == JointType::continuous) return 0;
  return std::min(std::max(0.0, joint.lower), std::max(joint.lower, joint.upper));
}

}  // namespace

Kinematics::Kinematics(const Robot& robot, const ArmSetup& setup) : setup_(setup) {
  const std::vector<Link>& links = robot.links();
  for (const Joint& joint : robot.joints()) values_.push_back(rest_value(joint));
  for (const auto& [joint, value] : setup.others) values_[joint] = value;
  frames_.assign(links.size(), KDL::Frame::Identity());
  poses_.assign(links.size(), Pose::Identity());

  std::vector<int> queue{robot.root_link()};
  std::vector<int> element_of_link(links.size(), -1);
  for (std::size_t next = 0; next < queue.size(); ++next) {
    for (const int joint : links[queue[next]].child_joints) {
      elements_.push_back(make_element(robot, joint));
      element_of_link[elements_.back().link] = static_cast<int>(elements_.size()) - 1;
      queue.push_back(elements_.back().link);
    }
  }
  for (int element = element_of_link[setup.tip_link]; element >= 0;
       element = element_of_link[elements_[element].parent]) {
    chain_.insert(chain_.begin(), element);
  }

  lower_.resize(arm_size());
  upper_.resize(arm_size());
  for (int i = 0; i < arm_size(); ++i) {
    const Joint& joint = robot.joints()[setup.arm[i]];
    const bool free = joint.type == JointType::continuous;
    lower_[i] = free ? -std::numeric_limits<double>::infinity() : joint.lower;
    upper_[i] = free ? std::numeric_limits<double>::infinity() : joint.upper;
    continuous_.push_back(free);
  }
}

Kinematics::Element Kinematics::make_element(const Robot& robot, int index) const {
  const std::vector<Joint>& joints = robot.joints();
  const Joint& joint = joints[index];
  Element element;
  element.joint = index;
  element.parent = joint.parent_link;
  element.link = joint.child_link;
  element.segment = KDL::Segment(robot.links()[joint.child_link].name, kdl_joint(joint), to_kdl(joint.T_parent_joint));
  element.source = index;
  // A mimic joint may follow another mimic joint; the count ends a ring of them.
  for (std::size_t hops = 0; hops < joints.size() && joints[element.source].mimic_joint >= 0; ++hops) {
    const Joint& follower = joints[element.source];
    element.offset += element.multiplier * follower.mimic_offset;
    element.multiplier *= follower.mimic_multiplier;
    element.source = follower.mimic_joint;
  }
  const auto driven = std::find(setup_.arm.begin(), setup_.arm.end(), element.source);
  if (moves(joint) && driven != setup_.arm.end()) element.column = static_cast<int>(driven - setup_.arm.begin());
  return element;
}

void Kinematics::set_arm(const Eigen::VectorXd& arm) {
  for (int i = 0; i < arm_size(); ++i) values_[setup_.arm[i]] = arm[i];
}

double Kinematics::value(const Element& element) const {
  return element.multiplier * values_[element.source] + element.offset;
}

const Poses& Kinematics::place(const Eigen::VectorXd& arm, double opening) {
  set_arm(arm);
  for (const FingerMap& finger : setup_.fingers) {
    values_[finger.joint] = finger.closed + (finger.open - finger.closed) * opening / setup_.max_opening;
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

}  // namespace mmgrasp::verify
