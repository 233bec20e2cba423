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

struct Block {
  StopShare share;
  std::vector<Miss> misses;
};

struct BlockCheck {
  const PartSupplyProblem& problem;
  const Stop& stop;
  const DrawBasePose& draw;
  BasePoseEvaluator& evaluator;
  Block& block;

  void run(Rng& rng, std::size_t count, const Monitor& monitor) {
    std::map<PartRef, int> last;
    for (std::size_t i = 0; i < count && !monitor.stopped(); ++i) {
      const Eigen::Vector3d pose = draw(stop, rng);
      ++block.share.samples;
      if (can_stand(pose) && all_graspable(pose, last)) ++block.share.good;
    }
  }

  bool can_stand(const Eigen::Vector3d& pose) {
    if (evaluator.home(pose) == Rejection::none) return true;
    for (TrayId tray : stop.trays) block.misses.push_back({tray, "", pose});
    return false;
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

StopSamples sample_base_poses(const PartSupplyProblem& problem, const BasePoseEvaluator& evaluator,
                              const std::vector<Stop>& stops, std::size_t samples, std::uint64_t seed, bool common,
                              const DrawBasePose& draw, const Monitor& monitor) {
  StopSamples result;
  const std::size_t per_stop = (samples + kBlock - 1) / kBlock;
  std::vector<Block> blocks(per_stop * stops.size());
  const int threads = resolve_threads(problem.options.threads);
  std::vector<BasePoseEvaluator> evaluators;
  for (int i = 0; i < threads; ++i) evaluators.push_back(evaluator.clone());
  const bool done = parallel_for(
      blocks.size(), threads,
      [&](std::size_t item, int worker) {
        Rng rng(seed, common ? item % per_stop : item);
        const std::size_t first = item % per_stop * kBlock;
        BlockCheck check{problem, stops[item / per_stop], draw, evaluators[worker], blocks[item]};
        check.run(rng, std::min(kBlock, samples - first), monitor);
      },
      monitor, "robustness");
  result.stopped = !done || monitor.stopped();
  result.stops.resize(stops.size());
  result.misses.resize(stops.size());
  for (std::size_t item = 0; item < blocks.size(); ++item) {
    StopShare& share = result.stops[item / per_stop];
    share.samples += blocks[item].share.samples;
    share.good += blocks[item].share.good;
    std::vector<Miss>& misses = result.misses[item / per_stop];
    misses.insert(misses.end(), blocks[item].misses.begin(), blocks[item].misses.end());
  }
  return result;
}

RobustnessResult check_robustness(const PartSupplyProblem& problem, const BasePoseEvaluator& evaluator,
                                  const BaseGrid& grid, const std::vector<Stop>& stops,
                                  std::vector<BaseRegion>& regions, const Monitor& monitor) {
  const double radius = problem.options.positioning_uncertainty;
  const auto in_disc = [radius](const Stop& stop, Rng& rng) {
    Eigen::Vector3d pose = stop.pose;
    pose.head<2>() += rng.in_disc(radius);
    return pose;
  };
  const StopSamples drawn = sample_base_poses(problem, evaluator, stops, problem.options.robustness_samples,
                                              problem.options.seed + 77, false, in_disc, monitor);
  RobustnessResult result;
  result.stopped = drawn.stopped;
  result.stops = drawn.stops;
  result.worst_part.resize(stops.size());
  for (std::size_t stop = 0; stop < stops.size(); ++stop) {
    std::map<std::string, std::size_t> missed;
    std::string& worst = result.worst_part[stop];
    for (const Miss& miss : drawn.misses[stop]) {
      if (++missed[miss.part] > missed[worst]) worst = miss.part;
      result.cells_removed += remove_cell(grid, miss.pose, regions[miss.tray]);
    }
  }
  return result;
}

}  // namespace mmgrasp::detail
