#include "mmgrasp/robot/ik.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/robot/detail/ik_candidates.hpp"
#include "mmgrasp/robot/detail/ik_descent.hpp"
#include "mmgrasp/robot/detail/ik_failure.hpp"
#include "mmgrasp/robot/detail/ik_starts.hpp"
#include "mmgrasp/robot/ik_objective.hpp"
#include "robot/ik/ik_null_space.hpp"

namespace mmgrasp {
namespace {

/// One call of solve_ik.
class Search {
 public:
  Search(const JointGroup& group, const Pose& T_world_tip, const Eigen::VectorXd& seed, const IkOptions& options,
         const ConfigurationFilter& valid)
      : group_(group), target_(T_world_tip), seed_(seed), options_(options), valid_(valid) {
    detail::confirm(group, T_world_tip, seed, options, result_.position_error, result_.rotation_error);
  }

  IkResult& result() { return result_; }

  /// Descends from q; true when that solved it.
  bool descent(Eigen::VectorXd q) {
    const detail::DescentEnd end = detail::descend(group_, target_, q, options_, workspace_, true);
    result_.iterations += end.iterations;
    const double score =
        end.position_error / options_.position_tolerance + end.rotation_error / options_.rotation_tolerance;
    if (score < best_) {
      best_ = score;
      result_.position_error = end.position_error;
      result_.rotation_error = end.rotation_error;
    }
    if (!end.converged) {
      result_.rejections.add(cause_.of(group_, target_, q, options_, workspace_));
      return false;
    }
    detail::unwind(group_, seed_, q);
    return accept(q);
  }

  /// The closed form, when the arm has one: branches inside limits, the least total cost of the objectives first, then
  /// the nearest to the seed; then descents from those that stick out of the limits least. True when that solved it.
  bool closed_form() {
    const detail::Candidates candidates = detail::closed_form_candidates(group_, target_, kRedundantValues);
    if (!candidates.known_form) return false;
    std::vector<Ranked> inside, outside;
    for (const Eigen::VectorXd& q : candidates.q) {
      const double violation = detail::limit_violation(group_, q);
      if (violation > 0) {
        outside.push_back({violation, 0, q});
        continue;
      }
      const Eigen::VectorXd near = detail::turned_towards(group_, q, seed_);
      inside.push_back(ranked(near));
      // A whole turn may change the cost, but no distance to the seed for the better.
      if (!options_.objectives.empty() && near != q) inside.push_back(ranked(q));
    }
    std::sort(inside.begin(), inside.end());
    std::sort(outside.begin(), outside.end());
    for (const Ranked& branch : inside)
      if (accept(branch.q)) return true;
    for (std::size_t i = 0; i < std::min(outside.size(), kNearlyInside); ++i)
      if (descent(outside[i].q)) return true;
    return false;
  }

 private:
  static constexpr int kRedundantValues = 24;
  static constexpr std::size_t kNearlyInside = 6;

  struct Ranked {
    double first, second;
    Eigen::VectorXd q;
    bool operator<(const Ranked& other) const {
      return first != other.first ? first < other.first : second < other.second;
    }
  };

  Ranked ranked(const Eigen::VectorXd& q) const {
    Eigen::ArrayXd way = (q - seed_).array().square();
    for (std::size_t i = 0; i < options_.joint_weights.size(); ++i)
      way[static_cast<Eigen::Index>(i)] *= options_.joint_weights[i];
    return {detail::total_cost(options_.objectives, q), way.sum(), q};
  }

  bool accept(Eigen::VectorXd q) {
    const Rejection verdict = valid_ ? valid_(q) : Rejection::none;
    if (verdict != Rejection::none) {
      result_.rejections.add(verdict);
      return false;
    }
    double position_error = 0, rotation_error = 0;
    if (!detail::confirm(group_, target_, q, options_, position_error, rotation_error)) {
      result_.rejections.add(Rejection::unreachable);
      return false;
    }
    if (!options_.objectives.empty()) {
      Eigen::VectorXd slid = q;
      double cost =
          detail::slide_along_solutions(group_, target_, options_, valid_, workspace_, slid, result_.iterations);
      double slid_position_error = 0, slid_rotation_error = 0;
      if (detail::confirm(group_, target_, slid, options_, slid_position_error, slid_rotation_error)) {
        q = slid;
        position_error = slid_position_error;
        rotation_error = slid_rotation_error;
      } else {
        cost = detail::total_cost(options_.objectives, q);
      }
      result_.objective = cost;
    }
    result_.outcome = Outcome::solved;
    result_.q = q;
    result_.position_error = position_error;
    result_.rotation_error = rotation_error;
    return true;
  }

