#include "plan/motion/beyond_limits.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace mmgrasp::detail {

std::string beyond_limits(const JointGroup& group, const Eigen::VectorXd& q) {
  Eigen::Index worst = 0;
  const double beyond = (q - group.upper()).cwiseMax(group.lower() - q).maxCoeff(&worst);
  if (!(beyond > 0)) return "";
  std::ostringstream out;
  out << std::setprecision(9);  // enough to tell the value from the limit
  out << group.names()[worst] << " = " << q[worst] << " is outside of its limits [" << group.lower()[worst] << ", "
      << group.upper()[worst] << "]";
  return out.str();
}

}  // namespace mmgrasp::detail
