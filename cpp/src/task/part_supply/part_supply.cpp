#include "mmgrasp/task/part_supply.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/optim/tour.hpp"
#include "task/base_sequence/visiting_order.hpp"
#include "task/part_supply/obstructions.hpp"
#include "task/part_supply/other_places.hpp"
#include "task/part_supply/stop_robustness.hpp"
#include "task/pick/joined_motions.hpp"
#include "task/pick/stop_picks.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp {
namespace {

constexpr int kRobustnessRounds = 5;
constexpr double kRequiredRate = 0.999;  // Share of sampled base poses that must work in the end.
constexpr std::size_t kOtherPlaces = 4;
constexpr std::size_t kNamedContacts = 3;
constexpr std::size_t kListedSets = 2000;

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
  detail::Stopwatch stopwatch_;
};

std::string text(const Eigen::Vector3d& pose) {
  std::ostringstream out;
  out.precision(6);
  out << "(" << pose.x() << ", " << pose.y() << ", " << pose.z() << ")";
  return out.str();
}

/// Start, goal and home must be sound before anything is planned.
void check_ends(const PartSupplyProblem& problem) {
  CollisionChecker checker(problem.arm, world_with_parts(problem, all_parts(problem)));
  for (const auto& [name, pose] : {std::pair{"start", problem.start}, std::pair{"goal", problem.goal}}) {
    checker.set_root(pose_from_planar(pose));
    if (checker.is_free(problem.home)) continue;
    std::string pairs;
    bool self = false;
    std::size_t named = 0;
    for (const Contact& contact : checker.contacts(problem.home)) {
      if (named++ >= kNamedContacts) break;
      pairs += (pairs.empty() ? "'" : ", '") + contact.a + "' touches '" + contact.b + "'";
      self = self || !contact.with_scene;
    }
    if (self) throw InvalidInput("home: " + pairs + "; the robot must be free of self-collision at home");
    throw InvalidInput(std::string(name) + " = " + text(pose) + ": " + pairs +
                       "; the robot at home must be free there");
  }
}

class PartSupply {
 public:
  PartSupply(const PartSupplyProblem& problem, const ReachDatabase& database, const Monitor& monitor)
      : problem_(problem), database_(database), monitor_(monitor) {}

  PartSupplyPlan run() {
    problem_.check();
    check_ends(problem_);
    if (!find_regions() || !find_stops() || !plan_picks_and_route()) {
      if (monitor_.stopped()) {
        plan_.outcome = Outcome::stopped;
        plan_.obstructions.clear();
      }
      return std::move(plan_);
    }
    plan_.outcome = Outcome::solved;
    return std::move(plan_);
  }

 private:
  bool find_regions() {
    const StageClock clock(plan_, "base regions");
    plan_.grid = make_base_grid(problem_, database_);
    std::vector<BaseRegion> regions = compute_base_regions(problem_, database_, plan_.grid, monitor_);
    if (monitor_.stopped()) return false;
    for (int tray = 0; tray < static_cast<int>(regions.size()); ++tray) {
      if (regions[tray].explanations.empty()) continue;  // nothing to pick
      plan_.regions.push_back(std::move(regions[tray]));
      plan_.region_trays.push_back(tray);
    }
    return true;
  }

  bool find_stops() {
    BasePoseEvaluator evaluator(problem_, database_);
    for (int round = 0;; ++round) {
      if (!solve_stops()) {
        explain_unreachable(evaluator);
        return false;
      }
      const StageClock clock(plan_, "robustness");
      const RobustnessResult check =
          check_robustness(problem_, evaluator, plan_.grid, plan_.stops, plan_.region_trays, plan_.regions, monitor_);
      if (check.stopped) return false;
      plan_.robustness_rate = check.rate();
      if (check.cells_removed == 0 || round + 1 == kRobustnessRounds) {
        return check.rate() >= kRequiredRate || not_robust(check);
      }
    }
  }

  bool solve_stops() {
    const StageClock clock(plan_, "intersections and stops");
    StopOptions options;
    options.min_radius = problem_.options.positioning_uncertainty;
    options.route_length = [this](const std::vector<Stop>& stops) { return straight_route(stops); };
    StopSet set = least_stops(plan_.grid, plan_.regions, options, monitor_);
    plan_.stops = std::move(set.stops);
    plan_.lower_bound = set.lower_bound;
    plan_.proven_minimal = set.outcome == Outcome::solved;
    unreachable_ = std::move(set.unreachable_trays);
    list_intersections(std::move(set.candidates));
    return set.outcome == Outcome::solved || set.outcome == Outcome::approximate;
  }

