#include "task/drive_by/drive_by_steps.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kAside = 0.003, kTilt = 0.03;  // off the straight way of a push-grasp [m], [rad]
constexpr double kFaster = 1.2;                 // tool before the object, over its speed at the grasp
constexpr double kSlack = 1.05;                 // factor on speed and duration while the fingers close

/// The axis of the frame that a direction is, or -1.
int axis_of(const Eigen::Vector3d& direction) {
  for (int k = 0; k < 3; ++k)
    if (std::abs(std::abs(direction[k]) - 1) < 1e-9 && std::abs(direction.norm() - 1) < 1e-9) return k;
  return -1;
}

void check_covariance(const Eigen::Matrix3d& covariance, const std::string& field) {
  require(covariance.allFinite(), field, covariance.sum(), "must be finite");
  const double scale = covariance.cwiseAbs().maxCoeff();
  require((covariance - covariance.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * scale, field,
          (covariance - covariance.transpose()).cwiseAbs().maxCoeff(), "must be symmetric");
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
  const double least = axes.eigenvalues()[0];
  require(least >= -1e-9 * scale, field, least, "must have no eigenvalue below 0");
}

void check_push(const DriveByTask& task, const std::string& field) {
  const DriveByPush& push = *task.push;
  push.closing.check();
  require(axis_of(push.approach) >= 0, field + ".approach", push.approach.norm(),
          "must be an axis of the tip's frame, of either sign");
  require_positive(push.free_length, field + ".free_length");
  require(std::abs(push.closing_direction.norm() - 1) < 1e-9, field + ".closing_direction",
          push.closing_direction.norm(), "must have length 1");
  require(std::abs(push.closing_direction.dot(push.approach)) < 1e-6, field + ".closing_direction along the approach",
          push.closing_direction.dot(push.approach), "must be 0");
  check_covariance(push.covariance, field + ".covariance");
  const PushGrasp grasp = push_grasp(push_closing(task));
  require(grasp.feasible, field + ".tool_speed", push.closing.tool_speed,
          "must leave a moment to close for every error asked for (at most " + std::to_string(grasp.max_tool_speed) +
              " m/s)");
  require(task.dwell == 0, field + " with dwell", task.dwell, "must be 0: the hand moves on");
  require(task.max_tool_speed == kInfinity && task.tolerance.isZero() && task.free_axes == std::vector<bool>(6, false),
          field + " with max_tool_speed, tolerance or free", 1, "must be left out: the push-grasp has its own");
}

DriveByStep moved(const DriveByTask& task, std::size_t index, double along) {
  DriveByStep step{task};
  step.task = index;
  step.axis = axis_of(task.push->approach);
  step.sign = task.push->approach[step.axis];
  step.object.clear();
  for (Pose& T : step.candidates) T = T * Eigen::Translation3d(along * task.push->approach);
  return step;
}

void add_push(const DriveByTask& task, std::size_t index, std::vector<DriveByStep>& steps) {
  const PushGraspProblem closing = push_closing(task);
  const PushGrasp grasp = push_grasp(closing);
  const double begin = grasp.push.start - closing.planned_depth, end = grasp.push.both_touch - closing.planned_depth;
  const double first = std::min(-closing.planned_depth, begin) - task.push->free_length;
  const bool slides = grasp.push.pushed > 0;  // before the palm; else it stays where it is until both fingers touch

  steps.push_back(moved(task, index, first));
  steps.back().closes = false;
  steps.back().tolerance << 0.005, 0.005, 0.005, kTilt, kTilt, kTilt;
  steps.back().max_tool_speed = kFaster * closing.tool_speed;
  steps.push_back(moved(task, index, begin));
  steps.back().way = begin - first;
  steps.push_back(moved(task, index, end));
  steps.back().way = end - begin;
  steps.back().closes = false;
  steps.back().duration = grasp.closing_time;
  for (std::size_t back = 1; back <= 2; ++back) {
    DriveByStep& step = steps[steps.size() - back];
    step.begins = false;
    step.max_tool_speed = kSlack * closing.tool_speed;
    if (slides == (back == 2)) step.object = task.object;
  }
  // It stands still until the palm has it.
  if (slides) steps[steps.size() - 2].insertion_distance = grasp.push.both_touch - grasp.push.start - grasp.push.pushed;
}

}  // namespace

