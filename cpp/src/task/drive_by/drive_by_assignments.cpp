#include "task/drive_by/drive_by_assignments.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/robot/base_motion.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr int kSpare = 3;           // chains looked at for each that is tried
constexpr double kCollision = 0.3;  // what a colliding waypoint of a guess counts as [s]

/// From rest to rest.
double rest_to_rest(double way, double velocity, double acceleration) {
  const double ramps = velocity * velocity / acceleration;
  return way >= ramps ? way / velocity + velocity / acceleration : 2 * std::sqrt(way / acceleration);
}

/// How far the tip can be from the base's origin at most, seen from above [m].
double reach_bound(const JointGroup& group) {
  const Robot& robot = group.robot();
  double sum = 0;
  for (int link = group.tip_link(); link > 0;) {
    const Joint& joint = robot.joints()[robot.links()[link].parent_joint];
    sum += joint.T_parent_joint.translation().norm();
    if (joint.type == JointType::prismatic) sum += std::max(std::abs(joint.lower), std::abs(joint.upper));
    link = joint.parent_link;
  }
  return sum;
}

double slack_of(const DriveByStep& step) {
  double square = 0;
  for (int k = 0; k < 3; ++k) square += step.free[k] ? kInfinity : step.tolerance[k] * step.tolerance[k];
  return std::sqrt(square);
}

double chain_time(const JointGroup& group, const std::vector<Stand>& chain, const VectorXd& start,
                  const VectorXd& goal) {
  double time = 0;
  VectorXd here = start;
  for (const Stand& stand : chain) {
    time += travel_time(group, here, stand.q);
    here = stand.q;
  }
  return time + travel_time(group, here, goal);
}

/// The stands of one candidate of one task; those of other tasks stay.
std::vector<std::vector<Stand>> only(const std::vector<DriveByStep>& steps, std::vector<std::vector<Stand>> stands,
                                     std::size_t task, int candidate) {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].task != task) continue;
    auto& list = stands[i];
    list.erase(std::remove_if(list.begin(), list.end(), [&](const Stand& s) { return s.candidate != candidate; }),
               list.end());
  }
  return stands;
}

}  // namespace

double least_duration(const JointGroup& group, const VectorXd& start, const DriveByGoal& goal, const Pose& T_world_tip,
                      double slack) {
  const VectorXd end = start.cwiseMax(goal.lower).cwiseMin(goal.upper);
  double least = 0;
  const int first = group.has_base() ? 3 : 0;
  for (int i = first; i < group.size(); ++i) {
    double way = std::abs(end[i] - start[i]);
    // Up to full turns; of a box some other value may be nearer.
    if (group.wraps()[i]) way = goal.lower[i] == goal.upper[i] ? std::abs(wrap_angle(end[i] - start[i])) : 0;
    least = std::max(least, rest_to_rest(way, group.velocity_limits()[i], group.acceleration_limits()[i]));
  }
  if (!group.has_base()) return least;
  const BaseLimits limits = driving_limits(group.robot().base(), group.robot().base_limits());
  const double reach = reach_bound(group) + slack;
  const Vector2d tool = T_world_tip.translation().head<2>(), from = start.head<2>();
  const Vector2d below = tool.cwiseMax(goal.lower.head<2>()).cwiseMin(goal.upper.head<2>());
  const double there = std::max(0.0, (tool - from).norm() - reach), back = std::max(0.0, (tool - below).norm() - reach);
  const double way = std::max((end - start).head<2>().norm(), there + back);
  return std::max(least, rest_to_rest(way, limits.linear_velocity, limits.linear_acceleration));
}

std::vector<DriveByChoice> drive_by_assignments(const JointGroup& group, const std::vector<DriveByStep>& steps,
                                                const std::vector<std::vector<Stand>>& stands, const VectorXd& start,
                                                const DriveByGoal& goal, const DriveByOptions& options,
                                                const std::function<int(const std::vector<Stand>&)>& collisions) {
  const VectorXd end = start.cwiseMax(goal.lower).cwiseMin(goal.upper);
  std::vector<DriveByChoice> choices;
  std::set<std::vector<int>> seen;
  const auto add = [&](const std::vector<std::vector<Stand>>& among) {
    DriveByChoice choice{choose_stands(group, steps, among, start, end, kSpare * options.attempts)};
    if (choice.chains.empty()) return;
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < choice.chains.size(); ++i)
      order.push_back({chain_time(group, choice.chains[i], start, end) + kCollision * collisions(choice.chains[i]), i});
    std::sort(order.begin(), order.end());
    order.resize(std::min(order.size(), static_cast<std::size_t>(options.attempts)));
    std::vector<std::vector<Stand>> chains;
    for (const auto& [cost, i] : order) chains.push_back(std::move(choice.chains[i]));
    choice.chains = std::move(chains);
    const std::vector<Stand>& chain = choice.chains.front();
    std::vector<int> candidates;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      candidates.push_back(chain[i].candidate);
      const Pose& T = steps[i].candidates[chain[i].candidate];
      choice.bound = std::max(choice.bound, least_duration(group, start, goal, T, slack_of(steps[i])));
    }
    if (!seen.insert(candidates).second) return;
    choice.about = chain_time(group, chain, start, end);
    choices.push_back(std::move(choice));
  };
  const bool several = std::any_of(steps.begin(), steps.end(), [](const auto& s) { return s.candidates.size() > 1; });
  if (steps.empty()) return {{{{}}}};
  if (!several || options.choices == 1) {
    add(stands);
    return choices;
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!steps[i].begins) continue;
    for (int c = 0; c < static_cast<int>(steps[i].candidates.size()); ++c) add(only(steps, stands, steps[i].task, c));
  }
  std::stable_sort(choices.begin(), choices.end(), [](const DriveByChoice& a, const DriveByChoice& b) {
    return a.bound != b.bound ? a.bound < b.bound : a.about < b.about;
  });
  return choices;
}

}  // namespace mmgrasp::detail
