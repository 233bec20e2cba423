#include "mmgrasp/robot/detail/ik_candidates.hpp"

#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/robot/detail/ik_descent.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kSame = 1e-4;  // [rad] Branches nearer than this are one: they have met in a singularity.

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

/// Whole turns bring a value nearest to the middle of its limits.
void turn_inside(const JointGroup& group, Eigen::VectorXd& q) {
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const double lower = group.lower()[i], upper = group.upper()[i];
    const double middle = std::isfinite(lower) && std::isfinite(upper) ? 0.5 * (lower + upper) : 0.0;
    q[i] = middle + wrap_angle(q[i] - middle);
    // A value on its limit may have come out a rounding beyond it.
    constexpr double kRounding = 1e-9;
    if (q[i] < lower && q[i] > lower - kRounding) q[i] = lower;
    if (q[i] > upper && q[i] < upper + kRounding) q[i] = upper;
  }
}

bool known(const std::vector<Eigen::VectorXd>& all, std::size_t first, const Eigen::VectorXd& q) {
  for (std::size_t i = first; i < all.size(); ++i) {
    double largest = 0;
    for (Eigen::Index j = 0; j < q.size(); ++j) largest = std::max(largest, std::abs(wrap_angle(q[j] - all[i][j])));
    if (largest < kSame) return true;
  }
  return false;
}

}  // namespace

Candidates closed_form_candidates(const JointGroup& group, const Pose& T_world_tip, int values) {
  Candidates candidates;
  const Screws screws = screws_of(group);
  if (screws.size == 0) return candidates;
  const int locked = screws.size == 7 ? redundant_joint(screws) : -1;
  ClosedForm form;
  if (screws.size == 6) form = closed_form_of(screws);
  candidates.known_form = locked >= 0 || form.family != ClosedForm::Family::none;
  if (!candidates.known_form) return candidates;
  candidates.redundant_joint = locked;
  const Rigid target = Rigid(T_world_tip) * screws.tip.inverse();
  double lower = 0, cell = 0;
  if (locked >= 0) {
    lower = group.sample_lower()[locked];
    cell = (group.sample_upper()[locked] - lower) / values;
  } else {
    values = 1;
  }
  IkWorkspace workspace;
  Branches branches;
  Eigen::VectorXd q(screws.size);
  for (int i = 0; i < values; ++i) {
    Rigid G = target;
    double locked_value = 0;
    if (locked >= 0) {
      locked_value = lower + (i + 0.5) * cell;
      const Screws six = lock_joint(screws, locked, locked_value, G);
      solve_closed_form(closed_form_of(six), six, G, branches);
    } else {
      solve_closed_form(form, screws, G, branches);
    }
    candidates.free = candidates.free || branches.free;
    const std::size_t first = candidates.q.size();
    for (int b = 0; b < branches.count; ++b) {
      const auto& value = branches.value[b];
      for (int j = 0; j < screws.size; ++j)
        q[j] = j == locked ? locked_value : value[locked >= 0 && j > locked ? j - 1 : j];
      if (!polish(group, T_world_tip, q, workspace)) continue;
      turn_inside(group, q);
      if (!known(candidates.q, first, q)) candidates.q.push_back(q);
    }
    candidates.without += candidates.q.size() == first;
  }
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
