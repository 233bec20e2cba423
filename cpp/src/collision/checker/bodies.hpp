#pragma once

#include <memory>
#include <string>
#include <vector>

#include "collision/broad/scene_packs.hpp"
#include "collision/broad/solid_cache.hpp"
#include "collision/broad/sphere_cover.hpp"
#include "collision/narrow/solid.hpp"
#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/detail/named_bodies.hpp"
#include "mmgrasp/core/detail/rigid.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp::detail {

/// One shape that moves with a robot link, whether of the link itself or of an attached object.
struct BodyShape {
  int body = 0;
  int link = 0;
  Rigid in_link;
  std::shared_ptr<const Solid> solid;             ///< Against the robot itself.
  std::shared_ptr<const Solid> padded;            ///< Against the scene.
  double growth = 0;                              ///< No point of `padded` is farther from `solid` [m].
  std::vector<char> may_touch;                    ///< Per shape of the scene: the two are not checked. Empty: all are.
  std::shared_ptr<const BoundingVolumes> bounds;  ///< Cover of the solid without padding, in its frame.
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
  std::shared_ptr<const Solid> solid;                       ///< Its shape with padding: decides whether it collides.
  std::shared_ptr<const Solid> bare;                        ///< Without: how far away it is.
  Eigen::Vector3d sphere_centre = Eigen::Vector3d::Zero();  ///< Centre of the bounding sphere, world frame.
};

/// Robot and world prepared for checking. Checkers and their clones share one and never change it; an AttachedChecker
/// has one to itself and moves its object with place_attached().
struct MMGRASP_EXPORT Snapshot {
  Snapshot(const Robot& robot_in, const World& world_in, const CheckerOptions& options_in);

  /// Moves the shapes of the only attached object: its pose in the link is `T_link_object` from now on. A PairPlan made
  /// of the snapshot must follow (PairPlan::place_attached). `world` keeps the pose it came with.
  void place_attached(const Pose& T_link_object);

  /// A shape and one of the scene that World::allow() takes out of all checks.
  bool allowed(int shape, int scene_shape) const {
    return !shapes[shape].may_touch.empty() && shapes[shape].may_touch[scene_shape] != 0;
  }

  Robot robot;
  World world;
  CheckerOptions options;
  AllowedPairs allowed_pairs;
  std::vector<Body> bodies;
  std::vector<BodyShape> shapes;
  int first_attached = 0;  ///< Shapes from here on belong to attached objects.
  std::vector<std::string> object_names;
  std::vector<SceneShape> scene;  ///< First those in `packs`, then voxels and planes.
  int packed = 0;                 ///< How many of them are in `packs`.
  ScenePacks packs;

 private:
  void add_robot(const BodyPadding& padding);
  void add_attached(const BodyPadding& padding);
  void add_scene(const BodyPadding& padding);
  void mark_allowed();
};

/// Links that an attached object may touch unless it names its own: its link, all links below it, and the whole end
/// effector it belongs to.
std::vector<int> default_touch_links(const Robot& robot, int link);

}  // namespace mmgrasp::detail
