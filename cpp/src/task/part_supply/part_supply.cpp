#include "mmgrasp/task/part_supply.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/error.hpp"
#include "task/base_region/region_search.hpp"
#include "task/base_region/search_area.hpp"
#include "task/base_sequence/base_routes.hpp"
#include "task/base_sequence/held_drives.hpp"
#include "task/part_supply/alternative_base_poses.hpp"
#include "task/part_supply/arrivals.hpp"
#include "task/part_supply/impossible.hpp"
#include "task/part_supply/obstructions.hpp"
#include "task/part_supply/pick_remedies.hpp"
#include "task/part_supply/plan_intersections.hpp"
#include "task/part_supply/stop_robustness.hpp"
#include "task/pick/joined_motions.hpp"
#include "task/pick/search_pick.hpp"
#include "task/pick/stop_picks.hpp"
#include "task/problem/scene.hpp"
#include "task/problem/standing.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kRobustnessRounds = 5;
constexpr double kRequiredRate = 0.999;   // Share of the base poses drawn at each stop that must work in the end.
constexpr double kLeastClearance = 0.01;  // Smaller ones are not advised [m].
constexpr std::size_t kAlternatives = 4;  // Base poses tried where no motion was found at a stop.
constexpr int kMotionRounds = 4;          // Sets of stops tried when no motion was found at some stop.

/// Adds up the wall time of a stage.
class StageClock {
 public:
  StageClock(PartSupplyPlan& plan, const char* stage) : plan_(plan), stage_(stage) {}
  ~StageClock() {
    const double seconds = stopwatch_.seconds();
    for (StageTime& time : plan_.timings) {
      if (time.stage == stage_) {
        time.seconds += seconds;
        return;
      }
    }
    plan_.timings.push_back({stage_, seconds});
  }
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

 private:
  PartSupplyPlan& plan_;
  const char* stage_;
  Stopwatch stopwatch_;
};

/// The stages of a part-supply plan in order: base regions, stops, picks, route. A stage that fails leaves its
/// obstructions.
class PartSupply {
 public:
  PartSupply(const PartSupplyProblem& problem, const ReachDatabase& database, const Monitor& monitor)
      : problem_(problem), database_(database), monitor_(monitor), held_drives_(problem, monitor) {
    if (!problem.unload_region) return;
    held_drive_ = [this](const Eigen::Vector3d& pose, PartRef part, int grasp, const std::vector<PartRef>& remaining) {
      return held_drives_.plan(pose, part, grasp, remaining);
    };
  }

  PartSupplyPlan run() {
    problem_.check();
    for (const auto& [name, pose] : {std::pair{"start", problem_.start}, std::pair{"goal", problem_.goal}})
      require_standing(problem_, name, pose, all_parts(problem_));
    if (!find_regions() || !find_stops(plan_.regions) || !plan_picks_and_route_somewhere()) {
      if (monitor_.stopped()) {
        plan_.outcome = Outcome::stopped;
        plan_.obstructions.clear();
      }
      return std::move(plan_);
    }
    if (!count_stop_arrivals()) return std::move(plan_);
    plan_.outcome = Outcome::solved;
    return std::move(plan_);
  }

 private:
  /// A base pose from which no motion was found for a pick from this tray.
  struct FailedPick {
    Eigen::Vector3d pose;
    TrayId tray;
  };

  /// Picks that failed at a stop, and the parts that were in place.
  struct UnpickedStop {
    std::vector<Pick> failed;
    Eigen::Vector3d pose;
    std::vector<PartRef> left;
  };

  bool find_regions() {
    const StageClock clock(plan_, "base regions");
    plan_.grid = make_base_grid(problem_, database_);
    evaluator_.emplace(problem_, database_);
    plan_.regions = compute_base_regions(problem_, database_, plan_.grid, *evaluator_, monitor_);
    if (monitor_.stopped()) return false;
    plan_.regions = share_headings(problem_, database_, plan_.grid, std::move(plan_.regions), *evaluator_, monitor_);
    return !monitor_.stopped();
  }

