#include "trajopt/tool_chain.hpp"

#include <algorithm>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/detail/joint_group_data.hpp"

namespace mmgrasp::detail {

ToolChain::ToolChain(const JointGroup& group) : ToolChain(group, group.tip_link()) {}

ToolChain::ToolChain(const JointGroup& group, int to_link) {
  const Robot& robot = group.robot();
  const FrameTree& tree = group.data().model->kinematics->tree;
  Rigid before;  // the root in the frame of the step before
  if (group.has_base()) {
    const Eigen::Vector3d axes[] = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
    for (int i = 0; i < 3; ++i) steps_.push_back({Rigid(), axes[i], i == 2, i});
  } else {
    before = Rigid(group.T_world_root());
  }
  std::vector<const ElementaryMotion*> motions = tree.motions_above(tree.frame_of_link[to_link]);
  std::reverse(motions.begin(), motions.end());
  for (const ElementaryMotion* motion : motions) {
    // The inner frames of planar and floating joints have no link.
    require(motion->frame < static_cast<int>(robot.links().size()), "group", group.name(),
            "must not move its tip by a planar or floating joint");
    const Joint& joint = robot.joints()[robot.links()[motion->frame].parent_joint];
    require(joint.mimic_joint < 0, "joint", joint.name, "must not mimic another joint on the way to the tip");
    steps_.push_back({before * motion->rest, motion->axis, motion->motion == Motion::revolute, motion->drive.column});
    before = Rigid();
  }
  T_last_tip_ = before * tree.link_in_frame[to_link];
}

void ToolChain::evaluate(const double* q, State& state) const {
  const std::size_t n = steps_.size();
  state.v.resize(n);
  state.w.resize(n);
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Quaterniond R = Eigen::Quaterniond::Identity();
  for (std::size_t i = 0; i < n; ++i) {
    const Step& step = steps_[i];
    p += R * step.before.t;
    R = R * Eigen::Quaterniond(step.before.R);
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
  p += R * T_last_tip_.t;
  state.p = p;
  state.rotation = R * Eigen::Quaterniond(T_last_tip_.R);
  for (std::size_t i = 0; i < n; ++i)
    if (steps_[i].turns) state.v[i] = state.w[i].cross(p - state.v[i]);
}

}  // namespace mmgrasp::detail
