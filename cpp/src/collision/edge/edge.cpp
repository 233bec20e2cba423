#include "mmgrasp/collision/edge.hpp"

#include <algorithm>
#include <cmath>

#include "collision/checker/checker_impl.hpp"
#include "collision/edge/edge_continuous.hpp"
#include "mmgrasp/collision/detail/edge_steps.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"

namespace mmgrasp {

void EdgeOptions::check() const {
  require_within(joint_step, 1e-9, kLargestLength, "joint_step", "rad or m");
  require(workspace_step > 0, "workspace_step", workspace_step, "must be > 0 [m]");
  require_positive(tolerance, "tolerance", "m");
  for (Eigen::Index i = 0; i < bend.size(); ++i)
    require_not_negative(bend[i], "bend[" + std::to_string(i) + "]", "rad or m");
}

namespace {

EdgeResult stepped_edge(CollisionChecker& checker, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1,
                        const EdgeOptions& options) {
  const Eigen::VectorXd delta = q1 - q0, bounds = motion_bounds(checker);
  const double step = detail::edge_step(delta, bounds, options.joint_step, options.workspace_step);
  const double count = std::max(1.0, detail::edge_pieces(delta.cwiseAbs().maxCoeff(), step));
  require(count < detail::kMaxPieces, "joint_step and workspace_step", count, "must not cut the edge into 1e9 pieces");
  const long pieces = static_cast<long>(count);
  const std::size_t before = checker.queries();
  EdgeResult result;
  // The quick answer first: most edges that are checked are likely to be free.
  result.free = checker.edge_is_free(q0, q1, step);
  result.checks = static_cast<int>(checker.queries() - before);
  if (result.free) return result;
  long i = 0;
  Eigen::VectorXd q = q0;
  while (i < pieces && checker.is_free(q)) {
    detail::throw_if_interrupted();
    ++i;
    q = q0 + (q1 - q0) * (static_cast<double>(i) / static_cast<double>(pieces));
  }
  result.fraction = static_cast<double>(i) / static_cast<double>(pieces);
  if (checker.rejection(q) != Rejection::limits) result.contact = checker.first_contact(q);
  result.checks = static_cast<int>(checker.queries() - before);
  return result;
}

}  // namespace

EdgeResult check_edge(CollisionChecker& checker, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1,
                      const EdgeOptions& options) {
  options.check();
  checker.group().check_configuration(q0, "q0");
  checker.group().check_configuration(q1, "q1");
  require(options.bend.size() == 0 || options.bend.size() == q0.size(), "bend",
          static_cast<double>(options.bend.size()), "must be empty or hold one value per joint");
  if (options.continuous) return detail::advance_edge(checker.impl_->engine, q0, q1, options.tolerance, options.bend);
  return stepped_edge(checker, q0, q1, options);
}

Eigen::VectorXd motion_bounds(const CollisionChecker& checker) {
  return checker.impl_->engine.placement().plan().motion_bounds(false);
}

std::vector<char> are_free(const CollisionChecker& checker, const Eigen::MatrixXd& Q, int threads) {
  require(Q.rows() == checker.group().size(), "Q rows", static_cast<double>(Q.rows()),
          "must be " + std::to_string(checker.group().size()) + " (group \"" + checker.group().name() + "\")");
  for (Eigen::Index i = 0; i < Q.cols(); ++i) {
    if (!Q.col(i).allFinite()) checker.group().check_configuration(Q.col(i), "Q column " + std::to_string(i) + " q");
  }
  constexpr Eigen::Index kBlock = 64;
  const std::size_t blocks = (Q.cols() + kBlock - 1) / kBlock;
  const int workers = std::min(resolve_threads(threads), std::max(1, static_cast<int>(blocks)));
  std::vector<CollisionChecker> checkers;
  for (int i = 0; i < workers; ++i) checkers.push_back(checker.clone());
  std::vector<char> free(Q.cols());
  parallel_for(blocks, workers, [&](std::size_t block, int worker) {
    const Eigen::Index first = static_cast<Eigen::Index>(block) * kBlock;
    Eigen::VectorXd q(Q.rows());
    for (Eigen::Index i = first; i < std::min(first + kBlock, Q.cols()); ++i) {
      q = Q.col(i);
      free[i] = checkers[worker].is_free(q);
    }
  });
  return free;
}

}  // namespace mmgrasp
