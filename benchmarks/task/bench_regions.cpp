// Base regions with a loaded database and otherwise empty caches: P1's tables 3.1 (one tray) and 3.3 (rows of trays,
// regions only), and rows of up to 500 trays.
#include <sys/resource.h>

#include <cstring>
#include <iomanip>
#include <numeric>
#include <sstream>

#include "core/report.hpp"
#include "mmgrasp/task/base_region.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "support/paths.hpp"
#include "support/tray_rows.hpp"

using namespace mmgrasp;
using testing_support::RowOptions;

namespace {

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Row {
  RowOptions set_up;
  double paper;  ///< [s]; 0: not printed.
};

void measure(const char* table, const testing_support::MobileManipulator& robot, const ReachDatabase& database,
             const Row& row, int rounds) {
  const PartSupplyProblem problem = testing_support::tray_row(robot, row.set_up);
  std::vector<double> wall, cpu;
  std::size_t cells = 0, tried = 0, feasible = 0;
  for (int round = 0; round < rounds; ++round) {
    const double begin = bench::now(), cpu_begin = cpu_seconds();
    const BaseGrid grid = make_base_grid(problem, database);
    const std::vector<BaseRegion> regions = compute_base_regions(problem, database, grid);
    wall.push_back(bench::now() - begin);
    cpu.push_back(cpu_seconds() - cpu_begin);
    cells = tried = feasible = 0;
    for (const BaseRegion& region : regions) {
      cells += region.count();
      for (const PartExplanation& part : region.explanations) {
        tried += part.base_poses_tried;
        feasible += part.base_poses_feasible;
      }
    }
  }
  std::sort(wall.begin(), wall.end());
  std::sort(cpu.begin(), cpu.end());
  std::ostringstream on, more;
  on << row.set_up.trays << (row.set_up.trays == 1 ? " tray of " : " trays of ") << row.set_up.rows << "x"
     << row.set_up.columns;
  more << std::setprecision(4) << "\"table\": \"" << table << "\", \"best\": " << wall.front()
       << ", \"processor_s\": " << cpu[cpu.size() / 2] << ", \"cells\": " << cells
       << ", \"objects\": " << row.set_up.trays * row.set_up.rows * row.set_up.columns
       << ", \"base poses tried\": " << tried << ", \"feasible\": " << feasible << ", \"paper\": " << row.paper;
  bench::print({"base regions", on.str(), "mmgrasp", "s", wall[wall.size() / 2], more.str(),
                "5 cm grid, one grasp from above, Fetch-like robot, database loaded, nothing else cached"});
}

/// The largest discs of 5,000 intersections: the region of one object with itself, shifted.
void measure_circles(const testing_support::MobileManipulator& robot, const ReachDatabase& database) {
  const PartSupplyProblem problem = testing_support::tray_row(robot, RowOptions());
  const BaseGrid grid = make_base_grid(problem, database);
  const CellMask cells = compute_base_regions(problem, database, grid)[0].cells;
  std::vector<CellMask> shared;
  std::size_t count = 0;
  for (int dy = -40; dy <= 40 && shared.size() < 5000; ++dy) {
    for (int dx = -40; dx <= 40 && shared.size() < 5000; ++dx) {
      CellMask both(cells.size(), 0);
      std::size_t own = 0;
      for (int iy = std::max(0, dy); iy < std::min(grid.ny, grid.ny + dy); ++iy) {
        for (int ix = std::max(0, dx); ix < std::min(grid.nx, grid.nx + dx); ++ix)
          own += both[grid.index(0, ix, iy)] = cells[grid.index(0, ix, iy)] & cells[grid.index(0, ix - dx, iy - dy)];
      }
      if (own == 0) continue;
      count += own;
      shared.push_back(std::move(both));
    }
  }
  double radii = 0;
  const double begin = bench::now();
  for (const CellMask& both : shared) radii += inscribed_circle(grid, both, 0).radius;
  const double seconds = bench::now() - begin;
  std::ostringstream more;
  more << "\"intersections\": " << shared.size() << ", \"cells\": " << count
       << ", \"mean radius m\": " << radii / static_cast<double>(shared.size());
  bench::print(
      {"inscribed circles", "shifted regions", "mmgrasp", "s", seconds, more.str(), "exact to 1e-6 m, one thread"});
}

}  // namespace

/// bench_regions <folder for databases> [rounds] [largest number of trays]
int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : "reach-cache";
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 5, most = argc > 3 ? std::atoi(argv[3]) : 500;
  const testing_support::MobileManipulator robot = testing_support::fetchlike(MMGRASP_ASSETS);
  const ReachDatabase database = ReachDatabase::load_or_build(robot.arm, {}, folder);
  const auto grid = [](int rows, int columns) {
    RowOptions set_up;
    set_up.rows = rows;
    set_up.columns = columns;
    return set_up;
  };
  for (const Row& row : std::vector<Row>{{grid(1, 1), 0.22},
                                         {grid(1, 2), 0.26},
                                         {grid(2, 2), 0.28},
                                         {grid(3, 4), 0.51},
                                         {grid(6, 8), 1.64},
                                         {grid(9, 12), 3.01},
                                         {grid(12, 16), 5.10},
                                         {grid(15, 20), 7.84},
                                         {grid(18, 24), 11.14},
                                         {grid(21, 28), 15.41}}) {
    measure("p1-table-3.1", robot, database, row, rounds);
  }
  const std::vector<std::pair<int, double>> trays = {{2, 6.17},    {4, 12.01},  {6, 18.40},  {8, 24.00},  {10, 31.07},
                                                     {12, 36.57},  {14, 42.55}, {16, 48.73}, {18, 54.94}, {20, 67.93},
                                                     {22, 139.25}, {50, 0},     {100, 0},    {200, 0},    {500, 0}};
  for (const auto& [count, paper] : trays) {
    if (count > most) break;
    RowOptions set_up = grid(9, 12);
    set_up.trays = count;
    measure("p1-table-3.3", robot, database, {set_up, paper}, count > 10 ? 1 : rounds);
  }
  measure_circles(robot, database);
}
