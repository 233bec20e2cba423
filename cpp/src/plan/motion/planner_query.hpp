#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace mmgrasp::detail {

/// What a planner is asked. Start and goals are valid; values that wrap lie in [-pi, pi].
struct PlannerQuery {
  std::string planner;
  Eigen::VectorXd lower, upper;
  Eigen::VectorXd near_lower, near_upper;  ///< Where samples are mostly drawn, within the limits; empty: anywhere.
  std::vector<bool> wraps;
  Eigen::VectorXd start;
  std::vector<Eigen::VectorXd> goals;
  double range = 0;
  unsigned seed = 1;
  int max_iterations = 1;
  double time_limit = 1;
  std::function<bool(const Eigen::VectorXd&)> is_free;
  std::function<bool(const Eigen::VectorXd&, const Eigen::VectorXd&)> edge_is_free;
  /// Brings a configuration back to where paths may run; false when that fails. Empty: they may run anywhere.
  std::function<bool(Eigen::VectorXd&)> project;
  std::function<bool()> stopped;
  /// Called with each path that is shorter than those before, by planners that go on after their first.
  std::function<void(const std::vector<Eigen::VectorXd>& waypoints)> improved;
};

struct PlannerAnswer {
  bool solved = false;
  bool exhausted = false;                  ///< The planner gave up before its budget was spent.
  std::vector<Eigen::VectorXd> waypoints;  ///< From start to a goal; values that wrap in [-pi, pi].
};

}  // namespace mmgrasp::detail
