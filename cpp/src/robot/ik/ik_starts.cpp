#include "mmgrasp/robot/detail/ik_starts.hpp"

#include <algorithm>

#include "mmgrasp/robot/detail/joint_group_data.hpp"

namespace mmgrasp::detail {

void keep_base_near(const JointGroup& group, const Pose& T_world_tip, Eigen::VectorXd& lower, Eigen::VectorXd& upper) {
  const GroupModel& model = *group.data().model;
  const double radius = std::min(model.reach + model.first_joint.norm(), group.robot().base_limits().workspace);
  for (int i = 0; i < 2; ++i) {
    lower[i] = std::max(lower[i], T_world_tip.translation()[i] - radius);
    upper[i] = std::max(lower[i], std::min(upper[i], T_world_tip.translation()[i] + radius));
  }
}

IkStarts::IkStarts(const JointGroup& group, const Pose& T_world_tip, unsigned seed)
    : lower_(group.sample_lower()), upper_(group.sample_upper()), position_(group.size()), step_(group.size()) {
  if (group.has_base()) keep_base_near(group, T_world_tip, lower_, upper_);
  const auto n = static_cast<double>(group.size());
  double root = 1.5;
  for (int i = 0; i < 40; ++i) root = std::pow(1 + root, 1 / (n + 1));
  Rng rng(seed);
  double power = 1;
  for (Eigen::Index i = 0; i < step_.size(); ++i) {
    power /= root;
    step_[i] = power;
    position_[i] = rng.uniform();
  }
}

Eigen::VectorXd IkStarts::next() {
  for (Eigen::Index i = 0; i < step_.size(); ++i) {
    position_[i] += step_[i];
    position_[i] -= std::floor(position_[i]);
  }
  return lower_ + position_.cwiseProduct(upper_ - lower_);
}

void unwind(const JointGroup& group, const Eigen::VectorXd& seed, Eigen::VectorXd& q) {
  for (Eigen::Index i = 0; i < q.size(); ++i)
    if (group.wraps()[i]) q[i] = seed[i] + wrap_angle(q[i] - seed[i]);
}

}  // namespace mmgrasp::detail
