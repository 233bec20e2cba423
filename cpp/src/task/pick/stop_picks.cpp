#include "task/pick/stop_picks.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "mmgrasp/core/parallel.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp {
namespace {

using PartId = std::pair<int, int>;  // tray, part
constexpr int kRounds = 6;

std::vector<PartId> first_order(const PartSupplyProblem& problem, const Eigen::Vector3d& base_pose,
                                const std::vector<int>& trays) {
  std::vector<PartId> order;
  for (int tray : trays) {
    const std::vector<Part>& parts = problem.trays[tray].parts;
    std::vector<PartId> here;
    for (int p = 0; p < static_cast<int>(parts.size()); ++p) {
      if (parts[p].target) here.emplace_back(tray, p);
    }
    const auto distance = [&](const PartId& id) {
      return (part_of(problem, id.first, id.second).T_world_part.translation().head<2>() - base_pose.head<2>()).norm();
    };
    std::stable_sort(here.begin(), here.end(),
                     [&](const PartId& a, const PartId& b) { return distance(a) < distance(b) - 1e-9; });
    order.insert(order.end(), here.begin(), here.end());
  }
  return order;
}

std::vector<PartId> without(const std::vector<PartId>& parts, const std::set<PartId>& gone) {
  std::vector<PartId> left;
  for (const PartId& id : parts) {
    if (!gone.count(id)) left.push_back(id);
  }
  return left;
}

}  // namespace

StopPicks plan_stop_picks(const PartSupplyProblem& problem, const ReachDatabase& database,
                          const Eigen::Vector3d& base_pose, const std::vector<int>& trays,
                          const std::vector<std::pair<int, int>>& remaining, const Monitor& monitor) {
  StopPicks result;
  std::vector<PartId> order = first_order(problem, base_pose, trays);
  std::map<PartId, std::pair<std::set<PartId>, Pick>> known;  // with the parts that were gone when it was planned
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::pair<PartId, std::set<PartId>>> open;
    std::set<PartId> gone;
    for (const PartId& id : order) {
      const auto found = known.find(id);
      if (found == known.end() || found->second.first != gone) open.emplace_back(id, gone);
      gone.insert(id);
    }
    std::vector<Pick> planned(open.size());
    const bool done = parallel_for(
        open.size(), problem.options.threads,
        [&](std::size_t item, int) {
          const auto& [id, before] = open[item];
          planned[item] =
              plan_pick(problem, database, base_pose, id.first, id.second, without(remaining, before), monitor);
        },
        monitor, "picks");
    if (!done || monitor.stopped()) {
      result.outcome = Outcome::stopped;
      return result;
    }
    for (std::size_t i = 0; i < open.size(); ++i) known[open[i].first] = {open[i].second, std::move(planned[i])};
    std::vector<PartId> next = order;
    const auto solved = [&](const PartId& id) { return known.at(id).second.outcome == Outcome::solved; };
    std::stable_partition(next.begin(), next.end(), solved);
    const bool all = std::all_of(order.begin(), order.end(), solved);
    result.picks.clear();
    for (const PartId& id : order) {
      if (all || !solved(id)) result.picks.push_back(known.at(id).second);
    }
    if (all) {
      result.outcome = Outcome::solved;
      return result;
    }
    if (next == order) return result;  // those that failed were last already: nothing else will get out of their way
    order = std::move(next);
  }
  return result;
}

}  // namespace mmgrasp
