#include "mmgrasp/robot/detail/ik_candidates.hpp"

#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/robot/detail/ik_descent.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kSameBranch = 1e-4;  // Branches nearer than this are one, they met in a singularity [rad].

/// Newton's method on the true chain, without limits: the closed form is exact for ideal geometry only.
bool polish(const JointGroup& group, const Pose& T_world_tip, Eigen::VectorXd& q, IkWorkspace& workspace) {
  static const IkOptions exact = [] {
    IkOptions options;
    options.position_tolerance = 1e-9;
    options.rotation_tolerance = 1e-9;
    options.max_iterations = 30;
    return options;
  }();
  return descend(group, T_world_tip, q, exact, workspace, false).converged;
}

}  // namespace

ClosedFormSolver::ClosedFormSolver(const JointGroup& group, int values) : group_(group), screws_(screws_of(group)) {
  if (screws_.size == 0) return;
  locked_ = screws_.size == 7 ? mmgrasp::detail::redundant_joint(screws_) : -1;
  if (screws_.size == 6) form_ = closed_form_of(screws_);
  known_form_ = locked_ >= 0 || form_.family != ClosedForm::Family::none;
  if (locked_ >= 0) {
    values_ = values;
    lower_ = group.sample_lower()[locked_];
    cell_ = (group.sample_upper()[locked_] - lower_) / values;
  }
  q_.resize(screws_.size);
  middle_ = Eigen::VectorXd::Zero(screws_.size);
  for (int i = 0; i < screws_.size; ++i) {
    const double lower = group.lower()[i], upper = group.upper()[i];
    if (std::isfinite(lower) && std::isfinite(upper)) middle_[i] = 0.5 * (lower + upper);
  }
}

/// Whole turns bring a value nearest to the middle of its limits.
void ClosedFormSolver::turn_inside(Eigen::VectorXd& q) const {
  const Eigen::VectorXd &lowest = group_.lower(), &highest = group_.upper();
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const double lower = lowest[i], upper = highest[i];
    const double from_middle = q[i] - middle_[i];
    q[i] = middle_[i] + (std::abs(from_middle) < kPi ? from_middle : wrap_angle(from_middle));
    // A value on its limit may have come out a rounding beyond it.
    constexpr double kRounding = 1e-9;
    if (q[i] < lower && q[i] > lower - kRounding) q[i] = lower;
    if (q[i] > upper && q[i] < upper + kRounding) q[i] = upper;
  }
}

/// The branch has met another one of the first `count` kept in a singularity.
bool ClosedFormSolver::known(std::size_t count) const {
  for (std::size_t i = 0; i < count; ++i) {
    double largest = 0;
    for (Eigen::Index j = 0; j < q_.size() && largest < kSameBranch; ++j) {
      const double difference = std::abs(q_[j] - kept_[i][j]);  // both within half a turn of the middle
      largest = std::max(largest, std::min(difference, std::abs(kTwoPi - difference)));
    }
    if (largest < kSameBranch) return true;
  }
  return false;
}

ClosedFormSolver::Counts ClosedFormSolver::solve(const Pose& T_world_tip, double outside, const Use& use) {
  Counts counts;
  if (!known_form_) return counts;
  const Rigid target = Rigid(T_world_tip) * screws_.tip.inverse();
  Branches branches;
  for (int i = 0; i < values_; ++i) {
    Rigid G = target;
    double locked_value = 0;
    if (locked_ >= 0) {
      locked_value = lower_ + (i + 0.5) * cell_;
      const Screws six = lock_joint(screws_, locked_, locked_value, G);
      solve_closed_form(closed_form_of(six), six, G, branches);
    } else {
      solve_closed_form(form_, screws_, G, branches);
    }
    counts.free = counts.free || branches.free;
    std::size_t kept = 0;
    bool any = false;
    for (int b = 0; b < branches.count; ++b) {
      const auto& value = branches.value[b];
      for (int j = 0; j < screws_.size; ++j)
        q_[j] = j == locked_ ? locked_value : value[locked_ >= 0 && j > locked_ ? j - 1 : j];
      if (outside < kInfinity) {
        turn_inside(q_);
        if (!group_.within_limits(q_, outside)) {
          ++counts.far;
          any = true;
          continue;
        }
      }
      if (!polish(group_, T_world_tip, q_, workspace_)) continue;
      turn_inside(q_);
      if (known(kept)) continue;
      if (kept == kept_.size()) kept_.emplace_back();
      kept_[kept++] = q_;
      any = true;
      use(q_, workspace_.J);
    }
    counts.without += !any;
  }
  return counts;
}

Candidates closed_form_candidates(const JointGroup& group, const Pose& T_world_tip, int values) {
  Candidates candidates;
  ClosedFormSolver solver(group, values);
  candidates.known_form = solver.known_form();
  candidates.redundant_joint = solver.redundant_joint();
  const ClosedFormSolver::Counts counts = solver.solve(
      T_world_tip, kInfinity, [&](const Eigen::VectorXd& q, const Matrix6Xd&) { candidates.q.push_back(q); });
  candidates.without = counts.without;
  candidates.free = counts.free;
  return candidates;
}

double joint_distance(const JointGroup& group, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double sum = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const double d = group.wraps()[i] ? wrap_angle(a[i] - b[i]) : a[i] - b[i];
    sum += d * d;
  }
  return std::sqrt(sum);
}

Eigen::VectorXd turned_towards(const JointGroup& group, const Eigen::VectorXd& q, const Eigen::VectorXd& reference) {
  Eigen::VectorXd turned = q;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    double near = reference[i] + wrap_angle(q[i] - reference[i]);
    if (near < group.lower()[i]) near += kTwoPi;
    if (near > group.upper()[i]) near -= kTwoPi;
    if (near >= group.lower()[i] && near <= group.upper()[i]) turned[i] = near;
  }
  return turned;
}

double limit_violation(const JointGroup& group, const Eigen::VectorXd& q) {
  return (group.lower() - q).cwiseMax(q - group.upper()).cwiseMax(0).sum();
}

}  // namespace mmgrasp::detail
