#include "mmgrasp/task/platform_locations.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "task/base_placement/platform_draws.hpp"

namespace mmgrasp {
namespace {

using detail::PlatformEnd;

double travel_of(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a.head<2>() - b.head<2>()).norm();
}

double turn_of(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return std::abs(wrap_angle(a[2] - b[2]));
}

/// One call of plan_platform_locations.
class Search {
 public:
  Search(CollisionChecker& checker, const PlatformLocationsProblem& problem, const PlatformLocationsOptions& options,
         IkSeedDatabase* database, const Monitor& monitor)
      : options_(options),
        database_(database),
        monitor_(monitor),
        pick_(checker, problem.T_world_pick, problem.pick_point, problem.camera, options, 0),
        place_(checker, problem.T_world_place, problem.place_point, problem.camera, options, 1) {}

  PlatformLocations run() {
    Outcome ended = Outcome::not_found;
    for (int round = 1; round <= kRounds && !(best_cost_ <= kZeroCost); ++round) {
      const std::size_t wanted = (options_.samples * round + kRounds - 1) / kRounds;
      if (over(ended) || !fill(pick_, wanted, ended) || !fill(place_, wanted, ended)) break;
      couple();
      monitor_.report("platform locations", static_cast<double>(round) / kRounds);
    }
    return answer(ended);
  }

 private:
  static constexpr int kRounds = 10;
  static constexpr double kZeroCost = 1e-9;
  static constexpr std::size_t kPairs = 4;

  struct Pair {
    double cost;
    Eigen::VectorXd pick, place;
  };

  bool over(Outcome& ended) {
    const double seconds = stopwatch_.seconds();
    if (monitor_.stopped())
      ended = Outcome::stopped;
    else if (seconds > options_.time_limit)
      ended = Outcome::timeout;
    return ended != Outcome::not_found;
  }

  /// Draws until `wanted` valid configurations are found; false when the budget ended before the first.
  bool fill(PlatformEnd& end, std::size_t wanted, Outcome& ended) {
    while (end.found.size() < wanted && end.counts.draws < static_cast<std::size_t>(options_.max_draws)) {
      if (over(ended)) break;
      if (end.draw(database_) && database_) database_->add(end.found.back());
    }
    return !end.found.empty() && ended != Outcome::stopped;
  }

  double cost(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    return travel_of(a, b) + options_.turn_weight * turn_of(a, b);
  }

  void offer(const Eigen::VectorXd& pick, const Eigen::VectorXd& place) {
    const double value = cost(pick, place);
    if (value >= best_cost_) return;
    pairs_.push_back({value, pick, place});
    best_cost_ = value;
  }

  /// Everything new against everything: the cheapest pairs, each end sought from the other's base pose, and the best
  /// drawn together.
  void couple() {
    std::vector<Pair> near;
    for (std::size_t i = 0; i < pick_.found.size(); ++i)
      for (std::size_t j = i < seen_pick_ ? seen_place_ : 0; j < place_.found.size(); ++j)
        near.push_back({cost(pick_.found[i], place_.found[j]), pick_.found[i], place_.found[j]});
    seen_pick_ = pick_.found.size();
    seen_place_ = place_.found.size();
    const std::size_t kept = std::min(near.size(), kPairs);
    std::partial_sort(near.begin(), near.begin() + static_cast<long>(kept), near.end(),
                      [](const Pair& a, const Pair& b) { return a.cost < b.cost; });
    for (std::size_t i = 0; i < kept; ++i) offer(near[i].pick, near[i].place);
    for (std::size_t i = 0; i < kept && best_cost_ > kZeroCost; ++i) {
      Eigen::VectorXd start = near[i].place;
      start.head<3>() = near[i].pick.head<3>();
      if (const auto q = place_.solve(start, true)) offer(near[i].pick, *q);
      start = near[i].pick;
      start.head<3>() = near[i].place.head<3>();
      if (const auto q = pick_.solve(start, true)) offer(*q, near[i].place);
    }
    if (best_cost_ > kZeroCost && kept > 0) draw_together(near[0]);
  }

