#include "collision/moving_frames.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {

namespace {

// A rotation that takes z to the axis.
Eigen::Matrix3d z_to(const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
}

int column_of(const JointGroup& group, int index) {
  const Joint& joint = group.robot().joints()[index];
  const std::vector<int>& driven = group.joints();
  const auto it = std::find(driven.begin(), driven.end(), joint.mimic_joint >= 0 ? joint.mimic_joint : index);
  if (it == driven.end()) return -1;
  if (joint.value_count() > 1)
    throw InvalidInput("group \"" + group.name() + "\": joint \"" + joint.name + "\" is " + to_string(joint.type) +
                       ", collision checks move joints with one value only");
  return static_cast<int>(it - driven.begin());
}

}  // namespace

MovingFrames::MovingFrames(const JointGroup& group) : has_base_(group.has_base()) {
  const Robot& robot = group.robot();
  const Poses reference = robot.link_poses(group.reference());
  frame_of_.assign(robot.links().size(), 0);
  link_in_frame_.assign(robot.links().size(), Rigid());
  for (std::size_t link = 1; link < robot.links().size(); ++link) {
    const Joint& joint = robot.joints()[robot.links()[link].parent_joint];
    const Rigid& parent = link_in_frame_[joint.parent_link];
    const int column = column_of(group, robot.links()[link].parent_joint);
    if (column < 0) {
      frame_of_[link] = frame_of_[joint.parent_link];
      link_in_frame_[link] = parent * Rigid(reference[joint.parent_link]).to(Rigid(reference[link]));
      continue;
    }
    const Eigen::Matrix3d turn = z_to(joint.axis);
    const Rigid at_zero = parent * Rigid(joint.T_parent_joint);
    const Eigen::Matrix3d R = at_zero.R * turn;
    FrameStep step{};
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) step.R[4 * c + r] = R(r, c);
      step.p[c] = at_zero.t[c];
    }
    const bool mimics = joint.mimic_joint >= 0;
    step.multiplier = mimics ? joint.mimic_multiplier : 1;
    step.offset = mimics ? joint.mimic_offset : 0;
    step.parent = frame_of_[joint.parent_link];
    step.column = column;
    step.prismatic = joint.type == JointType::prismatic;
    steps_.push_back(step);
    frame_of_[link] = static_cast<int>(steps_.size());
    link_in_frame_[link] = Rigid(turn.transpose(), Eigen::Vector3d::Zero());
  }
}

void MovingFrames::set(const Rigid& T, double* frame) {
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) frame[4 * c + r] = T.R(r, c);
    frame[4 * c + 3] = 0;
    frame[12 + c] = T.t[c];
  }
  frame[15] = 0;
}

Rigid MovingFrames::get(const double* frame) {
  Rigid T;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) T.R(r, c) = frame[4 * c + r];
    T.t[c] = frame[12 + c];
  }
  return T;
}

void MovingFrames::place(const double* q, double* frames) const {
  if (has_base_) {
    const double c = std::cos(q[2]), s = std::sin(q[2]);
    const double root[16] = {c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, q[0], q[1], 0, 0};
    std::copy(root, root + 16, frames);
  }
  kernels().place_frames(steps_.data(), static_cast<int>(steps_.size()), q, frames);
}

void MovingFrames::add_rates(int frame, double radius, int against, const Eigen::VectorXd& largest,
                             Eigen::VectorXd& rates) const {
  // Walking up: `radius` always bounds the distance from the point to the origin of the frame at hand.
  while (frame > 0 && frame != against) {
    const FrameStep& step = steps_[frame - 1];
    const double factor = std::abs(step.multiplier);
    rates[step.column] += step.prismatic ? factor : factor * radius;
    if (step.prismatic) radius += std::abs(step.offset) + (factor > 0 ? factor * largest[step.column] : 0);
    radius += Eigen::Vector3d(step.p[0], step.p[1], step.p[2]).norm();
    frame = step.parent;
  }
  if (!has_base_ || frame == against) return;
  rates[0] += 1;
  rates[1] += 1;
  rates[2] += radius;
}

int MovingFrames::common_frame(int a, int b) const {
  // Frames are numbered from the root outwards.
  while (a != b) (a > b ? a : b) = steps_[(a > b ? a : b) - 1].parent;
  return a;
}

}  // namespace mmgrasp::detail
