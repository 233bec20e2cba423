#pragma once

#include <array>
#include <memory>
#include <vector>

#include "collision/checker/bodies.hpp"
#include "collision/checker/clearance_table.hpp"
#include "collision/checker/motion_bounds.hpp"

namespace mmgrasp::detail {

/// Two shapes of the robot, or of what is attached to it, that must be checked against each other.
struct ShapePair {
  int a = 0, b = 0;
  int sphere_a = 0, sphere_b = 0;  ///< Their places among the plan's spheres.
  double reach = 0;                ///< Sum of the bounding spheres' radii [m].
  /// Lower bounds of the clearance of two links with meshes that two revolute joints part; null for other pairs.
  std::shared_ptr<const ClearanceTable> clearances;
  std::array<int, 2> columns{};  ///< Columns of these two joints.
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
  Eigen::MatrixXd shape_bends, pair_bends;  ///< See MotionBounds::point_bends(); empty where there are none.
  std::vector<char> b_moves;                ///< Per varying pair; see MotionBounds::closing_bends().
  bool finite = true;
};

/// Which pairs one group must check, and how its shapes move. Checkers share one and never change it; an
/// AttachedChecker has one to itself.
struct MMGRASP_EXPORT PairPlan {
  PairPlan(const Snapshot& snapshot, const JointGroup& group);

  MotionBounds frame_bounds;
  std::vector<PlacedShape> placed;   ///< Per shape.
  std::vector<FrameSphere> spheres;  ///< Around the shapes in `moving`, then in `fixed`, in their order, with padding.
  std::vector<int> sphere_of;        ///< Per shape: its place in `spheres`, or -1.
  std::vector<int> moving, fixed;    ///< Shapes the group moves, and the others; those checked against the scene first.
  int moving_in_scene = 0, fixed_in_scene = 0;  ///< How many of them are checked against the scene.
  std::vector<ShapePair> varying;               ///< Pairs whose relative pose depends on the configuration.
  std::vector<PairBlock> blocks;                ///< All varying pairs, by their spheres.
  std::vector<int> pair_of;                     ///< Per lane of a block: its number in `varying`.
  std::vector<ShapePair> constant;  ///< Pairs whose relative pose does not: one check per reference is enough.
  MotionRates rates;                ///< Bounds within the joints' limits; not finite where a prismatic joint has none.

  /// Bounds that hold along one straight edge; empty when `rates` are finite.
  MotionRates rates_along(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1) const;
  /// The greatest of `rates.shapes` in each row, over all moving shapes or those checked against the scene alone.
  Eigen::VectorXd motion_bounds(bool in_scene_only) const;

  /// Follows Snapshot::place_attached(), but for `rates`, which only edges need: they are out of date until
  /// bound_attached().
  void place_attached(const Snapshot& snapshot);
  void bound_attached(const Snapshot& snapshot);

 private:
  void place_shape(const Snapshot& snapshot, int shape);
  void sort_shapes(const Snapshot& snapshot, const JointGroup& group);
  void list_pairs(const Snapshot& snapshot, const JointGroup& group);
  void block_pairs();
  void find_clearance_tables(const Snapshot& snapshot);
  MotionRates bound_motion(const Eigen::VectorXd& largest) const;
  void bound_shape(MotionRates& out, Eigen::Index i, const Eigen::VectorXd& largest) const;
  void bound_pair(MotionRates& out, Eigen::Index i, const Eigen::VectorXd& largest) const;
  Eigen::VectorXd pair_rates(const ShapePair& pair, const Eigen::VectorXd& largest) const;

  Eigen::VectorXd largest_;  ///< Magnitude of each column within its limits.
};

/// Link of each rigid assembly: links joined by fixed joints share a number.
std::vector<int> rigid_assemblies(const Robot& robot);

}  // namespace mmgrasp::detail
