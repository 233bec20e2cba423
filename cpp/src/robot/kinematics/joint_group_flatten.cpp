// A chain as motions about and along z, which is what the kernels run on.
#include <algorithm>
#include <cmath>
#include <map>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/detail/joint_group_data.hpp"

namespace mmgrasp {
namespace detail {
namespace {

Eigen::Matrix3d turn_about(const Eigen::Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

/// A motion about or along z of its own frame.
struct AlongZ {
  Eigen::Matrix3d R;  ///< Rotation from the frame after the motion before.
  Eigen::Vector3d p;
  Motion motion = Motion::revolute;
  Drive drive;
};

struct Path {
  std::vector<AlongZ> motions;
  Rigid tip;  ///< Pose of the tip in the frame after the last motion.
};

/// The motions of the tree that move the tip, each frame turned so that its axis is z.
Path path_to_tip(const GroupModel& model, const FrameTree& tree) {
  const int tip_frame = tree.frame_of_link[model.tip_link];
  const std::vector<const ElementaryMotion*> above = tree.motions_above(tip_frame);
  Path path;
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();  // the frame before, to what the tree calls that frame
  for (auto it = above.rbegin(); it != above.rend(); ++it) {
    const ElementaryMotion& motion = **it;
    const Rigid rest = Rigid(turned.transpose(), Eigen::Vector3d::Zero()) * motion.rest;
    turned = rotation_from_z(motion.axis);
    path.motions.push_back({rest.R * turned, rest.t, motion.motion, motion.drive});
  }
  path.tip = Rigid(turned.transpose(), Eigen::Vector3d::Zero()) * tree.link_in_frame[model.tip_link];
  return path;
}

/// R = Rz(before) Rx(tilt) Rz(after).
struct ZxzAngles {
  double before = 0, after = 0;
  double tilt_cos = 1, tilt_sin = 0;
};

ZxzAngles zxz(const Eigen::Matrix3d& R) {
  ZxzAngles angles;
  angles.tilt_cos = R(2, 2);
  const double tilt = std::hypot(R(0, 2), R(1, 2));
  if (tilt > 4e-16) {                              // else the axes coincide to rounding, and there is but one angle
    angles.tilt_sin = R(1, 2) > 0 ? -tilt : tilt;  // of the two ways the one with the smaller angle before
    angles.before = std::atan2(R(0, 2) / angles.tilt_sin, -R(1, 2) / angles.tilt_sin);
  }
  const double c = std::cos(angles.before), s = std::sin(angles.before);
  const Eigen::Vector2d x(c * R(0, 0) + s * R(1, 0),
                          c * R(1, 0) - s * R(0, 0));  // column x before the rotation about z
  angles.after = std::atan2(angles.tilt_cos * x[1] + angles.tilt_sin * R(2, 0), x[0]);
  return angles;
}

/// Range of a prismatic joint as a length, for the reach bound.
double travel(const GroupModel& model, const AlongZ& motion) {
  if (motion.motion != Motion::prismatic) return 0;
  const double a = motion.drive.multiplier * model.lower[motion.drive.column] + motion.drive.offset;
  const double b = motion.drive.multiplier * model.upper[motion.drive.column] + motion.drive.offset;
  return std::max(std::abs(a), std::abs(b));
}

void bound_reach(const Path& path, GroupModel& model) {
  const Eigen::Vector3d p_tip = path.tip.t;
  model.reach = 0;
  model.first_joint = path.motions.empty() ? p_tip : path.motions.front().p;
  if (path.motions.empty()) return;
  model.reach = p_tip.norm();
  for (std::size_t i = 0; i < path.motions.size(); ++i)
    model.reach += travel(model, path.motions[i]) + (i > 0 ? path.motions[i].p.norm() : 0.0);
}

/// Bounds on the columns of the tip's Jacobian, by the longest lever of each joint: what lies beyond it, stretched out.
void bound_tip_motion(const Path& path, GroupModel& model) {
  std::map<int, TipLever> levers;  // by column
  double lever = path.tip.t.norm();
  for (auto motion = path.motions.rbegin(); motion != path.motions.rend(); ++motion) {
    const double rate = std::abs(motion->drive.multiplier);
    const bool slides = motion->motion == Motion::prismatic;
    TipLever& own = levers[motion->drive.column];
    own.first = motion->drive.column;
    // A rotation vector turns no faster than it changes.
    if (motion->motion == Motion::spherical) own.count = 3;
    own.speed += rate * (slides ? 1 : lever);
    if (!slides) own.turn += rate;
    lever += travel(model, *motion) + motion->p.norm();
  }
  if (model.has_base) {
    levers[0] = {0, 2, 1, 0};
    levers[2] = {2, 1, lever, 1};
  }
  model.tip_levers.clear();
  for (const auto& entry : levers) model.tip_levers.push_back(entry.second);
}

double wrapped(double angle) {
  return std::abs(angle) > kPi ? shortest_turn(angle) : angle;
}

void copy(const Eigen::Matrix3d& R, double* to) {
  Eigen::Map<Eigen::Matrix3d>(to, 3, 3) = R;
}

}  // namespace

int Angles::add(int at_column, double by, double from) {
  column.push_back(at_column);
  multiplier.push_back(by);
  offset.push_back(from);
  return static_cast<int>(column.size()) - 1;
}

AngleTable Angles::padded() {
  const int count = static_cast<int>(column.size());
  while (column.size() % kAngleBlock != 0) add(0, 0, 0);
  return {count, column.data(), multiplier.data(), offset.data()};
}

void flatten_chain(GroupModel& model, GroupKinematics& kinematics) {
  const Path path = path_to_tip(model, kinematics.tree);
  const int count = static_cast<int>(path.motions.size());
  require(count <= kMaxSegments, "group \"" + model.name + "\" motions on the way to its tip", count,
          "must be at most " + std::to_string(kMaxSegments));
  bound_reach(path, model);
  bound_tip_motion(path, model);
  std::vector<ZxzAngles> angles;
  for (const AlongZ& motion : path.motions) angles.push_back(zxz(motion.R));
  kinematics.first_angle = count > 0 ? angles.front().before : 0.0;
  std::vector<bool> seen(model.names.size(), false);
  for (int i = 0; i < model.base_columns(); ++i) seen[i] = true;
  for (int i = 0; i < count; ++i) {
    const AlongZ& motion = path.motions[i];
    const ZxzAngles& own = angles[i];
    const double next = i + 1 < count ? angles[i + 1].before : 0.0;
    Segment segment;
    const Eigen::Vector3d p = turn_about(Eigen::Vector3d::UnitZ(), -own.before) * motion.p;
    std::copy(p.data(), p.data() + 3, segment.p);
    segment.tilt_cos = own.tilt_cos;
    segment.tilt_sin = own.tilt_sin;
    segment.multiplier = motion.drive.multiplier;
    segment.offset = motion.drive.offset;
    segment.column = motion.drive.column;
    segment.motion = motion.motion;
    segment.adds = seen[segment.column];
    seen[segment.column] = true;
    const double between = wrapped(own.after + next);
    if (motion.motion == Motion::revolute) {
      kinematics.chain_angle_storage.add(segment.column, segment.multiplier,
                                         wrapped(own.after + next + segment.offset));
    } else {
      kinematics.chain_angle_storage.add(0, 0, motion.motion == Motion::prismatic ? between : 0.0);
    }
    if (motion.motion == Motion::spherical) {
      segment.spherical = static_cast<int>(kinematics.spherical.size());
      kinematics.spherical.push_back({segment.column, turn_about(Eigen::Vector3d::UnitZ(), own.after),
                                      turn_about(Eigen::Vector3d::UnitZ(), next)});
      for (int k = 0; k < 3; ++k) seen[segment.column + k] = true;
    }
    kinematics.segment_storage.push_back(segment);
  }
  if (model.has_base) kinematics.chain_angle_storage.add(2, 1, kinematics.first_angle);
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (!seen[i]) kinematics.still_storage.push_back(static_cast<int>(i));

  Chain& chain = kinematics.chain;
  chain.segments = count;
  chain.segment = kinematics.segment_storage.data();
  chain.angles = kinematics.chain_angle_storage.padded();
  chain.base = model.has_base;
  chain.columns = static_cast<int>(model.names.size());
  chain.still_columns = static_cast<int>(kinematics.still_storage.size());
  chain.still_column = kinematics.still_storage.data();
  copy(path.tip.R, chain.R_tip);
  std::copy(path.tip.t.data(), path.tip.t.data() + 3, chain.p_tip);
}

}  // namespace detail
}  // namespace mmgrasp
