#include "mmgrasp/task/visiting_order.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/optim/tour.hpp"
#include "task/base_sequence/base_routes.hpp"

namespace mmgrasp {
namespace detail {
namespace {

constexpr std::size_t kPlannedStops = 6;

/// Two places to drive between, by their indices: the stops, then start and goal.
using Leg = std::pair<int, int>;

/// Orders stops by the lengths of drives, which are planned for few stops and estimated for many.
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
      std::vector<Leg> all;
      for (int i = 0; i < n_ + 2; ++i) {
        for (int j = i + 1; j < n_ + 2; ++j) all.emplace_back(i, j);
      }
      lengths_ = Eigen::MatrixXd::Zero(n_ + 2, n_ + 2);
      plan(all);
      order = shortest_visiting_tour(lengths_).order;
    } else {
      order = order_by_estimates();
    }
    if (!order.empty() || n_ == 0) return {order};
    return missing_drive();
  }

 private:
  /// A drive that was not found, from the start if there is one.
  VisitingOrder missing_drive() const {
    VisitingOrder none;
    if (lengths_.rows() != n_ + 2) return none;
    for (int i = n_ - 1; i >= -1; --i) {
      for (int j = n_ + 1; j >= 0; --j) {
        const int from = i < 0 ? n_ : i;
        if (from == j || j == n_ || std::isfinite(lengths_(from, j))) continue;
        if (i < 0 && j == n_ + 1 && n_ > 0) continue;  // no order drives from start to goal at once
        none.from = i;
        none.unreachable = j == n_ + 1 ? -1 : j;
      }
    }
    return none;
  }

  /// Replaces lengths by those of planned drives.
  void plan(const std::vector<Leg>& legs) {
    std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> drives;
    for (const auto& [i, j] : legs) drives.emplace_back(place(i), place(j));
    routes_.prepare(drives);
    for (const auto& [i, j] : legs) {
      const BasePath path = routes_.between(place(i), place(j));
      planned_.insert(std::minmax(i, j));
      lengths_(i, j) = lengths_(j, i) = path.outcome == Outcome::solved ? path.length : kInfinity;
    }
  }

  std::vector<int> order_by_estimates() {
    lengths_ = routes_.estimates(places_);
    if (lengths_.rows() != n_ + 2) return {};
    // Drives out of narrow places, where the search of the floor finds no way, are planned at once; those from the
    // start first, since without them there is no order.
    plan(unreached_from(n_));
    if (!lengths_.row(n_).allFinite()) return {};
    for (int i = 0; i < n_ + 2; ++i) plan(unreached_from(i));
    while (true) {  // Ends: each round plans at least one drive that was not planned before.
      const std::vector<int> order = shortest_visiting_tour(lengths_).order;
      if (order.empty()) return {};
      std::vector<Leg> legs;
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

  std::vector<Leg> unreached_from(int from) const {
    std::vector<Leg> pairs;
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
  std::set<Leg> planned_;
};

}  // namespace

VisitingOrder order_stops(const PartSupplyProblem& problem, const std::vector<Stop>& stops, BaseRoutes& routes) {
  return StopOrdering(problem, stops, routes).run();
}

}  // namespace detail

VisitingOrder order_stops(const PartSupplyProblem& problem, const std::vector<Stop>& stops, const Monitor& monitor) {
  detail::BaseRoutes routes(problem, monitor);
  return detail::order_stops(problem, stops, routes);
}

}  // namespace mmgrasp
