#pragma once

#include <vector>

#include "mmgrasp/collision/collision_ik.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/task/base_pose_evaluator.hpp"
#include "mmgrasp/task/base_region.hpp"

/// Region maps against the core: collision-aware IK with random restarts, without a database and without anything of
/// the regions' own search, asked in checkers of its own.
namespace mmgrasp::testing_support {

struct TruthCounts {
  int compared = 0;   ///< Cells of one part each.
  int claimed = 0;    ///< In the region.
  int truth = 0;      ///< Feasible at the centre and the four corners.
  int missed = 0;     ///< Feasible and not in the region.
  int wrong = 0;      ///< In the region without any confirmed configuration somewhere.
  int elsewhere = 0;  ///< Confirmed only by the region's own configuration, checked afresh: restarts found none.
};

class RegionTruth {
 public:
  RegionTruth(const PartSupplyProblem& problem, const ReachDatabase& database, int restarts)
      : problem_(problem),
        evaluator_(problem, database),
        restarts_(restarts),
        home_(problem.arm, whole_world(problem)) {
    for (const Tray& tray : problem.trays) {
      for (const Part& part : tray.parts) {
        for (const Grasp& grasp : part.grasps) {
          const double opening = problem.gripper.pregrasp_opening(grasp.opening);
          if (!checkers_.empty() && opening == opening_) continue;
          opening_ = opening;
          Eigen::VectorXd values = problem.arm.reference();
          for (const auto& [name, value] : problem.gripper.joint_values(opening))
            values[problem.robot.joints()[problem.robot.joint_index(name)].value_index] = value;
          checkers_.emplace_back(problem.arm.with_reference(values), home_.world());
        }
      }
    }
  }

  static World whole_world(const PartSupplyProblem& problem) {
    World world = problem.world;
    for (const Tray& tray : problem.trays) {
      for (const Part& part : tray.parts) world.add(part.name, WorldObject{part.shapes, part.T_world_part});
    }
    return world;
  }

  bool home_is_free(const Eigen::Vector3d& base_pose) {
    home_.set_root(pose_from_planar(base_pose));
    return home_.is_free(problem_.home);
  }

  /// All grasps of a problem made for this have one opening.
  bool graspable(const Eigen::Vector3d& base_pose, const Part& part) {
    CollisionChecker& checker = checkers_.front();
    checker.set_root(pose_from_planar(base_pose));
    for (const Grasp& grasp : part.grasps) {
      IkOptions options;
      options.restarts = restarts_;
      options.time_limit = 1e6;
      if (solve_collision_free_ik(checker, part.T_world_part * grasp.T_object_hand, problem_.home, options).outcome ==
          Outcome::solved)
        return true;
    }
    return false;
  }

  /// The region's own configuration reaches the grasp and is free in a checker of ours.
  bool confirmed(const Eigen::Vector3d& base_pose, int tray, int index) {
    const PartAtPose seen = evaluator_.part(base_pose, {TrayId(tray), index});
    if (!seen.feasible) return false;
    const Part& part = problem_.trays[tray].parts[index];
    CollisionChecker& checker = checkers_.front();
    checker.set_root(pose_from_planar(base_pose));
    const Pose tool = checker.group().fk(seen.q);
    const Pose wanted = part.T_world_part * part.grasps[seen.grasp].T_object_hand;
    return (tool.translation() - wanted.translation()).norm() < 2e-5 && rotation_distance(tool, wanted) < 2e-4 &&
           checker.rejection(seen.q) == Rejection::none;
  }

 private:
  const PartSupplyProblem& problem_;
  BasePoseEvaluator evaluator_;
  int restarts_;
  double opening_ = 0;
  CollisionChecker home_;
  std::vector<CollisionChecker> checkers_;
};

/// Cells and parts drawn at random within `radius` of a tray [m].
inline TruthCounts compare_with_truth(const PartSupplyProblem& problem, const ReachDatabase& database,
                                      const BaseGrid& grid, const std::vector<BaseRegion>& regions, int tray,
                                      double radius, int samples, int restarts, unsigned seed) {
  RegionTruth truth(problem, database, restarts);
  Rng rng(seed);
  TruthCounts counts;
  const Tray& where = problem.trays[tray];
  const BaseRegion& region = regions[tray];
  while (counts.compared < samples) {
    const int ix = static_cast<int>(rng.index(grid.nx));
    const int iy = static_cast<int>(rng.index(grid.ny));
    const Eigen::Vector3d centre = grid.centre(0, ix, iy);
    if ((centre.head<2>() - where.T_world_tray.translation().head<2>()).norm() > radius) continue;
    const std::size_t part = rng.index(where.parts.size());
    ++counts.compared;
    const bool claimed = region.part_cells[part][grid.index(0, ix, iy)] != 0;
    counts.claimed += claimed;
    bool all = true, sound = true, searched = true;
    for (int corner = 0; corner < 5 && (all || claimed); ++corner) {
      Eigen::Vector3d pose = centre;
      if (corner > 0) {
        pose.x() += (corner & 1 ? 0.5 : -0.5) * grid.resolution;
        pose.y() += (corner & 2 ? 0.5 : -0.5) * grid.resolution;
      }
      const bool free = truth.home_is_free(pose);
      const bool found = free && truth.graspable(pose, where.parts[part]);
      searched = searched && found;
      const bool feasible = found || (free && claimed && truth.confirmed(pose, tray, static_cast<int>(part)));
      all = all && feasible;
      sound = sound && feasible;
    }
    counts.truth += all;
    counts.missed += all && !claimed;
    counts.wrong += claimed && !sound;
    counts.elsewhere += claimed && sound && !searched;
  }
  return counts;
}

}  // namespace mmgrasp::testing_support
