#include <cmath>

#include "robot/joint_group_data.hpp"

namespace mmgrasp {
namespace {

using detail::ChainSegment;
using detail::GroupModel;
using detail::LinkStep;

/// Frame while walking along a chain; plain matrices, because Isometry3d's 4 x 4 products cost twice as much.
struct Frame {
  Eigen::Matrix3d R;
  Eigen::Vector3d p;
};

Frame root_frame(const GroupModel& model, const Pose& T_world_root, const double* q) {
  if (!model.has_base) return {T_world_root.linear(), T_world_root.translation()};
  const double c = std::cos(q[2]), s = std::sin(q[2]);
  Frame frame;
  frame.R << c, -s, 0, s, c, 0, 0, 0, 1;
  frame.p << q[0], q[1], 0;
  return frame;
}

/// To the segment's joint frame, before it moves.
void step_to(Frame& frame, const ChainSegment& segment) {
  frame.p.noalias() += frame.R * segment.p;
  const Eigen::Matrix3d R = frame.R;
  frame.R.noalias() = R * segment.R;
}

void move(Frame& frame, const ChainSegment& segment, const double* q) {
  const double value = segment.multiplier * q[segment.column] + segment.offset;
  if (segment.prismatic) {
    frame.p += value * frame.R.col(2);
    return;
  }
  const double c = std::cos(value), s = std::sin(value);
  const Eigen::Vector3d x = frame.R.col(0);
  frame.R.col(0) = c * x + s * frame.R.col(1);
  frame.R.col(1) = c * frame.R.col(1) - s * x;
}

void finish(const Frame& frame, const GroupModel& model, Pose& T_world_tip) {
  T_world_tip.linear().noalias() = frame.R * model.R_tip;
  T_world_tip.translation().noalias() = frame.p + frame.R * model.p_tip;
  T_world_tip.matrix().row(3) << 0, 0, 0, 1;
}

void place_link(const LinkStep& step, const double* q, Poses& T_world_link) {
  const auto parent = T_world_link[static_cast<std::size_t>(step.parent)].matrix();
  auto& child = T_world_link[static_cast<std::size_t>(step.link)].matrix();
  const Eigen::Matrix3d R_parent = parent.topLeftCorner<3, 3>();
  Eigen::Vector3d p = step.p0;
  if (step.column < 0) {
    child.topLeftCorner<3, 3>().noalias() = R_parent * step.A;
  } else {
    const double value = step.multiplier * q[step.column] + step.offset;
    if (step.prismatic) {
      p += value * step.d;
      child.topLeftCorner<3, 3>().noalias() = R_parent * step.A;
    } else {
      const Eigen::Matrix3d R = step.A + std::sin(value) * step.B + std::cos(value) * step.C;
      child.topLeftCorner<3, 3>().noalias() = R_parent * R;
    }
  }
  child.topRightCorner<3, 1>().noalias() = parent.topRightCorner<3, 1>() + R_parent * p;
}

}  // namespace

Pose JointGroup::fk(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  const GroupModel& model = *data_->model;
  const double* values = q.data();
  Frame frame = root_frame(model, data_->T_world_root, values);
  for (const ChainSegment& segment : model.chain) {
    step_to(frame, segment);
    move(frame, segment, values);
  }
  Pose T_world_tip;
  finish(frame, model, T_world_tip);
  return T_world_tip;
}

Matrix6Xd JointGroup::jacobian(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  Matrix6Xd J(6, size());
  Pose T_world_tip;
  fk_jacobian(q, T_world_tip, J);
  return J;
}

void JointGroup::fk_jacobian(const Eigen::Ref<const Eigen::VectorXd>& q, Pose& T_world_tip,
                             Eigen::Ref<Matrix6Xd> J) const {
  const GroupModel& model = *data_->model;
  const double* values = q.data();
  Frame frame = root_frame(model, data_->T_world_root, values);
  const Eigen::Vector3d p_root = frame.p;
  J.setZero();
  // A column is the sum over the joints it moves (mimic joints share one). About an axis a through o the tip moves by
  // a x (p_tip - o): the part with p_tip is added when the tip is known. Origins are taken from the root, so that a
  // robot far from the world's origin loses no digits.
  for (const ChainSegment& segment : model.chain) {
    step_to(frame, segment);
    const Eigen::Vector3d axis = segment.multiplier * frame.R.col(2);
    auto column = J.col(segment.column);
    if (segment.prismatic) {
      column.head<3>() += axis;
    } else {
      column.head<3>() -= axis.cross(frame.p - p_root);
      column.tail<3>() += axis;
    }
    move(frame, segment, values);
  }
  finish(frame, model, T_world_tip);
  const Eigen::Vector3d arm = T_world_tip.translation() - p_root;
  for (Eigen::Index i = model.base_columns(); i < J.cols(); ++i) J.col(i).head<3>() += J.col(i).tail<3>().cross(arm);
  if (model.has_base) {
    J(0, 0) = 1;
    J(1, 1) = 1;
    J.col(2) << -arm[1], arm[0], 0, 0, 0, 1;
  }
}

void JointGroup::link_poses(const Eigen::Ref<const Eigen::VectorXd>& q, Poses& T_world_link, bool moved_only) const {
  const GroupModel& model = *data_->model;
  const std::size_t count = model.robot.links().size();
  const bool all = !moved_only || T_world_link.size() != count;
  if (T_world_link.size() != count) T_world_link.assign(count, Pose::Identity());
  if (all || model.has_base) {
    const Frame root = root_frame(model, data_->T_world_root, q.data());
    T_world_link[0].linear() = root.R;
    T_world_link[0].translation() = root.p;
  }
  if (all) {
    for (const LinkStep& step : model.steps) place_link(step, q.data(), T_world_link);
  } else {
    for (const int step : model.moving_steps)
      place_link(model.steps[static_cast<std::size_t>(step)], q.data(), T_world_link);
  }
}

double JointGroup::manipulability(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, detail::kMaxGroupSize> J(6, size());
  Pose T_world_tip;
  fk_jacobian(q, T_world_tip, J);
  const Eigen::Matrix<double, 6, 6> JJt = J * J.transpose();
  return std::sqrt(std::max(0.0, JJt.determinant()));
}

}  // namespace mmgrasp
