#include "task/pick/joined_motions.hpp"

#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kRounding = 1e-7;  // [rad or m]: what planning and timing may add to an end; more is a gap to be seen.

Eigen::VectorXd whole_turn_shift(const std::vector<bool>& wraps, const Eigen::VectorXd& from,
                                 const Eigen::VectorXd& start) {
  Eigen::VectorXd shift = Eigen::VectorXd::Zero(start.size());
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    if (wraps[i]) shift[i] = whole_turns(from[i] - start[i]);
  }
  return shift;
}

}  // namespace

Eigen::VectorXd join_motions(const std::vector<bool>& wraps, const Eigen::VectorXd& from,
                             std::vector<PickMotion>& motions) {
  Eigen::VectorXd at = from;
  for (PickMotion& motion : motions) {
    std::vector<Eigen::VectorXd>& positions = motion.trajectory.positions;
    if (positions.empty()) continue;
    const Eigen::VectorXd shift = whole_turn_shift(wraps, at, positions.front());
    if (!shift.isZero(0)) {
      for (Eigen::VectorXd& q : positions) q += shift;
    }
    if ((positions.front() - at).cwiseAbs().maxCoeff() <= kRounding) positions.front() = at;
    at = positions.back();
  }
  return at;
}

}  // namespace mmgrasp::detail
