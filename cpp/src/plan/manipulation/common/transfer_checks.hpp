#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/detail/attached_checker.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp::detail {

/// Collision checks of a manipulation problem, in two parts: the robot alone with its fingers at an opening (shared by
/// all grasps with that opening), and the object in hand with one grasp. There is one set of checkers per worker and
/// opening, made when first needed; from grasp to grasp only the object's pose in the hand changes.
class MMGRASP_EXPORT TransferChecks {
 public:
  /// `prepared`: a checker of the problem's group and world (checker_difference()), or null.
  TransferChecks(const ManipulationProblem& problem, const EdgeOptions& edge, int workers,
                 const CollisionChecker* prepared = nullptr);

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
  /// The attached object against the robot and the scene; the robot alone is not checked.
  bool attached_is_free(int worker, int grasp, const Eigen::VectorXd& q);
  bool attached_edge_is_free(int worker, int grasp, const Eigen::VectorXd& a, const Eigen::VectorXd& b);
  Rejection attached_rejection(int worker, int grasp, const Eigen::VectorXd& q);
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
  struct RobotAlone {
    CollisionChecker checker;
    Eigen::VectorXd motion;  ///< The checker's motion_bounds().
  };
  struct WithObject {
    AttachedChecker checker;
    int grasp;
  };

  RobotAlone& robot(int worker, int opening);
  AttachedChecker& attached(int worker, int grasp);
  /// The checker of `slot` with the object in this grasp.
  AttachedChecker& holding(std::optional<WithObject>& slot, int grasp, bool attached_only);
  CheckerOptions options() const;
  Pose T_tool_object(int grasp) const;
  World world_with(int grasp) const;

  const ManipulationProblem& problem_;
  const CollisionChecker* prepared_;
  const JointGroup group_;  ///< The problem's: the prepared checker's, of which more checkers can be made.
  EdgeOptions edge_, path_edge_;
  std::vector<JointGroup> groups_;  ///< One per opening.
  std::vector<int> opening_of_;     ///< Per grasp.
  std::string tip_;
  std::set<std::string> tool_;                                    ///< Links that stand still relative to the tip.
  std::vector<std::vector<std::optional<RobotAlone>>> robot_;     ///< Checks without the object, [worker][opening].
  std::vector<std::vector<std::optional<WithObject>>> attached_;  ///< The object alone, [worker][opening].
  std::vector<std::optional<WithObject>> whole_;                  ///< Everything, [opening].
};

}  // namespace mmgrasp::detail
