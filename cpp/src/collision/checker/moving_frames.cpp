#include "collision/checker/moving_frames.hpp"

#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {

namespace {

// A rotation that takes z to the axis.
Eigen::Matrix3d z_to(const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
}

// Where a body may be, seen from some frame, whatever the values of the joints in between.
struct Region {
  Eigen::Vector3d centre;
  double radius;
};

// The region that holds the body at every value of the joint, seen from its frame before it moves; the same holds the
// other way round.
Region swept(const FrameStep& step, Region region, const Eigen::VectorXd& largest) {
  switch (step.motion) {
    case FrameMotion::revolute:
      region.radius += region.centre.head<2>().norm();
      region.centre.head<2>().setZero();
      break;
    case FrameMotion::prismatic:
      region.radius +=
          std::abs(step.offset) + (step.multiplier != 0 ? std::abs(step.multiplier) * largest[step.column] : 0);
      break;
    case FrameMotion::spherical:
      region.radius += region.centre.norm();
      region.centre.setZero();
      break;
  }
  return region;
}

// How far a body's points move per unit of the joint's value, seen from the joint's frame.
double rate_about(const FrameStep& step, const Region& region) {
  const double factor = std::abs(step.multiplier);
  switch (step.motion) {
    case FrameMotion::revolute:
      return factor * (region.centre.head<2>().norm() + region.radius);
    case FrameMotion::prismatic:
      return factor;
    case FrameMotion::spherical:
      break;
  }
  return region.centre.norm() + region.radius;
}

// rates[i]: how fast the body in `sphere` moves about joint path[i]; the path leads from its frame up to joint `top` -
// 1 and down from joint `top` on.
std::vector<double> rates_on_path(const std::vector<const FrameStep*>& path, std::size_t top, const FrameSphere& sphere,
                                  const Eigen::VectorXd& largest) {
  std::vector<double> rates;
  Region region{Eigen::Vector3d(sphere.p), sphere.radius};
  for (std::size_t i = 0; i < path.size(); ++i) {
    const FrameStep& step = *path[i];
    const Rigid T = MovingFrames::rest(step);
    const bool up = i < top;
    if (!up) region.centre = T.R.transpose() * (region.centre - T.t);
    rates.push_back(rate_about(step, region));
    region = swept(step, region, largest);
    if (up) region.centre = T * region.centre;
  }
  return rates;
}

int column_of(const JointGroup& group, int index) {
  const Joint& joint = group.robot().joints()[index];
  const std::vector<int>& driven = group.joints();
  const auto it = std::find(driven.begin(), driven.end(), joint.mimic_joint >= 0 ? joint.mimic_joint : index);
  return it == driven.end() ? -1 : static_cast<int>(it - driven.begin());
}

// One motion about or along z of `align`, seen from the joint's frame.
struct ElementaryMotion {
  Eigen::Matrix3d align;
  FrameMotion kind;
};

// Turns an axis of the frame to where its z is.
Eigen::Matrix3d axis_first(const Eigen::Matrix3d& frame, int axis) {
  Eigen::Matrix3d align;
  for (int c = 0; c < 3; ++c) align.col((c + 2) % 3) = frame.col((axis + c) % 3);
  return align;
}

// A column of the configuration each, but for the sphere, which takes three.
std::vector<ElementaryMotion> motions_of(const Joint& joint) {
  const Eigen::Matrix3d own = Eigen::Matrix3d::Identity(), turned = z_to(joint.axis);
  switch (joint.type) {
    case JointType::fixed:
      return {};
    case JointType::revolute:
    case JointType::continuous:
      return {{turned, FrameMotion::revolute}};
    case JointType::prismatic:
      return {{turned, FrameMotion::prismatic}};
    case JointType::planar:
      return {{axis_first(turned, 0), FrameMotion::prismatic},
              {axis_first(turned, 1), FrameMotion::prismatic},
              {turned, FrameMotion::revolute}};
    case JointType::floating:
      return {{axis_first(own, 0), FrameMotion::prismatic},
              {axis_first(own, 1), FrameMotion::prismatic},
              {own, FrameMotion::prismatic},
              {own, FrameMotion::spherical}};
  }
  return {};
}

}  // namespace

