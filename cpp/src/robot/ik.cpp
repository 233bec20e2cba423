#include "mmgrasp/robot/ik.hpp"

#include <chrono>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "robot/ik_descent.hpp"
#include "robot/joint_group_data.hpp"

namespace mmgrasp {
namespace {

class Clock {
 public:
  explicit Clock(double limit) : limit_(limit), start_(std::chrono::steady_clock::now()) {}
  bool over() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count() > limit_;
  }

 private:
  double limit_;
  std::chrono::steady_clock::time_point start_;
};

/// Random start. A base starts somewhere from where the arm could reach, not anywhere in the workspace.
Eigen::VectorXd random_start(const JointGroup& group, const Eigen::Vector3d& target, Rng& rng) {
  Eigen::VectorXd lower = group.sample_lower(), upper = group.sample_upper();
  if (group.has_base()) {
    const detail::GroupModel& model = *group.data().model;
    const double radius = std::min(model.reach + model.first_joint.norm(), group.robot().base_limits().workspace);
    for (int i = 0; i < 2; ++i) {
      lower[i] = std::max(lower[i], target[i] - radius);
      upper[i] = std::max(lower[i], std::min(upper[i], target[i] + radius));
    }
  }
  return rng.uniform(lower, upper);
}

/// Angles without limits are taken the way that is nearest to the seed.
void unwind(const JointGroup& group, const Eigen::VectorXd& seed, Eigen::VectorXd& q) {
  for (Eigen::Index i = 0; i < q.size(); ++i)
    if (group.wraps()[static_cast<std::size_t>(i)]) q[i] = seed[i] + wrap_angle(q[i] - seed[i]);
}

/// Tells "out of reach" from "reached only outside joint limits" by going on without limits from where a descent
/// failed.
class FailureCause {
 public:
  Rejection of(const JointGroup& group, const Pose& T_world_tip, Eigen::VectorXd q, const IkOptions& options,
               IkWorkspace& workspace) {
    if (!reached_ && tries_ < kTries) {
      ++tries_;
      reached_ = detail::descend(group, T_world_tip, q, options, workspace, false).converged;
    }
    return reached_ ? Rejection::limits : Rejection::reach;
  }

 private:
  static constexpr int kTries = 3;  // the answer belongs to the pose: no need to ask again for each of 30 descents
  int tries_ = 0;
  bool reached_ = false;
};

void check_target(const JointGroup& group, const Pose& T_world_tip, const IkOptions& options) {
  options.check();
  checked_pose(T_world_tip.matrix(), "T_world_tip (group \"" + group.name() + "\")");
}

/// True when forward kinematics and the limits confirm q; fills the errors.
bool confirm(const JointGroup& group, const Pose& T_world_tip, const Eigen::VectorXd& q, const IkOptions& options,
             double& position_error, double& rotation_error) {
  const Vector6d error = pose_difference(group.fk(q), T_world_tip);
  position_error = error.head<3>().norm();
  rotation_error = error.tail<3>().norm();
  // Unwinding an angle changes it by roundings, which may lift an error that stood right at its bound.
  constexpr double kRounding = 1 + 1e-6;
  return position_error <= options.position_tolerance * kRounding &&
         rotation_error <= options.rotation_tolerance * kRounding && group.within_limits(q);
}

double joint_distance(const JointGroup& group, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double sum = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const double d = group.wraps()[static_cast<std::size_t>(i)] ? wrap_angle(a[i] - b[i]) : a[i] - b[i];
    sum += d * d;
  }
  return std::sqrt(sum);
}

}  // namespace

void IkOptions::check() const {
  const auto positive = [](double value, const char* field) {
    require(std::isfinite(value) && value > 0, std::string("ik.") + field, value, "must be positive and finite");
  };
  positive(position_tolerance, "position_tolerance");
  positive(rotation_tolerance, "rotation_tolerance");
  require(max_iterations > 0, "ik.max_iterations", max_iterations, "must be positive");
  require(restarts >= 0, "ik.restarts", restarts, "must not be negative");
  require(time_limit > 0, "ik.time_limit", time_limit, "must be positive");
}