  void draw_together(Pair pair) {
    constexpr int kTimes = 4;
    for (int i = 0; i < kTimes && best_cost_ > kZeroCost; ++i) {
      const double before = pair.cost;
      pair.pick = pick_.drawn_towards(pair.pick, pair.place.head<3>(), options_.turn_weight);
      pair.place = place_.drawn_towards(pair.place, pair.pick.head<3>(), options_.turn_weight);
      pair.cost = cost(pair.pick, pair.place);
      offer(pair.pick, pair.place);
      if (!(pair.cost < before - 1e-3)) break;
    }
    // What is nearly one stop may be made one.
    Eigen::VectorXd start = pair.place;
    start.head<3>() = pair.pick.head<3>();
    if (const auto q = place_.solve(start, true)) offer(pair.pick, *q);
  }

  PlatformLocations answer(Outcome ended) {
    PlatformLocations result;
    result.pick = pick_.counts;
    result.place = place_.counts;
    result.outcome = ended;
    for (auto pair = pairs_.rbegin(); pair != pairs_.rend(); ++pair) {  // the last is the cheapest
      if (!pick_.confirmed(pair->pick) || !place_.confirmed(pair->place)) continue;
      result.outcome = Outcome::solved;
      result.q_pick = pair->pick;
      result.q_place = pair->place;
      result.travel = travel_of(pair->pick, pair->place);
      result.turn = turn_of(pair->pick, pair->place);
      result.cost = result.travel + options_.turn_weight * result.turn;
      if (database_) {
        database_->add(result.q_pick);
        database_->add(result.q_place);
      }
      break;
    }
    return result;
  }

  const PlatformLocationsOptions& options_;
  IkSeedDatabase* database_;
  const Monitor& monitor_;
  PlatformEnd pick_, place_;
  std::vector<Pair> pairs_;  // each cheaper than the one before
  double best_cost_ = detail::kInfinity;
  std::size_t seen_pick_ = 0, seen_place_ = 0;
  detail::Stopwatch stopwatch_;
};

void check_point(const Eigen::Vector3d& point, const std::string& field) {
  for (int i = 0; i < 3; ++i) require_number(point[i], "platform_locations." + field + "[" + std::to_string(i) + "]");
}

}  // namespace

void PlatformLocationsOptions::check() const {
  require_count(samples, "platform_locations.samples", 1, 1'000'000);
  require_count(max_draws, "platform_locations.max_draws");
  require_not_negative(least_manipulability, "platform_locations.least_manipulability");
  require_not_negative(turn_weight, "platform_locations.turn_weight");
  require(time_limit > 0, "platform_locations.time_limit", time_limit, "must be positive");
}

PlatformLocations plan_platform_locations(CollisionChecker& checker, const PlatformLocationsProblem& problem,
                                          const PlatformLocationsOptions& options, IkSeedDatabase* database,
                                          const Monitor& monitor) {
  options.check();
  const JointGroup& group = checker.group();
  if (!group.has_base())
    throw InvalidInput("group \"" + group.name() + "\": platform locations need a group with base joints");
  checked_pose(problem.T_world_pick.matrix(), "platform_locations.T_world_pick");
  checked_pose(problem.T_world_place.matrix(), "platform_locations.T_world_place");
  check_point(problem.pick_point, "pick_point");
  check_point(problem.place_point, "place_point");
  if (problem.camera) {
    problem.camera->camera.check();
    const int links = static_cast<int>(group.robot().links().size());
    require(problem.camera->link >= 0 && problem.camera->link < links, "platform_locations.camera.link",
            problem.camera->link, "must be the index of a link, below " + std::to_string(links));
    checked_pose(problem.camera->T_link_camera.matrix(), "platform_locations.camera.T_link_camera");
  }
  if (database && database->group().names() != group.names())
    throw InvalidInput("group \"" + group.name() + "\": the seed database is of another group, \"" +
                       database->group().name() + "\"");
  return Search(checker, problem, options, database, monitor).run();
}

}  // namespace mmgrasp
