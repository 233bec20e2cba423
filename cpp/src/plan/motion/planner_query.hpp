#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "mmgrasp/robot/detail/joint_metric.hpp"

namespace mmgrasp::detail {

/// A planning problem for the planners of plan_motion. Start and goals are valid; values that wrap lie in [-pi, pi].
struct PlannerQuery {
  std::string planner;
  Eigen::VectorXd lower, upper;            ///< Sampling bounds.
  Eigen::VectorXd near_lower, near_upper;  ///< Where samples are mostly drawn, within these bounds; empty: anywhere.
  JointMetric metric;                      ///< What a path's length is, and which values wrap.
  Eigen::VectorXd start;
  std::vector<Eigen::VectorXd> goals;
  int turned_goals = 0;             ///< How many of the goals are whole turns of others.
  double range = 0;                 ///< Longest tree edge, by the metric; 0: the planner's choice.
  double near_end_probability = 0;  ///< Chance that a roadmap's sample is drawn around the start or a goal.
  unsigned seed = 1;
  int max_iterations = 1;
  double time_limit = 1;  ///< [s]
  std::function<bool(const Eigen::VectorXd&)> is_free;
  /// The edge from a configuration that is known to be free.
  std::function<bool(const Eigen::VectorXd&, const Eigen::VectorXd&)> edge_is_free;
  /// Projects a configuration onto the path constraint; false when that fails. Empty: there is none.
  std::function<bool(Eigen::VectorXd&)> project;
  std::function<bool()> stopped;
  /// Called with each path that is shorter than those before, by planners that go on after their first.
  std::function<void(const std::vector<Eigen::VectorXd>& waypoints)> on_improvement;
};

struct PlannerAnswer {
  bool solved = false;
  bool exhausted = false;                  ///< The planner gave up before its budget was spent.
  std::vector<Eigen::VectorXd> waypoints;  ///< Path from the start to a goal; values that wrap in [-pi, pi].
};

}  // namespace mmgrasp::detail
