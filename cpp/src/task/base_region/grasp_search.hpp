#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "task/base_region/grasp_table.hpp"
#include "task/base_region/ik_seed_grid.hpp"
#include "task/base_region/warm_started_ik.hpp"

namespace mmgrasp::detail {

/// What all searches of one problem share, whatever the thread.
struct GraspSearchTables {
  const PartSupplyProblem* problem;
  JointGroup arm;  ///< The arm, its root at the origin.
  std::shared_ptr<const IkSeedGrid> seeds;
  GraspTable grasps;
};

/// Looks for a collision-free arm configuration at the grasps of a part, from one base pose: the hot loop of base
/// regions. From the IK seeds of the cell that holds the tool pose a warm-started IK goes to the pose itself, and the
/// first configuration that the checker accepts ends the search. One per thread.
class GraspSearch {
 public:
  /// `checkers`: one for each of tables->grasps.openings().
  GraspSearch(std::shared_ptr<const GraspSearchTables> tables, std::vector<CollisionChecker> checkers);
  GraspSearch clone() const;

  /// Index of the first grasp that works, or -1 with one cause for each. `first_grasp` (when >= 0) is tried before the
  /// others. `any_order`: of a grasp's seeds, the one that was of use last is tried first.
  int find(const Eigen::Vector3d& base_pose, PartRef part, int first_grasp, bool any_order,
           std::vector<Rejection>& causes);
  /// The arm configuration that find() ended with, when it found a grasp.
  const Eigen::VectorXd& q() const { return q_; }
  /// The checker of an opening, with the robot's root at the base pose.
  CollisionChecker& checker_at(int opening, const Eigen::Vector3d& base_pose);

 private:
  /// A grasp as it is for one heading of the base, with the base in the origin.
  struct PlacedGrasp {
    IkSeedGrid::Slice* slice = nullptr;
    Pose T_root_hand;
  };

  const PlacedGrasp& placed(double heading, const Part& part, int index, int grasp);
  Rejection try_grasp(const Eigen::Vector3d& base_pose, const Part& part, int index, int grasp, bool any_order);
  bool solve_from(const double* seed, const Pose& T_base_hand, CollisionChecker& checker, Rejection& cause);
  Rejection try_branches(const Pose& T_base_hand, CollisionChecker& checker, Rejection worst);
  bool was_rejected(const Eigen::VectorXd& q) const;
  template <class Try>
  bool try_neighbours(IkSeedGrid::Slice& slice, const std::array<int, 2>& cell, double x, double y, const Try& tried);

  std::shared_ptr<const GraspSearchTables> tables_;
  std::vector<CollisionChecker> checkers_;
  std::vector<Eigen::Vector3d> root_at_;  // where each checker's root is now
  WarmStartedIk ik_;
  double heading_ = std::nan("");    // the heading that `placed_` is for
  std::vector<PlacedGrasp> placed_;  // one a grasp
  Eigen::VectorXd q_;
  Eigen::MatrixXd rejected_;  // configurations of the grasp at hand that the checker rejected
  Eigen::Index rejected_count_ = 0;
};

}  // namespace mmgrasp::detail
