#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mmgrasp/task/platform_locations.hpp"

namespace mmgrasp::detail {

/// One of the two ends of a platform locations problem: tells valid configurations and draws them.
class PlatformEnd {
 public:
  /// `checker` is shared by both ends and outlives them.
  PlatformEnd(CollisionChecker& checker, const Pose& T_world_tip, const Eigen::Vector3d& point,
              const std::optional<MountedCamera>& camera, const PlatformLocationsOptions& options,
              std::uint64_t stream);

  /// Draws once: an IK search from a remembered posture or from anywhere near, then along the solutions when view or
  /// singularity asks for it. True when it gave a valid configuration, which joins `found`.
  bool draw(const IkSeedDatabase* database);
  /// Searches from one start; `fixed_base` keeps its base pose exactly. Counts as a draw.
  std::optional<Eigen::VectorXd> solve(const Eigen::VectorXd& start, bool fixed_base);
  /// Moves q (valid) along the solutions of its pose towards a base pose; stays valid.
  Eigen::VectorXd drawn_towards(const Eigen::VectorXd& q, const Eigen::Vector3d& base, double turn_weight);

  /// Every constraint again by other means than the search used: the robot's plain kinematics, a projection of the
  /// point through it, the determinant by singular values, the list of contacts.
  bool confirmed(const Eigen::VectorXd& q) const;

  const Pose& target() const { return T_world_tip_; }
  std::vector<Eigen::VectorXd> found;
  PlatformLocationsCounts counts;

 private:
  enum class Fault { none, view, singular, other };
  Fault fault_of(const Eigen::VectorXd& q, Rejection& cause);
  bool in_view(const Pose& T_world_camera_link) const;
  bool count(Fault fault, Rejection cause);

  CollisionChecker& checker_;
  const JointGroup& group_;
  Pose T_world_tip_;
  Eigen::Vector3d point_;
  std::optional<MountedCamera> camera_;
  double least_manipulability_;
  IkOptions descent_, slide_;
  std::vector<Eigen::VectorXd> remembered_;
  std::size_t next_remembered_ = 0;
  bool queried_ = false;
  Eigen::VectorXd lower_, upper_;  // where starts are drawn
  std::uint64_t seed_, stream_;
};

}  // namespace mmgrasp::detail
