// plan_stops_exact(): the least number of stops, and the best among equally few.
#include <algorithm>
#include <cmath>
#include <map>

#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/optim/set_cover.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "task/base_sequence/equal_covers.hpp"
#include "task/base_sequence/region_patches.hpp"

namespace mmgrasp {
namespace {

using detail::RegionPatches;

constexpr std::size_t kMaxBoxes = 50'000'000;
constexpr double kRadiusStep = 1e-4;    // [m]: the smallest disc is the largest possible to this.
constexpr double kSumQuantum = 1e-3;    // [m]: radii are added up in whole steps.
constexpr int kLevels = 16;             // Radii at which the other discs' candidates are sought.
constexpr std::size_t kRoutes = 200;    // Equally good sequences whose routes are compared;
constexpr std::size_t kManyStops = 12;  // a tenth of them beyond so many stops, where routes take longer to find.

/// Finds the least number of stops, then breaks ties step by step: smallest disc, sum of radii, route.
class LeastStops {
 public:
  LeastStops(const BaseGrid& grid, const std::vector<BaseRegion>& regions, const StopOptions& options,
             const Monitor& monitor)
      : patches_(grid, regions), options_(options), monitor_(monitor), element_(regions.size(), -1) {
    for (TrayId tray : patches_.trays()) element_[tray] = elements_++;
  }

  StopSet run() {
    StopSet result;
    result.candidates = detail::maximal_intersections(patches_, options_.min_radius, kMaxBoxes, monitor_);
    if (monitor_.stopped()) return stopped(std::move(result));
    const SetCoverResult cover =
        solve_set_cover(cover_problem(result.candidates.robust), options_.time_limit, monitor_);
    result.outcome = cover.outcome;
    for (int element : cover.uncoverable) result.unreachable_trays.push_back(patches_.trays()[element]);
    if (cover.outcome == Outcome::infeasible) {
      if (!result.candidates.complete) result.outcome = Outcome::timeout;
      return result;
    }
    // A search that ended early may have missed places that serve more trays.
    const int one = patches_.trays().empty() ? 0 : 1;
    result.lower_bound = result.candidates.complete ? static_cast<int>(std::lround(cover.lower_bound)) : one;
    best_ = stops_of(result.candidates.robust, cover.chosen);
    time_limit_ = detail::TimeLimit(std::min(options_.tie_time_limit, 1e6));
    if (!best_.empty() && result.candidates.complete) {
      raise_smallest();
      raise_others();
    }
    if (monitor_.stopped()) return stopped(std::move(result));
    result.stops = best_;
    const bool proven = static_cast<int>(best_.size()) <= result.lower_bound;
    result.outcome = proven ? Outcome::solved : Outcome::approximate;
    return result;
  }

 private:
  static StopSet stopped(StopSet result) {
    result.outcome = Outcome::stopped;
    return result;
  }

  double seconds_left() const { return time_limit_.seconds_left(); }
  bool over() const { return monitor_.stopped() || seconds_left() <= 0; }

  SetCoverProblem cover_problem(const std::vector<Intersection>& places) const {
    SetCoverProblem problem;
    problem.elements = elements_;
    for (const Intersection& place : places) {
      problem.sets.emplace_back();
      for (TrayId tray : place.trays) problem.sets.back().push_back(element_[tray]);
    }
    return problem;
  }

  const Intersection& widest(const std::vector<TrayId>& trays) {
    const auto [it, is_new] = widest_.try_emplace(trays);
    if (is_new) it->second = patches_.widest(trays);
    return it->second;
  }

  static double smallest(const std::vector<Stop>& stops) {
    double least = stops.empty() ? 0 : stops.front().radius;
    for (const Stop& stop : stops) least = std::min(least, stop.radius);
    return least;
  }

  static double sum(const std::vector<Stop>& stops) {
    double total = 0;
    for (const Stop& stop : stops) total += stop.radius;
    return total;
  }

  /// Each tray at the first of the chosen places that serve it. A stop never has less room than its place.
  std::vector<Stop> stops_of(const std::vector<Intersection>& places, const std::vector<int>& chosen) {
    std::vector<char> served(element_.size(), 0);
    std::vector<Stop> stops;
    for (const int place : chosen) {
      std::vector<TrayId> trays;
      for (const TrayId tray : places[place].trays) {
        if (!served[tray]) trays.push_back(tray);
        served[tray] = 1;
      }
      if (!trays.empty()) stops.push_back(stop_for(trays, places[place]));
    }
    return stops;
  }

  /// `known` serves these trays as well: it is as wide but for a rounding at most.
  Stop stop_for(const std::vector<TrayId>& trays, const Intersection& known) {
    const Intersection& own = widest(trays);
    const Intersection& place = own.radius >= known.radius ? own : known;
    Stop stop;
    stop.trays = trays;
    stop.radius = place.radius;
    stop.pose = Eigen::Vector3d(place.centre.x(), place.centre.y(), patches_.grid().headings[place.heading]);
    return stop;
  }

