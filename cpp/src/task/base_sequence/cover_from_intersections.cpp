// cover_from_intersections(): the least number of robust intersections that cover all trays.
#include <algorithm>
#include <cmath>
#include <string>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/optim/set_cover.hpp"
#include "mmgrasp/task/base_sequence.hpp"

namespace mmgrasp {
namespace {

constexpr double kCoverTime = 60;  // [s]

/// Costs that put the number of stops first and large discs second (see SetCoverProblem).
std::vector<double> stop_costs(const std::vector<Intersection>& intersections) {
  double largest = 0;
  for (const Intersection& some : intersections) largest = std::max(largest, some.radius);
  std::vector<double> costs;
  for (const Intersection& some : intersections) {
    const double loss = largest > 0 ? 1 - some.radius / largest : 0;
    costs.push_back(1 + loss / (2.0 * static_cast<double>(intersections.size())));
  }
  return costs;
}

/// Throws InvalidInput unless the trays are ascending, each named once, and there are so many.
void check_trays(const std::vector<TrayId>& named, int trays) {
  for (auto tray = named.begin(); tray != named.end(); ++tray) {
    require(*tray >= 0 && *tray < trays, "intersections.trays", *tray,
            "must be at least 0 and below the number of trays, " + std::to_string(trays));
    if (tray == named.begin() || *(tray - 1) < *tray) continue;
    const bool is_new = std::find(named.begin(), tray, *tray) == tray;
    require(false, "intersections.trays", *tray,
            is_new ? "must be ascending" : "must not be named twice in an intersection");
  }
}

/// Serving fewer trays than the intersection allows, a stop may find a larger disc.
int widest_for(const std::vector<Intersection>& intersections, const std::vector<TrayId>& trays, int chosen) {
  int best = chosen;
  for (int i = 0; i < static_cast<int>(intersections.size()); ++i) {
    const Intersection& some = intersections[i];
    if (some.radius <= intersections[best].radius) continue;
    if (std::includes(some.trays.begin(), some.trays.end(), trays.begin(), trays.end())) best = i;
  }
  return best;
}

}  // namespace

StopSet cover_from_intersections(const BaseGrid& grid, const std::vector<Intersection>& intersections, int trays) {
  require_within(trays, 0, 10000, "trays", "");
  for (const Intersection& some : intersections) {
    check_trays(some.trays, trays);
    require(some.heading >= 0 && some.heading < static_cast<int>(grid.headings.size()), "intersections.heading",
            some.heading, "must be one of the grid's " + std::to_string(grid.headings.size()));
  }
  StopSet result;
  SetCoverProblem problem;
  problem.elements = trays;
  for (const Intersection& some : intersections) problem.sets.emplace_back(some.trays.begin(), some.trays.end());
  problem.costs = stop_costs(intersections);
  Monitor monitor;
  if (const CancelToken* stop = detail::interruption_token()) monitor.stop = *stop;
  const SetCoverResult cover = solve_set_cover(problem, kCoverTime, monitor);
  detail::throw_if_interrupted();
  result.outcome = cover.outcome;
  for (int tray : cover.uncoverable) result.unreachable_trays.emplace_back(tray);
  // All penalties together stay below 1/2.
  result.lower_bound = std::max(0, static_cast<int>(std::ceil(cover.lower_bound - 0.5 - 1e-6)));
  if (cover.outcome != Outcome::solved && cover.outcome != Outcome::approximate) return result;
  if (cover.outcome == Outcome::solved) result.lower_bound = static_cast<int>(cover.chosen.size());

  std::vector<std::vector<TrayId>> served(cover.chosen.size());
  for (TrayId tray(0); tray < trays; tray = TrayId(tray + 1)) {
    int best = -1;
    for (std::size_t c = 0; c < cover.chosen.size(); ++c) {
      const Intersection& some = intersections[cover.chosen[c]];
      if (!std::binary_search(some.trays.begin(), some.trays.end(), tray)) continue;
      if (best < 0 || some.radius > intersections[cover.chosen[best]].radius) best = static_cast<int>(c);
    }
    served[best].push_back(tray);
  }
  for (std::size_t c = 0; c < cover.chosen.size(); ++c) {
    if (served[c].empty()) continue;  // only without a proof: a least cover has no idle set
    Stop stop;
    stop.trays = served[c];
    stop.intersection = widest_for(intersections, stop.trays, cover.chosen[c]);
    const Intersection& place = intersections[stop.intersection];
    stop.radius = place.radius;
    stop.pose = Eigen::Vector3d(place.centre.x(), place.centre.y(), grid.headings[place.heading]);
    result.stops.push_back(stop);
  }
  return result;
}

StopSet cover_from_intersections(const BaseGrid& grid, const Intersections& intersections, int trays) {
  StopSet result = cover_from_intersections(grid, intersections.robust, trays);
  if (!intersections.complete) {
    result.lower_bound = std::min(result.lower_bound, 1);
    if (result.outcome == Outcome::infeasible) result.outcome = Outcome::timeout;
  }
  if (result.outcome == Outcome::solved || result.outcome == Outcome::approximate) {
    const bool proven = static_cast<int>(result.stops.size()) <= result.lower_bound;
    result.outcome = proven ? Outcome::solved : Outcome::approximate;
  }
  return result;
}

}  // namespace mmgrasp
