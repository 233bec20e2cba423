#include "mmgrasp/task/object_regions.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "mmgrasp/core/error.hpp"
#include "support/small_storeroom.hpp"

namespace mmgrasp {
namespace {

/// Four parts in each tray, near enough that the hand at one part runs into its neighbour.
class KeptRegions : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    problem_ = new PartSupplyProblem(test::small_storeroom(4));
    problem_->options.grid.resolution = 0.10;
    for (Tray& tray : problem_->trays) {
      for (std::size_t p = 0; p < tray.parts.size(); ++p) {
        tray.parts[p].T_world_part.translation().y() = tray.T_world_tray.translation().y() + 0.055 * (p - 1.5);
      }
    }
    // A tall one that stays in everybody's way until it leaves.
    Part& tall = problem_->trays[1].parts[2];
    tall.target = false;
    tall.shapes[0].shape = test::box_shape(0.03, 0.03, 0.30);
    database_ = new ReachDatabase(test::small_database(*problem_));
    grid_ = new BaseGrid(make_base_grid(*problem_, *database_));
  }
  static void TearDownTestSuite() {
    delete grid_;
    delete database_;
    delete problem_;
  }

  static PartSupplyProblem* problem_;
  static ReachDatabase* database_;
  static BaseGrid* grid_;
};

PartSupplyProblem* KeptRegions::problem_ = nullptr;
ReachDatabase* KeptRegions::database_ = nullptr;
BaseGrid* KeptRegions::grid_ = nullptr;

TEST_F(KeptRegions, AnyChoiceOfPartsIsAnIntersection) {
  const ObjectRegions kept = ObjectRegions::compute(*problem_, *database_, *grid_);
  const std::vector<BaseRegion> regions = compute_base_regions(*problem_, *database_, *grid_);
  ASSERT_TRUE(kept.complete());
  EXPECT_EQ(kept.trays(), 2);
  EXPECT_EQ(kept.parts(TrayId(0)), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(kept.parts(TrayId(1)), (std::vector<int>{0, 1, 3}));
  EXPECT_EQ(kept.region(TrayId(0), {0, 1, 2, 3}), regions[0].cells);
  EXPECT_EQ(kept.region(TrayId(1), {3}), regions[1].part_cells[2].mask());
  CellMask both = regions[0].part_cells[1].mask();
  for (std::size_t i = 0; i < both.size(); ++i) both[i] &= regions[0].part_cells[2][i];
  EXPECT_EQ(kept.region(TrayId(0), {2, 1}), both);
  EXPECT_THROW(kept.region(TrayId(0), {}), InvalidInput);
  EXPECT_THROW(kept.region(TrayId(1), {2}), InvalidInput);
  EXPECT_THROW(kept.region(TrayId(2), {0}), InvalidInput);
}

/// After every removal: what a computation from scratch gives, and nothing has shrunk.
TEST_F(KeptRegions, LeavingPartsGiveWhatScratchGives) {
  ObjectRegions kept = ObjectRegions::compute(*problem_, *database_, *grid_);
  PartSupplyProblem rest = *problem_;
  std::vector<std::vector<int>> left = {{0, 1, 2, 3}, {0, 1, 2, 3}};
  std::size_t grown = 0;
  const TrayId first(0), second(1);
  for (const std::vector<PartRef>& leaving :
       {std::vector<PartRef>{{first, 1}}, {{second, 2}}, {{first, 3}, {second, 0}}, {{first, 0}}}) {
    std::vector<std::vector<CellMask>> before(2);
    for (int tray = 0; tray < 2; ++tray) {
      for (int part : kept.parts(TrayId(tray))) before[tray].push_back(kept.region(TrayId(tray), {part}));
    }
    const std::vector<std::vector<int>> parts_before = {kept.parts(TrayId(0)), kept.parts(TrayId(1))};
    ASSERT_TRUE(kept.remove(leaving));
    for (const auto& [tray, part] : leaving) {
      std::vector<int>& known = left[tray];
      const auto place = std::find(known.begin(), known.end(), part) - known.begin();
      known.erase(known.begin() + place);
      std::vector<Part>& parts = rest.trays[tray].parts;
      parts.erase(parts.begin() + place);
    }
    const std::vector<BaseRegion> scratch = compute_base_regions(rest, *database_, *grid_);
    for (int tray = 0; tray < 2; ++tray) {
      const std::vector<int> parts = kept.parts(TrayId(tray));
      const BaseRegion& region = scratch[tray];
      ASSERT_EQ(parts.size(), region.part_cells.size());
      EXPECT_EQ(kept.base_region(TrayId(tray)).cells, region.cells);
      EXPECT_EQ(kept.base_region(TrayId(tray)).base_poses_in_collision, region.base_poses_in_collision);
      for (std::size_t p = 0; p < parts.size(); ++p) {
        const CellMask now = kept.region(TrayId(tray), {parts[p]});
        EXPECT_EQ(now, region.part_cells[p].mask());
        const PartExplanation reported = kept.base_region(TrayId(tray)).explanations[p];
        const PartExplanation& recount = region.explanations[p];
        EXPECT_EQ(reported.part, recount.part);
        EXPECT_EQ(reported.base_poses_tried, recount.base_poses_tried);
        EXPECT_EQ(reported.base_poses_feasible, recount.base_poses_feasible);
        EXPECT_EQ(reported.rejections, recount.rejections)
            << reported.rejections.summary() << " against " << recount.rejections.summary();
        const std::vector<int>& known = parts_before[tray];
        const auto place = static_cast<std::size_t>(std::find(known.begin(), known.end(), parts[p]) - known.begin());
        const CellMask& then = before[tray][place];
        for (std::size_t i = 0; i < now.size(); ++i) {
          EXPECT_LE(then[i], now[i]);
          grown += now[i] > then[i];
        }
      }
    }
  }
  EXPECT_GT(grown, 0u);
  EXPECT_THROW(kept.remove({{TrayId(0), 1}}), InvalidInput);
  EXPECT_EQ(kept.parts(TrayId(0)), (std::vector<int>{2}));
}

TEST_F(KeptRegions, StoppedTheyAreWhatTheyWere) {
  ObjectRegions kept = ObjectRegions::compute(*problem_, *database_, *grid_);
  const CellMask before = kept.region(TrayId(0), {0});
  Monitor monitor;
  monitor.stop.stop();
  EXPECT_FALSE(kept.remove({{TrayId(0), 1}}, monitor));
  EXPECT_EQ(kept.parts(TrayId(0)), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(kept.region(TrayId(0), {0}), before);
  EXPECT_FALSE(ObjectRegions::compute(*problem_, *database_, *grid_, monitor).complete());
}

}  // namespace
}  // namespace mmgrasp