  /// For the reader of the plan: every robust set of trays when there are not too many, else those that matter.
  void list_intersections(Intersections candidates) {
    plan_.intersections =
        robust_intersections(plan_.grid, plan_.regions, problem_.options.positioning_uncertainty, kListedSets);
    if (!plan_.intersections.complete) plan_.intersections = std::move(candidates);
    std::vector<Intersection>& robust = plan_.intersections.robust;
    for (Stop& stop : plan_.stops) {
      const auto same = std::find_if(robust.begin(), robust.end(), [&](const Intersection& some) {
        return some.trays == stop.trays && std::abs(heading_of(some) - stop.pose.z()) < 1e-12;
      });
      stop.intersection = static_cast<int>(same - robust.begin());
      if (same == robust.end()) robust.push_back(intersection_of(stop));
    }
  }

  double heading_of(const Intersection& some) const { return plan_.grid.headings[some.heading]; }

  Intersection intersection_of(const Stop& stop) const {
    Intersection own;
    own.trays = stop.trays;
    own.centre = stop.pose.head<2>();
    own.radius = stop.radius;
    while (heading_of(own) != stop.pose.z()) ++own.heading;
    for (std::size_t cell = 0; cell < static_cast<std::size_t>(plan_.grid.cells_per_layer()); ++cell) {
      const std::size_t at = plan_.grid.index(own.heading, 0, 0) + cell;
      own.cells +=
          std::all_of(own.trays.begin(), own.trays.end(), [&](int tray) { return plan_.regions[tray].cells[at] != 0; });
    }
    return own;
  }

  /// From start to goal over all stops as the crow flies: enough to choose among equally good sequences.
  double straight_route(const std::vector<Stop>& stops) const {
    std::vector<Eigen::Vector2d> places;
    for (const Stop& stop : stops) places.emplace_back(stop.pose.head<2>());
    places.emplace_back(problem_.start.head<2>());
    places.emplace_back(problem_.goal.head<2>());
    const auto n = static_cast<Eigen::Index>(places.size());
    const Eigen::MatrixXd lengths = Eigen::MatrixXd::NullaryExpr(
        n, n, [&](Eigen::Index i, Eigen::Index j) { return (places[i] - places[j]).norm(); });
    return shortest_visiting_tour(lengths).length;
  }

  void explain_unreachable(BasePoseEvaluator& evaluator) {
    for (int region : unreachable_) {
      plan_.obstructions.push_back(explain_region(problem_, database_, evaluator, plan_.grid,
                                                  plan_.region_trays[region], plan_.regions[region],
                                                  plan_.obstructions));
    }
  }

  bool not_robust(const RobustnessResult& check) {
    Obstruction obstruction;
    obstruction.stage = "robustness";
    obstruction.part = check.worst_part;
    std::ostringstream message;
    message << "only " << check.good << " of " << check.samples
            << " base poses drawn in the uncertainty discs reach every part (worst: '" << check.worst_part
            << "'): use a finer grid.resolution or a smaller positioning_uncertainty";
    obstruction.message = message.str();
    plan_.obstructions.push_back(obstruction);
    return false;
  }

  bool plan_picks_and_route() {
    BaseRoutes routes(problem_, monitor_);
    if (!order_stops(routes)) return false;
    std::set<std::pair<int, int>> gone;
    for (int stop = 0; stop < static_cast<int>(plan_.stops.size()); ++stop) {
      if (!picks_at(stop, routes, gone)) return false;
    }
    join_picks();
    return plan_legs(routes);
  }

  bool order_stops(BaseRoutes& routes) {
    const StageClock clock(plan_, "route");
    const VisitingOrder visiting = mmgrasp::order_stops(problem_, plan_.stops, routes);
    const std::vector<int>& order = visiting.stops;
    if (monitor_.stopped()) return false;
    if (order.size() != plan_.stops.size() || (order.empty() && !no_stops_route(routes)))
      return no_route(visiting.unreachable);
    std::vector<Stop> ordered;
    for (int stop : order) ordered.push_back(plan_.stops[stop]);
    plan_.stops = std::move(ordered);
    return true;
  }

  bool no_stops_route(BaseRoutes& routes) {
    return routes.between(problem_.start, problem_.goal).outcome == Outcome::solved;
  }

  bool no_route(int stop) {
    Obstruction obstruction;
    obstruction.stage = "route";
    const Eigen::Vector3d pose = stop >= 0 ? plan_.stops[stop].pose : problem_.goal;
    if (stop >= 0) obstruction.tray = plan_.regions[plan_.stops[stop].trays.front()].tray;
    obstruction.message = std::string("no drive from the start leads to ") +
                          (stop >= 0 ? "the stop at " : "the goal at ") + text(pose) +
                          " with the arm at home: widen the way, choose a narrower home, or a finer route_resolution";
    plan_.obstructions.push_back(obstruction);
    return false;
  }

