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

constexpr int kSpare = 3;           // sequences generated for each that is tried
constexpr double kCollision = 0.3;  // what a colliding waypoint of a guess counts as [s]

/// Least time for a way from rest to rest [s].
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
  for (int k = 0; k < 3; ++k) square += step.free_axes[k] ? kInfinity : step.tolerance[k] * step.tolerance[k];
  return std::sqrt(square);
}

double sequence_time(const JointGroup& group, const ConfigurationSequence& sequence, const VectorXd& start,
                     const VectorXd& goal) {
  double time = 0;
  VectorXd here = start;
  for (const StepConfiguration& configuration : sequence) {
    time += travel_time(group, here, configuration.q);
    here = configuration.q;
  }
  return time + travel_time(group, here, goal);
}

/// Keeps the configurations of one candidate of one task; those of other tasks stay.
std::vector<GoalConfigurations> only(const std::vector<DriveByStep>& steps, std::vector<GoalConfigurations> goals,
                                     std::size_t task, int candidate) {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].task != task) continue;
    auto& list = goals[i];
    list.erase(
        std::remove_if(list.begin(), list.end(), [&](const StepConfiguration& s) { return s.candidate != candidate; }),
        list.end());
  }
  return goals;
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

std::vector<GraspAssignment> drive_by_assignments(const JointGroup& group, const std::vector<DriveByStep>& steps,
                                                  const std::vector<GoalConfigurations>& goals, const VectorXd& start,
                                                  const DriveByGoal& goal, const DriveByOptions& options,
                                                  const std::function<int(const ConfigurationSequence&)>& collisions) {
  const VectorXd end = start.cwiseMax(goal.lower).cwiseMin(goal.upper);
  std::vector<GraspAssignment> assignments;
  std::set<std::vector<int>> seen;
  const auto add = [&](const std::vector<GoalConfigurations>& among) {
    GraspAssignment assignment{choose_sequences(group, steps, among, start, end, kSpare * options.seeds)};
    if (assignment.sequences.empty()) return;
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < assignment.sequences.size(); ++i)
      order.push_back(
          {sequence_time(group, assignment.sequences[i], start, end) + kCollision * collisions(assignment.sequences[i]),
           i});
    std::sort(order.begin(), order.end());
    order.resize(std::min(order.size(), static_cast<std::size_t>(options.seeds)));
    std::vector<ConfigurationSequence> sequences;
    for (const auto& [cost, i] : order) sequences.push_back(std::move(assignment.sequences[i]));
    assignment.sequences = std::move(sequences);
    const ConfigurationSequence& sequence = assignment.sequences.front();
    std::vector<int> candidates;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      candidates.push_back(sequence[i].candidate);
      const Pose& T = steps[i].candidates[sequence[i].candidate];
      assignment.bound = std::max(assignment.bound, least_duration(group, start, goal, T, slack_of(steps[i])));
    }
    if (!seen.insert(candidates).second) return;
    assignment.estimated_duration = sequence_time(group, sequence, start, end);
    assignments.push_back(std::move(assignment));
  };
  const bool several = std::any_of(steps.begin(), steps.end(), [](const auto& s) { return s.candidates.size() > 1; });
  if (steps.empty()) return {{{{}}}};
  if (!several || options.grasp_assignments == 1) {
    add(goals);
    return assignments;
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!steps[i].begins) continue;
    for (int c = 0; c < static_cast<int>(steps[i].candidates.size()); ++c) add(only(steps, goals, steps[i].task, c));
  }
  std::stable_sort(assignments.begin(), assignments.end(), [](const GraspAssignment& a, const GraspAssignment& b) {
    return a.bound != b.bound ? a.bound < b.bound : a.estimated_duration < b.estimated_duration;
  });
  return assignments;
}

}  // namespace mmgrasp::detail
