#include "mmgrasp/robot/detail/whole_turns.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/least_sums.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/robot/detail/joint_metric.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kRounding = 1e-9;  // [rad]

/// The robot stands the same when this joint has made a turn.
bool is_same_after_a_turn(const Robot& robot, int joint) {
  if (joint < 0 || robot.joints()[joint].type != JointType::revolute) return false;
  return std::none_of(robot.joints().begin(), robot.joints().end(), [&](const Joint& other) {
    return other.mimic_joint == joint &&
           (other.type == JointType::prismatic || other.mimic_multiplier != std::round(other.mimic_multiplier));
  });
}

}  // namespace

WholeTurns::WholeTurns(const JointGroup& group) : lower_(group.lower()), upper_(group.upper()), wraps_(group.wraps()) {
  for (int i = 0; i < group.size(); ++i) {
    const bool turns =
        !wraps_[i] && std::isfinite(upper_[i] - lower_[i]) && is_same_after_a_turn(group.robot(), group.joints()[i]);
    turns_.push_back(turns);
    any_ = any_ || (turns && upper_[i] - lower_[i] >= kTwoPi - kRounding);
  }
}

std::vector<double> WholeTurns::of(int i, double value) const {
  if (!turns_[i]) return {value};
  std::vector<double> out;
  const double first = std::ceil((lower_[i] - kRounding - value) / kTwoPi);
  for (double k = first; value + k * kTwoPi <= upper_[i] + kRounding; ++k)
    out.push_back(std::clamp(k == 0 ? value : value + k * kTwoPi, lower_[i], upper_[i]));
  return out;
}

std::vector<Eigen::VectorXd> WholeTurns::of(const Eigen::VectorXd& q, const Eigen::VectorXd& near,
                                            std::size_t count) const {
  std::vector<std::vector<double>> values, squared;
  for (int i = 0; i < static_cast<int>(q.size()); ++i) {
    std::vector<double> own = wraps_[i] ? std::vector<double>{JointMetric::nearest_angle(near[i], q[i])} : of(i, q[i]);
    std::sort(own.begin(), own.end(),
              [&](double a, double b) { return std::abs(a - near[i]) < std::abs(b - near[i]); });
    std::vector<double> distances;
    for (const double value : own) distances.push_back((value - near[i]) * (value - near[i]));
    values.push_back(std::move(own));
    squared.push_back(std::move(distances));
  }
  LeastSums sums(std::move(squared));
  std::vector<Eigen::VectorXd> out;
  std::vector<int> choice;
  double sum = 0;
  while (out.size() < count && sums.next(choice, sum)) {
    Eigen::VectorXd turned(q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) turned[i] = values[i][choice[i]];
    out.push_back(std::move(turned));
  }
  return out;
}

std::vector<Eigen::VectorXd> all_whole_turns(const JointGroup& group,
                                             const std::vector<Eigen::VectorXd>& configurations) {
  const WholeTurns turns(group);
  if (!turns.any()) return configurations;
  const Eigen::VectorXd middle = 0.5 * (group.sample_lower() + group.sample_upper());
  std::vector<Eigen::VectorXd> out;
  for (const Eigen::VectorXd& q : configurations)
    for (Eigen::VectorXd& turned : turns.of(q, middle)) out.push_back(std::move(turned));
  return out;
}

}  // namespace mmgrasp::detail
