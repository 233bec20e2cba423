// Region maps of whole robots against collision-aware IK of the core, cell by cell (benchmarks/task/bench_regions_truth
// compares more of them).
#include <gtest/gtest.h>

#include "support/paths.hpp"
#include "support/region_truth.hpp"
#include "support/robot_support.hpp"
#include "support/tray_rows.hpp"

namespace mmgrasp {
namespace {

ReachOptions samples_drawn(std::int64_t count) {
  ReachOptions reach;
  reach.samples = count;
  return reach;
}

/// No false cells; of the feasible ones at most this share is missed.
void expect_true_cells(const testing_support::MobileManipulator& robot, int samples, double missed,
                       const ReachOptions& reach = samples_drawn(400000), int grasps = 2) {
  testing_support::RowOptions row;
  row.rows = row.columns = 2;
  row.grasps = grasps;
  row.tool_height = 0.07;
  const PartSupplyProblem problem = testing_support::tray_row(robot, row);
  const ReachDatabase database = ReachDatabase::build(robot.arm, reach);
  const BaseGrid grid = make_base_grid(problem, database);
  const std::vector<BaseRegion> regions = compute_base_regions(problem, database, grid);
  const testing_support::TruthCounts counts =
      testing_support::compare_with_truth(problem, database, grid, regions, 0, 1.2, samples, 20, 1);
  EXPECT_EQ(counts.wrong, 0) << robot.name;
  EXPECT_GT(counts.claimed, samples / 20) << robot.name;
  EXPECT_LE(counts.missed, missed * counts.truth) << robot.name;
  ::testing::Test::RecordProperty("feasible by IK", counts.truth);
  ::testing::Test::RecordProperty("missed", counts.missed);
}

TEST(RegionTruth, FetchLike) {
  expect_true_cells(testing_support::fetchlike(MMGRASP_ASSETS), 120, 0.2);
}

TEST(RegionTruth, Tiago) {
  MMGRASP_NEEDS_SHARED_DATA();
  expect_true_cells(testing_support::tiago_with_gripper(MMGRASP_SHARED_DATA), 60, 0.2);
}

TEST(RegionTruth, Ur10eOnRidgeback) {
  MMGRASP_NEEDS_SHARED_DATA();
  expect_true_cells(testing_support::ur10e_on_ridgeback(MMGRASP_SHARED_DATA), 60, 0.05);
}

// Parts with one grasp: of seven joints eight postures at each would miss a tenth of the cells.
TEST(RegionTruth, OneGraspOfAPart) {
  expect_true_cells(testing_support::fetchlike(MMGRASP_ASSETS), 200, 0.02, samples_drawn(400000), 1);
}

// A database that is sparse in its cells, for few samples or for small cells, leads to the cells nonetheless.
TEST(RegionTruth, SparseDatabases) {
  const testing_support::MobileManipulator robot = testing_support::fetchlike(MMGRASP_ASSETS);
  expect_true_cells(robot, 200, 0.05, samples_drawn(30000));
  ReachOptions small_cells = samples_drawn(300000);
  small_cells.position_cell = 0.06;
  small_cells.rotation_cell = 0.4;
  expect_true_cells(robot, 200, 0.05, small_cells);
}

// Six joints in closed form: what the database holds decides nothing, and nor does what was asked before.
TEST(RegionTruth, ClosedFormNeedsNoDatabase) {
  MMGRASP_NEEDS_SHARED_DATA();
  const testing_support::MobileManipulator robot = testing_support::ur10e_on_ridgeback(MMGRASP_SHARED_DATA);
  testing_support::RowOptions row;
  row.rows = row.columns = 2;
  row.grasps = 2;
  row.tool_height = 0.07;
  PartSupplyProblem problem = testing_support::tray_row(robot, row);
  problem.options.grid.max_distance = 1.3;
  ReachOptions reach;
  reach.samples = 20000;
  const ReachDatabase larger = ReachDatabase::build(robot.arm, reach);
  reach.samples = 50;
  const ReachDatabase tiny = ReachDatabase::build(robot.arm, reach);
  const BaseGrid grid = make_base_grid(problem, larger);
  problem.options.threads = 1;
  const std::vector<BaseRegion> one = compute_base_regions(problem, larger, grid);
  problem.options.threads = 4;
  const std::vector<BaseRegion> other = compute_base_regions(problem, tiny, grid);
  EXPECT_GT(one[0].count(), 500U);
  EXPECT_EQ(one[0].cells, other[0].cells);
  ASSERT_EQ(one[0].explanations.size(), other[0].explanations.size());
  for (std::size_t part = 0; part < one[0].explanations.size(); ++part) {
    const PartExplanation &a = one[0].explanations[part], &b = other[0].explanations[part];
    EXPECT_EQ(a.base_poses_tried, b.base_poses_tried);
    EXPECT_EQ(a.base_poses_feasible, b.base_poses_feasible);
    EXPECT_EQ(a.rejections.total(), b.rejections.total());
    EXPECT_EQ(a.rejections.unreachable, b.rejections.unreachable);
    EXPECT_EQ(a.rejections.limits, b.rejections.limits);
  }
}

}  // namespace
}  // namespace mmgrasp
