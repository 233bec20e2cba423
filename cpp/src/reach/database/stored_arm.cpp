#include "reach/database/stored_arm.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/hash.hpp"
#include "mmgrasp/robot/detail/joint_group_data.hpp"

namespace mmgrasp::detail {
namespace {

std::vector<double> rows_of(const double* R, const double* p) {
  std::vector<double> out;
  for (int row = 0; row < 3; ++row) out.insert(out.end(), {R[row], R[row + 3], R[row + 6], p[row]});
  return out;
}

void columns_of(const std::vector<double>& rows, double* R, double* p) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) R[row + 3 * column] = rows[4 * row + column];
    p[row] = rows[4 * row + 3];
  }
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.9g", value);
  return text;
}

}  // namespace

/// The arm in the form that the kinematics kernels read.
struct StoredArm::Tables {
  std::vector<Segment> segments;
  Angles angles;
  RootPose root;
  Chain chain;
};

StoredArm::StoredArm(const JointGroup& arm) {
  const GroupKinematics& kinematics = *arm.data().kinematics;
  require(kinematics.spherical.empty(), "arm", arm.name(), "must not have floating joints on the way to its tip");
  robot = arm.robot().name();
  robot_hash = Hasher().add(arm.robot().hash()).hex();
  group = arm.name();
  tip = arm.robot().links()[arm.tip_link()].name;
  joints = arm.names();
  const Eigen::VectorXd reference = arm.full_values(Eigen::VectorXd::Zero(arm.size()));
  const Eigen::VectorXd moved = arm.full_values(Eigen::VectorXd::Ones(arm.size()));
  for (const Joint& joint : arm.robot().joints()) {
    for (int i = 0; joint.value_index >= 0 && i < joint.value_count(); ++i) {
      const Eigen::Index at = joint.value_index + i;
      if (reference[at] != moved[at]) continue;
      other_joints.push_back(joint.value_count() == 1 ? joint.name : joint.name + "/" + std::to_string(i));
      other_values.push_back(reference[at]);
    }
  }
  const Eigen::VectorXd low = arm.sample_lower(), high = arm.sample_upper();
  for (Eigen::Index i = 0; i < low.size(); ++i) {
    double width = (high[i] - low[i]) / (kLevels - 1);
    while (width > 0 && low[i] + width * (kLevels - 1) > high[i]) width = std::nextafter(width, 0.0);
    lower.push_back(low[i]);
    step.push_back(width);
  }
  for (int i = 0; i < kinematics.chain.segments; ++i) {
    const Segment& segment = kinematics.chain.segment[i];
    const AngleTable& angles = kinematics.chain.angles;
    const bool prismatic = segment.motion == Motion::prismatic;
    chain.insert(chain.end(),
                 {segment.p[0], segment.p[1], segment.p[2], segment.tilt_cos, segment.tilt_sin, angles.multiplier[i],
                  angles.offset[i], prismatic ? segment.multiplier : 0.0, prismatic ? segment.offset : 0.0,
                  static_cast<double>(segment.column), prismatic ? 1.0 : 0.0});
  }
  root = rows_of(arm.data().root.R, arm.data().root.p);
  tip_pose = rows_of(kinematics.chain.R_tip, kinematics.chain.p_tip);
  complete();
}

bool StoredArm::sound() const {
  const auto count = joints.size();
  if (count == 0 || count > kMaxColumns || lower.size() != count || step.size() != count) return false;
  if (chain.size() % kRow != 0 || chain.size() > kRow * kMaxSegments) return false;
  if (root.size() != 12 || tip_pose.size() != 12 || other_joints.size() != other_values.size()) return false;
  for (const auto* values : {&lower, &step, &chain, &root, &tip_pose})
    for (const double value : *values)
      if (!std::isfinite(value)) return false;
  for (std::size_t i = 9; i < chain.size(); i += kRow)
    if (!(chain[i] >= 0 && chain[i] < static_cast<double>(count))) return false;
  return true;
}

