#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/detail/attached_checker.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp::detail {

/// Collision questions of a carry, told apart: the robot alone with its fingers at an opening (shared by all grasps
/// with that opening), and the object in hand with one grasp. One set of checkers per worker and opening, made when
/// first needed; from grasp to grasp only the object's pose in the hand changes.
class TransferChecks {
 public:
  /// Edges asked for the robot alone and for the held object are cut into steps `search_steps` times as long as `edge`
  /// says.
  TransferChecks(const ManipulationProblem& problem, const EdgeOptions& edge, double search_steps, int workers);

  int opening_count() const { return static_cast<int>(groups_.size()); }
  int opening_of(int grasp) const { return opening_of_[grasp]; }
  /// The problem's group with its fingers at an opening.
  const JointGroup& group(int opening) const { return groups_[opening]; }

  bool robot_is_free(int worker, int opening, const Eigen::VectorXd& q);
  bool robot_edge_is_free(int worker, int opening, const Eigen::VectorXd& a, const Eigen::VectorXd& b);
  Rejection robot_rejection(int worker, int opening, const Eigen::VectorXd& q);
  /// Whether a link that stands still relative to the tip (hand and fingers) hits the scene: it then does so in every
  /// configuration that puts the tip there.
  bool tool_hits_scene(int worker, int opening, const Eigen::VectorXd& q);
  /// The held object against the robot and the scene; the robot alone is not looked at.
  bool held_is_free(int worker, int grasp, const Eigen::VectorXd& q);
  bool held_edge_is_free(int worker, int grasp, const Eigen::VectorXd& a, const Eigen::VectorXd& b);
  Rejection held_rejection(int worker, int grasp, const Eigen::VectorXd& q);
  /// Robot and object together, at the options' steps. For one thread.
  bool edge_is_free(int grasp, const Eigen::VectorXd& a, const Eigen::VectorXd& b);
  /// Robot and object together, at 0.005 rad or m, and no coarser than the options say: for finished paths.
  bool path_edge_is_free(int grasp, const Eigen::VectorXd& a, const Eigen::VectorXd& b);
  /// The first edge of a finished path that is not free by path_edge_is_free(); -1: all are.
  int blocked_edge(int grasp, const JointPath& path);
  /// A checker of everything.
  CollisionChecker whole(int grasp) const;
  const ManipulationProblem& problem() const { return problem_; }

 private:
  struct Bare {
    CollisionChecker checker;
    Eigen::VectorXd motion;  ///< Its motion_bounds().
  };
  struct Held {
    AttachedChecker checker;
    int grasp;
  };

  Bare& robot(int worker, int opening);
  AttachedChecker& held(int worker, int grasp);
  /// The checker of `slot` with the object in this grasp.
  AttachedChecker& holding(std::optional<Held>& slot, int grasp, bool held_only);
  Pose T_tool_object(int grasp) const;
  World world_with(int grasp) const;

  const ManipulationProblem& problem_;
  EdgeOptions edge_, search_edge_, path_edge_;
  std::vector<JointGroup> groups_;  ///< One an opening.
  std::vector<int> opening_of_;     ///< Per grasp.
  std::string tip_;
  std::set<std::string> tool_;                           ///< Links that stand still relative to the tip.
  std::vector<std::vector<std::optional<Bare>>> robot_;  ///< Without a held object, [worker][opening].
  std::vector<std::vector<std::optional<Held>>> held_;   ///< [worker][opening].
  std::vector<std::optional<Held>> whole_;               ///< Everything, [opening].
};

}  // namespace mmgrasp::detail