  /// Halves the range in which the smallest radius of as few stops can be.
  void raise_smallest() {
    double low = smallest(best_), high = limit_of_smallest();
    while (high - low > kRadiusStep && !over()) {
      const double radius = 0.5 * (low + high);
      const Intersections found = detail::maximal_intersections(patches_, radius, kMaxBoxes, monitor_);
      if (!found.complete) return;
      const SetCoverResult cover =
          solve_set_cover(cover_problem(found.robust), std::max(1e-3, seconds_left()), monitor_);
      const bool as_few = cover.outcome != Outcome::infeasible && cover.chosen.size() <= best_.size();
      if (as_few) {
        best_ = stops_of(found.robust, cover.chosen);
        low = std::max(radius, smallest(best_));
      } else {
        high = radius;
      }
    }
  }

  /// No tray has more room than alone.
  double limit_of_smallest() {
    double least = widest({patches_.trays().front()}).radius;
    for (TrayId tray : patches_.trays()) least = std::min(least, widest({tray}).radius);
    return least;
  }

  /// The largest sum of radii without a smaller smallest one, and of such sequences the shortest route.
  void raise_others() {
    if (over()) return;
    const std::vector<Intersection> places = places_at_levels();
    if (places.empty()) return;
    const SetCoverProblem problem = weighted(places);
    const SetCoverResult cover = solve_set_cover(problem, std::max(1e-3, seconds_left()), monitor_);
    if (cover.chosen.size() != best_.size()) return;
    take_if_better(stops_of(places, cover.chosen));
    if (!options_.route_length || cover.outcome != Outcome::solved) return;
    const std::size_t routes = best_.size() > kManyStops ? kRoutes / 10 : kRoutes;
    double length = options_.route_length(best_);
    for (const std::vector<int>& chosen : detail::equal_covers(problem, cover.cost, best_.size(), routes)) {
      if (over()) return;
      std::vector<Stop> stops = stops_of(places, chosen);
      if (smallest(stops) < smallest(best_) - kRadiusStep ||
          sum(stops) < sum(best_) - kSumQuantum * static_cast<double>(stops.size()))
        continue;
      const double found = options_.route_length(stops);
      if (!(found < length - 1e-9)) continue;
      length = found;
      best_ = std::move(stops);
    }
  }

  void take_if_better(std::vector<Stop> stops) {
    if (smallest(stops) < smallest(best_) - kRadiusStep) return;
    if (sum(stops) > sum(best_)) best_ = std::move(stops);
  }

  /// Maximal intersections for a ladder of radii from the smallest one up.
  std::vector<Intersection> places_at_levels() {
    const double low = smallest(best_) - 1e-9;
    double high = low;
    for (TrayId tray : patches_.trays()) high = std::max(high, widest({tray}).radius);
    const double step = std::max(0.25 * patches_.grid().resolution, (high - low) / kLevels);
    std::map<std::pair<std::vector<TrayId>, int>, Intersection> found;
    for (int level = 0; low + level * step <= high; ++level) {
      Intersections here =
          detail::maximal_intersections(patches_, std::max(0.0, low + level * step), kMaxBoxes, monitor_);
      if (!here.complete || over()) return {};
      for (Intersection& place : here.robust) {
        std::pair<std::vector<TrayId>, int> key{place.trays, place.heading};
        found.emplace(std::move(key), std::move(place));
      }
    }
    std::vector<Intersection> places;
    for (auto& [key, place] : found) places.push_back(std::move(place));
    return places;
  }

  /// Whole-numbered costs: another stop costs more than any loss in radii.
  SetCoverProblem weighted(const std::vector<Intersection>& places) const {
    SetCoverProblem problem = cover_problem(places);
    double largest = 0;
    for (const Intersection& place : places) largest = std::max(largest, place.radius);
    const double stop = std::floor(largest / kSumQuantum) * static_cast<double>(best_.size()) + 1;
    for (const Intersection& place : places)
      problem.costs.push_back(stop + std::floor((largest - place.radius) / kSumQuantum));
    return problem;
  }

  RegionPatches patches_;
  const StopOptions& options_;
  const Monitor& monitor_;
  std::vector<int> element_;  // element of the cover problem, by tray; -1: not to be served
  int elements_ = 0;
  std::map<std::vector<TrayId>, Intersection> widest_;
  std::vector<Stop> best_;
  detail::TimeLimit time_limit_{0};
};

}  // namespace

void StopOptions::check() const {
  require_not_negative(min_radius, "min_radius");
  require(time_limit > 0, "time_limit", time_limit, "must be > 0");
  require(tie_time_limit >= 0, "tie_time_limit", tie_time_limit, "must be 0 or more");
}

StopSet plan_stops_exact(const BaseGrid& grid, const std::vector<BaseRegion>& regions, const StopOptions& options,
                         const Monitor& monitor) {
  options.check();
  return LeastStops(grid, regions, options, monitor).run();
}

}  // namespace mmgrasp
