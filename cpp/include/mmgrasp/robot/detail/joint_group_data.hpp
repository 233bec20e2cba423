#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/robot/detail/chain_kernel.hpp"
#include "mmgrasp/robot/detail/frame_tree.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp {
namespace detail {

constexpr int kMaxGroupSize = kMaxColumns;  ///< Lets Jacobians live on the stack.

/// Storage of an AngleTable.
struct Angles {
  std::vector<int> column;
  std::vector<double> multiplier, offset;
  int add(int at_column, double by, double from);  ///< Returns the entry's index.
  AngleTable padded();                             ///< Fills the last block; the table is what the kernels read.
};

/// A floating joint on the way to the tip, between the rotations about z that belong to its neighbours.
struct SphericalFrame {
  int column = 0;
  Eigen::Matrix3d before, after;
};

/// A joint of the group, or one that mimics it, as a mover of points.
struct Mover {
  int joint = 0;
  int column = 0;
  double multiplier = 1;
  Eigen::Vector3d axis;  ///< Revolute or prismatic: in the parent link.
  int next = -1;         ///< The mover above it.
};

/// The kinematics of a group: its tree of frames, and what the kernels read, made from it: the chain to the tip, and a
/// step for each frame and each link. Not copied, so that the tables may point into their storage.
struct GroupKinematics {
  explicit GroupKinematics(const GroupModel& model) : tree(model) {}
  GroupKinematics(const GroupKinematics&) = delete;
  GroupKinematics& operator=(const GroupKinematics&) = delete;

  FrameTree tree;

  Chain chain;
  double first_angle = 0;  ///< About the root's z, before the chain begins.
  std::vector<SphericalFrame> spherical;

  /// The tree's motions in their order, then the other links that move, then those that stand.
  std::vector<FrameStep> steps;
  int moving_steps = 0;
  std::vector<int> moving_links;
  AngleTable frame_angles;

  std::vector<Mover> movers;
  std::vector<int> mover_of_link;  ///< The nearest one above or at each link; -1: nothing but the base moves it.

  std::vector<Segment> segment_storage;
  std::vector<int> still_storage;
  Angles chain_angle_storage, frame_angle_storage;

  /// Places the tree's frames. T: 4 x 4 poses by frame number, the root's in place.
  void place_frames(const double* q, double* T) const {
    kinematics_kernels().frames(steps.data(), static_cast<int>(tree.motions.size()), frame_angles, q, T);
  }
  /// Places the other links, or those of them that move, once the frames are.
  void place_other_links(bool moving_only, double* T) const {
    const auto first = static_cast<int>(tree.motions.size());
    const int last = moving_only ? moving_steps : static_cast<int>(steps.size());
    kinematics_kernels().frames(steps.data() + first, last - first, AngleTable(), nullptr, T);
  }
};

/// How far the tip moves [m] and turns [rad] at most when a value changes by 1, or several together (a ball's rotation
/// vector, x and y of a base) by a vector of length 1.
struct TipLever {
  int first = 0, count = 1;  ///< Columns.
  double speed = 0, turn = 0;
};

/// Everything of a group but where its root stands; shared by all its copies.
struct GroupModel {
  Robot robot;
  std::string name;
  std::vector<std::string> names;
  std::vector<int> joints;  ///< Robot joint of each column; -1 for the base's.
  bool has_base = false;
  int tip_link = 0;
  Eigen::VectorXd lower, upper, velocity, acceleration, reference;
  std::vector<bool> wraps;
  std::shared_ptr<const GroupKinematics> kinematics;
  double reach = 0;  ///< Bound on the distance from first_joint (or the root) to the tip [m].
  Eigen::Vector3d first_joint = Eigen::Vector3d::Zero();  ///< Where the chain starts, in the root.
  std::vector<TipLever> tip_levers;                       ///< What may move the tip.

  explicit GroupModel(Robot r) : robot(std::move(r)) {}
  int base_columns() const { return has_base ? 3 : 0; }
};

/// Fills the kinematics from robot, joints, limits, tip and reference.
void flatten(GroupModel& model);

Drive drive_of(const GroupModel& model, int joint);
/// T_parent_child of a joint that stands at the reference.
Pose standing_pose(const GroupModel& model, const Joint& joint);
void flatten_chain(GroupModel& model, GroupKinematics& kinematics);
void flatten_frames(const GroupModel& model, GroupKinematics& kinematics);

/// Joint indices must be movable and not mimic; `tip_link` any link.
JointGroup make_group(const Robot& robot, const std::string& name, const std::vector<int>& joints, int tip_link,
                      bool with_base);

}  // namespace detail

struct JointGroup::Data {
  Data(std::shared_ptr<const detail::GroupModel> model, const Pose& T_world_root);
  std::shared_ptr<const detail::GroupModel> model;
  Pose T_world_root;
  const detail::GroupKinematics* kinematics;  ///< The model's.
  detail::RootPose root;                      ///< T_world_root with the chain's first angle.
};

}  // namespace mmgrasp
