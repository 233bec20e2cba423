#include "mmgrasp/task/base_region.hpp"

#include <gtest/gtest.h>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "mmgrasp/task/base_pose_evaluator.hpp"
#include "support/small_storeroom.hpp"

namespace mmgrasp {
namespace {

using BaseRegions = test::SmallRegions;

TEST_F(BaseRegions, RegionsAreThereAndFitTheGrid) {
  ASSERT_EQ(regions_->size(), 2u);
  for (const BaseRegion& region : *regions_) {
    EXPECT_EQ(region.cells.size(), grid_->size());
    EXPECT_GT(region.count(), 10u);
    ASSERT_EQ(region.part_cells.size(), 2u);
    for (std::size_t i = 0; i < region.cells.size(); ++i) {
      EXPECT_EQ(region.cells[i] != 0, region.part_cells[0][i] && region.part_cells[1][i]);
    }
  }
}

/// Every counter again, base pose by base pose, from the definition: no rows, no threads, no grasp tried first.
TEST_F(BaseRegions, CountersEqualABruteForceRecount) {
  BasePoseEvaluator evaluator(*problem_, *database_);
  const double radius = database_->reach() + 0.5 * problem_->trays[0].size.head<2>().norm();
  const double h = grid_->resolution;
  for (int tray = 0; tray < 2; ++tray) {
    const Eigen::Vector2d middle = problem_->trays[tray].T_world_tray.translation().head<2>();
    for (int part = 0; part < 2; ++part) {
      PartExplanation recount;
      std::size_t at_home = 0;
      std::vector<std::uint8_t> centres(grid_->size(), 0);
      const auto look = [&](const Eigen::Vector3d& pose) {
        if (evaluator.home(pose) != Rejection::none) return false;
        ++recount.base_poses_tried;
        const PartAtPose seen = evaluator.part(pose, {TrayId(tray), part});
        for (Rejection cause : seen.causes) recount.rejections.add(cause);
        recount.base_poses_feasible += seen.feasible;
        return seen.feasible;
      };
      for (int iy = 0; iy < grid_->ny; ++iy) {
        for (int ix = 0; ix < grid_->nx; ++ix) {
          const Eigen::Vector3d pose = grid_->centre(0, ix, iy);
          if ((pose.head<2>() - middle).norm() > radius) continue;
          at_home += evaluator.home(pose) != Rejection::none;
          centres[grid_->index(0, ix, iy)] = look(pose);
        }
      }
      std::vector<std::uint8_t> corners((grid_->nx + 1) * (grid_->ny + 1), 0);
      const auto centre_at = [&](int ix, int iy) {
        return ix >= 0 && iy >= 0 && ix < grid_->nx && iy < grid_->ny && centres[grid_->index(0, ix, iy)];
      };
      for (int iy = 0; iy <= grid_->ny; ++iy) {
        for (int ix = 0; ix <= grid_->nx; ++ix) {
          if (!centre_at(ix, iy) && !centre_at(ix - 1, iy) && !centre_at(ix, iy - 1) && !centre_at(ix - 1, iy - 1))
            continue;
          Eigen::Vector3d pose = grid_->centre(0, ix, iy);
          pose.head<2>().array() -= 0.5 * h;
          corners[iy * (grid_->nx + 1) + ix] = look(pose);
        }
      }
      const BaseRegion& region = (*regions_)[tray];
      const PartExplanation& reported = region.explanations[part];
      EXPECT_EQ(reported.grasps, 12);
      EXPECT_EQ(reported.base_poses_tried, recount.base_poses_tried);
      EXPECT_EQ(reported.base_poses_feasible, recount.base_poses_feasible);
      EXPECT_EQ(reported.rejections, recount.rejections)
          << reported.rejections.summary() << " against " << recount.rejections.summary();
      EXPECT_EQ(reported.rejections.total(), 12 * (reported.base_poses_tried - reported.base_poses_feasible));
      EXPECT_EQ(region.base_poses_in_collision, at_home);
      for (int iy = 0; iy < grid_->ny; ++iy) {
        for (int ix = 0; ix < grid_->nx; ++ix) {
          const int row = iy * (grid_->nx + 1) + ix;
          const auto corner = [&](int i) { return corners[i] != 0; };
          const bool good = centre_at(ix, iy) && corner(row) && corner(row + 1) && corner(row + grid_->nx + 1) &&
                            corner(row + grid_->nx + 2);
          EXPECT_EQ(region.part_cells[part][grid_->index(0, ix, iy)] != 0, good);
        }
      }
    }
  }
}

/// No false cells: from sampled points of the region another IK (random restarts, no database) and a fresh checker
/// agree.
TEST_F(BaseRegions, CellsAreFeasibleForAnotherIk) {
  Rng rng(5);
  World world = problem_->world;
  for (const Tray& tray : problem_->trays) {
    for (const Part& part : tray.parts) world.add(part.name, part.shapes[0].shape, part.T_world_part);
  }
  Eigen::VectorXd values = problem_->arm.reference();
  for (const auto& [name, value] : problem_->gripper.joint_values(0.05)) {
    values[problem_->robot.joints()[problem_->robot.joint_index(name)].value_index] = value;
  }
  const BaseRegion& region = (*regions_)[0];
  int looked_at = 0, solved = 0;
  for (int sample = 0; sample < 4000 && looked_at < 40; ++sample) {
    const int ix = static_cast<int>(rng.index(grid_->nx));
    const int iy = static_cast<int>(rng.index(grid_->ny));
    if (!region.cells[grid_->index(0, ix, iy)]) continue;
    ++looked_at;
    const Pose T_world_root = pose_from_planar(grid_->centre(0, ix, iy));
    CollisionChecker checker(problem_->arm.with_reference(values).at(T_world_root), world);
    bool all = true;
    for (const Part& part : problem_->trays[0].parts) {
      bool any = false;
      for (std::size_t g = 0; g < part.grasps.size() && !any; ++g) {
        IkOptions options;
        options.restarts = 60;
        const IkResult ik = solve_ik(checker.group(), part.T_world_part * part.grasps[g].T_object_hand, problem_->home,
                                     options, [&](const Eigen::VectorXd& q) { return checker.rejection(q); });
        any = ik.outcome == Outcome::solved;
      }
      all = all && any;
    }
    solved += all;
  }
  EXPECT_EQ(looked_at, 40);
  EXPECT_EQ(solved, looked_at);
}

TEST_F(BaseRegions, ConfigurationsReachTheirGrasps) {
  BasePoseEvaluator evaluator(*problem_, *database_);
  int seen_feasible = 0;
  for (int iy = 0; iy < grid_->ny; ++iy) {
    for (int ix = 0; ix < grid_->nx; ix += 3) {
      const Eigen::Vector3d pose = grid_->centre(0, ix, iy);
      const PartAtPose seen = evaluator.part(pose, {TrayId(0), 0});
      if (!seen.feasible) continue;
      ++seen_feasible;
      const Part& part = problem_->trays[0].parts[0];
      const Pose wanted = part.T_world_part * part.grasps[seen.grasp].T_object_hand;
      const Pose tool = problem_->robot.link_poses(problem_->arm.full_values(seen.q),
                                                   pose_from_planar(pose))[problem_->robot.link_index("tcp")];
      EXPECT_LT((tool.translation() - wanted.translation()).norm(), 1e-4);
      EXPECT_LT(rotation_distance(tool, wanted), 1e-3);
    }
  }
  EXPECT_GT(seen_feasible, 10);
}

TEST_F(BaseRegions, TheSameAtAnyThreadCount) {
  PartSupplyProblem other = *problem_;
  for (int threads : {1, 3}) {
    other.options.threads = threads;
    const std::vector<BaseRegion> regions = compute_base_regions(other, *database_, *grid_);
    for (std::size_t tray = 0; tray < 2; ++tray) {
      EXPECT_EQ(regions[tray].cells, (*regions_)[tray].cells);
      EXPECT_EQ(regions[tray].part_cells, (*regions_)[tray].part_cells);
      for (std::size_t part = 0; part < 2; ++part) {
        EXPECT_EQ(regions[tray].explanations[part].rejections, (*regions_)[tray].explanations[part].rejections);
      }
    }
  }
}

TEST_F(BaseRegions, AnObstacleNeverMakesARegionLarger) {
  PartSupplyProblem other = *problem_;
  other.world.add("post", test::box_shape(0.1, 0.1, 1.0), test::at(0.55, -0.45, 0.5));
  const std::vector<BaseRegion> regions = compute_base_regions(other, *database_, *grid_);
  for (std::size_t tray = 0; tray < 2; ++tray) {
    for (std::size_t i = 0; i < grid_->size(); ++i) EXPECT_LE(regions[tray].cells[i], (*regions_)[tray].cells[i]);
  }
  EXPECT_LT(regions[0].count(), (*regions_)[0].count());
}

TEST_F(BaseRegions, NoGraspAndNoTargetGiveEmptyRegions) {
  PartSupplyProblem other = *problem_;
  other.trays[0].parts[1].grasps.clear();
  for (Part& part : other.trays[1].parts) part.target = false;
  const std::vector<BaseRegion> regions = compute_base_regions(other, *database_, *grid_);
  EXPECT_EQ(regions[0].count(), 0u);
  EXPECT_EQ(regions[0].explanations[1].base_poses_feasible, 0u);
  EXPECT_GT(regions[0].explanations[0].base_poses_feasible, 0u);
  EXPECT_EQ(regions[1].count(), 0u);
  EXPECT_TRUE(regions[1].explanations.empty());
}

/// Grasps from below run the hand into the table, whatever the arm does.
TEST_F(BaseRegions, BlockedHandsAreFilteredBeforeTheArm) {
  PartSupplyProblem other = *problem_;
  Grasp below = other.trays[0].parts[0].grasps[0];
  below.T_object_hand.linear() = Eigen::Matrix3d::Identity();
  other.trays[0].parts[0].grasps = {below};
  BasePoseEvaluator evaluator(other, *database_);
  EXPECT_TRUE(evaluator.hand_blocked({TrayId(0), 0}, 0));
  EXPECT_FALSE(evaluator.hand_blocked({TrayId(0), 1}, 0));
  const PartAtPose seen = evaluator.part(Eigen::Vector3d(0.3, -0.2, 0), {TrayId(0), 0});
  ASSERT_EQ(seen.causes.size(), 1u);
  EXPECT_EQ(seen.causes[0], Rejection::grasp_filter);
}

}  // namespace
}  // namespace mmgrasp
