#include <gtest/gtest.h>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/task/base_region.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "support/small_storeroom.hpp"

namespace mmgrasp {
namespace {

/// Two trays side by side on one table; the second wants the robot to stand turned by a quarter.
class SharedHeadings : public test::SmallRegions {
 protected:
  static void SetUpTestSuite() {
    PartSupplyProblem problem = test::small_storeroom();
    Tray& turned = problem.trays[1];
    turned.T_world_tray.linear() = Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    set_up(problem);
  }
};

/// What the search at all headings finds, in the cells where the tray is served whose heading it is.
TEST_F(SharedHeadings, AreThoseOfTheWholeSearchWhereTheirTrayIsServed) {
  ASSERT_EQ(grid_->headings.size(), 2u);
  const std::vector<BaseRegion> shared = share_headings(*problem_, *database_, *grid_, *regions_);
  PartSupplyProblem listed = *problem_;
  for (Tray& tray : listed.trays) tray.headings = grid_->headings;
  const std::vector<BaseRegion> whole = compute_base_regions(listed, *database_, *grid_);
  const std::size_t layer_size = grid_->size() / 2;
  std::size_t gained = 0;
  for (std::size_t tray = 0; tray < 2; ++tray) {
    for (std::size_t i = 0; i < grid_->size(); ++i) {
      const std::size_t owner = i / layer_size;
      const bool expected = whole[tray].cells[i] && (owner == tray || (*regions_)[owner].cells[i]);
      ASSERT_EQ(shared[tray].cells[i] != 0, expected) << "tray " << tray << ", cell " << i;
      gained += expected && owner != tray;
    }
    for (std::size_t part = 0; part < 2; ++part) {
      const PartExplanation &before = (*regions_)[tray].explanations[part], &after = shared[tray].explanations[part];
      EXPECT_GT(after.base_poses_tried, before.base_poses_tried);
      EXPECT_EQ(after.rejections.total(), after.grasps * (after.base_poses_tried - after.base_poses_feasible));
    }
  }
  EXPECT_GT(gained, 10u);
}

TEST_F(SharedHeadings, GiveTwoTraysOneStop) {
  StopOptions options;
  options.min_radius = problem_->options.positioning_uncertainty;
  EXPECT_EQ(plan_stops_exact(*grid_, *regions_, options).stops.size(), 2u);
  const std::vector<BaseRegion> shared = share_headings(*problem_, *database_, *grid_, *regions_);
  EXPECT_EQ(plan_stops_exact(*grid_, shared, options).stops.size(), 1u);
}

TEST_F(SharedHeadings, TheSameAtAnyThreadCount) {
  PartSupplyProblem other = *problem_;
  std::vector<BaseRegion> found[2];
  for (int threads : {1, 3}) {
    other.options.threads = threads;
    found[threads / 2] = share_headings(other, *database_, *grid_, *regions_);
  }
  for (std::size_t tray = 0; tray < 2; ++tray) {
    EXPECT_EQ(found[0][tray].cells, found[1][tray].cells);
    EXPECT_EQ(found[0][tray].part_cells, found[1][tray].part_cells);
  }
}

TEST_F(SharedHeadings, TraysThatListHeadingsKeepToThem) {
  PartSupplyProblem listed = *problem_;
  listed.trays[0].headings = {grid_->headings[0]};
  const std::vector<BaseRegion> shared = share_headings(listed, *database_, *grid_, *regions_);
  EXPECT_EQ(shared[0].cells, (*regions_)[0].cells);
  EXPECT_GT(shared[1].count(), (*regions_)[1].count());
}

TEST_F(SharedHeadings, BadInputAndStopping) {
  EXPECT_THROW(share_headings(*problem_, *database_, *grid_, {}), InvalidInput);
  std::vector<BaseRegion> foreign = *regions_;
  foreign[0].cells.pop_back();
  EXPECT_THROW(share_headings(*problem_, *database_, *grid_, foreign), InvalidInput);
  foreign = *regions_;
  foreign[1].part_cells.pop_back();
  EXPECT_THROW(share_headings(*problem_, *database_, *grid_, foreign), InvalidInput);
  Monitor monitor;
  monitor.stop.stop();
  EXPECT_TRUE(share_headings(*problem_, *database_, *grid_, *regions_, monitor).empty());
}

}  // namespace
}  // namespace mmgrasp