  bool find_stops(std::vector<BaseRegion>& regions) {
    for (int round = 0;; ++round) {
      if (!solve_stops(regions)) {
        explain_unreachable();
        return false;
      }
      const StageClock clock(plan_, "robustness");
      const RobustnessResult check =
          check_robustness(problem_, *evaluator_, plan_.grid, plan_.stops, regions, monitor_);
      if (check.stopped) return false;
      plan_.robustness_rate = check.rate();
      if (check.cells_removed == 0 || round + 1 == kRobustnessRounds) {
        if (check.rate() < kRequiredRate) return obstructed(explain_robustness(check, plan_.stops));
        break;
      }
    }
    return !arrivals_matter() || seek_likely_stops(regions);
  }

  bool arrivals_matter() const { return !problem_.arrival_covariance.isZero(0); }

  bool seek_likely_stops(std::vector<BaseRegion>& regions) {
    const StageClock clock(plan_, "arrivals");
    seek_likely_poses(problem_, *evaluator_, plan_.grid, regions, plan_.stops, kRequiredRate, monitor_);
    const RobustnessResult check = check_robustness(problem_, *evaluator_, plan_.grid, plan_.stops, regions, monitor_);
    plan_.robustness_rate = check.rate();
    return !check.stopped;
  }

  /// Counts how many arrivals each stop serves, in its final place.
  bool count_stop_arrivals() {
    if (!arrivals_matter()) return true;
    const StageClock clock(plan_, "arrivals");
    const StopSamples seen =
        count_arrivals(problem_, *evaluator_, plan_.stops, problem_.options.robustness_samples, true, monitor_);
    for (std::size_t i = 0; i < plan_.stops.size(); ++i) {
      plan_.stops[i].arrivals = seen.stops[i].samples;
      plan_.stops[i].arrivals_served = seen.stops[i].good;
    }
    if (seen.stopped) plan_.outcome = Outcome::stopped;
    return !seen.stopped;
  }

  bool solve_stops(const std::vector<BaseRegion>& regions) {
    const StageClock clock(plan_, "intersections and stops");
    StopOptions options;
    options.min_radius = problem_.options.positioning_uncertainty;
    options.route_length = [this](const std::vector<Stop>& stops) {
      return straight_route_length(stops, problem_.start.head<2>(), problem_.goal.head<2>());
    };
    StopSet set = plan_stops_exact(plan_.grid, regions, options, monitor_);
    plan_.stops = std::move(set.stops);
    plan_.lower_bound = set.lower_bound;
    plan_.proven_minimal = set.outcome == Outcome::solved;
    unreachable_ = std::move(set.unreachable_trays);
    if (set.outcome == Outcome::timeout) plan_.outcome = Outcome::timeout;
    plan_.intersections =
        plan_intersections(plan_.grid, regions, options.min_radius, std::move(set.candidates), plan_.stops);
    return set.outcome == Outcome::solved || set.outcome == Outcome::approximate;
  }

  void explain_unreachable() {
    for (TrayId tray : unreachable_) {
      plan_.obstructions.push_back(
          explain_region(problem_, database_, *evaluator_, plan_.grid, tray, plan_.regions[tray], plan_.obstructions));
      if (grasp_is_impossible(problem_, *evaluator_, tray)) plan_.outcome = Outcome::infeasible;
    }
  }

  bool obstructed(Obstruction obstruction) {
    plan_.obstructions.push_back(std::move(obstruction));
    return false;
  }

  /// When no motion is found at a stop, other stops are sought without the base poses that failed, as long as they are
  /// no more: the proof is that of the regions. What is reported in the end is why the first ones failed.
  bool plan_picks_and_route_somewhere() {
    PartSupplyPlan first;
    std::vector<BaseRegion> left;
    for (int round = 0;; ++round) {
      failed_.clear();
      if (plan_picks_and_route()) {
        if (round > 0) measure_in_regions(std::move(first.intersections));
        return true;
      }
      if (round == 0) {
        first = plan_;
        left = plan_.regions;
      }
      if (failed_.empty() || monitor_.stopped() || round + 1 == kMotionRounds) break;
      for (const FailedPick& failed : failed_) close_cell(failed, left);
      start_again(first);
      if (!find_stops(left) || plan_.stops.size() > first.stops.size()) break;
      plan_.lower_bound = first.lower_bound;
      plan_.proven_minimal = first.proven_minimal;
    }
    plan_ = std::move(first);
    if (unpicked_) explain_picks(*unpicked_);
    return false;
  }

