#include "task/base_sequence/visiting_order.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/optim/tour.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp {
namespace {

constexpr std::size_t kPlannedStops = 6;
constexpr double kPadding = 0.01;  // [m]

std::array<double, 6> key_of(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return {from.x(), from.y(), from.z(), to.x(), to.y(), to.z()};
}

CheckerOptions with_padding(double padding) {
  CheckerOptions options;
  options.padding = padding;
  return options;
}

}  // namespace

BaseRoutes::BaseRoutes(const PartSupplyProblem& problem, const Monitor& monitor)
    : problem_(problem),
      monitor_(monitor),
      padded_(problem.arm, world_with_parts(problem, all_parts(problem)), with_padding(kPadding)),
      bare_(problem.arm, world_with_parts(problem, all_parts(problem))) {}

BasePath BaseRoutes::plan(CollisionChecker& padded, CollisionChecker& bare, const Eigen::Vector3d& from,
                          const Eigen::Vector3d& to) const {
  Monitor quiet;
  quiet.stop = monitor_.stop;
  BaseRouteOptions options;
  options.base = problem_.robot.base();
  options.resolution = problem_.options.route_resolution;
  BasePath path = plan_base_route(padded, problem_.home, from, to, options, quiet);
  if (path.outcome == Outcome::solved || monitor_.stopped()) return path;
  path = plan_base_route(bare, problem_.home, from, to, options, quiet);
  if (path.outcome == Outcome::solved || monitor_.stopped()) return path;
  options.resolution *= 0.5;  // a narrow place may need a finer lattice
  return plan_base_route(bare, problem_.home, from, to, options, quiet);
}

BasePath BaseRoutes::between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  prepare({{from, to}});
  const auto found = known_.find(key_of(from, to));
  return found == known_.end() ? BasePath{} : found->second;
}

void BaseRoutes::prepare(const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& pairs) {
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> open;
  for (const auto& [from, to] : pairs) {
    if (!known_.count(key_of(from, to))) open.emplace_back(from, to);
  }
  std::vector<BasePath> paths(open.size());
  const bool done = parallel_for(
      open.size(), problem_.options.threads,
      [&](std::size_t item, int) {
        CollisionChecker padded = padded_.clone(), bare = bare_.clone();
        paths[item] = plan(padded, bare, open[item].first, open[item].second);
      },
      monitor_, "route");
  if (!done) return;
  for (std::size_t i = 0; i < open.size(); ++i) {
    const auto& [from, to] = open[i];
    BasePath back = paths[i];  // every primitive can be driven the other way
    std::reverse(back.poses.begin(), back.poses.end());
    known_[key_of(from, to)] = std::move(paths[i]);
    known_.emplace(key_of(to, from), std::move(back));
  }
}

Eigen::MatrixXd BaseRoutes::estimates(const std::vector<Eigen::Vector3d>& places) const {
  BaseRouteOptions options;
  options.base = problem_.robot.base();
  options.resolution = problem_.options.route_resolution;
  return route_lengths(bare_, problem_.home, places, options, problem_.options.threads, monitor_);
}

namespace {

class StopOrdering {
 public:
  StopOrdering(const PartSupplyProblem& problem, const std::vector<Stop>& stops, BaseRoutes& routes)
      : routes_(routes), n_(static_cast<int>(stops.size())) {
    for (const Stop& stop : stops) places_.push_back(stop.pose);
    places_.push_back(problem.start);
    places_.push_back(problem.goal);
  }

  VisitingOrder run() {
    std::vector<int> order;
    if (n_ <= static_cast<int>(kPlannedStops)) {
      std::vector<std::pair<int, int>> all;
      for (int i = 0; i < n_ + 2; ++i) {
        for (int j = i + 1; j < n_ + 2; ++j) all.emplace_back(i, j);
      }
      lengths_ = Eigen::MatrixXd::Zero(n_ + 2, n_ + 2);
      plan(all);
      order = shortest_visiting_tour(lengths_).order;
    } else {
      order = by_estimates();
    }
    if (!order.empty() || n_ == 0) return {order};
    VisitingOrder none;
    for (int i = 0; i < n_; ++i) {
      if (lengths_.rows() == n_ + 2 && !std::isfinite(lengths_(n_, i))) none.unreachable = i;
    }
    return none;
  }

 private:
  /// Replaces lengths by those of planned drives.
  void plan(const std::vector<std::pair<int, int>>& pairs) {
    std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> drives;
    for (const auto& [i, j] : pairs) drives.emplace_back(place(i), place(j));
    routes_.prepare(drives);
    for (const auto& [i, j] : pairs) {
      const BasePath path = routes_.between(place(i), place(j));
      planned_.insert(std::minmax(i, j));
      lengths_(i, j) = lengths_(j, i) = path.outcome == Outcome::solved ? path.length : detail::kInfinity;
    }
  }

  std::vector<int> by_estimates() {
    lengths_ = routes_.estimates(places_);
    if (lengths_.rows() != n_ + 2) return {};
    // Narrow places that the search of the floor does not get out of: their drives are planned at once, the ones from
    // the start first, since without them there is no order.
    plan(unreached(n_));
    if (!lengths_.row(n_).allFinite()) return {};
    for (int i = 0; i < n_ + 2; ++i) plan(unreached(i));
    while (true) {  // Each round plans a drive at least that was not planned before.
      const std::vector<int> order = shortest_visiting_tour(lengths_).order;
      if (order.empty()) return {};
      std::vector<std::pair<int, int>> legs;
      int at = n_;
      for (std::size_t i = 0; i <= order.size(); ++i) {
        const int to = i < order.size() ? order[i] : n_ + 1;
        if (planned_.count(std::minmax(at, to)) == 0) legs.emplace_back(at, to);
        at = to;
      }
      if (legs.empty()) return order;
      plan(legs);
    }
  }

  std::vector<std::pair<int, int>> unreached(int from) const {
    std::vector<std::pair<int, int>> pairs;
    for (int to = 0; to < n_ + 2; ++to) {
      if (!std::isfinite(lengths_(from, to)) && planned_.count(std::minmax(from, to)) == 0)
        pairs.emplace_back(from, to);
    }
    return pairs;
  }

  const Eigen::Vector3d& place(int i) const { return places_[i]; }

  BaseRoutes& routes_;
  int n_;
  std::vector<Eigen::Vector3d> places_;
  Eigen::MatrixXd lengths_;
  std::set<std::pair<int, int>> planned_;
};

}  // namespace

VisitingOrder order_stops(const PartSupplyProblem& problem, const std::vector<Stop>& stops, BaseRoutes& routes) {
  return StopOrdering(problem, stops, routes).run();
}

VisitingOrder order_stops(const PartSupplyProblem& problem, const std::vector<Stop>& stops, const Monitor& monitor) {
  BaseRoutes routes(problem, monitor);
  return order_stops(problem, stops, routes);
}

}  // namespace mmgrasp
