#include "task/drive_by/drive_by_goals.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/no_time_limit.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/base_motion.hpp"
#include "mmgrasp/robot/ik.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;

constexpr double kMinBaseToTool = 0.35, kMaxBaseToTool = 1.1;  // distance along the floor of the bases tried [m]
constexpr double kHeadingSpread = 0.6;                         // deviation from the direction of travel [rad]
constexpr double kSameConfiguration = 0.3;  // configurations closer than this in every value count as one [rad or m]
constexpr int kRounds = 8;                  // rounds of tries while nothing is found

double direction(const VectorXd& from, const VectorXd& to, double otherwise) {
  const Eigen::Vector2d way = to.head<2>() - from.head<2>();
  return way.norm() > 0.05 ? std::atan2(way.y(), way.x()) : otherwise;
}

/// A candidate turned and shifted along what is free.
Pose drawn_pose(const DriveByTask& task, int candidate, Rng& rng) {
  Pose T = task.candidates[candidate];
  for (int i = 3; i < 6; ++i)
    if (task.free_axes[i]) T.rotate(Eigen::AngleAxisd(rng.uniform(-kPi, kPi), Eigen::Vector3d::Unit(i - 3)));
  return T;
}

IkOptions goal_ik() {
  IkOptions ik;
  ik.restarts = 0;
  ik.position_tolerance = 1e-5;
  ik.max_iterations = 40;
  ik.time_limit = detail::kNoTimeLimit;
  return ik;
}

}  // namespace

double travel_time(const JointGroup& group, const VectorXd& from, const VectorXd& to) {
  double time = 0;
  int first = 0;
  if (group.has_base()) {
    first = 3;
    const BaseKind kind = group.robot().base();
    const BaseLimits limits = driving_limits(kind, group.robot().base_limits());
    const double way = (to - from).head<2>().norm();
    double turn = std::abs(wrap_angle(to[2] - from[2]));
    if (kind == BaseKind::diff_drive && way > 0.05) {
      const double along = direction(from, to, 0);
      turn = std::abs(wrap_angle(along - from[2])) + std::abs(wrap_angle(to[2] - along));
    }
    // A curve turns while it drives.
    time = way / limits.linear_velocity + 0.5 * turn / limits.angular_velocity;
  }
  for (int i = first; i < group.size(); ++i)
    time = std::max(time, std::abs(to[i] - from[i]) / group.velocity_limits()[i]);
  return time;
}

VectorXd unwound(const JointGroup& group, const VectorXd& from, VectorXd to) {
  for (int i = 0; i < group.size(); ++i)
    if (group.wraps()[i]) to[i] = from[i] + wrap_angle(to[i] - from[i]);
  return to;
}

GoalConfigurations find_goal_configurations(const JointGroup& group, CollisionChecker* checker, const DriveByTask& task,
                                            const VectorXd& before, const VectorXd& after,
                                            const DriveByOptions& options, unsigned stream, const Monitor& monitor) {
  const std::size_t each = options.goal_configurations, count = each * task.candidates.size();
  GoalConfigurations found;
  const int threads = resolve_threads(options.threads);
  std::vector<CollisionChecker> checkers;
  for (int i = 0; checker && i < threads; ++i) checkers.push_back(checker->clone());
  const IkOptions ik = goal_ik();
  const double along = group.has_base() ? direction(before, after, before[2]) : 0;
  std::size_t first = 0;
  const auto try_one = [&](std::size_t index, int worker) {
    const std::size_t item = first + index % each;
    Rng rng(options.seed, 1000003u * (stream + 1) + item);
    const int candidate = static_cast<int>(index / each);
    const Pose T = drawn_pose(task, candidate, rng);
    const double share = rng.uniform(0.2, 0.8);
    VectorXd seed = (1 - share) * before + share * after;
    // The first tries keep the arm near the way, later ones look anywhere.
    if (item * 3 >= each) {
      const VectorXd any = rng.uniform(group.sample_lower(), group.sample_upper());
      seed.tail(seed.size() - (group.has_base() ? 3 : 0)) = any.tail(seed.size() - (group.has_base() ? 3 : 0));
    }
    if (group.has_base()) {
      const double angle = rng.uniform(-kPi, kPi), radius = rng.uniform(kMinBaseToTool, kMaxBaseToTool);
      seed[0] = T.translation().x() + radius * std::cos(angle);
      seed[1] = T.translation().y() + radius * std::sin(angle);
      seed[2] = along + kHeadingSpread * rng.normal();
    }
    // Numbers of joints without limits may be whole turns away: what is sampled is one turn.
    for (int i = 0; i < group.size(); ++i)
      if (group.wraps()[i]) seed[i] = wrap_angle(seed[i]);
    seed = seed.cwiseMax(group.sample_lower()).cwiseMin(group.sample_upper());
    const ConfigurationFilter valid = [&](const VectorXd& q) {
      return checker ? checkers[worker].rejection(q) : Rejection::none;
    };
    const IkResult r = solve_ik(group, T, seed, ik, valid, {monitor.stop, {}});
    if (r.outcome != Outcome::solved) return;
    found[index].q = unwound(group, 0.5 * (before + after), r.q);
    found[index].candidate = candidate;
  };
  const auto any = [&] {
    return std::any_of(found.begin(), found.end(), [](const StepConfiguration& s) { return s.q.size() > 0; });
  };
  for (int round = 0; round < kRounds && !any() && !monitor.stopped(); ++round, first += each) {
    found.assign(count, {});
    parallel_for(count, threads, try_one, monitor);
  }
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i].q.size() == 0) continue;
    order.push_back({travel_time(group, before, found[i].q) + travel_time(group, found[i].q, after), i});
  }
  std::sort(order.begin(), order.end());
  GoalConfigurations result;
  for (const auto& time_and_index : order) {
    const StepConfiguration& one = found[time_and_index.second];
    const bool twin = std::any_of(result.begin(), result.end(), [&](const StepConfiguration& s) {
      return s.candidate == one.candidate && (s.q - one.q).cwiseAbs().maxCoeff() < kSameConfiguration;
    });
    if (!twin) result.push_back(one);
  }
  return result;
}