void StoredArm::complete() {
  auto tables = std::make_shared<Tables>();
  for (std::size_t i = 0; i < chain.size(); i += kRow) {
    const double* row = &chain[i];
    Segment segment;
    std::copy(row, row + 3, segment.p);
    segment.tilt_cos = row[3];
    segment.tilt_sin = row[4];
    segment.column = static_cast<int>(row[9]);
    segment.motion = row[10] != 0 ? Motion::prismatic : Motion::revolute;
    segment.multiplier = row[7];
    segment.offset = row[8];
    tables->angles.add(segment.column, row[5], row[6]);
    tables->segments.push_back(segment);
  }
  tables->chain.segments = static_cast<int>(tables->segments.size());
  tables->chain.segment = tables->segments.data();
  tables->chain.angles = tables->angles.padded();
  tables->chain.columns = size();
  columns_of(tip_pose, tables->chain.R_tip, tables->chain.p_tip);
  columns_of(root, tables->root.R, tables->root.p);
  tables_ = std::move(tables);
}

void StoredArm::decode(const std::uint16_t* stored, std::size_t count, double* q) const {
  const std::size_t n = joints.size();
  for (std::size_t i = 0; i < count; ++i, stored += n, q += n)
    for (std::size_t k = 0; k < n; ++k) q[k] = lower[k] + step[k] * stored[k];
}

void StoredArm::tool_poses(const std::uint16_t* stored, std::size_t count, Pose* poses) const {
  constexpr std::size_t kBlock = 64, kLanes = 8;
  double q[(kBlock + kLanes) * kMaxColumns];
  const std::size_t n = joints.size();
  for (std::size_t first = 0; first < count; first += kBlock) {
    const std::size_t some = std::min(kBlock, count - first);
    decode(stored + first * n, some, q);
    tool_poses_of(q, some, poses + first);
  }
}

void StoredArm::tool_poses_of(const double* q, std::size_t count, Pose* poses) const {
  static_assert(sizeof(Pose) == 16 * sizeof(double), "poses must lie next to each other");
  const KinematicsKernels& kernels = kinematics_kernels();
  const std::size_t lanes = kernels.lanes, n = joints.size();
  const std::size_t whole = count / lanes, rest = count % lanes;
  const Chain& chain_tables = tables_->chain;
  if (whole > 0)
    kernels.batch(chain_tables, tables_->root, q, static_cast<long>(n), static_cast<long>(whole), poses[0].data(),
                  nullptr);
  if (rest == 0) return;
  // Filled up with the last one, so that a pose does not depend on where it stands among the others.
  constexpr std::size_t kMaxLanes = 8;
  double last[kMaxLanes * kMaxColumns], out[kMaxLanes * 16];
  for (std::size_t i = 0; i < lanes; ++i) std::copy_n(q + (whole * lanes + std::min(i, rest - 1)) * n, n, last + i * n);
  kernels.batch(chain_tables, tables_->root, last, static_cast<long>(n), 1, out, nullptr);
  std::copy(out, out + 16 * rest, poses[whole * lanes].data());
}

std::string StoredArm::difference(const StoredArm& now) const {
  const auto changed = [](const std::string& what, const std::string& then, const std::string& current) {
    return what + " was " + then + ", is " + current;
  };
  const auto listed = [](const std::vector<std::string>& names) {
    std::string out;
    for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
    return "[" + out + "]";
  };
  if (robot != now.robot) return changed("the robot", "\"" + robot + "\"", "\"" + now.robot + "\"");
  if (joints != now.joints) return changed("the list of joints", listed(joints), listed(now.joints));
  if (tip != now.tip) return changed("the tip", "\"" + tip + "\"", "\"" + now.tip + "\"");
  for (std::size_t i = 0; i < lower.size(); ++i) {
    if (lower[i] != now.lower[i])
      return changed("the lower limit of \"" + joints[i] + "\"", short_number(lower[i]), short_number(now.lower[i]));
    if (step[i] != now.step[i])
      return changed("the upper limit of \"" + joints[i] + "\"", short_number(value(static_cast<int>(i), kLevels - 1)),
                     short_number(now.value(static_cast<int>(i), kLevels - 1)));
  }
  if (other_joints != now.other_joints)
    return changed("the list of the robot's other joints", listed(other_joints), listed(now.other_joints));
  for (std::size_t i = 0; i < other_values.size(); ++i) {
    if (other_values[i] != now.other_values[i])
      return changed("the value \"" + other_joints[i] + "\" is held at", short_number(other_values[i]),
                     short_number(now.other_values[i]));
  }
  if (chain != now.chain || root != now.root || tip_pose != now.tip_pose)
    return "the kinematics of the chain to \"" + tip + "\" (origins or axes of joints) is another";
  if (robot_hash != now.robot_hash)
    return "the robot's collision shapes, disabled pairs or links off the arm are others";
  return {};
}

}  // namespace mmgrasp::detail