MovingFrames::MovingFrames(const JointGroup& group)
    : has_base_(group.has_base()), columns_(static_cast<int>(group.size())) {
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
    for (const ElementaryMotion& motion : motions_of(joint)) {
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
      bends_ = bends_ && motion.kind != FrameMotion::spherical;
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

Rigid MovingFrames::rest(const FrameStep& step) {
  return {Eigen::Map<const Eigen::Matrix<double, 4, 3>>(step.R).topRows<3>(), Eigen::Vector3d(step.p)};
}

void MovingFrames::place(const double* q, double* frames) const {
  if (has_base_) {
    const double c = std::cos(q[2]), s = std::sin(q[2]);
    const double root[16] = {c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, q[0], q[1], 0, 0};
    std::copy(root, root + 16, frames);
  }
  kernels().place_frames(steps_.data(), static_cast<int>(steps_.size()), q, frames);
}

std::vector<MovingFrames::JointReach> MovingFrames::joints_above(const FrameSphere& sphere,
                                                                 const Eigen::VectorXd& largest) const {
  std::vector<JointReach> joints;
  // Walking up: `radius` always bounds the distance from the points to the origin of the frame at hand.
  double radius = Eigen::Vector3d(sphere.p).norm() + sphere.radius;
  for (int frame = sphere.frame; frame > 0;) {
    const FrameStep& step = steps_[frame - 1];
    const double factor = std::abs(step.multiplier);
    const bool slides = step.motion == FrameMotion::prismatic;
    joints.push_back({step.column, slides ? 0 : factor, slides ? factor : factor * radius});
    if (step.motion == FrameMotion::spherical) {
      // A rotation vector's rate is never less than the angular velocity it makes.
      for (const int k : {1, 2}) joints.push_back({step.column + k, 1, radius});
    }
    if (slides) radius += std::abs(step.offset) + (factor > 0 ? factor * largest[step.column] : 0);
    radius += Eigen::Vector3d(step.p[0], step.p[1], step.p[2]).norm();
    frame = step.parent;
  }
  if (has_base_) {
    joints.push_back({2, 1, radius});
    for (const int k : {0, 1}) joints.push_back({k, 0, 1});
  }
  return joints;
}

void MovingFrames::joints_between(const FrameSphere& a, const FrameSphere& b, const Eigen::VectorXd& largest,
                                  std::vector<JointReach>& of_a, std::vector<JointReach>& of_b) const {
  const int common = common_frame(a.frame, b.frame);
  std::vector<const FrameStep*> path, down;
  for (int frame = a.frame; frame != common; frame = path.back()->parent) path.push_back(&steps_[frame - 1]);
  for (int frame = b.frame; frame != common; frame = down.back()->parent) down.push_back(&steps_[frame - 1]);
  const std::size_t up = path.size();
  path.insert(path.end(), down.rbegin(), down.rend());
  const auto reaches = [&](std::size_t top, const FrameSphere& sphere, std::vector<JointReach>& out) {
    const std::vector<double> rates = rates_on_path(path, top, sphere, largest);
    out.clear();
    for (std::size_t i = 0; i < path.size(); ++i) {
      const FrameStep& step = *path[i];
      const bool slides = step.motion == FrameMotion::prismatic;
      out.push_back({step.column, slides ? 0 : std::abs(step.multiplier), rates[i]});
    }
  };
  reaches(up, a, of_a);
  std::reverse(path.begin(), path.end());
  reaches(path.size() - up, b, of_b);
}

Eigen::VectorXd MovingFrames::point_rates(const FrameSphere& sphere, const Eigen::VectorXd& largest) const {
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(columns_);
  for (const JointReach& joint : joints_above(sphere, largest)) rates[joint.column] += joint.rate;
  return rates;
}

Eigen::VectorXd MovingFrames::closing_rates(const FrameSphere& a, const FrameSphere& b,
                                            const Eigen::VectorXd& largest) const {
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(columns_);
  std::vector<JointReach> of_a, of_b;
  joints_between(a, b, largest, of_a, of_b);
  const auto spherical = [&](int column) {
    return std::any_of(steps_.begin(), steps_.end(), [&](const FrameStep& step) {
      return step.motion == FrameMotion::spherical && step.column == column;
    });
  };
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    const JointReach& joint = of_a[i];
    const double rate = std::min(joint.rate, of_b[of_b.size() - 1 - i].rate);
    // A rotation vector's rate is never less than the angular velocity it makes.
    for (int k = 0; k < (spherical(joint.column) ? 3 : 1); ++k) rates[joint.column + k] += rate;
  }
  return rates;
}

// With the angular velocities w_k of the joints from the root outwards and u_k from joint k to the point, the
// acceleration is the sum over k of w_k x (w_k x u_k) + 2 w_j x (w_k x u_k) for all j before k.
Eigen::VectorXd MovingFrames::bends_of(const std::vector<JointReach>& joints) const {
  Eigen::VectorXd bends = Eigen::VectorXd::Zero(columns_ * (columns_ + 1) / 2);
  const auto entry = [&](int i, int j) -> double& {
    if (i > j) std::swap(i, j);
    return bends[i * columns_ - i * (i - 1) / 2 + j - i];
  };
  for (std::size_t k = 0; k < joints.size(); ++k) {
    entry(joints[k].column, joints[k].column) += joints[k].rate * joints[k].turning;
    for (std::size_t j = k + 1; j < joints.size(); ++j)
      entry(joints[j].column, joints[k].column) += 2 * joints[j].turning * joints[k].rate;
  }
  return bends;
}

Eigen::VectorXd MovingFrames::point_bends(const FrameSphere& sphere, const Eigen::VectorXd& largest) const {
  return bends_of(joints_above(sphere, largest));
}

Eigen::VectorXd MovingFrames::closing_bends(const FrameSphere& a, const FrameSphere& b, const Eigen::VectorXd& largest,
                                            bool& b_moves) const {
  std::vector<JointReach> of_a, of_b;
  joints_between(a, b, largest, of_a, of_b);
  const Eigen::VectorXd bends_a = bends_of(of_a), bends_b = bends_of(of_b);
  b_moves = bends_b.sum() < bends_a.sum();
  return b_moves ? bends_b : bends_a;
}

void MovingFrames::squares(const Eigen::VectorXd& values, Eigen::VectorXd& out) {
  const Eigen::Index n = values.size();
  out.resize(n * (n + 1) / 2);
  for (Eigen::Index i = 0, at = 0; i < n; at += n - i++) out.segment(at, n - i) = values[i] * values.tail(n - i);
}

int MovingFrames::common_frame(int a, int b) const {
  // Frames are numbered from the root outwards.
  while (a != b) (a > b ? a : b) = steps_[(a > b ? a : b) - 1].parent;
  return a;
}

}  // namespace mmgrasp::detail
