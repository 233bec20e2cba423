#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/task/ids.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp {

/// Whether and how one part can be grasped from one base pose.
struct MMGRASP_EXPORT PartAtPose {
  bool feasible = false;
  int grasp = -1;                 ///< Index of a grasp that works; -1: none.
  Eigen::VectorXd q;              ///< A collision-free arm configuration for it.
  std::vector<Rejection> causes;  ///< When not feasible: one a grasp.
};

/// Can this part be grasped from here? Answers for single base poses what compute_base_regions() answers for all cells.
///
/// The same base pose gives the same answer, whatever was queried before. Parts are all in place. Costly to build (all
/// grasps are filtered with the hand alone), cheap to clone. Not thread-safe: use `clone()`, one a thread. The problem
/// and the database must outlive it.
/// @code
///   BasePoseEvaluator evaluator(problem, database);
///   const PartAtPose seen = evaluator.part({1.2, 0.4, 0.0}, {TrayId(0), 2});
///   if (seen.feasible) std::cout << "grasp " << seen.grasp << " at q = " << seen.q.transpose() << "\n";
/// @endcode
class MMGRASP_EXPORT BasePoseEvaluator {
 public:
  /// Throws InvalidInput for a database of another arm.
  BasePoseEvaluator(const PartSupplyProblem& problem, const ReachDatabase& database);
  BasePoseEvaluator(BasePoseEvaluator&&) noexcept;
  BasePoseEvaluator& operator=(BasePoseEvaluator&&) noexcept;
  ~BasePoseEvaluator();
  BasePoseEvaluator clone() const;
  /// The same with these parts removed: they are no obstacles any more, and must not be queried. Quicker than building
  /// a new one. Throws InvalidInput for a part that is removed already.
  BasePoseEvaluator without(const std::vector<PartRef>& removed) const;

  /// What the robot at home with fingers at rest collides with when its base is at this pose (x, y, theta); `limits`
  /// outside the workspace of the base.
  Rejection home(const Eigen::Vector3d& base_pose);
  /// Grasps are tried in order, `first_grasp` (when >= 0) before the others: that saves time and changes only which
  /// grasp is named. The robot at home is not checked.
  PartAtPose part(const Eigen::Vector3d& base_pose, PartRef part, int first_grasp = -1);
  /// Index of a grasp that works, or -1 with one cause for each in `causes`. As part(), quicker: without naming a
  /// configuration, and what worked near by is tried first; that changes only which grasp is named.
  int find_grasp(const Eigen::Vector3d& base_pose, PartRef part, int first_grasp, std::vector<Rejection>& causes);
  /// The same with random restarts of IK: slower, finds a configuration in more cases. For checks, not for regions.
  bool part_with_restarts(const Eigen::Vector3d& base_pose, PartRef part, int first_grasp = -1);
  /// True when the open hand alone touches the scene or a part at the grasp: no arm configuration can be free.
  bool hand_blocked(PartRef part, int grasp) const;
  /// How far the tool at its nearest usable grasp lies beyond the arm's reach from a base pose [m]; 0: within reach.
  double reach_deficit(const Eigen::Vector3d& base_pose, PartRef part) const;
  /// How far the nearest in height of a part's grasps lies above (> 0) or below (< 0) all sampled postures of the arm,
  /// wherever the base stands [m].
  double height_deficit(PartRef part) const;

 private:
  struct Impl;
  explicit BasePoseEvaluator(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mmgrasp
