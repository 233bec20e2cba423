#include "plan/manipulation/common/turned_ends.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mmgrasp/core/detail/least_sums.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

using Configurations = std::vector<Eigen::VectorXd>;

constexpr std::size_t kMaxPairs = 64;          // Pairs of turns for each start and goal,
constexpr std::size_t kMaxPairsUnbounded = 8;  // ... and while no path bounds them.
constexpr double kSameConfiguration = 1e-9;    // Nearer configurations are the same [rad or m].

/// Turns of one joint at the start and at the goal.
struct TurnPair {
  double start, goal;
  int turns;  ///< The same for pairs with the same difference.
  double squared() const { return (goal - start) * (goal - start); }
  /// How far the nearer of the two lies from a limit.
  double room(double lower, double upper) const {
    return std::min(std::min(start, goal) - lower, upper - std::max(start, goal));
  }
};

/// The pairs of turns that paths which move the joint by less than `bound` need, nearest first. Those with the same
/// difference are the same motion, shifted: one will do from which the path cannot reach a limit. It leaves the range
/// between its ends by at most half of what it is longer than their difference.
std::vector<TurnPair> needed_pairs(const std::vector<double>& starts, const std::vector<double>& goals,
                                   double own_start, double lower, double upper, double bound) {
  std::vector<TurnPair> all;
  for (const double a : starts)
    for (const double b : goals)
      all.push_back({a, b, static_cast<int>(std::lround((b - a - (goals.front() - starts.front())) / kTwoPi))});
  // Among equal differences the start's own turn comes first, so that most pairs share it; then the pair with most
  // room.
  std::sort(all.begin(), all.end(), [&](const TurnPair& a, const TurnPair& b) {
    const double a_off = std::abs(a.start - own_start), b_off = std::abs(b.start - own_start);
    if (a.turns != b.turns) return a.turns < b.turns;
    return std::abs(a_off - b_off) > kSameConfiguration ? a_off < b_off : a.room(lower, upper) > b.room(lower, upper);
  });
  std::vector<TurnPair> out;
  for (auto first = all.begin(), last = first; first != all.end(); first = last) {
    last = std::find_if(first, all.end(), [&](const TurnPair& pair) { return pair.turns != first->turns; });
    const double detour = 0.5 * (bound - std::sqrt(first->squared()));
    if (!(detour > 0)) continue;
    const auto enough = std::isinf(bound) ? first : std::find_if(first, last, [&](const TurnPair& pair) {
      return pair.room(lower, upper) >= detour;
    });
    if (enough != last) {
      out.push_back(*enough);
    } else {
      out.insert(out.end(), first, last);
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const TurnPair& a, const TurnPair& b) { return a.squared() < b.squared(); });
  return out;
}

/// The turns of each value of a configuration.
using Values = std::vector<std::vector<double>>;

std::vector<Values> turns_of_all(const WholeTurns& turns, const Configurations& all) {
  std::vector<Values> out;
  for (const Eigen::VectorXd& q : all) {
    Values values;
    for (int i = 0; i < static_cast<int>(q.size()); ++i) values.push_back(turns.of(i, q[i]));
    out.push_back(std::move(values));
  }
  return out;
}

bool any_turns(const std::vector<Values>& all) {
  return std::any_of(all.begin(), all.end(), [](const Values& values) {
    return std::any_of(values.begin(), values.end(), [](const auto& own) { return own.size() > 1; });
  });
}

void add_new(Configurations& all, const Eigen::VectorXd& q) {
  const bool known = std::any_of(all.begin(), all.end(), [&](const Eigen::VectorXd& other) {
    return (other - q).cwiseAbs().maxCoeff() < kSameConfiguration;
  });
  if (!known) all.push_back(q);
}

/// Those nearest to any of `others` first.
void sort_by_distance(const JointMetric& metric, const Configurations& others, Configurations& all) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < all.size(); ++i) {
    double least = kInfinity;
    for (const Eigen::VectorXd& other : others) least = std::min(least, metric.distance(all[i], other));
    order.emplace_back(least, i);
  }
  std::sort(order.begin(), order.end());
  Configurations sorted;
  for (const auto& entry : order) sorted.push_back(std::move(all[entry.second]));
  all = std::move(sorted);
}

}  // namespace

void add_turned_ends(const WholeTurns& turns, const JointGroup& group, double bound, GraspCandidate& candidate) {
  if (!turns.any()) return;
  const std::vector<Values> start_turns = turns_of_all(turns, candidate.starts),
                            goal_turns = turns_of_all(turns, candidate.goals);
  if (!any_turns(start_turns) && !any_turns(goal_turns)) return;
  const double length = bound - candidate.cost;
  const std::size_t most = std::isinf(length) ? kMaxPairsUnbounded : kMaxPairs;
  Configurations starts = candidate.starts, goals = candidate.goals;
  std::vector<int> choice;
  double squared = 0;
  for (std::size_t first = 0; first < candidate.starts.size(); ++first)
    for (std::size_t last = 0; last < candidate.goals.size(); ++last) {
      const Eigen::VectorXd &s = candidate.starts[first], &g = candidate.goals[last];
      std::vector<std::vector<TurnPair>> pairs;
      std::vector<std::vector<double>> distances;
      for (int i = 0; i < static_cast<int>(s.size()); ++i) {
        pairs.push_back(candidate.metric.wraps(i)
                            ? std::vector<TurnPair>{{s[i], candidate.metric.nearest(i, s[i], g[i]), 0}}
                            : needed_pairs(start_turns[first][i], goal_turns[last][i], s[i], group.lower()[i],
                                           group.upper()[i], length / candidate.metric.weight(i)));
        std::vector<double> own;
        const double weight = candidate.metric.weight(i);
        for (const TurnPair& pair : pairs.back()) own.push_back(weight * weight * pair.squared());
        distances.push_back(std::move(own));
      }
      LeastSums sums(std::move(distances));
      for (std::size_t n = 0; n < most && sums.next(choice, squared) && std::sqrt(squared) < length; ++n) {
        Eigen::VectorXd start = s, goal = g;
        for (std::size_t i = 0; i < choice.size(); ++i) {
          const TurnPair& pair = pairs[i][choice[i]];
          if (candidate.metric.wraps(static_cast<int>(i))) continue;
          start[static_cast<Eigen::Index>(i)] = pair.start;
          goal[static_cast<Eigen::Index>(i)] = pair.goal;
        }
        add_new(starts, start);
        add_new(goals, goal);
      }
    }
  if (starts.size() == candidate.starts.size() && goals.size() == candidate.goals.size()) return;
  sort_by_distance(candidate.metric, goals, starts);
  sort_by_distance(candidate.metric, starts, goals);
  candidate.turned_goals += static_cast<int>(goals.size() - candidate.goals.size());
  candidate.starts = std::move(starts);
  candidate.goals = std::move(goals);
}

void add_ends(const GraspCandidate& from, GraspCandidate& to) {
  for (const Eigen::VectorXd& q : from.starts) add_new(to.starts, q);
  const std::size_t before = to.goals.size();
  for (const Eigen::VectorXd& q : from.goals) add_new(to.goals, q);
  to.turned_goals += static_cast<int>(to.goals.size() - before);
}

}  // namespace mmgrasp::detail
