#pragma once

#include <memory>
#include <string>
#include <vector>

#include "collision/broad/scene_packs.hpp"
#include "collision/broad/solid_cache.hpp"
#include "collision/broad/sphere_cover.hpp"
#include "collision/narrow/solid.hpp"
#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/detail/rigid.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp::detail {

/// One shape that moves with a robot link, whether of the link itself or of an attached object.
struct BodyShape {
  int body = 0;
  int link = 0;
  Rigid in_link;
  std::shared_ptr<const Solid> solid;                       ///< Against the robot itself.
  std::shared_ptr<const Solid> padded;                      ///< Against the scene.
  std::shared_ptr<const BoundingVolumes> bounds;            ///< Cover of the solid without padding, in its frame.
  Eigen::Vector3d sphere_centre = Eigen::Vector3d::Zero();  ///< Centre of the bounding sphere in the link.

  /// Sets the pose in the link and what follows from it.
  void place(const Rigid& pose_in_link);
};

/// A robot link with shapes, or an attached object.
struct Body {
  std::string name;
  int link = 0;
  bool attached = false;
  std::vector<int> touch_links;  ///< Attached objects: links that may touch it, ascending.
};

/// One shape of an object of the scene.
struct SceneShape {
  int object = 0;
  Rigid T_world;
  std::shared_ptr<const Solid> solid;
  Eigen::Vector3d sphere_centre = Eigen::Vector3d::Zero();  ///< Centre of the bounding sphere, world frame.
};

/// Robot and world prepared for checking. Checkers and their clones share one and never change it; an AttachedChecker
/// has one to itself and moves its object with place_attached().
struct MMGRASP_EXPORT Snapshot {
  Snapshot(const Robot& robot_in, const World& world_in, const CheckerOptions& options_in);

  /// Moves the shapes of the only attached object: its pose in the link is `T_link_object` from now on. A PairPlan made
  /// of the snapshot must follow (PairPlan::place_attached). `world` keeps the pose it came with.
  void place_attached(const Pose& T_link_object);

  Robot robot;
  World world;
  CheckerOptions options;
  std::vector<Body> bodies;
  std::vector<BodyShape> shapes;
  int first_attached = 0;  ///< Shapes from here on belong to attached objects.
  std::vector<std::string> object_names;
  std::vector<SceneShape> scene;  ///< First those in `packs`, then voxels and planes.
  int packed = 0;                 ///< How many of them are in `packs`.
  ScenePacks packs;

 private:
  void add_robot();
  void add_attached();
  void add_scene();
};

/// Links that an attached object may touch unless it names its own: its link, all links below it, and the whole end
/// effector it belongs to.
std::vector<int> default_touch_links(const Robot& robot, int link);

}  // namespace mmgrasp::detail