GoalConfigurations follow_goal_configurations(const JointGroup& group, CollisionChecker* checker,
                                              const DriveByStep& step, const GoalConfigurations& before,
                                              const Monitor& monitor) {
  const ConfigurationFilter valid = [&](const VectorXd& q) {
    return checker ? checker->rejection(q) : Rejection::none;
  };
  GoalConfigurations result;
  for (const StepConfiguration& configuration : before) {
    const Pose& T = step.candidates[configuration.candidate];
    const IkResult r = solve_ik(group, T, configuration.q, goal_ik(), valid, {monitor.stop, {}});
    if (r.outcome == Outcome::solved) result.push_back({unwound(group, configuration.q, r.q), configuration.candidate});
  }
  return result;
}

std::vector<ConfigurationSequence> choose_sequences(const JointGroup& group, const std::vector<DriveByStep>& steps,
                                                    const std::vector<GoalConfigurations>& goals, const VectorXd& start,
                                                    const VectorXd& goal, int count) {
  // Each round takes the quickest sequence; the configurations it used become costlier for the next ones.
  constexpr double kUsed = 1.5;  // [s] per use
  std::vector<std::vector<double>> penalty;
  for (const auto& list : goals) penalty.push_back(std::vector<double>(list.size(), 0));
  std::vector<ConfigurationSequence> sequences;
  std::vector<std::vector<std::size_t>> seen;
  for (int round = 0; round < 4 * count && static_cast<int>(sequences.size()) < count; ++round) {
    std::vector<std::vector<double>> cost;
    std::vector<std::vector<std::size_t>> from;
    for (std::size_t t = 0; t < goals.size(); ++t) {
      cost.push_back(std::vector<double>(goals[t].size(), kInfinity));
      from.push_back(std::vector<std::size_t>(goals[t].size(), 0));
      for (std::size_t i = 0; i < goals[t].size(); ++i) {
        if (t == 0) cost[t][i] = travel_time(group, start, goals[t][i].q);
        for (std::size_t j = 0; t > 0 && j < goals[t - 1].size(); ++j) {
          if (steps[t].way > 0 && goals[t - 1][j].candidate != goals[t][i].candidate) continue;
          const double c = cost[t - 1][j] + travel_time(group, goals[t - 1][j].q, goals[t][i].q);
          if (c < cost[t][i]) {
            cost[t][i] = c;
            from[t][i] = j;
          }
        }
        cost[t][i] += penalty[t][i];
      }
    }
    std::size_t best = 0;
    double least = kInfinity;
    for (std::size_t i = 0; i < goals.back().size(); ++i) {
      const double c = cost.back()[i] + travel_time(group, goals.back()[i].q, goal);
      if (c < least) {
        least = c;
        best = i;
      }
    }
    if (least == kInfinity) break;
    std::vector<std::size_t> sequence(goals.size());
    for (std::size_t t = goals.size(); t-- > 0;) {
      sequence[t] = best;
      penalty[t][best] += kUsed;
      best = from[t][best];
    }
    if (std::find(seen.begin(), seen.end(), sequence) != seen.end()) continue;
    seen.push_back(sequence);
    sequences.emplace_back();
    for (std::size_t t = 0; t < goals.size(); ++t) sequences.back().push_back(goals[t][sequence[t]]);
  }
  return sequences;
}

}  // namespace mmgrasp::detail
