#pragma once

#include <Eigen/Core>
#include <string>

namespace mmgrasp::detail {

/// "(x, y, theta)" for messages.
std::string pose_text(const Eigen::Vector3d& pose);

/// Six significant digits.
std::string six_digits(double value);

}  // namespace mmgrasp::detail
