#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/joint.hpp"
#include "mmgrasp/robot/planar_base.hpp"

namespace mmgrasp {

/// Where meshes may lie and how the base moves.
struct MMGRASP_EXPORT RobotOptions {
  BaseKind base = BaseKind::fixed;
  BaseLimits base_limits;
  std::map<std::string, std::string> package_dirs;  ///< package://NAME/... -> folder. Checked first.
  std::string mesh_dir;                             ///< Folder that relative mesh paths refer to; default: the URDF's.
  bool load_meshes = true;                          ///< false: kinematics only, links with meshes get no shape.
  double mesh_tolerance = 0;  ///< A primitive, hull or decimated mesh that contains a collision mesh and sticks out by
                              ///< at most this [m] replaces it; >= 0. With 0 only what is the same solid is replaced.
  bool allow_missing_meshes = false;  ///< true: a missing mesh is a warning in the report, not an IoError.
};

/// Why a pair of links needs no check for self-collision, by the SRDF's names; `default_`: the SRDF switched it off for
/// all pairs of a link.
enum class DisabledReason { adjacent, never, always, user, default_ };

/// What loading found: shown by `mmgrasp check`.
struct MMGRASP_EXPORT RobotReport {
  std::vector<std::string> warnings;  ///< One sentence each (link over 5 m, SRDF names an unknown link, ...).
  std::vector<MeshReport> meshes;     ///< Collision meshes that were read.
  std::vector<std::string> missing;   ///< Mesh URIs that could not be found (only with allow_missing_meshes).
};

/// A group of the SRDF, resolved: joints in chain order; `tip` empty when the group is no chain.
struct MMGRASP_EXPORT GroupDescription {
  std::string name;
  std::vector<std::string> joints;  ///< Movable, non-mimic joints in order from base to tip.
  std::string base_link;
  std::string tip_link;
  std::vector<std::string> links = {};  ///< Carried by the joints that the SRDF names, fixed and mimic ones too.
};

/// An end effector of the SRDF: the joint group of the hand, and the arm's link that it is mounted on.
struct MMGRASP_EXPORT EndEffectorDescription {
  std::string name, group, parent_link;
};

class JointGroup;

/// A robot as URDF and SRDF describe it: links, joints, collision shapes, groups, pairs that need no collision check.
///
///     const Robot robot = Robot::load("panda.urdf", "panda.srdf");
///     const JointGroup arm = robot.group("panda_arm");
///     const Robot equipped = robot.with_link("tool", "panda_hand", T_hand_tool);
///
/// - Immutable and cheap to copy (shared data): mount(), with_link() and with_disabled_pairs() give new robots.
/// - Links and joints are indexed in breadth-first order, root link first.
/// - RobotOptions::base says whether it stands, drives (diff_drive) or glides (omni); a moving base adds x, y, theta.
class MMGRASP_EXPORT Robot {
 public:
  /// Reads files. Throws IoError / InvalidInput naming file, element, value and rule. An empty srdf_path means none;
  /// the disabled pairs are then computed by sampling when a collision checker first needs them (see
  /// collision/disabled_pairs.hpp); here only adjacent ones are set.
  static Robot load(const std::string& urdf_path, const std::string& srdf_path = "", const RobotOptions& options = {});
  /// The same from text; `origin` names the source in messages and gives the folder for relative meshes. An empty
  /// `srdf_origin` is "<origin> (SRDF)".
  static Robot from_strings(const std::string& urdf, const std::string& srdf = "", const RobotOptions& options = {},
                            const std::string& origin = "<string>", const std::string& srdf_origin = "");

  const std::string& name() const;
  BaseKind base() const;
  const BaseLimits& base_limits() const;
  const std::vector<Link>& links() const;
  const std::vector<Joint>& joints() const;
  const RobotReport& report() const;

  int root_link() const { return 0; }
  int link_index(const std::string& name) const;   ///< Throws InvalidInput naming the nearest link.
  int joint_index(const std::string& name) const;  ///< Throws InvalidInput naming the nearest joint.
  bool has_link(const std::string& name) const;

  /// Length of a full value vector (every movable non-mimic joint; without the virtual base).
  int value_count() const;
  /// All zeros, moved into limits where zero is outside.
  Eigen::VectorXd default_values() const;
  /// default_values() with the named joints set. A planar joint's values are named joint/x, joint/y, joint/theta, a
  /// floating one's joint/x, /y, /z, /rx, /ry, /rz. Throws InvalidInput on unknown names or values outside limits.
  Eigen::VectorXd values(const std::map<std::string, double>& by_name) const;
  /// Pose of every link for full values, root at T_world_root. The slow general reference; JointGroup has the fast
  /// path.
  Poses link_poses(const Eigen::VectorXd& values, const Pose& T_world_root = Pose::Identity()) const;

  const std::vector<GroupDescription>& groups() const;
  const std::vector<EndEffectorDescription>& end_effectors() const;
  /// SRDF group states: group -> state -> joint -> value, with the names that values() takes.
  const std::map<std::string, std::map<std::string, std::map<std::string, double>>>& group_states() const;
  /// Joints that the SRDF calls passive (castors): they move, but nothing drives them. No group contains them.
  const std::vector<std::string>& passive_joints() const;
  bool has_srdf() const;

  /// True when the two links need no self-collision check: the SRDF says so, a joint joins them (also across links
  /// without shapes), or they belong to one rigid body.
  bool pair_disabled(int link_a, int link_b) const;
  const std::map<std::pair<int, int>, DisabledReason>& disabled_pairs() const;  ///< Keys with first < second.
  Robot with_disabled_pairs(std::map<std::pair<int, int>, DisabledReason> pairs) const;

  /// An SRDF group by name, or a chain given by its ends. `tip` moves the tip to any link that the last joint carries;
  /// empty: the chain's last link. With `with_base`, the virtual joints x, y, theta come first (base kind must not be
  /// fixed).
  JointGroup group(const std::string& name, const std::string& tip = "", bool with_base = false) const;
  JointGroup chain(const std::string& base_link, const std::string& tip_link, bool with_base = false) const;

  /// Puts `other` on `parent_link`, its root link at T_parent_other; names of `other` get "prefix" in front (chosen
  /// from its robot name when empty: "name_"). SRDFs are merged; pairs between the two are not disabled except the
  /// mounting pair.
  Robot mount(const Robot& other, const std::string& parent_link, const Pose& T_parent_other,
              const std::string& prefix = "") const;
  /// Adds a fixed link (a tool centre point, a bin): with or without shapes.
  Robot with_link(const std::string& name, const std::string& parent_link, const Pose& T_parent_link,
                  const std::vector<LinkShape>& collisions = {}) const;

  /// The whole robot written out: links with inertias and collision shapes, joints; without visuals. Mesh URIs are
  /// written as absolute file paths; meshes that were not loaded are left out. Throws InvalidInput for a mesh that came
  /// from no file.
  std::string to_urdf() const;
  std::string to_srdf() const;
  /// Content hash of kinematics, shapes (mesh contents included), limits and disabled pairs.
  std::string hash() const;

  struct Data;
  explicit Robot(std::shared_ptr<const Data> data);
  const Data& data() const { return *data_; }

 private:
  std::shared_ptr<const Data> data_;
};

}  // namespace mmgrasp