  const JointGroup& group_;
  const Pose& target_;
  const Eigen::VectorXd& seed_;
  const IkOptions& options_;
  const ConfigurationFilter& valid_;
  IkResult result_;
  IkWorkspace workspace_;
  detail::FailureCause cause_;
  double best_ = detail::kInfinity;
};

}  // namespace

namespace detail {

void check_target(const JointGroup& group, const Pose& T_world_tip, const IkOptions& options) {
  options.check();
  if (!options.joint_weights.empty())
    require(static_cast<int>(options.joint_weights.size()) == group.size(), "ik.joint_weights length",
            static_cast<double>(options.joint_weights.size()),
            "must be " + std::to_string(group.size()) + " (group \"" + group.name() + "\")");
  for (std::size_t i = 0; i < options.objectives.size(); ++i)
    require(options.objectives[i]->size() == group.size(), "ik.objectives[" + std::to_string(i) + "] length",
            options.objectives[i]->size(),
            "must be " + std::to_string(group.size()) + " (group \"" + group.name() + "\")");
  checked_pose(T_world_tip.matrix(), "T_world_tip (group \"" + group.name() + "\")");
}

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

}  // namespace detail

void IkOptions::check() const {
  require_positive(position_tolerance, "ik.position_tolerance", "m");
  require_positive(rotation_tolerance, "ik.rotation_tolerance", "rad");
  require_count(max_iterations, "ik.max_iterations");
  require_count(restarts, "ik.restarts", 0);
  require_positive(time_limit, "ik.time_limit", "s", detail::kInfinity);
  for (std::size_t i = 0; i < joint_weights.size(); ++i)
    if (!(joint_weights[i] > 0 && joint_weights[i] <= kLargestNumber))
      require_positive(joint_weights[i], "ik.joint_weights[" + std::to_string(i) + "]", "", kLargestNumber);
  for (std::size_t i = 0; i < objectives.size(); ++i)
    if (!objectives[i]) throw InvalidInput("ik.objectives[" + std::to_string(i) + "]: must not be empty");
  require_count(objective_iterations, "ik.objective_iterations", 0);
}

IkResult solve_ik(const JointGroup& group, const Pose& T_world_tip, const Eigen::VectorXd& seed,
                  const IkOptions& options, const ConfigurationFilter& valid, const Monitor& monitor) {
  detail::check_target(group, T_world_tip, options);
  group.check_configuration(seed, "seed");
  Search search(group, T_world_tip, seed, options, valid);
  IkResult& result = search.result();
  if (!detail::maybe_in_reach(group, T_world_tip.translation(), options.position_tolerance)) {
    result.outcome = Outcome::infeasible;
    result.rejections.add(Rejection::unreachable);
    return result;
  }
  // Six joints: every branch, for less than a descent takes. Seven: two descents solve nearly every pose that has room,
  // for less than sampling the redundant joint takes.
  const bool six = detail::screws_of(group).size == 6;
  double position_error = 0, rotation_error = 0;
  const bool there = detail::confirm(group, T_world_tip, seed, options, position_error, rotation_error);
  // A seed that solves is kept unless objectives want to know of other branches, or the filter refuses it.
  const int descents_before_closed_form = !six ? 2 : there && options.objectives.empty() ? 1 : 0;
  const detail::TimeLimit time_limit(options.time_limit);
  detail::IkStarts starts(group, T_world_tip, options.seed);
  for (int attempt = 0; attempt <= std::max(options.restarts, six ? descents_before_closed_form : 0); ++attempt) {
    if (monitor.stopped() || (attempt > 0 && time_limit.expired())) {
      result.outcome = monitor.stopped() ? Outcome::stopped : Outcome::timeout;
      return result;
    }
    // A singular pose leaves the closed form one of infinitely many splits: descents may still find another.
    if (attempt == descents_before_closed_form && search.closed_form()) return result;
    if (attempt <= options.restarts && search.descent(attempt == 0 ? seed : starts.next())) return result;
  }
  return result;
}

}  // namespace mmgrasp
