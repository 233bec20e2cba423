#include "collision/moving_frames.hpp"

#include <algorithm>
#include <cmath>

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
  return it == driven.end() ? -1 : static_cast<int>(it - driven.begin());
}

// One motion about or along z of `align`, seen from the joint's frame.
struct Motion {
  Eigen::Matrix3d align;
  FrameMotion kind;
};

// Turns an axis of the frame to where its z is.
Eigen::Matrix3d axis_first(const Eigen::Matrix3d& frame, int axis) {
  Eigen::Matrix3d align;
  for (int c = 0; c < 3; ++c) align.col((c + 2) % 3) = frame.col((axis + c) % 3);
  return align;
}

// A column of the configuration each, but for the ball, which takes three.
std::vector<Motion> motions_of(const Joint& joint) {
  const Eigen::Matrix3d own = Eigen::Matrix3d::Identity(), turned = z_to(joint.axis);
  switch (joint.type) {
    case JointType::fixed:
      return {};
    case JointType::revolute:
    case JointType::continuous:
      return {{turned, FrameMotion::turn}};
    case JointType::prismatic:
      return {{turned, FrameMotion::slide}};
    case JointType::planar:
      return {{axis_first(turned, 0), FrameMotion::slide},
              {axis_first(turned, 1), FrameMotion::slide},
              {turned, FrameMotion::turn}};
    case JointType::floating:
      return {{axis_first(own, 0), FrameMotion::slide},
              {axis_first(own, 1), FrameMotion::slide},
              {own, FrameMotion::slide},
              {own, FrameMotion::ball}};
  }
  return {};
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
    const bool mimics = joint.mimic_joint >= 0;
    int frame = frame_of_[joint.parent_link], at = column;
    Rigid rest = parent * Rigid(joint.T_parent_joint);
    for (const Motion& motion : motions_of(joint)) {
      FrameStep step{};
      const Eigen::Matrix3d R = rest.R * motion.align;
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) step.R[4 * c + r] = R(r, c);
        step.p[c] = rest.t[c];
      }
      step.multiplier = mimics ? joint.mimic_multiplier : 1;
      step.offset = mimics ? joint.mimic_offset : 0;
      step.parent = frame;
      step.column = at++;
      step.motion = motion.kind;
      steps_.push_back(step);
      frame = static_cast<int>(steps_.size());
      rest = Rigid(motion.align.transpose(), Eigen::Vector3d::Zero());
    }
    frame_of_[link] = frame;
    link_in_frame_[link] = rest;
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
    const bool slides = step.motion == FrameMotion::slide;
    rates[step.column] += slides ? factor : factor * radius;
    if (step.motion == FrameMotion::ball) {
      // A rotation vector's rate is never less than the angular velocity it makes.
      rates[step.column + 1] += radius;
      rates[step.column + 2] += radius;
    }
    if (slides) radius += std::abs(step.offset) + (factor > 0 ? factor * largest[step.column] : 0);
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