  /// Stops that were sought with base poses closed are described in the regions as they are, closed poses included.
  void measure_in_regions(Intersections candidates) {
    for (Stop& stop : plan_.stops) stop.radius = room_around(plan_.grid, plan_.regions, stop);
    plan_.intersections = plan_intersections(plan_.grid, plan_.regions, problem_.options.positioning_uncertainty,
                                             std::move(candidates), plan_.stops);
  }

  void start_again(const PartSupplyPlan& first) {
    plan_.picks.clear();
    plan_.route.clear();
    plan_.unloadings.clear();
    plan_.obstructions.clear();
    plan_.outcome = first.outcome;
  }

  /// Takes the cell of a base pose from the region of the tray whose pick found no motion there.
  void close_cell(const FailedPick& failed, std::vector<BaseRegion>& regions) const {
    const BaseGrid& grid = plan_.grid;
    const Eigen::Vector2d cell = (failed.pose.head<2>() - grid.origin) / grid.resolution;
    const int ix = static_cast<int>(std::floor(cell.x())), iy = static_cast<int>(std::floor(cell.y()));
    for (int layer = 0; layer < static_cast<int>(grid.headings.size()); ++layer) {
      if (std::abs(wrap_angle(grid.headings[layer] - failed.pose.z())) < kSameHeading)
        regions[failed.tray].cells[grid.index(layer, ix, iy)] = 0;
    }
  }

  bool plan_picks_and_route() {
    BaseRoutes routes(problem_, monitor_);
    if (!put_stops_in_order(routes)) return false;
    std::set<PartRef> picked;
    for (int stop = 0; stop < static_cast<int>(plan_.stops.size()); ++stop) {
      if (!plan_picks_at_stop(stop, routes, picked)) return false;
    }
    join_picks();
    return plan_unloadings(routes) && plan_legs(routes);
  }

  bool put_stops_in_order(BaseRoutes& routes) {
    const StageClock clock(plan_, "route");
    const VisitingOrder visiting = order_stops(problem_, plan_.stops, routes);
    const std::vector<int>& order = visiting.stops;
    if (monitor_.stopped()) return false;
    if (order.size() != plan_.stops.size() || (order.empty() && !goal_is_reached(routes)))
      return obstructed_route(routes, visiting.from, visiting.unreachable);
    std::vector<Stop> ordered;
    for (int stop : order) ordered.push_back(plan_.stops[stop]);
    plan_.stops = std::move(ordered);
    return true;
  }

  bool goal_is_reached(BaseRoutes& routes) {
    return routes.between(problem_.start, problem_.goal).outcome == Outcome::solved;
  }

  std::string first_tray(int stop) const { return plan_.regions[plan_.stops[stop].trays.front()].tray; }

  /// No drive leads from a stop, by its index, or the start (-1), to another, or to the goal (-1).
  bool obstructed_route(BaseRoutes& routes, int last_stop, int stop) {
    const Eigen::Vector3d from = last_stop < 0 ? problem_.start : plan_.stops[last_stop].pose;
    const Eigen::Vector3d to = stop < 0 ? problem_.goal : plan_.stops[stop].pose;
    const std::string tray = stop < 0 ? "" : first_tray(stop);
    const BasePath searched = routes.between(from, to);
    if (searched.outcome == Outcome::timeout) plan_.outcome = Outcome::timeout;
    return obstructed(explain_route(from, last_stop >= 0, to, tray, searched, smaller_clearance(from, to)));
  }

  /// The first of a half of the drives' clearance, a quarter, ... in whole millimetres, with which this drive and an
  /// order of the stops are found; 0: without any, negative: not even so, or none was asked for.
  double smaller_clearance(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    PartSupplyProblem smaller = problem_;
    while (smaller.drive_clearance > 0 && !monitor_.stopped()) {
      const double half = std::floor(500 * smaller.drive_clearance) / 1000;
      smaller.drive_clearance = half < kLeastClearance ? 0 : half;
      BaseRoutes routes(smaller, monitor_);
      const bool is_there = routes.between(from, to).outcome == Outcome::solved;
      if (is_there && order_stops(smaller, plan_.stops, routes).stops.size() == plan_.stops.size())
        return smaller.drive_clearance;
    }
    return -1;
  }

