// Checks the stops with the base displaced: parts stay graspable from drawn poses.
#include <algorithm>
#include <cmath>
#include <utility>

#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/core/random.hpp"
#include "verify/base/grasp_search.hpp"
#include "verify/context.hpp"

namespace mmgrasp::verify::detail {
namespace {

constexpr int kChunks = 20;  // Pieces of a stop's samples that are worked on independently.

/// What one piece of one stop's samples gave.
struct ChunkResult {
  int samples = 0, good = 0;
  std::vector<int> lost;  ///< At how many samples a wanted part was the one that failed, by part.
  int home_blocked = 0;
};

/// The samples of a stop along a winding path over the disc, so that neighbours in the list are neighbours on the
/// floor.
std::vector<Eigen::Vector3d> sorted_samples(const Context& context, std::size_t stop) {
  const double radius = context.plan.positioning_uncertainty;
  const Eigen::Vector3d& pose = context.plan.stops[stop].pose;
  Rng rng(context.options.seed, stop);
  std::vector<Eigen::Vector2d> offsets;
  for (int i = 0; i < context.options.samples; ++i) offsets.push_back(rng.in_disc(radius));
  const double strip = radius > 0 ? radius / 10 : 1.0;
  const auto key = [strip](const Eigen::Vector2d& p) {
    const int row = static_cast<int>(std::floor(p.x() / strip));
    return std::make_pair(row, row % 2 ? -p.y() : p.y());
  };
  std::sort(offsets.begin(), offsets.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  std::vector<Eigen::Vector3d> poses;
  for (const Eigen::Vector2d& offset : offsets)
    poses.emplace_back(pose.x() + offset.x(), pose.y() + offset.y(), pose.z());
  return poses;
}

/// One piece of a stop. It ends early once it alone has lost more samples than the whole stop may lose.
ChunkResult run_chunk(const Context& context, const std::vector<Eigen::Vector3d>& poses, std::size_t begin,
                      std::size_t end, const std::vector<int>& wanted, Judge& judge, GraspSearch search) {
  ChunkResult result;
  result.lost.assign(wanted.size(), 0);
  const double allowed = (1 - context.options.required_rate) * context.options.samples;
  std::vector<std::size_t> order(wanted.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  for (std::size_t i = begin; i < end; ++i) {
    if (result.samples - result.good > allowed || context.monitor.stopped()) break;
    judge.set_base(poses[i]);
    ++result.samples;
    if (judge.touch(context.plan.home, 0)) {
      ++result.home_blocked;
      continue;
    }
    const auto failed =
        std::find_if(order.begin(), order.end(), [&](std::size_t k) { return !search.find_thoroughly(wanted[k]); });
    if (failed == order.end()) {
      ++result.good;
    } else {
      ++result.lost[*failed];
      std::rotate(order.begin(), failed, failed + 1);  // what failed here is likely to fail next door: ask it first
    }
  }
  return result;
}

StopRate summarize(const Context& context, std::size_t stop, const std::vector<int>& wanted,
                   const std::vector<ChunkResult>& chunks, Faults& faults) {
  StopRate rate;
  rate.stop = static_cast<int>(stop);
  std::vector<int> lost(wanted.size(), 0);
  int home_blocked = 0;
  for (const ChunkResult& chunk : chunks) {
    rate.samples += chunk.samples;
    rate.good += chunk.good;
    home_blocked += chunk.home_blocked;
    for (std::size_t i = 0; i < chunk.lost.size(); ++i) lost[i] += chunk.lost[i];
  }
  const auto worst = std::max_element(lost.begin(), lost.end());
  if (worst != lost.end() && *worst > 0) rate.worst_part = context.plan.parts[wanted[worst - lost.begin()]].body.name;
  if (rate.good >= context.options.required_rate * rate.samples) return rate;
  std::string why = rate.worst_part.empty() ? "" : "; most often '" + rate.worst_part + "' has no free grasp";
  if (home_blocked > 0) why += "; at " + std::to_string(home_blocked) + " the robot collides at home";
  faults.push_back({"not-robust", "stop " + std::to_string(stop),
                    "all parts can be grasped from " + std::to_string(rate.good) + " of " +
                        std::to_string(rate.samples) + " base poses, required is a share of " +
                        text(context.options.required_rate) + why});
  return rate;
}

}  // namespace

void check_robustness(const Context& context, Faults& faults, std::vector<StopRate>& rates,
                      std::size_t& configurations) {
  const std::size_t stops = context.plan.stops.size();
  std::vector<std::vector<Eigen::Vector3d>> poses;
  std::vector<std::vector<int>> wanted;
  for (std::size_t stop = 0; stop < stops; ++stop) {
    poses.push_back(sorted_samples(context, stop));
    wanted.push_back(wanted_parts(context.plan, context.plan.stops[stop].trays));
  }
  const Pools pools = planned_holds(context);
  std::vector<Judge> judges(resolve_threads(context.options.threads), Judge(context.stage));
  std::vector<std::vector<ChunkResult>> results(stops, std::vector<ChunkResult>(kChunks));
  const auto work = [&](std::size_t item, int worker) {
    const std::size_t stop = item / kChunks, chunk = item % kChunks, count = poses[stop].size();
    GraspSearch search(context, judges[worker], pools, Rng(context.options.seed, stops + item));
    results[stop][chunk] = run_chunk(context, poses[stop], count * chunk / kChunks, count * (chunk + 1) / kChunks,
                                     wanted[stop], judges[worker], std::move(search));
  };
  parallel_for(stops * kChunks, context.options.threads, work, context.monitor, "robustness");
  for (std::size_t stop = 0; stop < stops; ++stop) {
    rates.push_back(summarize(context, stop, wanted[stop], results[stop], faults));
  }
  for (const Judge& judge : judges) configurations += judge.queries();
}

}  // namespace mmgrasp::verify::detail
