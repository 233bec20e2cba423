// What must hold between the regions of related problems, whatever they are.
#include <gtest/gtest.h>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/task/base_pose_evaluator.hpp"
#include "mmgrasp/task/base_region.hpp"
#include "support/small_storeroom.hpp"

namespace mmgrasp {
namespace {

class RegionRelations : public test::SmallRegions {
 protected:
  /// Everything but the robot, moved by a rigid motion of the floor.
  static PartSupplyProblem moved(const PartSupplyProblem& problem, const Eigen::Vector3d& motion) {
    PartSupplyProblem other = problem;
    const Pose T = pose_from_planar(motion);
    for (const auto& [name, object] : problem.world.objects()) other.world.move(name, T * object.T_world_object);
    for (Tray& tray : other.trays) {
      tray.T_world_tray = T * tray.T_world_tray;
      for (Part& part : tray.parts) part.T_world_part = T * part.T_world_part;
      for (double& heading : tray.headings) heading = wrap_angle(heading + motion.z());
    }
    return other;
  }

  /// Number of cells that differ in any part's region, and of those that are in any.
  static std::pair<std::size_t, std::size_t> differences(const std::vector<BaseRegion>& a,
                                                         const std::vector<BaseRegion>& b) {
    std::size_t different = 0, in_any = 0;
    for (std::size_t tray = 0; tray < a.size(); ++tray) {
      for (std::size_t part = 0; part < a[tray].part_cells.size(); ++part) {
        for (std::size_t i = 0; i < a[tray].cells.size(); ++i) {
          different += a[tray].part_cells[part][i] != b[tray].part_cells[part][i];
          in_any += a[tray].part_cells[part][i];
        }
      }
    }
    return {different, in_any};
  }
};

TEST_F(RegionRelations, AnObstacleNeverGrowsARegion) {
  Rng rng(3);
  std::size_t lost = 0;
  for (int round = 0; round < 6; ++round) {
    PartSupplyProblem other = *problem_;
    for (int i = 0; i < 2; ++i) {
      other.world.add("post " + std::to_string(i), test::box_shape(0.06, 0.06, rng.uniform(0.3, 1.2)),
                      test::at(rng.uniform(0.2, 1.1), rng.uniform(-0.6, 0.6), rng.uniform(0.2, 0.9)));
    }
    const std::vector<BaseRegion> regions = compute_base_regions(other, *database_, *grid_);
    for (std::size_t tray = 0; tray < 2; ++tray) {
      for (std::size_t part = 0; part < 2; ++part) {
        for (std::size_t i = 0; i < grid_->size(); ++i) {
          const bool before = (*regions_)[tray].part_cells[part][i], now = regions[tray].part_cells[part][i];
          EXPECT_LE(now, before);
          lost += before && !now;
        }
      }
    }
  }
  EXPECT_GT(lost, 100u);
}

TEST_F(RegionRelations, AGraspNeverShrinksARegion) {
  std::size_t gained = 0;
  for (std::size_t kept = 1; kept < 12; kept += 4) {
    PartSupplyProblem fewer = *problem_;
    for (Tray& tray : fewer.trays) {
      for (Part& part : tray.parts) part.grasps.resize(kept);
    }
    const std::vector<BaseRegion> regions = compute_base_regions(fewer, *database_, *grid_);
    for (std::size_t tray = 0; tray < 2; ++tray) {
      for (std::size_t part = 0; part < 2; ++part) {
        for (std::size_t i = 0; i < grid_->size(); ++i) {
          const bool with_all = (*regions_)[tray].part_cells[part][i], with_few = regions[tray].part_cells[part][i];
          EXPECT_LE(with_few, with_all);
          gained += with_all && !with_few;
        }
      }
    }
  }
  EXPECT_GT(gained, 20u);
}

TEST_F(RegionRelations, WholeCellsMoveTheRegionByWholeCells) {
  const PartSupplyProblem other = moved(*problem_, Eigen::Vector3d(7 * 0.08, -3 * 0.08, 0));
  const BaseGrid grid = make_base_grid(other, *database_);
  ASSERT_EQ(grid.nx, grid_->nx);
  ASSERT_EQ(grid.ny, grid_->ny);
  EXPECT_LT((grid.origin - grid_->origin - Eigen::Vector2d(7 * 0.08, -3 * 0.08)).norm(), 1e-12);
  const auto [different, in_any] = differences(*regions_, compute_base_regions(other, *database_, grid));
  EXPECT_EQ(different, 0u);
  EXPECT_GT(in_any, 100u);
}

TEST_F(RegionRelations, AnyShiftMovesTheRegionWhenTheGridGoesAlong) {
  const Eigen::Vector2d shift(0.0371, -1.2345);
  BaseGrid grid = *grid_;
  grid.origin += shift;
  const PartSupplyProblem other = moved(*problem_, Eigen::Vector3d(shift.x(), shift.y(), 0));
  EXPECT_EQ(differences(*regions_, compute_base_regions(other, *database_, grid)).first, 0u);
}

TEST_F(RegionRelations, AQuarterTurnTurnsTheRegion) {
  const PartSupplyProblem other = moved(*problem_, Eigen::Vector3d(0, 0, 0.5 * M_PI));
  BaseGrid grid = *grid_;  // (x, y) goes to (-y, x)
  grid.nx = grid_->ny;
  grid.ny = grid_->nx;
  grid.origin = Eigen::Vector2d(-grid_->origin.y() - grid_->ny * grid_->resolution, grid_->origin.x());
  grid.headings = {0.5 * M_PI};
  const std::vector<BaseRegion> regions = compute_base_regions(other, *database_, grid);
  std::size_t in_any = 0;
  for (std::size_t tray = 0; tray < 2; ++tray) {
    for (std::size_t part = 0; part < 2; ++part) {
      for (int iy = 0; iy < grid_->ny; ++iy) {
        for (int ix = 0; ix < grid_->nx; ++ix) {
          const bool here = (*regions_)[tray].part_cells[part][grid_->index(0, ix, iy)];
          EXPECT_EQ(regions[tray].part_cells[part][grid.index(0, grid_->ny - 1 - iy, ix)], here);
          in_any += here;
        }
      }
    }
  }
  EXPECT_GT(in_any, 100u);
}

/// Grids lie along the world's axes, so that other turns are asked base pose by base pose.
TEST_F(RegionRelations, AnyRigidMotionMovesTheAnswerOfABasePose) {
  const Eigen::Vector3d motion(1.7, -0.6, 2.345);
  const PartSupplyProblem other = moved(*problem_, motion);
  BasePoseEvaluator here(*problem_, *database_), there(other, *database_);
  Rng rng(8);
  int feasible = 0, differences = 0;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d base(rng.uniform(-0.3, 1.2), rng.uniform(-0.9, 0.9), rng.uniform(-0.6, 0.6));
    Eigen::Vector3d base_there = motion;
    base_there.head<2>() += Eigen::Rotation2Dd(motion.z()) * base.head<2>();
    base_there.z() = wrap_angle(base.z() + motion.z());
    const int tray = i % 2, part = i / 2 % 2;
    const bool works = here.part(base, {TrayId(tray), part}).feasible;
    feasible += works;
    differences += works != there.part(base_there, {TrayId(tray), part}).feasible;
  }
  EXPECT_EQ(differences, 0);
  EXPECT_GT(feasible, 300);
}

}  // namespace
}  // namespace mmgrasp
