#include "reach/database/pose_search.hpp"

#include <cmath>
#include <limits>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/detail/ik_candidates.hpp"
#include "mmgrasp/robot/detail/ik_descent.hpp"

namespace mmgrasp::detail {
namespace {

/// The nearest float inside limits.
float round_inwards(double value, double lower, double upper) {
  float rounded = static_cast<float>(value);
  if (rounded > upper) rounded = std::nextafter(rounded, -std::numeric_limits<float>::infinity());
  if (rounded < lower) rounded = std::nextafter(rounded, std::numeric_limits<float>::infinity());
  return rounded;
}

/// How near to a solution a failure is.
int rank(Rejection cause) {
  return static_cast<int>(cause);
}

}  // namespace

PoseSearch::PoseSearch(const CollisionChecker& checker, const HandProbe& hand, const BranchTable& table, unsigned seed)
    : table_(table),
      arm_(checker.group()),
      checker_(checker.clone()),
      hand_(hand),
      seed_(seed),
      found_(arm_.size()),
      q_(arm_.size()),
      trial_(arm_.size()),
      rounded_(arm_.size()) {}

bool PoseSearch::start(const Pose& T_world_tip, std::uint64_t number) {
  target_ = T_world_tip;
  motion_ = Rigid(T_world_tip);
  number_ = number;
  cause_ = Rejection::unreachable;
  out_of_reach_ = hand_checked_ = false;
  sample_ = -1;
  outside_.fill(kInfinity);
  return maybe_in_reach(arm_, T_world_tip.translation());
}

bool PoseSearch::refused(Rejection cause) {
  if (rank(cause) > rank(cause_)) cause_ = cause;
  if (rank(cause) >= rank(Rejection::self_collision) && !hand_checked_) {
    hand_checked_ = true;
    const Rejection hand = hand_.rejection(target_);
    if (hand != Rejection::none) {
      out_of_reach_ = true;
      cause_ = hand;
    }
  }
  return out_of_reach_;
}

bool PoseSearch::accept(Eigen::VectorXd& q) {
  const auto off = [&](const Eigen::VectorXd& at) {
    const Pose T = arm_.fk(at);
    // Squared angle of a small rotation by its Frobenius norm: |R - R'|^2 = 2 angle^2.
    const double position = (T.translation() - target_.translation()).squaredNorm();
    const double rotation = 0.5 * (T.linear() - target_.linear()).squaredNorm();
    return position > 0.9 * ik_.position_tolerance * ik_.position_tolerance ||
           rotation > 0.9 * ik_.rotation_tolerance * ik_.rotation_tolerance;
  };
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    found_[i] = round_inwards(q[i], arm_.lower()[i], arm_.upper()[i]);
    rounded_[i] = static_cast<double>(found_[i]);
  }
  if (off(rounded_)) {
    static const IkOptions exact = [] {
      IkOptions options;
      options.position_tolerance = 1e-8;
      options.rotation_tolerance = 1e-8;
      options.max_iterations = 12;
      return options;
    }();
    trial_ = q;
    if (!descend(arm_, target_, trial_, exact, workspace_, true).converged) {
      if (rank(cause_) < rank(Rejection::limits)) cause_ = Rejection::limits;
      return false;
    }
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      if (arm_.wraps()[i]) trial_[i] = wrap_angle(trial_[i]);
      found_[i] = round_inwards(trial_[i], arm_.lower()[i], arm_.upper()[i]);
      rounded_[i] = static_cast<double>(found_[i]);
    }
    if (off(rounded_)) return false;
  }
  const Rejection cause = checker_.rejection(rounded_);
  if (cause == Rejection::none) return true;
  refused(cause);
  return false;
}

bool PoseSearch::try_samples_near(int sample, int count) {
  for (const int s : table_.order(sample)) {
    if (s < count && try_samples(s, s + 1)) return true;
    if (out_of_reach_) return false;
  }
  return false;
}

bool PoseSearch::try_samples(int first, int last) {
  for (int s = first; s < last && !out_of_reach_; ++s) {
    if (!try_branches(table_[s])) continue;
    sample_ = s;
    return true;
  }
  return false;
}

bool PoseSearch::try_locked(const Eigen::VectorXd& q) {
  return !out_of_reach_ && try_branches(table_.lock(q));
}

bool PoseSearch::try_branches(const LockedArm& arm) {
  bool found = false;
  table_.each_branch(arm, motion_, q_, [&](Eigen::VectorXd& q, double outside) {
    if (rank(cause_) < rank(Rejection::limits)) cause_ = Rejection::limits;
    if (outside > 0) {
      note_outside(q, outside);
      return false;
    }
    found = accept(q);
    return found || out_of_reach_;
  });
  return found;
}

void PoseSearch::note_outside(const Eigen::VectorXd& q, double outside) {
  std::size_t worst = 0;
  for (std::size_t i = 1; i < outside_.size(); ++i)
    if (outside_[i] > outside_[worst]) worst = i;
  if (outside >= outside_[worst]) return;
  outside_[worst] = outside;
  nearly_[worst] = q;
}

bool PoseSearch::try_nearly_inside(int iterations) {
  for (std::size_t i = 0; i < outside_.size(); ++i)
    if (std::isfinite(outside_[i]) && try_descent(nearly_[i], iterations)) return true;
  return false;
}

bool PoseSearch::try_descent(const Eigen::VectorXd& q, int iterations) {
  if (out_of_reach_) return false;
  q_ = q;
  ik_.max_iterations = iterations;
  if (!descend(arm_, target_, q_, ik_, workspace_, true).converged) return false;
  for (Eigen::Index i = 0; i < q_.size(); ++i)
    if (arm_.wraps()[i]) q_[i] = wrap_angle(q_[i]);
  return accept(q_);
}

bool PoseSearch::try_random_descents(int count, int iterations) {
  Rng rng(seed_, number_);
  for (int i = 0; i < count && !out_of_reach_; ++i)
    if (try_descent(rng.uniform(arm_.sample_lower(), arm_.sample_upper()), iterations)) return true;
  return false;
}

bool PoseSearch::try_configuration(const Eigen::VectorXd& q) {
  q_ = q;
  return accept(q_);
}

}  // namespace mmgrasp::detail