  std::vector<std::pair<int, int>> remaining(const std::set<std::pair<int, int>>& gone) const {
    std::vector<std::pair<int, int>> left;
    for (const auto& id : all_parts(problem_)) {
      if (!gone.count(id)) left.push_back(id);
    }
    return left;
  }

  /// Picks at one stop; when some motion fails there, at other places of the same region.
  bool picks_at(int index, BaseRoutes& routes, std::set<std::pair<int, int>>& gone) {
    const StageClock clock(plan_, "picks");
    Stop& stop = plan_.stops[index];
    std::vector<int> trays;
    for (int region : stop.trays) trays.push_back(plan_.region_trays[region]);
    StopPicks found = plan_stop_picks(problem_, database_, stop.pose, trays, remaining(gone), monitor_);
    if (found.outcome == Outcome::infeasible) {
      const StopPicks first = found;
      for (const Stop& place : other_places(plan_.grid, plan_.regions, stop, problem_.options.positioning_uncertainty,
                                            2 * plan_.grid.resolution, kOtherPlaces)) {
        if (routes.between(problem_.start, place.pose).outcome != Outcome::solved) continue;
        found = plan_stop_picks(problem_, database_, place.pose, trays, remaining(gone), monitor_);
        if (found.outcome == Outcome::solved && !still_robust(place)) found.outcome = Outcome::infeasible;
        if (found.outcome == Outcome::solved) stop = place;
        if (found.outcome != Outcome::infeasible) break;
      }
      if (found.outcome == Outcome::infeasible) return no_motion(stop, first);
    }
    if (found.outcome != Outcome::solved) return false;
    for (Pick& pick : found.picks) {
      pick.stop = index;
      gone.insert({pick.tray, pick.part});
      plan_.picks.push_back(std::move(pick));
    }
    return true;
  }

  /// Joints without limits may come home some turns further: the next pick goes on from there.
  void join_picks() {
    Eigen::VectorXd at = problem_.home;
    for (Pick& pick : plan_.picks) at = join_motions(problem_.arm.wraps(), at, pick.motions);
  }

  bool still_robust(const Stop& place) {
    const BasePoseEvaluator evaluator(problem_, database_);
    std::vector<BaseRegion> scratch = plan_.regions;
    const RobustnessResult check =
        check_robustness(problem_, evaluator, plan_.grid, {place}, plan_.region_trays, scratch, monitor_);
    if (check.stopped || check.rate() < kRequiredRate) return false;
    plan_.robustness_rate = std::min(plan_.robustness_rate, check.rate());
    return true;
  }

  bool no_motion(const Stop& stop, const StopPicks& failed) {
    for (const Pick& pick : failed.picks) {
      Obstruction obstruction;
      const Part& part = part_of(problem_, pick.tray, pick.part);
      obstruction.tray = problem_.trays[pick.tray].name;
      obstruction.part = part.name;
      obstruction.stage = "motion";
      obstruction.message = "part '" + part.name + "' can be grasped from the stop at " + text(stop.pose) +
                            ", but no arm motion was found: most candidates fell at '" + pick.failed_at + "' (" +
                            pick.rejections.summary() + "): " + motion_advice(pick.failed_at);
      plan_.obstructions.push_back(obstruction);
    }
    return false;
  }

  static std::string motion_advice(const std::string& stage) {
    if (stage == "approach") return "shorten approach_distance or make room in front of the part";
    if (stage == "lift") return "lower lift_height or make room above the part";
    if (stage == "release") return "move the bin (carry) to where the arm can hold a part level over it";
    if (stage == "close") return "leave room for the fingers beside the part";
    return "raise motion_time_limit, or choose another home configuration";
  }

  bool plan_legs(BaseRoutes& routes) {
    const StageClock clock(plan_, "route");
    std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> legs;
    Eigen::Vector3d at = problem_.start;
    for (const Stop& stop : plan_.stops) {
      legs.emplace_back(at, stop.pose);
      at = stop.pose;
    }
    legs.emplace_back(at, problem_.goal);
    routes.prepare(legs);
    for (std::size_t i = 0; i < legs.size(); ++i) {
      BasePath path = routes.between(legs[i].first, legs[i].second);
      if (monitor_.stopped()) return false;
      if (path.outcome != Outcome::solved) return no_route(i < plan_.stops.size() ? static_cast<int>(i) : -1);
      plan_.route.push_back(std::move(path));
    }
    return true;
  }

  const PartSupplyProblem& problem_;
  const ReachDatabase& database_;
  const Monitor& monitor_;
  PartSupplyPlan plan_;
  std::vector<int> unreachable_;
};

}  // namespace

PartSupplyPlan plan_part_supply(const PartSupplyProblem& problem, const ReachDatabase& database,
                                const Monitor& monitor) {
  return PartSupply(problem, database, monitor).run();
}

}  // namespace mmgrasp
