#include "task/pick/stop_picks.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "task/pick/joined_motions.hpp"
#include "task/problem/scene.hpp"
#include "task/problem/standing.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kRounds = 6;

std::vector<PartRef> first_order(const PartSupplyProblem& problem, const Eigen::Vector3d& base_pose,
                                 const std::vector<TrayId>& trays, const std::vector<PartRef>& remaining) {
  std::vector<PartRef> order;
  for (TrayId tray : trays) {
    std::vector<PartRef> here;
    for (const PartRef& target : target_parts(problem, tray)) {
      if (std::count(remaining.begin(), remaining.end(), target) > 0) here.push_back(target);
    }
    const auto distance = [&](const PartRef& id) {
      return (part_of(problem, id).T_world_part.translation().head<2>() - base_pose.head<2>()).norm();
    };
    std::stable_sort(here.begin(), here.end(),
                     [&](const PartRef& a, const PartRef& b) { return distance(a) < distance(b) - 1e-9; });
    order.insert(order.end(), here.begin(), here.end());
  }
  return order;
}

std::vector<PartRef> without(const std::vector<PartRef>& parts, const std::set<PartRef>& removed) {
  std::vector<PartRef> left;
  for (const PartRef& id : parts) {
    if (!removed.count(id)) left.push_back(id);
  }
  return left;
}

}  // namespace

StopPicks stop_picks(const PartSupplyProblem& problem, const ReachDatabase& database, const Eigen::Vector3d& base_pose,
                     const std::vector<TrayId>& trays, const std::vector<PartRef>& remaining, const Monitor& monitor,
                     const HeldDrive& drive) {
  StopPicks result;
  std::vector<PartRef> order = first_order(problem, base_pose, trays, remaining);
  std::map<PartRef, std::pair<std::set<PartRef>, Pick>> known;  // with the parts that were gone when it was planned
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::pair<PartRef, std::set<PartRef>>> open;
    std::set<PartRef> removed;
    for (const PartRef& id : order) {
      const auto found = known.find(id);
      if (found == known.end() || found->second.first != removed) open.emplace_back(id, removed);
      removed.insert(id);
    }
    std::vector<Pick> planned(open.size());
    const bool done = parallel_for(
        open.size(), problem.options.threads,
        [&](std::size_t item, int) {
          const auto& [id, before] = open[item];
          planned[item] = pick_part(problem, database, base_pose, id, without(remaining, before), monitor, drive);
        },
        monitor, "picks");
    if (!done || monitor.stopped()) {
      result.outcome = Outcome::stopped;
      return result;
    }
    for (std::size_t i = 0; i < open.size(); ++i) known[open[i].first] = {open[i].second, std::move(planned[i])};
    std::vector<PartRef> next = order;
    const auto solved = [&](const PartRef& id) { return known.at(id).second.outcome == Outcome::solved; };
    std::stable_partition(next.begin(), next.end(), solved);
    const bool all = std::all_of(order.begin(), order.end(), solved);
    result.picks.clear();
    for (const PartRef& id : order) {
      if (all || !solved(id)) result.picks.push_back(known.at(id).second);
    }
    if (all) {
      result.outcome = Outcome::solved;
      return result;
    }
    if (next == order) return result;  // the failed ones were last already: no other part will be removed before them
    order = std::move(next);
  }
  return result;
}

}  // namespace mmgrasp::detail

namespace mmgrasp {

StopPicks plan_stop_picks(const PartSupplyProblem& problem, const ReachDatabase& database,
                          const Eigen::Vector3d& base_pose, const std::vector<TrayId>& trays,
                          const std::vector<PartRef>& remaining, const Monitor& monitor) {
  const std::vector<PartRef> all = detail::all_parts(problem);
  for (auto part = remaining.begin(); part != remaining.end(); ++part) {
    require(std::count(all.begin(), all.end(), *part) == 1, "remaining", part->part, "must be parts of the problem");
    require(std::count(remaining.begin(), part, *part) == 0, "remaining", part->part, "must not be named twice");
  }
  for (auto tray = trays.begin(); tray != trays.end(); ++tray) {
    require(*tray >= 0 && *tray < static_cast<int>(problem.trays.size()), "trays", *tray, "must be the problem's");
    require(std::count(trays.begin(), tray, *tray) == 0, "trays", *tray, "must not be named twice");
  }
  detail::require_standing(problem, "base_pose", base_pose, remaining);
  StopPicks found = detail::stop_picks(problem, database, base_pose, trays, remaining, monitor);
  if (found.outcome != Outcome::solved) return found;
  Eigen::VectorXd at = problem.home;
  for (Pick& pick : found.picks) at = detail::join_motions(problem.arm.wraps(), at, pick.motions);
  return found;
}

}  // namespace mmgrasp
