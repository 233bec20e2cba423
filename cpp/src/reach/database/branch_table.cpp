#include "reach/database/branch_table.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mmgrasp/core/pose.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

/// Screws of the turning columns at `at`.
LockedArm locked_at(const JointGroup& arm, const std::vector<int>& turning, const Eigen::VectorXd& at) {
  LockedArm locked;
  locked.at = at;
  Pose T_world_tip;
  Matrix6Xd J(6, arm.size());
  arm.fk_jacobian(at, T_world_tip, J);
  locked.six.size = static_cast<int>(turning.size());
  for (std::size_t i = 0; i < turning.size(); ++i) {
    const Vector3d v = J.col(turning[i]).head<3>(), w = J.col(turning[i]).tail<3>();
    locked.six.h[i] = w;
    locked.six.p[i] = T_world_tip.translation() - v.cross(w);
  }
  locked.six.tip = Rigid(T_world_tip);
  locked.tip_inverse = locked.six.tip.inverse();
  locked.form = closed_form_of(locked.six);
  return locked;
}

/// Columns that turn the tip, by their Jacobian at zero; empty when one does neither turn nor slide.
bool turns(const Matrix6Xd& J, int column) {
  return std::abs(J.col(column).tail<3>().norm() - 1) < 1e-9;
}

/// What holds at these values, which are nothing special, holds at all.
bool form_everywhere(const JointGroup& arm, const std::vector<int>& turning, const std::vector<int>& locked) {
  for (const double share : {0.31, 0.47, 0.83}) {
    Eigen::VectorXd at = Eigen::VectorXd::Zero(arm.size());
    for (const int column : locked)
      at[column] = arm.sample_lower()[column] + share * (arm.sample_upper()[column] - arm.sample_lower()[column]);
    if (locked_at(arm, turning, at).form.family == ClosedForm::Family::none) return false;
  }
  return true;
}

/// Which columns to lock so that six turning ones with a closed form are left; false when there are none.
bool choose(const JointGroup& arm, std::vector<int>& locked, std::vector<int>& turning) {
  const int n = arm.size();
  if (arm.has_base() || n < 6 || n > 8 || !one_joint_a_column(arm)) return false;
  Pose T;
  Matrix6Xd J(6, n);
  arm.fk_jacobian(Eigen::VectorXd::Zero(n), T, J);
  std::vector<int> turning_all, sliding;
  for (int i = 0; i < n; ++i) (turns(J, i) ? turning_all : sliding).push_back(i);
  if (turning_all.size() < 6 || turning_all.size() > 7) return false;
  const auto fits = [&](int extra) {
    locked = sliding;
    turning.clear();
    for (const int column : turning_all) (column == extra ? locked : turning).push_back(column);
    return form_everywhere(arm, turning, locked);
  };
  if (turning_all.size() == 6) return fits(-1);
  for (const int extra : turning_all)
    if (fits(extra)) return true;
  return false;
}

}  // namespace

BranchTable::BranchTable(const JointGroup& arm, int samples) : arm_(arm) {
  if (!choose(arm, locked_, turning_)) {
    locked_.clear();
    return;
  }
  lower_ = arm.lower();
  upper_ = arm.upper();
  middle_ = 0.5 * (arm.sample_lower() + arm.sample_upper());
  constexpr int kUsual[] = {1, 64, 128};
  if (samples == 0) samples = kUsual[locked_.size()];
  if (locked_.empty()) samples = 1;
  // Additive sequence with the powers of the root of x^(d+1) = x + 1: evenly spread however far it goes.
  const auto d = static_cast<double>(locked_.size());
  double root = 1.5;
  for (int i = 0; i < 40; ++i) root = std::pow(1 + root, 1 / (d + 1));
  std::vector<Eigen::VectorXd> shares;
  for (int s = 0; s < samples; ++s) {
    Eigen::VectorXd at = Eigen::VectorXd::Zero(arm.size()), share(locked_.size());
    double step = 1;
    for (std::size_t i = 0; i < locked_.size(); ++i) {
      step /= root;
      const double position = 0.5 + s * step;
      share[static_cast<Eigen::Index>(i)] = position - std::floor(position);
      const int column = locked_[i];
      at[column] = arm.sample_lower()[column] +
                   share[static_cast<Eigen::Index>(i)] * (arm.sample_upper()[column] - arm.sample_lower()[column]);
    }
    shares.push_back(share);
    arms_.push_back(locked_at(arm, turning_, at));
  }
  for (int s = 0; s < samples; ++s) {
    std::vector<int> order(samples);
    std::iota(order.begin(), order.end(), 0);
    const auto distance = [&](int other) { return (shares[other] - shares[s]).squaredNorm(); };
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return distance(a) < distance(b); });
    orders_.push_back(std::move(order));
  }
}

LockedArm BranchTable::lock(const Eigen::VectorXd& q) const {
  Eigen::VectorXd at = Eigen::VectorXd::Zero(arm_.size());
  for (const int column : locked_) at[column] = q[column];
  return locked_at(arm_, turning_, at);
}

double BranchTable::fill(const std::array<double, Screws::kMaxJoints>& values, const LockedArm& arm,
                         Eigen::VectorXd& q) const {
  constexpr double kRounding = 1e-6;  // the solver's and the geometry's; what is accepted is held to limits later
  q = arm.at;
  double outside = 0;
  for (std::size_t i = 0; i < turning_.size(); ++i) {
    const int column = turning_[i];
    const double value = middle_[column] + wrap_angle(values[i] - middle_[column]);
    q[column] = std::clamp(value, lower_[column], upper_[column]);
    const double over = std::abs(value - q[column]);
    if (over > kRounding) outside += over;
  }
  return outside;
}

}  // namespace mmgrasp::detail
