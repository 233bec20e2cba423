#include "mmgrasp/optim/shared_tours.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/optim/tour.hpp"

namespace mmgrasp {
namespace {

constexpr int kExactStops = 12;
constexpr double kGain = 1e-9;  // Relative: less is rounding.

using Orders = std::vector<std::vector<int>>;

/// Exact for few stops, by subsets; for more, one tour is cut up and stops change robots while that helps.
class Sharing {
 public:
  Sharing(const Eigen::MatrixXd& drive_times, const std::vector<double>& stop_times, int robots)
      : drive_(drive_times), stop_(stop_times), n_(static_cast<int>(stop_times.size())), robots_(robots) {}

  SharedTours run() {
    SharedTours result;
    result.orders = n_ <= kExactStops ? exact() : good();
    for (int robot = 0; robot < robots_; ++robot) result.durations.push_back(duration(robot, result.orders[robot]));
    result.makespan = *std::max_element(result.durations.begin(), result.durations.end());
    result.lower_bound = n_ <= kExactStops ? result.makespan : std::min(bound(), result.makespan);
    if (!std::isfinite(result.makespan)) {
      result.outcome = std::isfinite(result.lower_bound) ? Outcome::not_found : Outcome::infeasible;
      result.orders.assign(robots_, {});
      result.durations.assign(robots_, 0.0);
    } else {
      const bool proven = result.lower_bound >= result.makespan * (1 - kGain);
      result.outcome = proven ? Outcome::solved : Outcome::approximate;
    }
    return result;
  }

 private:
  int start(int robot) const { return n_ + robot; }
  int goal(int robot) const { return n_ + robots_ + robot; }
  double service(int stop) const { return stop_[stop]; }

  double duration(int robot, const std::vector<int>& order) const {
    if (order.empty()) return 0;
    double sum = 0;
    int at = start(robot);
    for (int stop : order) {
      sum += drive_(at, stop) + service(stop);
      at = stop;
    }
    return sum + drive_(at, goal(robot));
  }

  /// What each robot needs for each subset, then the best way to split all stops robot by robot.
  Orders exact() const {
    const std::size_t masks = std::size_t{1} << n_;
    std::vector<double> so_far(masks, detail::kInfinity);
    so_far[0] = 0;
    std::vector<std::vector<std::size_t>> share(robots_, std::vector<std::size_t>(masks, 0));
    for (int robot = 0; robot < robots_; ++robot) {
      const std::vector<double> alone = durations_of_subsets(robot);
      std::vector<double> with(masks, detail::kInfinity);
      for (std::size_t mask = 0; mask < masks; ++mask) {
        detail::throw_if_interrupted();
        for (std::size_t own = mask;; own = (own - 1) & mask) {
          const double longest = std::max(so_far[mask ^ own], alone[own]);
          if (longest < with[mask]) {
            with[mask] = longest;
            share[robot][mask] = own;
          }
          if (own == 0) break;
        }
      }
      so_far = std::move(with);
    }
    Orders orders(robots_);
    std::size_t mask = masks - 1;
    for (int robot = robots_ - 1; robot >= 0; --robot) {
      const std::size_t own = std::isfinite(so_far.back()) ? share[robot][mask] : mask;
      std::vector<int> stops;
      for (int stop = 0; stop < n_; ++stop) {
        if (own >> stop & 1) stops.push_back(stop);
      }
      orders[robot] = ordered(robot, stops);
      mask ^= own;
    }
    return orders;
  }

  std::vector<double> durations_of_subsets(int robot) const {
    const std::size_t n = n_;
    const std::size_t masks = std::size_t{1} << n;
    std::vector<double> ending(masks * n, detail::kInfinity), total(masks, detail::kInfinity);
    total[0] = 0;
    for (int j = 0; j < n_; ++j) ending[(std::size_t{1} << j) * n + j] = drive_(start(robot), j) + service(j);
    for (std::size_t mask = 1; mask < masks; ++mask) {
      for (int last = 0; last < n_; ++last) {
        const double here = ending[mask * n + last];
        if (here == detail::kInfinity) continue;
        total[mask] = std::min(total[mask], here + drive_(last, goal(robot)));
        for (int next = 0; next < n_; ++next) {
          if (mask >> next & 1) continue;
          double& to = ending[(mask | std::size_t{1} << next) * n + next];
          to = std::min(to, here + drive_(last, next) + service(next));
        }
      }
    }
    return total;
  }

