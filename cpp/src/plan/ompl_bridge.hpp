#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace mmgrasp::detail {

/// A query for the plugin that holds OMPL. Start and goals are valid; values that wrap lie in [-pi, pi].
struct OmplQuery {
  std::string planner;
  Eigen::VectorXd lower, upper;
  std::vector<bool> wraps;
  Eigen::VectorXd start;
  std::vector<Eigen::VectorXd> goals;
  double range = 0;
  unsigned seed = 1;
  int max_iterations = 1;
  double time_limit = 1;
  std::function<bool(const Eigen::VectorXd&)> is_free;
  std::function<bool(const Eigen::VectorXd&, const Eigen::VectorXd&)> edge_is_free;
  std::function<bool()> stopped;
};

struct OmplAnswer {
  bool solved = false;
  bool exhausted = false;                  ///< The planner gave up before its budget was spent.
  std::vector<Eigen::VectorXd> waypoints;  ///< From start to a goal; values that wrap in [-pi, pi].
};

/// Throws IoError when the plugin cannot be opened, and whatever the query's functions threw.
OmplAnswer solve_with_ompl(const OmplQuery& query);

/// Names in the plugin's table. Throws IoError as above.
std::vector<std::string> ompl_planner_names();

}  // namespace mmgrasp::detail
