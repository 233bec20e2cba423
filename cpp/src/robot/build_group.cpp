#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "robot/joint_group_data.hpp"
#include "robot/joint_motion.hpp"
#include "robot/near_name.hpp"

namespace mmgrasp {
namespace detail {
namespace {

const Joint& joint_of(const GroupModel& model, int index) {
  return model.robot.joints()[static_cast<std::size_t>(index)];
}

/// How one robot joint depends on the configuration; column -1 when it stands still.
struct Drive {
  int column = -1;
  double multiplier = 1, offset = 0;
};

Drive drive_of(const GroupModel& model, const Joint& joint, int index) {
  const int source = joint.mimic_joint >= 0 ? joint.mimic_joint : index;
  const auto found = std::find(model.joints.begin(), model.joints.end(), source);
  if (found == model.joints.end()) return {};
  Drive drive{model.base_columns() + static_cast<int>(found - model.joints.begin()), 1, 0};
  if (joint.mimic_joint >= 0) {
    drive.multiplier = joint.mimic_multiplier;
    drive.offset = joint.mimic_offset;
  }
  return drive;
}

/// T_parent_child of a joint that stands at the reference.
Pose standing_pose(const GroupModel& model, const Joint& joint) {
  if (joint.mimic_joint >= 0) {
    const int source = joint_of(model, joint.mimic_joint).value_index;
    const double value = joint.mimic_multiplier * model.reference[source] + joint.mimic_offset;
    return joint.T_parent_joint * joint_motion(joint, &value);
  }
  if (joint.value_index < 0) return joint.T_parent_joint;
  return joint.T_parent_joint * joint_motion(joint, model.reference.data() + joint.value_index);
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d M;
  M << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return M;
}

LinkStep link_step(const GroupModel& model, const Joint& joint, int index) {
  const Drive drive = drive_of(model, joint, index);
  LinkStep step;
  step.link = joint.child_link;
  step.parent = joint.parent_link;
  step.column = drive.column;
  step.multiplier = drive.multiplier;
  step.offset = drive.offset;
  step.prismatic = joint.type == JointType::prismatic;
  const Pose T = drive.column < 0 ? standing_pose(model, joint) : joint.T_parent_joint;
  const Eigen::Matrix3d R = T.linear();
  step.A = R;
  step.B.setZero();
  step.C.setZero();
  if (drive.column >= 0 && !step.prismatic) {
    // Rodrigues: a a^T + sin [a]x + cos (1 - a a^T), with the fixed rotation multiplied in.
    const Eigen::Matrix3d along = joint.axis * joint.axis.transpose();
    step.A = R * along;
    step.B = R * cross_matrix(joint.axis);
    step.C = R * (Eigen::Matrix3d::Identity() - along);
  }
  step.p0 = T.translation();
  step.d = R * joint.axis;
  return step;
}

void flatten_links(GroupModel& model) {
  model.steps.clear();
  model.moving_links.clear();
  model.moving_steps.clear();
  std::vector<bool> moves(model.robot.links().size(), model.has_base);
  if (model.has_base) model.moving_links.push_back(0);
  const std::vector<Joint>& joints = model.robot.joints();
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const LinkStep step = link_step(model, joints[i], static_cast<int>(i));
    if (moves[static_cast<std::size_t>(step.parent)] || step.column >= 0) {
      moves[static_cast<std::size_t>(step.link)] = true;
      model.moving_links.push_back(step.link);
      model.moving_steps.push_back(static_cast<int>(model.steps.size()));
    }
    model.steps.push_back(step);
  }
}

Eigen::Matrix3d rotation_from_z(const Eigen::Vector3d& axis) {
  if (axis == -Eigen::Vector3d::UnitZ()) return Eigen::Vector3d(1, -1, -1).asDiagonal();
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
}

/// Range of a joint value as a length, for the reach bound.
double travel(const GroupModel& model, const ChainSegment& segment) {
  if (!segment.prismatic) return 0;
  const double a = segment.multiplier * model.lower[segment.column] + segment.offset;
  const double b = segment.multiplier * model.upper[segment.column] + segment.offset;
  return std::max(std::abs(a), std::abs(b));
}

void flatten_chain(GroupModel& model) {
  std::vector<int> path;
  for (int link = model.tip_link; link > 0; link = joint_of(model, link - 1).parent_link) path.push_back(link - 1);
  std::reverse(path.begin(), path.end());
  model.chain.clear();
  model.reach = 0;
  model.first_joint.setZero();
  Pose fixed = Pose::Identity();
  for (const int index : path) {
    const Joint& joint = joint_of(model, index);
    const Drive drive = drive_of(model, joint, index);
    if (drive.column < 0) {
      fixed = fixed * standing_pose(model, joint);
      continue;
    }
    // Turn the joint frame so that the axis is z, and back behind the joint.
    const Eigen::Matrix3d align = rotation_from_z(joint.axis);
    const Pose before = fixed * joint.T_parent_joint;
    ChainSegment segment;
    segment.R = before.linear() * align;
    segment.p = before.translation();
    segment.prismatic = joint.type == JointType::prismatic;
    segment.column = drive.column;
    segment.multiplier = drive.multiplier;
    segment.offset = drive.offset;
    if (model.chain.empty()) {
      model.first_joint = segment.p;
    } else {
      model.reach += segment.p.norm();
    }
    model.reach += travel(model, segment);
    model.chain.push_back(segment);
    fixed = Pose::Identity();
    fixed.linear() = align.transpose();
  }
  model.R_tip = fixed.linear();
  model.p_tip = fixed.translation();
  if (model.chain.empty()) {
    model.first_joint = model.p_tip;
  } else {
    model.reach += model.p_tip.norm();
  }
}

void add_base_columns(GroupModel& model, std::vector<double> (&columns)[4]) {
  const BaseLimits& limits = model.robot.base_limits();
  const double inf = std::numeric_limits<double>::infinity();
  model.names = {"x", "y", "theta"};
  model.wraps = {false, false, true};
  columns[0] = {-limits.workspace, -limits.workspace, -inf};
  columns[1] = {limits.workspace, limits.workspace, inf};
  columns[2] = {limits.linear_velocity, limits.linear_velocity, limits.angular_velocity};
  columns[3] = {limits.linear_acceleration, limits.linear_acceleration, limits.angular_acceleration};
}

Eigen::VectorXd to_eigen(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

void flatten(GroupModel& model) {
  flatten_links(model);
  flatten_chain(model);
}

JointGroup make_group(const Robot& robot, const std::string& name, const std::vector<int>& joints, int tip_link,
                      bool with_base) {
  constexpr double kAccelerationPerVelocity = 4.0;  // [1/s]: URDF knows no acceleration limits
  if (with_base && robot.base() == BaseKind::fixed)
    throw InvalidInput("group \"" + name + "\": with_base = true: robot \"" + robot.name() +
                       "\" has base kind fixed, load it as diff_drive or omni");
  auto model = std::make_shared<GroupModel>(robot);
  model->name = name;
  model->joints = joints;
  model->has_base = with_base;
  model->tip_link = tip_link;
  model->reference = robot.default_values();
  std::vector<double> columns[4];  // lower, upper, velocity, acceleration
  if (with_base) add_base_columns(*model, columns);
  for (const int index : joints) {
    const Joint& joint = joint_of(*model, index);
    model->names.push_back(joint.name);
    model->wraps.push_back(joint.type == JointType::continuous);
    const double values[4] = {joint.lower, joint.upper, joint.velocity, kAccelerationPerVelocity * joint.velocity};
    for (int i = 0; i < 4; ++i) columns[i].push_back(values[i]);
  }
  const int size = static_cast<int>(model->names.size());
  require(size > 0, "group \"" + name + "\" size", size, "must have at least one movable joint");
  require(size <= kMaxGroupSize, "group \"" + name + "\" size", size,
          "must be at most " + std::to_string(kMaxGroupSize));
  model->lower = to_eigen(columns[0]);
  model->upper = to_eigen(columns[1]);
  model->velocity = to_eigen(columns[2]);
  model->acceleration = to_eigen(columns[3]);
  flatten(*model);
  return JointGroup(std::make_shared<JointGroup::Data>(JointGroup::Data{std::move(model), Pose::Identity()}));
}

}  // namespace detail

namespace {

/// True when `link` is `ancestor` or hangs from it.
bool hangs_from(const Robot& robot, int link, int ancestor) {
  while (link > ancestor) link = robot.joints()[static_cast<std::size_t>(link - 1)].parent_link;
  return link == ancestor;
}

const GroupDescription& find_group(const Robot& robot, const std::string& name) {
  std::vector<std::string> known;
  for (const GroupDescription& group : robot.groups()) {
    if (group.name == name) return group;
    known.push_back(group.name);
  }
  std::string list;
  for (const std::string& each : known) list += (list.empty() ? "" : ", ") + each;
  throw InvalidInput("group = \"" + name + "\": robot \"" + robot.name() + "\" has no such group" +
                     detail::near_miss(name, known) + "; known groups: " + (list.empty() ? "none (no SRDF)" : list));
}

}  // namespace

JointGroup Robot::group(const std::string& name, const std::string& tip, bool with_base) const {
  const GroupDescription& group = find_group(*this, name);
  std::vector<int> joints;
  for (const std::string& joint : group.joints) joints.push_back(joint_index(joint));
  if (tip.empty()) {
    if (group.tip_link.empty())
      throw InvalidInput("group \"" + name + "\" is no chain: name the tip link that is meant");
    return detail::make_group(*this, name, joints, link_index(group.tip_link), with_base);
  }
  const int tip_link = link_index(tip);
  // A tree (a hand, two arms) may take its tip anywhere below any of its joints, a chain below its last one.
  const auto carries = [&](int joint) { return hangs_from(*this, tip_link, joint + 1); };
  const bool ok = joints.empty() || (group.tip_link.empty() ? std::any_of(joints.begin(), joints.end(), carries)
                                                            : carries(joints.back()));
  if (!ok)
    throw InvalidInput("tip = \"" + tip + "\": must be carried by the last joint of group \"" + name + "\" (\"" +
                       group.joints.back() + "\")");
  return detail::make_group(*this, name, joints, tip_link, with_base);
}

JointGroup Robot::chain(const std::string& base_link, const std::string& tip_link, bool with_base) const {
  const int base = link_index(base_link), tip = link_index(tip_link);
  if (!hangs_from(*this, tip, base))
    throw InvalidInput("tip_link = \"" + tip_link + "\": must hang from base_link = \"" + base_link + "\"");
  std::vector<int> chain_joints;
  for (int link = tip; link != base; link = joints()[static_cast<std::size_t>(link - 1)].parent_link) {
    const Joint& joint = joints()[static_cast<std::size_t>(link - 1)];
    if (joint.value_count() > 1)
      throw InvalidInput("joint \"" + joint.name + "\": is " + to_string(joint.type) +
                         ", a chain may hold joints with one value only");
    // A mimic joint moves with the one it follows, which must be in the chain itself to count.
    if (joint.value_index >= 0) chain_joints.push_back(link - 1);
  }
  std::reverse(chain_joints.begin(), chain_joints.end());
  return detail::make_group(*this, base_link + "-" + tip_link, chain_joints, tip, with_base);
}

}  // namespace mmgrasp
