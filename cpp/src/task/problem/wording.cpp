#include "task/problem/wording.hpp"

#include <sstream>

namespace mmgrasp::detail {

std::string pose_text(const Eigen::Vector3d& pose) {
  std::ostringstream out;
  out.precision(6);
  out << "(" << pose.x() << ", " << pose.y() << ", " << pose.z() << ")";
  return out.str();
}

std::string six_digits(double value) {
  std::ostringstream out;
  out.precision(6);
  out << value;
  return out.str();
}

}  // namespace mmgrasp::detail
