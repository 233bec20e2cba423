#include "mmgrasp/reach/reach_solve.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "reach/database/reach_data.hpp"
#include "reach/database/seeded_ik.hpp"

namespace mmgrasp {
namespace {

/// Farthest-point order over joint values scaled by their ranges.
void spread(std::vector<Eigen::VectorXd>& configurations, const Eigen::VectorXd& scale) {
  std::vector<double> apart(configurations.size(), detail::kInfinity);
  for (std::size_t chosen = 0; chosen + 2 < configurations.size(); ++chosen) {
    std::size_t farthest = chosen + 1;
    for (std::size_t i = chosen + 1; i < configurations.size(); ++i) {
      apart[i] = std::min(apart[i], (configurations[i] - configurations[chosen]).cwiseProduct(scale).squaredNorm());
      if (apart[i] > apart[farthest]) farthest = i;
    }
    std::swap(configurations[chosen + 1], configurations[farthest]);
    std::swap(apart[chosen + 1], apart[farthest]);
  }
}

std::vector<Eigen::VectorXd> solve(detail::SeededIk& ik, const Pose& T_base_tip, const ReachSolveOptions& options,
                                   CollisionChecker* checker) {
  std::vector<Eigen::VectorXd> found;
  const int candidates = ik.seed(T_base_tip, options.candidates);
  for (int i = 0; i < candidates; ++i) {
    if (!ik.refine(T_base_tip, i)) continue;
    const Eigen::VectorXd& q = ik.q();
    const bool known = std::any_of(found.begin(), found.end(), [&](const Eigen::VectorXd& other) {
      return (other - q).cwiseAbs().maxCoeff() <= options.distinct;
    });
    if (known || (checker != nullptr && !checker->is_free(q))) continue;
    found.push_back(q);
  }
  spread(found, (ik.arm().sample_upper() - ik.arm().sample_lower()).cwiseMax(1e-9).cwiseInverse());
  if (static_cast<int>(found.size()) > options.count) found.resize(options.count);
  return found;
}

}  // namespace

namespace detail {

SeededIk::SeededIk(const ReachDatabase& database, const JointGroup& arm, const IkOptions& options)
    : database_(database), arm_(checked_arm(arm)), options_(options) {
  require(arm_.size() == database.joint_count(), "arm", arm.name(),
          "must have the database's " + std::to_string(database.joint_count()) + " joints");
  options_.check();
  options_.time_limit = 1e9;  // the answer must not depend on the machine's speed
}

int SeededIk::seed(const Pose& T_base_tip, int count) {
  return database_.nearest(T_base_tip, count, seeds_);
}

bool SeededIk::refine(const Pose& T_base_tip, int seed) {
  q_ = seeds_.col(seed).head(arm_.size());
  if (!refine_ik(arm_, T_base_tip, q_, options_, workspace_)) return false;
  const Pose T = arm_.fk(q_);
  return (T.translation() - T_base_tip.translation()).norm() <= options_.position_tolerance &&
         rotation_distance(T, T_base_tip) <= options_.rotation_tolerance && arm_.within_limits(q_, 1e-9);
}

void check_checker(const CollisionChecker* checker, const JointGroup& arm) {
  if (checker == nullptr) return;
  require(!checker->group().has_base() && checker->group().size() == arm.size(), "checker", checker->group().name(),
          "must be of a group with the arm's joints, without base joints");
}

}  // namespace detail

void ReachSolveOptions::check() const {
  require_within(count, 1, 1e6, "count", "configurations");
  require_within(candidates, 1, 1e6, "candidates", "stored configurations");
  require_not_negative(distinct, "distinct", "rad or m");
  resolve_threads(threads);  // says what is wrong
  ik.check();
}

std::vector<Eigen::VectorXd> solve_reach(const ReachDatabase& database, const JointGroup& arm, const Pose& T_base_tip,
                                         const ReachSolveOptions& options, CollisionChecker* checker) {
  options.check();
  detail::check_checker(checker, arm);
  detail::SeededIk ik(database, arm, options.ik);
  return solve(ik, T_base_tip, options, checker);
}

std::vector<std::vector<Eigen::VectorXd>> solve_reach_batch(const ReachDatabase& database, const JointGroup& arm,
                                                            const Poses& T_base_tip, const ReachSolveOptions& options,
                                                            const CollisionChecker* checker, const Monitor& monitor) {
  options.check();
  detail::check_checker(checker, arm);
  const int threads = resolve_threads(options.threads);
  std::vector<detail::SeededIk> ik(threads, {database, arm, options.ik});
  std::vector<CollisionChecker> checkers;
  for (int i = 0; checker != nullptr && i < threads; ++i) checkers.push_back(checker->clone());
  std::vector<std::vector<Eigen::VectorXd>> out(T_base_tip.size());
  const auto work = [&](std::size_t item, int worker) {
    const std::size_t w = worker;
    out[item] = solve(ik[w], T_base_tip[item], options, checkers.empty() ? nullptr : &checkers[w]);
  };
  parallel_for(T_base_tip.size(), threads, work, monitor, "inverse kinematics");
  return out;
}

}  // namespace mmgrasp
