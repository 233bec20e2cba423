#include "trajopt/tool_chain.hpp"

#include <algorithm>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {

ToolChain::ToolChain(const JointGroup& group) : ToolChain(group, group.tip_link(), Pose::Identity()) {}

ToolChain::ToolChain(const JointGroup& group, int to_link, const Pose& T_link_point) {
  const Robot& robot = group.robot();
  // Links between moving joints stand still relative to each other: one placement gives their offsets.
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(group.size());
  Poses T_world_link;
  group.link_poses(zero, T_world_link);
  const auto pose = [&](int link) -> const Pose& { return T_world_link[link]; };

  std::vector<const Joint*> moving;
  for (int link = to_link; link > 0;) {
    const Joint& joint = robot.joints()[robot.links()[link].parent_joint];
    const int index = static_cast<int>(&joint - robot.joints().data());
    const auto& columns = group.joints();
    if (joint.mimic_joint >= 0) {
      const bool moves = std::find(columns.begin(), columns.end(), joint.mimic_joint) != columns.end();
      require(!moves, "joint", joint.name, "must not mimic another joint on the way to the tip");
    }
    if (std::find(columns.begin(), columns.end(), index) != columns.end()) {
      require(joint.type == JointType::revolute || joint.type == JointType::continuous ||
                  joint.type == JointType::prismatic,
              "joint", joint.name, "must turn about an axis or slide along one");
      moving.push_back(&joint);
    }
    link = joint.parent_link;
  }
  std::reverse(moving.begin(), moving.end());

  Pose T_world_before = Pose::Identity();
  if (group.has_base()) {
    const Eigen::Vector3d axes[] = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
    for (int i = 0; i < 3; ++i) steps_.push_back({Pose::Identity(), axes[i], i == 2, i});
  }
  for (const Joint* joint : moving) {
    const auto& columns = group.joints();
    const int index = static_cast<int>(joint - robot.joints().data());
    Step step;
    step.column = static_cast<int>(std::find(columns.begin(), columns.end(), index) - columns.begin());
    step.axis = joint->axis;
    step.turns = joint->type != JointType::prismatic;
    const Pose T_world_joint = pose(joint->parent_link) * joint->T_parent_joint;
    step.T_before = T_world_before.inverse() * T_world_joint;
    T_world_before = pose(joint->child_link);
    steps_.push_back(step);
  }
  T_last_tip_ = T_world_before.inverse() * pose(to_link) * T_link_point;
}

void ToolChain::evaluate(const double* q, State& state) const {
  const std::size_t n = steps_.size();
  state.v.resize(n);
  state.w.resize(n);
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Quaterniond R = Eigen::Quaterniond::Identity();
  for (std::size_t i = 0; i < n; ++i) {
    const Step& step = steps_[i];
    p += R * step.T_before.translation();
    R = R * Eigen::Quaterniond(step.T_before.linear());
    const Eigen::Vector3d axis = R * step.axis;
    const double value = q[step.column];
    if (step.turns) {
      state.w[i] = axis;
      state.v[i] = p;  // its origin, until the tip is known
      R = R * Eigen::Quaterniond(Eigen::AngleAxisd(value, step.axis));
    } else {
      state.w[i].setZero();
      state.v[i] = axis;
      p += value * axis;
    }
  }
  p += R * T_last_tip_.translation();
  state.p = p;
  state.rotation = R * Eigen::Quaterniond(T_last_tip_.linear());
  for (std::size_t i = 0; i < n; ++i)
    if (steps_[i].turns) state.v[i] = state.w[i].cross(p - state.v[i]);
}

}  // namespace mmgrasp::detail
