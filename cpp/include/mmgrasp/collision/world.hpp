#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/collision/field_obstacle.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/geometry/shape.hpp"
#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp {

/// A named rigid body of the scene; several shapes may make one (a tray is five boxes).
struct MMGRASP_EXPORT WorldObject {
  std::vector<LinkShape> shapes;  ///< T_link_shape is here T_object_shape.
  Pose T_world_object = Pose::Identity();
};

/// A body that moves with a link of the robot.
struct MMGRASP_EXPORT AttachedObject {
  std::vector<LinkShape> shapes;
  std::string link;  ///< It moves with this robot link.
  Pose T_link_object = Pose::Identity();
  std::set<std::string> touch_links;  ///< Robot links it may touch (the fingers).
};

/// How far bodies are grown where the robot, with what is attached to it, meets the scene [m], each finite and >= 0.
/// Two bodies keep the sum of their paddings apart. Never within the robot: as MoveIt's link padding.
struct MMGRASP_EXPORT Padding {
  double links = 0;     ///< Links of the robot.
  double attached = 0;  ///< What is attached to them.
  double objects = 0;   ///< Objects of the scene.
  /// Padding of single bodies, used in place of these: the key names a link, an object (attached or not) or an SRDF
  /// group, whose links take it unless they are named themselves (of several groups the most).
  std::map<std::string, double> by_name = {};
  double most() const;  ///< The largest of all.
  void check() const;
};

/// What stands around the robot and what it holds: named rigid bodies, and rules about who may touch whom.
///
///     World world;
///     world.add("table", Box{{1.2, 0.6, 0.04}}, pose_from_xyz_rpy({1, 0, 0.7}, {0, 0, 0}));
///     world.add("cup", Cylinder{0.04, 0.1}, pose_from_xyz_rpy({1, 0, 0.78}, {0, 0, 0}));
///     world.allow("cup", "table");              // these two may touch
///     world.attach("cup", "hand", T_hand_cup);  // from now on it moves with the hand
///
/// - A World is plain values: a copy is a snapshot, and checkers keep the copy that they were made with.
/// - Names are unique over objects, attached objects and fields.
/// - A distance field is an obstacle of its own kind (add_field): a mesh's or a grid's. Maps of cameras are added as
///   solid cells instead (ProbabilisticSdf::obstacle_cells), since their error is not bounded everywhere.
/// - Padding grows bodies where the robot meets the scene, never the robot against itself.
class MMGRASP_EXPORT World {
 public:
  /// Throws InvalidInput on a name in use, an invalid shape or a pose that is not finite.
  void add(const std::string& name, const Shape& shape, const Pose& T_world_object);
  void add(const std::string& name, WorldObject object);
  /// What a distance field holds, as an obstacle. The world shares the field.
  void add_field(const std::string& name, const FieldObstacle& obstacle);
  void move(const std::string& name, const Pose& T_world_object);
  /// Takes an object, attached or not, or a field out of the world; see forget().
  void remove(const std::string& name);
  /// Takes an object from the scene to a link. Empty touch_links: `link`, every link below it and, when `link` lies in
  /// an SRDF end effector's group or below its parent link, all links of that group (resolved by the checker, which
  /// also refuses unknown links). Links that are rigidly joined to `link` are never checked against the object.
  void attach(const std::string& name, const std::string& link, const Pose& T_link_object,
              std::set<std::string> touch_links = {});
  void detach(const std::string& name, const Pose& T_world_object);  ///< Back into the scene.
  bool has(const std::string& name) const;

  /// The two may touch: they are not checked against each other, as in MoveIt's allowed collision matrix. Each names a
  /// link of the robot, an SRDF group (all its links), or an object, attached or not, and that under any of these which
  /// bears the name. The pair may come before its objects: a checker throws InvalidInput for names that robot and world
  /// lack when it is made.
  void allow(const std::string& a, const std::string& b);
  void disallow(const std::string& a, const std::string& b);  ///< Takes a pair back; throws unless it is there.
  using NamePair = std::pair<std::string, std::string>;
  const std::set<NamePair>& allowed() const { return allowed_; }  ///< Pairs given to allow(), the smaller name first.
  /// Replaces the padding of all bodies. Names are checked as those of allow().
  void set_padding(Padding padding);
  const Padding& padding() const { return padding_; }
  /// Takes back what allow() and set_padding() said about a name; remove() does so for the object it removes.
  void forget(const std::string& name);

  const std::map<std::string, WorldObject>& objects() const { return objects_; }
  const std::map<std::string, AttachedObject>& attached() const { return attached_; }
  const std::map<std::string, FieldObstacle>& fields() const { return fields_; }

 private:
  std::map<std::string, WorldObject> objects_;
  std::map<std::string, AttachedObject> attached_;
  std::map<std::string, FieldObstacle> fields_;
  std::set<NamePair> allowed_;
  Padding padding_;
};

}  // namespace mmgrasp