  std::vector<PartRef> remaining(const std::set<PartRef>& picked) const {
    std::vector<PartRef> left;
    for (const PartRef& part : all_parts(problem_)) {
      if (!picked.count(part)) left.push_back(part);
    }
    return left;
  }

  /// Why picks failed. What helps the first is tried for the others, too; all that might would take too long.
  void explain_picks(const UnpickedStop& stop) {
    std::vector<std::string> known;
    for (const Pick& pick : stop.failed) {
      const bool first = &pick == &stop.failed.front();
      std::vector<std::string> remedies;
      if (pick.failed_at == kHeldDriveStage) {
        obstructed(explain_held_drive(problem_, stop.pose, pick.part, held_drives_.found(stop.pose, pick.part)));
        continue;
      }
      if (first || !known.empty())
        remedies = pick_remedies(problem_, database_, stop.pose, pick.part, stop.left, known, monitor_);
      obstructed(explain_motion(problem_, stop.pose, pick, remedies));
      if (first) known = std::move(remedies);
    }
  }

  /// Plans the picks at one stop; when some motion fails there, at other base poses of the same region.
  bool plan_picks_at_stop(int index, BaseRoutes& routes, std::set<PartRef>& picked) {
    const StageClock clock(plan_, "picks");
    Stop& stop = plan_.stops[index];
    const std::vector<PartRef> left = remaining(picked);
    StopPicks found = stop_picks(problem_, database_, stop.pose, stop.trays, left, monitor_, held_drive_);
    std::vector<FailedPick> failed;
    const auto note = [&](const StopPicks& picks, const Eigen::Vector3d& pose) {
      for (const Pick& pick : picks.picks) failed.push_back({pose, pick.part.tray});
    };
    const auto lacks_drive = [](const StopPicks& picks) {  // which other base poses near by would lack, too
      return std::any_of(picks.picks.begin(), picks.picks.end(),
                         [](const Pick& pick) { return pick.failed_at == kHeldDriveStage; });
    };
    if (found.outcome == Outcome::not_found && lacks_drive(found)) {
      if (!unpicked_) unpicked_ = {found.picks, stop.pose, left};
      return false;
    }
    if (found.outcome == Outcome::not_found) {
      const StopPicks first = found;
      note(first, stop.pose);
      for (const Stop& other :
           alternative_base_poses(plan_.grid, plan_.regions, stop, problem_.options.positioning_uncertainty,
                                  2 * plan_.grid.resolution, kAlternatives)) {
        if (routes.between(problem_.start, other.pose).outcome != Outcome::solved) continue;
        found = stop_picks(problem_, database_, other.pose, other.trays, left, monitor_, held_drive_);
        if (found.outcome == Outcome::not_found) note(found, other.pose);
        if (found.outcome == Outcome::solved && !still_robust(other)) found.outcome = Outcome::not_found;
        if (found.outcome == Outcome::solved) stop = other;
        if (found.outcome != Outcome::not_found) break;
      }
      if (found.outcome == Outcome::not_found) {
        if (!unpicked_) unpicked_ = {first.picks, stop.pose, left};
        failed_ = std::move(failed);
        return false;
      }
    }
    if (found.outcome != Outcome::solved) return false;
    for (Pick& pick : found.picks) {
      pick.stop = index;
      picked.insert(pick.part);
      plan_.picks.push_back(std::move(pick));
    }
    return true;
  }

  /// Joints without limits may return home some turns further: the next pick starts there.
  void join_picks() {
    Eigen::VectorXd at = problem_.home;
    for (Pick& pick : plan_.picks) at = join_motions(problem_.arm.wraps(), at, pick.motions);
  }

