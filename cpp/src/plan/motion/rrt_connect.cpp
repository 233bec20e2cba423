#include "plan/motion/rrt_connect.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/random.hpp"
#include "plan/motion/configuration_tree.hpp"

namespace mmgrasp::detail {
namespace {

// Longest edge by the diagonal of the sampling bounds, when the caller names none (docs/methods/plan.md has figures).
constexpr double kRangeShare = 0.05;
constexpr double kAnywhereProbability = 0.1;  // Chance to sample from the whole bounds, not near the ends.
constexpr double kSameConfiguration = 1e-9;   // Nearer configurations are the same [rad or m].
constexpr double kLeastProgress =
    0.05;  // Least approach of a projected step to its target, as a share of the step's length.

enum class Growth { trapped, advanced, reached };

/// Two trees that grow towards each other (Kuffner and LaValle 2000); the words extend, trapped, advanced and reached
/// are theirs.
class Connect {
 public:
  explicit Connect(const PlannerQuery& query)
      : query_(query),
        rng_(query.seed, 2),
        range_(query.range > 0 ? query.range : kRangeShare * query.metric.norm(query.upper - query.lower)),
        time_limit_(query.time_limit),
        trees_{ConfigurationTree(query.start.size(), query.metric),
               ConfigurationTree(query.start.size(), query.metric)},
        sample_(query.start.size()),
        from_(query.start.size()),
        next_(query.start.size()),
        meet_(query.start.size()),
        motion_(query.start.size()) {
    trees_[0].add(query.start, -1);
    for (const auto& goal : query.goals) trees_[1].add(goal, -1);
  }

  PlannerAnswer run() {
    for (int i = 0; i < query_.max_iterations && !over(); ++i) {
      // Turns of a goal are no growth of its tree.
      const int growing = trees_[0].size() <= trees_[1].size() - query_.turned_goals ? 0 : 1;
      draw();
      if (query_.project && !query_.project(sample_)) continue;
      int node = trees_[growing].nearest(sample_);
      if (extend(trees_[growing], node, sample_) == Growth::trapped) continue;
      trees_[growing].get(node, meet_);
      int other = trees_[1 - growing].nearest(meet_);
      Growth growth = Growth::advanced;
      while (growth == Growth::advanced && !over()) growth = extend(trees_[1 - growing], other, meet_);
      if (growth == Growth::reached) return solved(growing == 0 ? node : other, growing == 0 ? other : node);
    }
    return {};
  }

 private:
  bool over() const { return query_.stopped() || time_limit_.expired(); }

  void draw() {
    const bool anywhere = query_.near_lower.size() == 0 || rng_.uniform(0.0, 1.0) < kAnywhereProbability;
    const Eigen::VectorXd& lower = anywhere ? query_.lower : query_.near_lower;
    const Eigen::VectorXd& upper = anywhere ? query_.upper : query_.near_upper;
    for (Eigen::Index i = 0; i < sample_.size(); ++i) {
      const bool wraps = query_.metric.wraps(static_cast<int>(i));
      sample_[i] = wraps ? rng_.uniform(-kPi, kPi) : rng_.uniform(lower[i], upper[i]);
    }
  }

  /// The motion from one configuration to another, the short way round; returns its length.
  double motion(const Eigen::VectorXd& from, const Eigen::VectorXd& to, Eigen::VectorXd& out) const {
    out = to - from;
    query_.metric.wrap(out.data());
    return query_.metric.norm(out);
  }

  /// One step from `node`, which becomes the new node.
  Growth extend(ConfigurationTree& tree, int& node, const Eigen::VectorXd& target) {
    tree.get(node, from_);
    const double distance = motion(from_, target, next_);
    if (distance < kSameConfiguration * query_.metric.unit()) return Growth::reached;
    const bool reached = distance <= range_ * (1 + 1e-9);
    if (reached) {
      next_ = target;
    } else {
      next_ = from_ + next_ * (range_ / distance);
      query_.metric.wrap(next_.data());
      if (query_.project) {
        if (!query_.project(next_)) return Growth::trapped;
        query_.metric.wrap(next_.data());
        // The projection may have taken back the step.
        if (motion(next_, target, motion_) > distance - kLeastProgress * range_) return Growth::trapped;
      }
    }
    if (!query_.edge_is_free(from_, next_)) return Growth::trapped;
    node = tree.add(next_, node);
    return reached ? Growth::reached : Growth::advanced;
  }

  PlannerAnswer solved(int from_start, int from_goal) {
    PlannerAnswer answer;
    answer.solved = true;
    Eigen::VectorXd q(query_.start.size());
    for (int node = from_start; node >= 0; node = trees_[0].parent(node)) {
      trees_[0].get(node, q);
      answer.waypoints.push_back(q);
    }
    std::reverse(answer.waypoints.begin(), answer.waypoints.end());
    for (int node = from_goal; node >= 0; node = trees_[1].parent(node)) {
      trees_[1].get(node, q);
      if ((q - answer.waypoints.back()).norm() > kSameConfiguration) answer.waypoints.push_back(q);
    }
    return answer;
  }

  const PlannerQuery& query_;
  Rng rng_;
  const double range_;
  const TimeLimit time_limit_;
  ConfigurationTree trees_[2];
  Eigen::VectorXd sample_, from_, next_, meet_, motion_;
};

}  // namespace

PlannerAnswer rrt_connect(const PlannerQuery& query) {
  return Connect(query).run();
}

}  // namespace mmgrasp::detail