std::vector<DriveByStep> steps_of(const std::vector<DriveByTask>& tasks) {
  std::vector<DriveByStep> steps;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (tasks[i].push) {
      add_push(tasks[i], i, steps);
      continue;
    }
    steps.push_back({tasks[i]});
    steps.back().task = i;
  }
  return steps;
}

void check_tasks(const std::vector<DriveByTask>& tasks, const World& world) {
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const std::string field = "tasks[" + std::to_string(i) + "]";
    const DriveByTask& task = tasks[i];
    require(!task.candidates.empty(), field + ".candidates", 0, "must hold at least one pose");
    for (std::size_t c = 0; c < task.candidates.size(); ++c)
      checked_pose(task.candidates[c].matrix(), field + ".candidates[" + std::to_string(c) + "]");
    for (int k = 0; k < 6; ++k) {
      require_not_negative(task.tolerance[k], field + ".tolerance[" + std::to_string(k) + "]");
    }
    require(task.free_axes.size() == 6, field + ".free_axes", static_cast<double>(task.free_axes.size()),
            "must have 6 entries");
    require(task.max_tool_speed > 0, field + ".max_tool_speed", task.max_tool_speed, "must be positive");
    require(task.object.empty() || world.objects().count(task.object) > 0, field + ".object", "'" + task.object + "'",
            "must be an object of the world");
    require_not_negative(task.dwell, field + ".dwell");
    if (task.push) check_push(task, field + ".push");
  }
}

Pose attached_pose(const DriveByStep& step, const Pose& T_world_tip, const Pose& T_world_object) {
  const Eigen::Vector3d nearer = -step.insertion_distance * step.sign * Eigen::Vector3d::Unit(step.axis);
  return Eigen::Translation3d(nearer) * (T_world_tip.inverse() * T_world_object);
}

ToolConstraint constraint_at(const DriveByStep& step, int candidate, int waypoint) {
  ToolConstraint tool;
  tool.waypoint = waypoint;
  tool.T_world_tip = step.candidates[candidate];
  for (int k = 0; k < 6; ++k) {
    const double slack = step.free_axes[k] ? kInfinity : step.tolerance[k];
    tool.lower[k] = -slack;
    tool.upper[k] = slack;
  }
  tool.max_speed = step.max_tool_speed;
  return tool;
}

ToolConstraint constraint_before(const DriveByStep& step, int candidate, int waypoint) {
  ToolConstraint tool = constraint_at(step, candidate, waypoint);
  tool.upper << kAside, kAside, kAside, kTilt, kTilt, kTilt;
  tool.lower = -tool.upper;
  // Only the part of the way that lies before the step.
  (step.sign > 0 ? tool.lower : tool.upper)[step.axis] = -step.sign * step.way;
  (step.sign > 0 ? tool.upper : tool.lower)[step.axis] = 0;
  (step.sign > 0 ? tool.velocity_lower : tool.velocity_upper)[step.axis] = 0;
  return tool;
}

}  // namespace mmgrasp::detail

namespace mmgrasp {

PushGraspProblem push_closing(const DriveByTask& task) {
  if (!task.push) throw InvalidInput("push: the task has none");
  const DriveByPush& push = *task.push;
  PushGraspProblem closing = push.closing;
  for (const Pose& T : task.candidates) {
    const auto deviation = [&](const Eigen::Vector3d& direction) {
      const Eigen::Vector3d d = T.linear() * direction;
      return std::sqrt(std::max(0.0, d.dot(push.covariance * d)));
    };
    closing.along_deviation = std::max(closing.along_deviation, deviation(push.approach));
    closing.lateral_deviation = std::max(closing.lateral_deviation, deviation(push.closing_direction));
  }
  return closing;
}

}  // namespace mmgrasp
