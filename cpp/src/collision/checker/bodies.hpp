#pragma once

#include <memory>
#include <string>
#include <vector>

#include "collision/broad/scene_packs.hpp"
#include "collision/broad/solid_cache.hpp"
#include "collision/broad/sphere_cover.hpp"
#include "collision/checker/clearance_table.hpp"
#include "collision/checker/moving_frames.hpp"
#include "collision/narrow/solid.hpp"
#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp::detail {

/// One shape that moves with a robot link, whether of the link itself or of a held object.
struct BodyShape {
  int body = 0;
  int link = 0;
  Rigid in_link;
  std::shared_ptr<const Solid> solid;              ///< Against the robot itself.
  std::shared_ptr<const Solid> padded;             ///< Against the scene.
  std::shared_ptr<const BoundingVolumes> bounds;   ///< Of the solid without padding, in its frame.
  Eigen::Vector3d ball = Eigen::Vector3d::Zero();  ///< Centre of the bounding sphere in the link.
};

/// A robot link with shapes, or a held object.
struct Body {
  std::string name;
  int link = 0;
  bool held = false;
  std::vector<int> touch_links;  ///< Held objects: links that may touch it, ascending.
};

struct SceneShape {
  int object = 0;
  Rigid T_world;
  std::shared_ptr<const Solid> solid;
  Eigen::Vector3d ball = Eigen::Vector3d::Zero();  ///< World frame.
};

/// Robot and world prepared for checking. Immutable; shared by all clones.
struct MMGRASP_EXPORT Snapshot {
  Snapshot(const Robot& robot_in, const World& world_in, const CheckerOptions& options_in);

  Robot robot;
  World world;
  CheckerOptions options;
  std::vector<Body> bodies;
  std::vector<BodyShape> shapes;
  std::vector<std::string> object_names;
  std::vector<SceneShape> scene;  ///< First those in `packs`, then voxels and planes.
  int packed = 0;
  ScenePacks packs;

 private:
  void add_robot();
  void add_held();
  void add_scene();
};

/// Links that a held object may touch when nobody said: its link, all links below it, and the whole end effector it
/// belongs to.
std::vector<int> default_touch_links(const Robot& robot, int link);

struct ShapePair {
  int a = 0, b = 0;
  int ball_a = 0, ball_b = 0;  ///< Their places among the plan's balls.
  double reach = 0;            ///< Sum of the bounding spheres' radii.
  /// Of two links with meshes that two turning joints part, and the columns of these joints.
  std::shared_ptr<const ClearanceTable> gaps;
  std::array<int, 2> columns{};
};

/// Where a shape sits among the frames of a group.
struct PlacedShape {
  int frame = 0;
  Rigid in_frame;
};

/// Bounds on how fast a point of each moving shape moves in the world, and of each varying pair's bodies against each
/// other, per unit of each column (rows) [m/rad or m/m].
struct MotionRates {
  Eigen::MatrixXd shapes, pairs;
  bool finite = true;
};

/// Which pairs one group must look at, and how its shapes move.
struct MMGRASP_EXPORT PairPlan {
  PairPlan(const Snapshot& snapshot, const JointGroup& group);

  MovingFrames frames;
  std::vector<PlacedShape> placed;  ///< Per shape.
  std::vector<FrameSphere> balls;   ///< Of `moving`, then of `fixed`, in their order; padding included.
  std::vector<int> ball_of;         ///< Per shape: its place in `balls`, or -1.
  std::vector<int> moving, fixed;   ///< Shapes the group moves, and the others; those checked against the scene first.
  int moving_in_scene = 0, fixed_in_scene = 0;  ///< How many of them are checked against the scene.
  std::vector<ShapePair> varying;               ///< Relative pose depends on the configuration.
  std::vector<PairBlock> blocks;                ///< All varying pairs, by their balls.
  std::vector<int> pair_of;                     ///< Per lane of a block: its number in `varying`.
  std::vector<ShapePair> constant;              ///< It does not: one look per reference is enough.
  MotionRates rates;  ///< Within the joints' limits; not finite where a sliding joint has none.

  /// What holds along one straight edge; empty when `rates` are finite.
  MotionRates rates_along(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1) const;

 private:
  void block_pairs();
  void find_gap_tables(const Snapshot& snapshot);
  MotionRates bound_motion(const Eigen::VectorXd& largest) const;
};

/// Link of each rigid assembly: links joined by fixed joints share a number.
std::vector<int> rigid_assemblies(const Robot& robot);

}  // namespace mmgrasp::detail