  /// Shortest order of one robot's stops; as given when there is none.
  std::vector<int> ordered(int robot, const std::vector<int>& stops) const {
    const auto m = static_cast<Eigen::Index>(stops.size());
    std::vector<int> nodes = stops;
    nodes.push_back(start(robot));
    nodes.push_back(goal(robot));
    const Eigen::MatrixXd lengths = Eigen::MatrixXd::NullaryExpr(
        m + 2, m + 2, [&](Eigen::Index i, Eigen::Index j) { return i == j ? 0.0 : drive_(nodes[i], nodes[j]); });
    const TourResult tour = shortest_visiting_tour(lengths);
    if (tour.order.size() != stops.size()) return stops;
    std::vector<int> order;
    for (int i : tour.order) order.push_back(stops[i]);
    return duration(robot, order) <= duration(robot, stops) ? order : stops;
  }

  /// One tour over all stops, cut where the longest piece is shortest; then stops change robots.
  Orders good() const {
    std::vector<int> all(n_);
    std::iota(all.begin(), all.end(), 0);
    const std::vector<int> tour = ordered(0, all);
    std::vector<double> best(n_ + 1, detail::kInfinity);
    best[0] = 0;
    std::vector<std::vector<int>> cut(robots_, std::vector<int>(n_ + 1, 0));
    for (int robot = 0; robot < robots_; ++robot) {
      std::vector<double> with(best.size(), detail::kInfinity);
      for (int end = 0; end <= n_; ++end) {
        for (int begin = 0; begin <= end; ++begin) {
          detail::throw_if_interrupted();
          const std::vector<int> piece(tour.begin() + begin, tour.begin() + end);
          const double longest = std::max(best[begin], duration(robot, piece));
          if (longest >= with[end]) continue;
          with[end] = longest;
          cut[robot][end] = begin;
        }
      }
      best = std::move(with);
    }
    Orders orders(robots_);
    int end = n_;
    for (int robot = robots_ - 1; robot >= 0; --robot) {
      const int begin = robot == 0 ? 0 : cut[robot][end];
      orders[robot] = ordered(robot, {tour.begin() + begin, tour.begin() + end});
      end = begin;
    }
    while (hand_over(orders)) {
    }
    return orders;
  }

  /// The longest robot gives a stop away, or exchanges one, when both are then done before it was.
  bool hand_over(Orders& orders) const {
    std::vector<double> durations;
    for (int robot = 0; robot < robots_; ++robot) durations.push_back(duration(robot, orders[robot]));
    const std::size_t longest = std::max_element(durations.begin(), durations.end()) - durations.begin();
    for (std::size_t i = 0; i < orders[longest].size(); ++i) {
      for (std::size_t other = 0; other < orders.size(); ++other) {
        if (other == longest) continue;
        for (int k = -1; k < static_cast<int>(orders[other].size()); ++k) {
          std::vector<int> mine = orders[longest], theirs = orders[other];
          if (k < 0) {
            mine.erase(mine.begin() + static_cast<std::ptrdiff_t>(i));
            theirs = inserted(static_cast<int>(other), theirs, orders[longest][i]);
          } else {
            mine.erase(mine.begin() + static_cast<std::ptrdiff_t>(i));
            mine = inserted(static_cast<int>(longest), mine, theirs[k]);
            theirs.erase(theirs.begin() + k);
            theirs = inserted(static_cast<int>(other), theirs, orders[longest][i]);
          }
          const double after =
              std::max(duration(static_cast<int>(longest), mine), duration(static_cast<int>(other), theirs));
          if (!(after < durations[longest] * (1 - kGain))) continue;
          orders[longest] = ordered(static_cast<int>(longest), mine);
          orders[other] = ordered(static_cast<int>(other), theirs);
          return true;
        }
      }
    }
    return false;
  }

