#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "collision/checker/bodies.hpp"
#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/edge.hpp"
#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// A checker of a robot that holds one object, whose pose in the hand can be changed for about the price of one
/// question: many grasps of one object need no checker each. Answers are those of a checker made for the pose. Not
/// thread-safe.
class MMGRASP_EXPORT AttachedChecker {
 public:
  /// `checker`'s world must have exactly one attached object.
  explicit AttachedChecker(const CollisionChecker& checker);

  void hold(const Pose& T_link_object);

  bool is_free(const Eigen::VectorXd& q) { return checker_.is_free(q); }
  Rejection rejection(const Eigen::VectorXd& q) { return checker_.rejection(q); }
  /// check_edge(...).free. No point of what is checked (with CheckerOptions::held_only: of the object) moves more than
  /// the workspace step.
  bool edge_is_free(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, const EdgeOptions& options);

 private:
  struct Part {
    int shape;
    Rigid in_object;
  };

  /// What edges need to know, and single configurations do not.
  void bound_motion();

  CollisionChecker checker_;
  std::shared_ptr<Snapshot> snapshot_;  ///< The checker's own.
  std::shared_ptr<PairPlan> plan_;
  std::vector<Part> parts_;
  Eigen::VectorXd largest_, column_;
  Eigen::VectorXd motion_;  ///< As mmgrasp::motion_bounds().
  bool bounded_ = false;
};

/// Free by the steps of `options`, with motion_bounds() known: quicker than check_edge(), which finds out where an edge
/// is blocked. Not for continuous checks.
bool stepped_edge_is_free(CollisionChecker& checker, const Eigen::VectorXd& motion_bounds, const Eigen::VectorXd& q0,
                          const Eigen::VectorXd& q1, const EdgeOptions& options);

}  // namespace mmgrasp::detail
