#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

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

/// Scene as plain values: a copy is a snapshot. Names are unique over objects and attached objects.
class MMGRASP_EXPORT World {
 public:
  /// Throws InvalidInput on a name in use, an invalid shape or a pose that is not finite.
  void add(const std::string& name, const Shape& shape, const Pose& T_world_object);
  void add(const std::string& name, WorldObject object);
  void move(const std::string& name, const Pose& T_world_object);
  void remove(const std::string& name);  ///< Takes an object, attached or not, out of the world.
  /// From the scene to a link. Empty touch_links: `link`, every link below it and, when `link` lies in an SRDF end
  /// effector's group or below its parent link, all links of that group (resolved by the checker, which also refuses
  /// unknown links). Links that are rigidly joined to `link` are never checked against the object.
  void attach(const std::string& name, const std::string& link, const Pose& T_link_object,
              std::set<std::string> touch_links = {});
  void detach(const std::string& name, const Pose& T_world_object);  ///< Back into the scene.
  bool has(const std::string& name) const;

  const std::map<std::string, WorldObject>& objects() const { return objects_; }
  const std::map<std::string, AttachedObject>& attached() const { return attached_; }

 private:
  std::map<std::string, WorldObject> objects_;
  std::map<std::string, AttachedObject> attached_;
};

}  // namespace mmgrasp
