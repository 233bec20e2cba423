#pragma once

#include <cstdint>
#include <optional>

#include "collision/bodies.hpp"
#include "collision/narrow.hpp"
#include "mmgrasp/collision/checker.hpp"

namespace mmgrasp {

/// Scratch of one checker on top of shared, immutable preparation.
struct CollisionChecker::Impl {
  Impl(std::shared_ptr<const detail::Snapshot> snapshot_in, const JointGroup& group_in);

  /// Places links for q and the balls of moving shapes.
  void place(const Eigen::VectorXd& q);
  /// Forgets what depends on root and reference.
  void forget();

  Rejection rejection(const Eigen::VectorXd& q);
  /// The same yes or no, but whatever hit last time is looked at first.
  bool is_free(const Eigen::VectorXd& q);

  bool self_collides();
  bool scene_collides();
  bool pair_collides(const detail::ShapePair& pair);
  bool hits_scene(int shape, int scene_shape);
  /// First scene shape hit by the shape, or -1.
  int find_scene_hit(int shape);
  const detail::Rigid& pose(int shape);

  std::shared_ptr<const detail::Snapshot> snapshot;
  std::shared_ptr<const detail::PairPlan> plan;
  JointGroup group;
  std::size_t queries = 0;

  Poses links;  ///< Of the last configuration.
  bool links_valid = false;
  std::vector<Eigen::Vector3d> balls;  ///< World frame, per shape.
  std::vector<detail::Rigid> poses;    ///< World frame, per shape; made when first asked for.
  std::vector<std::uint64_t> pose_stamp;
  std::uint64_t stamp = 0, fixed_stamp = 0;
  std::vector<char> moves;  ///< Per shape.

  std::optional<bool> constant_self;  ///< Pairs whose relative pose no configuration changes.
  std::optional<bool> fixed_scene;    ///< Links that no configuration moves, against the scene.
  int last_pair = -1;                 ///< What collided last tends to collide again.
  int last_shape = -1, last_scene = -1;
};

}  // namespace mmgrasp
