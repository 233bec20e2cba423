#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp {

class CollisionChecker;
struct EdgeOptions;
struct EdgeResult;
MMGRASP_EXPORT EdgeResult check_edge(CollisionChecker& checker, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1,
                                     const EdgeOptions& options);
MMGRASP_EXPORT Eigen::VectorXd motion_bounds(const CollisionChecker& checker);

/// Which collisions a CollisionChecker looks for, and how much room it keeps around the robot's links.
struct MMGRASP_EXPORT CheckerOptions {
  double padding = 0;       ///< Links are padded by at least this, whatever World::padding() says [m]; >= 0.
  bool check_self = true;   ///< Check the robot and what is attached to it against itself.
  bool check_scene = true;  ///< Check the robot and what is attached to it against the scene.
  /// Check only what is attached, against the robot and the scene: the robot alone is taken to be free (many grasps of
  /// one object share what is known of the robot, P2 4.3.2.4).
  bool attached_only = false;
  void check() const;
};

/// Two bodies that touch. `a` is a robot link or an attached object, `b` a link, an attached object or a scene object.
struct MMGRASP_EXPORT Contact {
  std::string a, b;
  bool with_scene = false;
  bool by_padding = false;  ///< The bodies themselves stay apart: only their padding meets.
};

/// "'hand' touches 'table'", or, by padding, "'hand' comes closer to 'table' than their padding".
MMGRASP_EXPORT std::string describe(const Contact& contact);

/// How far apart two bodies are at a configuration, and where they come closest.
struct MMGRASP_EXPORT DistanceResult {
  double value = std::numeric_limits<double>::infinity();  ///< [m]; negative: depth.
  std::string a, b;                                        ///< The closest pair.
  Eigen::Vector3d point_a = Eigen::Vector3d::Zero();       ///< Witness points, world frame.
  Eigen::Vector3d point_b = Eigen::Vector3d::Zero();
  bool with_scene = false;   ///< `b` is an object of the scene.
  Eigen::VectorXd gradient;  ///< d value / d q, length of the configuration; empty unless requested.
};

/// Is a configuration free of collisions, what touches, and how far away is the rest? A checker answers for one group
/// of one robot in one snapshot of a world: it prepares shapes and pairs once, so that a query takes microseconds.
///
///   CollisionChecker checker(robot.group("arm"), world);
///   if (!checker.is_free(q)) std::cout << checker.first_contact(q)->a;
///   checker.edge_is_free(q0, q1);             // the straight line between two configurations, in steps of 0.02 rad
///   CollisionChecker other = checker.clone();  // for another thread
///
/// - Closed meshes are solids: a body wholly inside one collides. Open meshes are surfaces.
/// - The answers are exact; docs/methods/collision.md says how they get quick.
/// - Later changes of the world do not reach the checker: make a new one, which is cheap, since meshes stay prepared.
/// - Not thread-safe, for it has scratch inside; clones share everything that does not change.
class MMGRASP_EXPORT CollisionChecker {
 public:
  CollisionChecker(const JointGroup& group, const World& world, const CheckerOptions& options = {});
  CollisionChecker(CollisionChecker&&) noexcept;
  CollisionChecker& operator=(CollisionChecker&&) noexcept;
  ~CollisionChecker();
  CollisionChecker clone() const;

  const JointGroup& group() const;
  const World& world() const;
  const CheckerOptions& options() const;

  /// The same checker with the group re-referenced (base stands elsewhere, fingers opened) or another group of the same
  /// robot: geometry is not rebuilt. Throws InvalidInput for a group of another robot.
  CollisionChecker with_group(const JointGroup& group) const;
  /// Cheap in-place variant of the above for loops over base poses.
  void set_root(const Pose& T_world_root);

  /// Limits (with 1e-9 of slack for rounding), then self, then scene: the first cause found, or none. The hot query.
  /// `q` must have the right length and be finite (checked; throws InvalidInput).
  Rejection rejection(const Eigen::VectorXd& q);
  /// rejection(q) == Rejection::none, quicker: what collided last is tested first.
  bool is_free(const Eigen::VectorXd& q);
  /// Every touching pair (limits are not checked).
  std::vector<Contact> contacts(const Eigen::VectorXd& q);
  /// One touching pair (limits are not checked), self before scene; nothing when free. Cheaper than contacts().
  std::optional<Contact> first_contact(const Eigen::VectorXd& q);
  /// Smallest distance over all checked pairs; padding is not subtracted. Infinite when there is no pair.
  DistanceResult distance(const Eigen::VectorXd& q);
  /// The same with its gradient in joint space: n^T (J_a(point_a) - J_b(point_b)), n from b to a; exact wherever the
  /// closest points are unique. Zero when the pair cannot move.
  DistanceResult distance_and_gradient(const Eigen::VectorXd& q);
  /// Every pair of bodies nearer than `within` [m], nearest first, each with its gradient (P3 5.8's sum runs over the
  /// self pairs among them).
  std::vector<DistanceResult> distances(const Eigen::VectorXd& q, double within);

  /// Straight joint-space edge (angles are not wrapped), checked at steps in which no joint moves more than `step` (rad
  /// or m), ends included.
  bool edge_is_free(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, double step = 0.02);
  /// The same where q0 is known to be free, or both ends are: they are not checked again.
  bool edge_stays_free(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, double step = 0.02,
                       bool end_is_free = false);

  std::size_t queries() const;  ///< Configurations checked so far.

 private:
  friend EdgeResult check_edge(CollisionChecker&, const Eigen::VectorXd&, const Eigen::VectorXd&, const EdgeOptions&);
  friend Eigen::VectorXd motion_bounds(const CollisionChecker&);
  struct Impl;
  explicit CollisionChecker(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mmgrasp
