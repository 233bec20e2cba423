#include "mmgrasp/robot/joint_weights.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/near_name.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {

Eigen::VectorXd JointWeights::of(const JointGroup& group) const {
  const std::vector<std::string>& names = group.names();
  Eigen::VectorXd weights = values;
  if (!by_name.empty()) {
    require(values.size() == 0, "joint_weights", values.size(), "must be given by number or by name, not both");
    weights = Eigen::VectorXd::Ones(group.size());
    for (const auto& [name, weight] : by_name) {
      const auto at = std::find(names.begin(), names.end(), name);
      if (at == names.end()) {
        throw InvalidInput("joint_weights: group '" + group.name() + "' has no joint '" + name + "'" +
                           detail::near_miss(name, names));
      }
      weights[at - names.begin()] = weight;
    }
  }
  if (weights.size() == 0) return {};
  require(weights.size() == group.size(), "joint_weights: number of them", weights.size(),
          "must be " + std::to_string(group.size()) + ", one per joint of group '" + group.name() + "'");
  for (Eigen::Index i = 0; i < weights.size(); ++i)
    require_positive(weights[i], "joint_weights of '" + names[i] + "'", "", kLargestNumber);
  return (weights.array() == 1).all() ? Eigen::VectorXd() : weights;
}

}  // namespace mmgrasp