IkResult solve_ik(const JointGroup& group, const Pose& T_world_tip, const Eigen::VectorXd& seed,
                  const IkOptions& options, const ConfigurationFilter& valid, const Monitor& monitor) {
  check_target(group, T_world_tip, options);
  group.check_configuration(seed, "seed");
  IkResult result;
  confirm(group, T_world_tip, seed, options, result.position_error, result.rotation_error);
  if (!detail::maybe_in_reach(group, T_world_tip.translation())) {
    result.rejections.add(Rejection::reach);
    return result;
  }
  const Clock clock(options.time_limit);
  Rng rng(options.seed);
  IkWorkspace workspace;
  FailureCause cause;
  double best = std::numeric_limits<double>::infinity();
  Eigen::VectorXd q = seed;
  for (int attempt = 0; attempt <= options.restarts; ++attempt) {
    if (monitor.stopped() || (attempt > 0 && clock.over())) {
      result.outcome = monitor.stopped() ? Outcome::stopped : Outcome::timeout;
      return result;
    }
    if (attempt > 0) q = random_start(group, T_world_tip.translation(), rng);
    const detail::DescentEnd end = detail::descend(group, T_world_tip, q, options, workspace, true);
    result.iterations += end.iterations;
    const double score =
        end.position_error / options.position_tolerance + end.rotation_error / options.rotation_tolerance;
    if (score < best) {
      best = score;
      result.position_error = end.position_error;
      result.rotation_error = end.rotation_error;
    }
    if (!end.converged) {
      result.rejections.add(cause.of(group, T_world_tip, q, options, workspace));
      continue;
    }
    unwind(group, seed, q);
    const Rejection verdict = valid ? valid(q) : Rejection::none;
    if (verdict != Rejection::none) {
      result.rejections.add(verdict);
      continue;
    }
    double position_error = 0, rotation_error = 0;
    if (!confirm(group, T_world_tip, q, options, position_error, rotation_error)) {
      result.rejections.add(Rejection::reach);
      continue;
    }
    result.outcome = Outcome::solved;
    result.q = q;
    result.position_error = position_error;
    result.rotation_error = rotation_error;
    return result;
  }
  return result;
}

std::vector<Eigen::VectorXd> solve_ik_all(const JointGroup& group, const Pose& T_world_tip, int count,
                                          const IkOptions& options, const ConfigurationFilter& valid) {
  check_target(group, T_world_tip, options);
  require(count >= 0, "count", count, "must not be negative");
  constexpr double kDistinct = 0.1;  // [rad]
  std::vector<Eigen::VectorXd> solutions;
  if (!detail::maybe_in_reach(group, T_world_tip.translation())) return solutions;
  const Clock clock(options.time_limit);
  const Eigen::VectorXd middle = Eigen::VectorXd::Zero(group.size());
  Rng rng(options.seed);
  IkWorkspace workspace;
  const long budget = static_cast<long>(options.restarts + 1) * count;
  for (long attempt = 0; attempt < budget && static_cast<int>(solutions.size()) < count && !clock.over(); ++attempt) {
    Eigen::VectorXd q = random_start(group, T_world_tip.translation(), rng);
    if (!detail::descend(group, T_world_tip, q, options, workspace, true).converged) continue;
    unwind(group, middle, q);
    bool known = false;
    for (const Eigen::VectorXd& other : solutions) known = known || joint_distance(group, q, other) <= kDistinct;
    if (known || (valid && valid(q) != Rejection::none)) continue;
    double position_error = 0, rotation_error = 0;
    if (confirm(group, T_world_tip, q, options, position_error, rotation_error)) solutions.push_back(std::move(q));
  }
  return solutions;
}

}  // namespace mmgrasp