  bool still_robust(const Stop& stop) {
    std::vector<BaseRegion> scratch = plan_.regions;
    const RobustnessResult check = check_robustness(problem_, *evaluator_, plan_.grid, {stop}, scratch, monitor_);
    if (check.stopped || check.rate() < kRequiredRate) return false;
    plan_.robustness_rate = std::min(plan_.robustness_rate, check.rate());
    return true;
  }

  /// The drive to the goal from the stop of a pick, with its part in the hand where there is no bin.
  BasePath drive_to_goal(const Pick& pick, BaseRoutes& routes) {
    const Eigen::Vector3d& pose = plan_.stops[pick.stop].pose;
    return problem_.unload_region ? held_drives_.found(pose, pick.part) : routes.between(pose, problem_.goal);
  }

  /// Trips to the goal each time that the bin is full, or one part in the hand, but for the last one, which ends the
  /// route.
  bool plan_unloadings(BaseRoutes& routes) {
    const StageClock clock(plan_, "route");
    const int capacity = problem_.unload_region ? 1 : problem_.place_region.capacity;
    int inside = 0;
    for (int i = 0; i + 1 < static_cast<int>(plan_.picks.size()); ++i) {
      if (++inside != capacity) continue;
      inside = 0;
      const int stop = plan_.picks[i].stop;
      const Eigen::Vector3d& pose = plan_.stops[stop].pose;
      Unloading unloading{i, drive_to_goal(plan_.picks[i], routes), {}};
      const bool returns = plan_.picks[i + 1].stop == stop;
      if (returns) unloading.back = routes.between(problem_.goal, pose);  // the same drive the other way
      if (monitor_.stopped()) return false;
      if (unloading.to_goal.outcome != Outcome::solved) return obstructed_route(routes, stop, -1);
      plan_.unloadings.push_back(std::move(unloading));
    }
    return true;
  }

  /// Where the base is when all parts of a stop are picked.
  Eigen::Vector3d left_from(int stop) const {
    for (const Unloading& unloading : plan_.unloadings) {
      if (plan_.picks[unloading.after_pick].stop == stop && unloading.back.poses.empty()) return problem_.goal;
    }
    return plan_.stops[stop].pose;
  }

  bool plan_legs(BaseRoutes& routes) {
    const StageClock clock(plan_, "route");
    std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> legs;
    Eigen::Vector3d at = problem_.start;
    for (int stop = 0; stop < static_cast<int>(plan_.stops.size()); ++stop) {
      legs.emplace_back(at, plan_.stops[stop].pose);
      at = left_from(stop);
    }
    legs.emplace_back(at, problem_.goal);
    const bool holds = problem_.unload_region && !plan_.picks.empty();  // then the last drive is planned already
    routes.prepare({legs.begin(), legs.end() - (holds ? 1 : 0)});
    for (std::size_t i = 0; i < legs.size(); ++i) {
      const bool is_last = i + 1 == legs.size() && !plan_.picks.empty();
      BasePath path =
          is_last ? drive_to_goal(plan_.picks.back(), routes) : routes.between(legs[i].first, legs[i].second);
      if (monitor_.stopped()) return false;
      if (path.outcome != Outcome::solved)
        return obstructed_route(routes, static_cast<int>(i) - 1, i < plan_.stops.size() ? static_cast<int>(i) : -1);
      plan_.route.push_back(std::move(path));
    }
    return true;
  }

  const PartSupplyProblem& problem_;
  const ReachDatabase& database_;
  const Monitor& monitor_;
  HeldDrives held_drives_;
  HeldDrive held_drive_;  ///< Empty where the robot has a bin.
  PartSupplyPlan plan_;
  std::optional<BasePoseEvaluator> evaluator_;  // with all parts in place; built once
  std::vector<TrayId> unreachable_;
  std::vector<FailedPick> failed_;
  std::optional<UnpickedStop> unpicked_;  ///< The first: what is reported when no other stops do better.
};

}  // namespace
}  // namespace mmgrasp::detail

namespace mmgrasp {

PartSupplyPlan plan_part_supply(const PartSupplyProblem& problem, const ReachDatabase& database,
                                const Monitor& monitor) {
  return detail::PartSupply(problem, database, monitor).run();
}

}  // namespace mmgrasp
