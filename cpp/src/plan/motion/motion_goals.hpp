#pragma once

#include <vector>

#include "mmgrasp/core/monitor.hpp"
#include "plan/motion/motion_edges.hpp"

namespace mmgrasp::detail {

/// A configuration a motion may end at, and which of the caller's goals that is.
struct GoalConfiguration {
  Eigen::VectorXd q;
  int goal = -1;
  bool turned = false;  ///< A whole turn away from another one of the same pose that is nearer to the start.
};

/// The allowed configurations among the goals and those that inverse kinematics finds for their poses, the latter in
/// every whole turn that limits allow, nearest to `start` first: turns of one touch the same. What is rejected
/// is counted by cause, a pose once; `contacts` says what touches in the first rejected configuration.
std::vector<GoalConfiguration> allowed_goals(MotionEdges& edges, const Eigen::VectorXd& start, const MotionGoals& goals,
                                             const MotionOptions& options, const Monitor& monitor,
                                             Rejections& rejections, std::vector<Contact>& contacts);

}  // namespace mmgrasp::detail
