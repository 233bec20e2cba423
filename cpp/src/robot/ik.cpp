#include "mmgrasp/robot/ik.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/ik_objective.hpp"
#include "robot/ik_candidates.hpp"
#include "robot/ik_descent.hpp"
#include "robot/ik_null_space.hpp"
#include "robot/ik_starts.hpp"

namespace mmgrasp {
namespace {

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

  /// The closed form, when the arm has one: branches inside limits, nearest to the seed first; with seven joints then
  /// descents from those that stick out least. Returns true when nothing is left to try: solved, or every branch of six
  /// joints turned down.
  bool closed_form() {
    const detail::Candidates candidates = detail::closed_form_candidates(group_, target_, kRedundantValues);
    if (!candidates.known_form) return false;
    std::vector<std::pair<double, Eigen::VectorXd>> inside, outside;
    for (const Eigen::VectorXd& q : candidates.q) {
      const double violation = detail::limit_violation(group_, q);
      if (violation > 0) {
        outside.emplace_back(violation, q);
        continue;
      }
      const Eigen::VectorXd near = detail::turned_towards(group_, q, seed_);
      inside.emplace_back((near - seed_).squaredNorm(), near);
    }
    const auto nearer = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::sort(inside.begin(), inside.end(), nearer);
    std::sort(outside.begin(), outside.end(), nearer);
    for (const auto& [distance, q] : inside)
      if (accept(q)) return true;
    if (candidates.redundant_joint < 0) {
      result_.rejections.add(Rejection::limits, outside.size());
      return !candidates.q.empty();
    }
    for (std::size_t i = 0; i < std::min(outside.size(), kNearlyInside); ++i)
      if (descent(outside[i].second)) return true;
    return false;
  }

 private:
  static constexpr int kRedundantValues = 24;
  static constexpr std::size_t kNearlyInside = 6;

  bool accept(Eigen::VectorXd q) {
    const Rejection verdict = valid_ ? valid_(q) : Rejection::none;
    if (verdict != Rejection::none) {
      result_.rejections.add(verdict);
      return false;
    }
    double position_error = 0, rotation_error = 0;
    if (!detail::confirm(group_, target_, q, options_, position_error, rotation_error)) {
      result_.rejections.add(Rejection::reach);
      return false;
    }
    if (!options_.objectives.empty()) {
      result_.objective =
          detail::slide_along_solutions(group_, target_, options_, valid_, workspace_, q, result_.iterations);
      detail::confirm(group_, target_, q, options_, position_error, rotation_error);
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
  FailureCause cause_;
  double best_ = std::numeric_limits<double>::infinity();
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
  const auto positive = [](double value, const std::string& field) {
    require(std::isfinite(value) && value > 0, "ik." + field, value, "must be positive and finite");
  };
  positive(position_tolerance, "position_tolerance");
  positive(rotation_tolerance, "rotation_tolerance");
  require(max_iterations > 0, "ik.max_iterations", max_iterations, "must be positive");
  require(restarts >= 0, "ik.restarts", restarts, "must not be negative");
  require(time_limit > 0, "ik.time_limit", time_limit, "must be positive");
  for (std::size_t i = 0; i < joint_weights.size(); ++i)
    positive(joint_weights[i], "joint_weights[" + std::to_string(i) + "]");
  for (std::size_t i = 0; i < objectives.size(); ++i)
    if (!objectives[i]) throw InvalidInput("ik.objectives[" + std::to_string(i) + "]: must not be empty");
  require(objective_iterations >= 0, "ik.objective_iterations", objective_iterations, "must not be negative");
}

IkResult solve_ik(const JointGroup& group, const Pose& T_world_tip, const Eigen::VectorXd& seed,
                  const IkOptions& options, const ConfigurationFilter& valid, const Monitor& monitor) {
  detail::check_target(group, T_world_tip, options);
  group.check_configuration(seed, "seed");
  Search search(group, T_world_tip, seed, options, valid);
  IkResult& result = search.result();
  if (!detail::maybe_in_reach(group, T_world_tip.translation())) {
    result.rejections.add(Rejection::reach);
    return result;
  }
  // Six joints: the branch nearest to the seed, for less than a descent takes. Seven: two descents solve nearly every
  // pose that has room, for less than sampling the redundant joint takes.
  const bool six = detail::screws_of(group).size == 6;
  constexpr int kDescentsBeforeClosedForm = 2;
  double position_error = 0, rotation_error = 0;
  const bool there = detail::confirm(group, T_world_tip, seed, options, position_error, rotation_error);
  const detail::Clock clock(options.time_limit);
  detail::IkStarts starts(group, T_world_tip, options.seed);
  if (six && !there && !monitor.stopped() && search.closed_form()) return result;
  for (int attempt = 0; attempt <= options.restarts; ++attempt) {
    if (monitor.stopped() || (attempt > 0 && clock.over())) {
      result.outcome = monitor.stopped() ? Outcome::stopped : Outcome::timeout;
      return result;
    }
    if (!six && attempt == kDescentsBeforeClosedForm && search.closed_form()) return result;
    if (search.descent(attempt == 0 ? seed : starts.next())) return result;
  }
  return result;
}

}  // namespace mmgrasp