  std::vector<int> inserted(int robot, const std::vector<int>& order, int stop) const {
    detail::InterruptionPoll poll(16);
    std::vector<int> best;
    double least = detail::kInfinity;
    for (std::size_t place = 0; place <= order.size(); ++place) {
      poll();
      std::vector<int> trial = order;
      trial.insert(trial.begin() + static_cast<std::ptrdiff_t>(place), stop);
      const double found = duration(robot, trial);
      if (!best.empty() && found >= least) continue;
      least = found;
      best = std::move(trial);
    }
    return best;
  }

  /// Someone has to serve the farthest stop; and all that must be done, shared evenly.
  double bound() const {
    double farthest = 0, work = 0, home = detail::kInfinity;
    for (int robot = 0; robot < robots_; ++robot) {
      for (int i = 0; i < n_; ++i) home = std::min(home, drive_(i, goal(robot)));
    }
    for (int stop = 0; stop < n_; ++stop) {
      detail::throw_if_interrupted();
      double alone = detail::kInfinity, arrival = detail::kInfinity;
      for (int robot = 0; robot < robots_; ++robot) {
        alone = std::min(alone, duration(robot, {stop}));
        arrival = std::min(arrival, drive_(start(robot), stop));
      }
      for (int other = 0; other < n_; ++other) {
        if (other != stop) arrival = std::min(arrival, drive_(other, stop));
      }
      // A detour over other stops may be shorter than the direct way when lengths break the triangle rule.
      farthest = std::max(farthest, arrival + service(stop) + home);
      if (triangle()) farthest = std::max(farthest, alone);
      work += arrival + service(stop);
    }
    return std::max(farthest, (work + home) / robots_);
  }

  bool triangle() const {
    if (triangle_ >= 0) return triangle_ == 1;
    triangle_ = 1;
    const auto size = drive_.rows();
    for (Eigen::Index via = 0; via < n_ && triangle_ == 1; ++via) {
      for (Eigen::Index i = 0; i < size && triangle_ == 1; ++i) {
        detail::throw_if_interrupted();
        for (Eigen::Index j = 0; j < size; ++j) {
          if (i != via && j != via && i != j &&
              drive_(i, via) + service(static_cast<int>(via)) + drive_(via, j) < drive_(i, j) * (1 - kGain)) {
            triangle_ = 0;
            break;
          }
        }
      }
    }
    return triangle_ == 1;
  }

  const Eigen::MatrixXd& drive_;
  const std::vector<double>& stop_;
  int n_, robots_;
  mutable int triangle_ = -1;  // not checked yet
};

}  // namespace

SharedTours share_stops(const Eigen::MatrixXd& drive_times, const std::vector<double>& stop_times, int robots) {
  require_count(robots, "robots", 1, 1000);
  const auto size = static_cast<Eigen::Index>(stop_times.size()) + 2 * robots;
  require(drive_times.rows() == size && drive_times.cols() == size, "drive_times",
          std::to_string(drive_times.rows()) + " x " + std::to_string(drive_times.cols()),
          "must be square, (stops + 2 robots) = " + std::to_string(size) + " wide");
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      require(drive_times(i, j) >= 0 || i == j, "drive_times(" + std::to_string(i) + ", " + std::to_string(j) + ")",
              drive_times(i, j), "must be 0 or more (infinite: no way)");
    }
  }
  for (std::size_t stop = 0; stop < stop_times.size(); ++stop) {
    require_not_negative(stop_times[stop], "stop_times[" + std::to_string(stop) + "]", "", kLargestNumber);
  }
  return Sharing(drive_times, stop_times, robots).run();
}

}  // namespace mmgrasp
