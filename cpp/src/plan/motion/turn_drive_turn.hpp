#pragma once

#include <Eigen/Core>
#include <vector>

namespace mmgrasp::detail {

/// How a platform that cannot move sideways goes from one configuration (x, y, theta, arm joints ...) to another: turn
/// on the spot towards the goal, drive straight, turn on the spot; or turn away from the goal and drive backwards. The
/// arm's joints move along evenly. The heading with less turning is taken, so that the path back is the same one.
/// Appends the corners after `from`, the goal included, whose theta (and other values that wrap) may come out whole
/// turns away from `to`.
void append_turn_drive_turn(const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                            std::vector<Eigen::VectorXd>& corners);

}  // namespace mmgrasp::detail
