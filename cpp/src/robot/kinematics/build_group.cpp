// Robot::group: a chain of joints, checked and flattened.
#include <algorithm>
#include <cmath>
#include <set>

#include "mmgrasp/core/detail/near_name.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/detail/joint_group_data.hpp"
#include "robot/model/joint_motion.hpp"

namespace mmgrasp {
namespace detail {
namespace {

const Joint& joint_of(const GroupModel& model, int index) {
  return model.robot.joints()[index];
}

constexpr double kAccelerationPerVelocity = 4.0;  // [1/s]: URDF knows no acceleration limits

struct Column {
  std::string name;
  int joint = -1;
  double lower = 0, upper = 0, velocity = 0, acceleration = 0;
  bool wraps = false;
};

std::vector<Column> base_columns(const BaseLimits& limits) {
  const double w = limits.workspace, v = limits.linear_velocity, a = limits.linear_acceleration;
  return {{"x", -1, -w, w, v, a, false},
          {"y", -1, -w, w, v, a, false},
          {"theta", -1, -kInfinity, kInfinity, limits.angular_velocity, limits.angular_acceleration, true}};
}

std::vector<Column> joint_columns(const Joint& joint, int index, double workspace) {
  const double v = joint.velocity, a = kAccelerationPerVelocity * v;
  const auto translation = [&](const char* axis) {
    return Column{joint.name + "/" + axis, index, -workspace, workspace, v, a, false};
  };
  // A rotation vector's entries are no angles of their own: half turns either way hold every rotation.
  const auto rotation = [&](const char* axis) {
    return Column{joint.name + "/" + axis, index, -kPi, kPi, v, a, false};
  };
  switch (joint.type) {
    case JointType::planar:
      return {translation("x"), translation("y"),
              Column{joint.name + "/theta", index, -kInfinity, kInfinity, v, a, true}};
    case JointType::floating:
      return {translation("x"), translation("y"), translation("z"), rotation("rx"), rotation("ry"), rotation("rz")};
    default:
      return {{joint.name, index, joint.lower, joint.upper, v, a, joint.type == JointType::continuous}};
  }
}

/// Values are given by name: a joint called "x" beside a base's x would be lost.
void check_names(const std::vector<Column>& columns, const std::string& group) {
  std::set<std::string> seen;
  for (const Column& column : columns) {
    if (!seen.insert(column.name).second)
      throw InvalidInput("group \"" + group + "\": joint \"" + column.name +
                         "\" has the name of another column (a base's are x, y, theta): rename the joint");
  }
}

void set_columns(const std::vector<Column>& columns, GroupModel& model) {
  const Eigen::Index size = static_cast<Eigen::Index>(columns.size());
  for (Eigen::VectorXd* v : {&model.lower, &model.upper, &model.velocity, &model.acceleration}) v->resize(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const Column& column = columns[i];
    model.names.push_back(column.name);
    model.joints.push_back(column.joint);
    model.wraps.push_back(column.wraps);
    model.lower[i] = column.lower;
    model.upper[i] = column.upper;
    model.velocity[i] = column.velocity;
    model.acceleration[i] = column.acceleration;
  }
}

}  // namespace

Drive drive_of(const GroupModel& model, int index) {
  const Joint& joint = joint_of(model, index);
  const int source = joint.mimic_joint >= 0 ? joint.mimic_joint : index;
  const auto found = std::find(model.joints.begin(), model.joints.end(), source);
  if (found == model.joints.end()) return {};
  Drive drive{static_cast<int>(found - model.joints.begin()), 1, 0};
  if (joint.mimic_joint >= 0) {
    drive.multiplier = joint.mimic_multiplier;
    drive.offset = joint.mimic_offset;
  }
  return drive;
}

Pose standing_pose(const GroupModel& model, const Joint& joint) {
  if (joint.mimic_joint >= 0) {
    const int source = joint_of(model, joint.mimic_joint).value_index;
    const double value = joint.mimic_multiplier * model.reference[source] + joint.mimic_offset;
    return joint.T_parent_joint * joint_motion(joint, &value);
  }
  if (joint.value_index < 0) return joint.T_parent_joint;
  return joint.T_parent_joint * joint_motion(joint, model.reference.data() + joint.value_index);
}

void flatten(GroupModel& model) {
  auto kinematics = std::make_shared<GroupKinematics>(model);
  flatten_frames(model, *kinematics);
  flatten_chain(model, *kinematics);
  model.kinematics = std::move(kinematics);
}

JointGroup make_group(const Robot& robot, const std::string& name, const std::vector<int>& joints, int tip_link,
                      bool with_base) {
  if (with_base && robot.base() == BaseKind::fixed)
    throw InvalidInput("group \"" + name + "\": with_base = true: robot \"" + robot.name() +
                       "\" has base kind fixed, load it as diff_drive or omni");
  auto model = std::make_shared<GroupModel>(robot);
  model->name = name;
  model->has_base = with_base;
  model->tip_link = tip_link;
  model->reference = robot.default_values();
  std::vector<Column> columns;
  if (with_base) columns = base_columns(robot.base_limits());
  for (const int index : joints) {
    const std::vector<Column> more = joint_columns(joint_of(*model, index), index, robot.base_limits().workspace);
    columns.insert(columns.end(), more.begin(), more.end());
  }
  const int size = static_cast<int>(columns.size());
  require(size > 0, "group \"" + name + "\" size", size, "must have at least one movable joint");
  require(size <= kMaxGroupSize, "group \"" + name + "\" size", size,
          "must be at most " + std::to_string(kMaxGroupSize));
  check_names(columns, name);
  set_columns(columns, *model);
  flatten(*model);
  return JointGroup(std::make_shared<JointGroup::Data>(std::move(model), Pose::Identity()));
}

}  // namespace detail

namespace {

/// True when `link` is `ancestor` or hangs from it.
bool hangs_from(const Robot& robot, int link, int ancestor) {
  while (link > ancestor) link = robot.joints()[link - 1].parent_link;
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
  const auto moves_tip = [&](int joint) { return hangs_from(*this, tip_link, joint + 1); };
  const bool ok = joints.empty() || (group.tip_link.empty() ? std::any_of(joints.begin(), joints.end(), moves_tip)
                                                            : moves_tip(joints.back()));
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
  for (int link = tip; link != base; link = joints()[link - 1].parent_link) {
    const Joint& joint = joints()[link - 1];
    // A mimic joint moves with the one it follows, which must be in the chain itself to count.
    if (joint.value_index >= 0) chain_joints.push_back(link - 1);
  }
  std::reverse(chain_joints.begin(), chain_joints.end());
  return detail::make_group(*this, base_link + "-" + tip_link, chain_joints, tip, with_base);
}

}  // namespace mmgrasp
