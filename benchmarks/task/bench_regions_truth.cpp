// Region maps against collision-aware IK with many random restarts, cell by cell, on three robots: cells that the
// regions miss, and cells that are false (claimed, and not confirmed by configurations checked by a fresh checker).
#include <cstring>
#include <filesystem>
#include <iomanip>
#include <sstream>

#include "core/report.hpp"
#include "mmgrasp/collision/collision_ik.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/task/base_region.hpp"
#include "support/paths.hpp"
#include "support/region_truth.hpp"
#include "support/tray_rows.hpp"

using namespace mmgrasp;

namespace {

void compare(const testing_support::MobileManipulator& robot, const std::string& folder, int samples, int restarts) {
  testing_support::RowOptions set_up;
  set_up.rows = 2;
  set_up.columns = 2;
  set_up.grasps = 4;
  set_up.tool_height = 0.07;
  const PartSupplyProblem problem = testing_support::tray_row(robot, set_up);
  const ReachDatabase database = ReachDatabase::load_or_build(robot.arm, {}, folder);
  const BaseGrid grid = make_base_grid(problem, database);
  const double begin = bench::now();
  const std::vector<BaseRegion> regions = compute_base_regions(problem, database, grid);
  const double seconds = bench::now() - begin;
  const testing_support::TruthCounts counts =
      testing_support::compare_with_truth(problem, database, grid, regions, 0, 1.3, samples, restarts, 1);
  std::ostringstream more;
  more << std::setprecision(4) << "\"cells\": " << regions[0].count() << ", \"compared\": " << counts.compared
       << ", \"feasible by IK\": " << counts.truth << ", \"missed\": " << counts.missed
       << ", \"false\": " << counts.wrong << ", \"confirmed by their own configuration only\": " << counts.elsewhere
       << ", \"restarts\": " << restarts << ", \"regions s\": " << seconds;
  bench::print({"region maps", robot.name, "mmgrasp", "missed share",
                counts.truth == 0 ? 0 : static_cast<double>(counts.missed) / static_cast<double>(counts.truth),
                more.str(),
                "one tray of 2x2 objects, four grasps from above each; part by part, cell centre and corners; " +
                    std::to_string(samples) + " cells and parts, " + std::to_string(restarts) + " restarts"});
}

}  // namespace

/// bench_regions_truth <folder for databases> [cells and parts compared] [restarts]
int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : "reach-cache";
  const int samples = argc > 2 ? std::atoi(argv[2]) : 2000, restarts = argc > 3 ? std::atoi(argv[3]) : 200;
  compare(testing_support::fetchlike(MMGRASP_ASSETS), folder, samples, restarts);
  if (!std::filesystem::exists(MMGRASP_SHARED_DATA)) return 0;
  compare(testing_support::tiago_with_gripper(MMGRASP_SHARED_DATA), folder, samples, restarts);
  compare(testing_support::ur10e_on_ridgeback(MMGRASP_SHARED_DATA), folder, samples, restarts);
}
