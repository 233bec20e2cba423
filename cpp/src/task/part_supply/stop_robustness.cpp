#include "task/part_supply/stop_robustness.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/core/random.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp::detail {
namespace {

constexpr std::size_t kBlock = 20;  // Samples of one work item; the grasp that worked last is tried first within it.

struct Miss {
  TrayId tray;
  std::string part;
  Eigen::Vector3d pose;
};

struct Block {
  std::size_t samples = 0, good = 0;
  std::vector<Miss> misses;
};

struct BlockCheck {
  const PartSupplyProblem& problem;
  const Stop& stop;
  BasePoseEvaluator& evaluator;
  Block& block;

  void run(Rng& rng, std::size_t count, const Monitor& monitor) {
    std::map<PartRef, int> last;
    for (std::size_t i = 0; i < count && !monitor.stopped(); ++i) {
      Eigen::Vector3d pose = stop.pose;
      pose.head<2>() += rng.in_disc(problem.options.positioning_uncertainty);
      ++block.samples;
      if (all_graspable(pose, last)) ++block.good;
    }
  }

  bool all_graspable(const Eigen::Vector3d& pose, std::map<PartRef, int>& last) {
    bool all = true;
    for (TrayId tray : stop.trays) {
      for (const PartRef& part : target_parts(problem, tray)) {
        int& first = last.emplace(part, -1).first->second;
        const PartAtPose seen = evaluator.part(pose, part, first);
        if (seen.feasible) {
          first = seen.grasp;
        } else if (!evaluator.part_with_restarts(pose, part)) {
          block.misses.push_back({tray, part_of(problem, part).name, pose});
          all = false;
          break;  // the cell is lost to this tray
        }
      }
    }
    return all;
  }
};

bool remove_cell(const BaseGrid& grid, const Eigen::Vector3d& pose, BaseRegion& region) {
  const int ix = static_cast<int>(std::floor((pose.x() - grid.origin.x()) / grid.resolution));
  const int iy = static_cast<int>(std::floor((pose.y() - grid.origin.y()) / grid.resolution));
  if (ix < 0 || iy < 0 || ix >= grid.nx || iy >= grid.ny) return false;
  for (int h = 0; h < static_cast<int>(grid.headings.size()); ++h) {
    if (std::abs(wrap_angle(grid.headings[h] - pose.z())) > 1e-9) continue;
    std::uint8_t& cell = region.cells[grid.index(h, ix, iy)];
    const bool was = cell != 0;
    cell = 0;
    return was;
  }
  return false;
}

}  // namespace

RobustnessResult check_robustness(const PartSupplyProblem& problem, const BasePoseEvaluator& evaluator,
                                  const BaseGrid& grid, const std::vector<Stop>& stops,
                                  std::vector<BaseRegion>& regions, const Monitor& monitor) {
  RobustnessResult result;
  const std::size_t wanted = problem.options.robustness_samples;
  const std::size_t per_stop = (wanted + kBlock - 1) / kBlock;
  std::vector<Block> blocks(per_stop * stops.size());
  const int threads = resolve_threads(problem.options.threads);
  std::vector<BasePoseEvaluator> evaluators;
  for (int i = 0; i < threads; ++i) evaluators.push_back(evaluator.clone());
  const bool done = parallel_for(
      blocks.size(), threads,
      [&](std::size_t item, int worker) {
        Rng rng(problem.options.seed + 77, item);
        const std::size_t first = item % per_stop * kBlock;
        BlockCheck check{problem, stops[item / per_stop], evaluators[worker], blocks[item]};
        check.run(rng, std::min(kBlock, wanted - first), monitor);
      },
      monitor, "robustness");
  result.stopped = !done || monitor.stopped();
  result.stops.resize(stops.size());
  result.worst_part.resize(stops.size());
  std::vector<std::map<std::string, std::size_t>> missed(stops.size());
  for (std::size_t item = 0; item < blocks.size(); ++item) {
    const std::size_t stop = item / per_stop;
    result.stops[stop].samples += blocks[item].samples;
    result.stops[stop].good += blocks[item].good;
    std::string& worst = result.worst_part[stop];
    for (const Miss& miss : blocks[item].misses) {
      if (++missed[stop][miss.part] > missed[stop][worst]) worst = miss.part;
      result.cells_removed += remove_cell(grid, miss.pose, regions[miss.tray]);
    }
  }
  return result;
}

}  // namespace mmgrasp::detail
