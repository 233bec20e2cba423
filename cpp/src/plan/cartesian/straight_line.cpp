#include "mmgrasp/plan/straight_line.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "plan/motion/beyond_limits.hpp"
#include "plan/motion/steered_base.hpp"

namespace mmgrasp {
namespace {

constexpr double kAtLimit = 1e-6;        // A joint value this close to its limit counts as stopped by it [rad or m].
constexpr double kLineTolerance = 5e-5;  // Tool's distance from the line halfway between two waypoints [m].
constexpr int kMaxHalvings = 6;          // Halvings of a step that keep the tool on the line between waypoints.

/// Positions on a line, rotations by slerp.
class CartesianLine {
 public:
  CartesianLine(const Pose& from, const Pose& to)
      : from_(from), to_(to), rotation_from_(from.linear()), rotation_to_(to.linear()) {}

  double translation() const { return (to_.translation() - from_.translation()).norm(); }
  double rotation() const { return rotation_distance(from_, to_); }

  Pose at(double fraction) const {
    if (fraction >= 1) return to_;
    Pose pose = Pose::Identity();
    pose.translation() = from_.translation() + fraction * (to_.translation() - from_.translation());
    pose.linear() = rotation_from_.slerp(fraction, rotation_to_).toRotationMatrix();
    return pose;
  }

 private:
  Pose from_, to_;
  Eigen::Quaterniond rotation_from_, rotation_to_;
};

/// Number of steps: at least one, and few enough to count in 64 bits.
std::int64_t step_count(double steps) {
  return static_cast<std::int64_t>(std::clamp(std::ceil(steps), 1.0, 1e15));
}

/// Follows a straight line of the tool waypoint by waypoint, halving steps whose middle would leave it.
class LineFollower {
 public:
  LineFollower(CollisionChecker& checker, const Eigen::VectorXd& start, const Pose& goal,
               const StraightLineOptions& options, const Monitor& monitor)
      : checker_(checker),
        group_(checker.group()),
        options_(options),
        monitor_(monitor),
        line_(group_.fk(start), goal) {
    path_.waypoints.push_back(start);
  }

  StraightLineResult run() {
    result_.cause = checker_.rejection(path_.waypoints.front());
    if (result_.cause != Rejection::none) {
      result_.outcome = Outcome::invalid_start;
      if (result_.cause == Rejection::limits)
        result_.beyond_limits = detail::beyond_limits(group_, path_.waypoints.front());
      note_contact(path_.waypoints.front());
      return std::move(result_);
    }
    const double steps =
        std::max(line_.translation() / options_.position_step, line_.rotation() / options_.rotation_step);
    const std::int64_t count = step_count(steps - 1e-9);
    smallest_step_ = 1.0 / static_cast<double>(count) / (1 << kMaxHalvings);
    for (std::int64_t i = 1; i <= count; ++i) {
      if (!advance(static_cast<double>(i) / static_cast<double>(count))) {
        if (monitor_.stopped()) result_.outcome = Outcome::stopped;
        return std::move(result_);
      }
      monitor_.report("straight line", result_.fraction);
    }
    result_.outcome = Outcome::solved;
    result_.path = std::move(path_);
    return std::move(result_);
  }

 private:
  /// Moves from the last waypoint to `fraction`, halving the step where the tool would leave the line in between.
  bool advance(double fraction) {
    if (monitor_.stopped()) return false;
    Eigen::VectorXd next = first_guess(fraction);
    if (!refine_ik(group_, line_.at(fraction), next, options_.ik, workspace_)) {
      next = path_.waypoints.back();
      if (!refine_ik(group_, line_.at(fraction), next, options_.ik, workspace_)) return fail(reach_or_limits(next));
    }
    const Eigen::VectorXd& previous = path_.waypoints.back();
    if ((next - previous).cwiseAbs().maxCoeff() > options_.jump_threshold) return fail(Rejection::unreachable);
    const double middle = 0.5 * (result_.fraction + fraction);
    if (off_line(0.5 * (previous + next), middle) > std::max(kLineTolerance, 2 * options_.ik.position_tolerance)) {
      if (fraction - result_.fraction < 1.5 * smallest_step_) return fail(Rejection::unreachable);
      return advance(middle) && advance(fraction);
    }
    if (!edge_is_free(previous, next)) return false;
    velocity_ = (next - previous) / (fraction - result_.fraction);
    path_.waypoints.push_back(next);
    result_.fraction = fraction;
    return true;
  }

  /// The previous motion continued, within limits.
  Eigen::VectorXd first_guess(double fraction) const {
    const Eigen::VectorXd& previous = path_.waypoints.back();
    if (velocity_.size() == 0) return previous;
    const Eigen::VectorXd guess = previous + (fraction - result_.fraction) * velocity_;
    return guess.cwiseMax(group_.lower()).cwiseMin(group_.upper());
  }

  double off_line(const Eigen::VectorXd& q, double fraction) const {
    return (group_.fk(q).translation() - line_.at(fraction).translation()).norm();
  }

  Rejection reach_or_limits(const Eigen::VectorXd& q) const {
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      if (q[i] <= group_.lower()[i] + kAtLimit || q[i] >= group_.upper()[i] - kAtLimit) return Rejection::limits;
    }
    return Rejection::unreachable;
  }

  /// Records the cause when the edge is not free. False when stopped, too.
  bool edge_is_free(const Eigen::VectorXd& from, const Eigen::VectorXd& to) {
    const double step = options_.joint_step / 8;
    const std::int64_t count = step_count((to - from).cwiseAbs().maxCoeff() / step);
    for (std::int64_t i = 1; i <= count; ++i) {
      if (monitor_.stopped()) return false;
      const Eigen::VectorXd q = from + (static_cast<double>(i) / static_cast<double>(count)) * (to - from);
      const Rejection cause = checker_.rejection(q);
      if (cause == Rejection::none) continue;
      if (cause != Rejection::limits) note_contact(q);
      return fail(cause);
    }
    return true;
  }

  void note_contact(const Eigen::VectorXd& q) { result_.contact = checker_.first_contact(q); }

  bool fail(Rejection cause) {
    result_.cause = cause;
    result_.outcome = Outcome::not_found;
    return false;
  }

  CollisionChecker& checker_;
  const JointGroup group_;
  const StraightLineOptions& options_;
  const Monitor& monitor_;
  const CartesianLine line_;
  JointPath path_;
  double smallest_step_ = 0;
  Eigen::VectorXd velocity_;  // Joint motion per fraction of the line; empty before the first step.
  IkWorkspace workspace_;
  StraightLineResult result_;
};

}  // namespace

void StraightLineOptions::check() const {
  const auto positive = [](double value, const char* field) { require_positive(value, field); };
  positive(position_step, "position_step");
  positive(rotation_step, "rotation_step");
  positive(jump_threshold, "jump_threshold");
  positive(joint_step, "joint_step");
  ik.check();
}

StraightLineResult plan_straight_line(CollisionChecker& checker, const Eigen::VectorXd& q_start, const Pose& T_world_to,
                                      const StraightLineOptions& options, const Monitor& monitor) {
  options.check();
  detail::refuse_steered_base(checker.group(), "plan_straight_line");
  checker.group().check_configuration(q_start, "q_start");
  const Pose goal = checked_pose(T_world_to.matrix(), "T_world_to");
  return LineFollower(checker, q_start, goal, options, monitor).run();
}

}  // namespace mmgrasp
