#include "mmgrasp/robot/manipulability.hpp"

#include <Eigen/QR>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/robot/detail/joint_group_data.hpp"
#include "mmgrasp/robot/detail/manipulability_measure.hpp"

namespace mmgrasp {
namespace {

/// Part of J's largest stretch below which one counts as none: what rounding leaves of a zero.
constexpr double kRankTolerance = 1e-13;
/// How far a unit direction may lie off those in which the tool can move and still count as one of them.
constexpr double kOffRange = 1e-9;

/// J^T on the stack.
using Transposed = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, detail::kMaxGroupSize, 6>;
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;

Transposed jacobian_rows(const JointGroup& group, const Eigen::VectorXd& q, Eigen::Index rows) {
  group.check_configuration(q, "q");
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, detail::kMaxGroupSize> J(6, group.size());
  Pose T_world_tip;
  group.fk_jacobian(q, T_world_tip, J);
  return J.topRows(rows).transpose();
}

SmallVector unit(const Eigen::VectorXd& direction) {
  require(direction.size() == 3 || direction.size() == 6, "direction length", static_cast<double>(direction.size()),
          "must be 3 (translation) or 6 (twist)");
  for (Eigen::Index i = 0; i < direction.size(); ++i)
    require_number(direction[i], "direction[" + std::to_string(i) + "]");
  const double length = direction.stableNorm();
  require(length > 0, "direction length", length, "must not be zero: the tool has to go somewhere");
  return direction / length;
}

}  // namespace

namespace detail {

double volume(const Eigen::Ref<const Matrix6Xd>& J) {
  if (J.cols() < 6) return 0;
  // J^T = Q R, so J J^T = R^T R and the product is |det R|. Gram-Schmidt would lose it near singularities.
  Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, kMaxGroupSize, 6> A = J.transpose();
  double product = 1;
  for (Eigen::Index k = 0; k < 6; ++k) {
    auto head = A.col(k).tail(A.rows() - k);
    const double norm = head.norm();
    product *= norm;
    if (!(norm > 0)) return product;
    head[0] += head[0] < 0 ? -norm : norm;
    const double scale = 2 / head.squaredNorm();
    for (Eigen::Index j = k + 1; j < 6; ++j) {
      auto column = A.col(j).tail(A.rows() - k);
      column -= scale * head.dot(column) * head;
    }
  }
  return product;
}

}  // namespace detail

double JointGroup::manipulability(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, detail::kMaxGroupSize> J(6, size());
  Pose T_world_tip;
  fk_jacobian(q, T_world_tip, J);
  return detail::volume(J);
}

double velocity_manipulability(const JointGroup& group, const Eigen::VectorXd& q, const Eigen::VectorXd& direction) {
  const SmallVector z = unit(direction);
  // The shortest of the joint velocities y that move the tool with z has length (z^T (J J^T)^-1 z)^(1/2). With
  // J^T P = Q R the condition J y = z reads R^T (Q^T y) = P^T z: the first rows give Q^T y, the rest must agree.
  Eigen::ColPivHouseholderQR<Transposed> qr(jacobian_rows(group, q, z.size()));
  qr.setThreshold(kRankTolerance);
  const Eigen::Index rank = qr.rank(), rest = z.size() - rank;
  if (rank == 0) return 0;
  const SmallVector target = qr.colsPermutation().transpose() * z;
  SmallVector y = target.head(rank);
  const auto& R = qr.matrixQR();
  R.topLeftCorner(rank, rank).triangularView<Eigen::Upper>().transpose().solveInPlace(y);
  const double length = y.norm();
  if (rest > 0) {
    const SmallVector missed = R.topRightCorner(rank, rest).transpose() * y - target.tail(rest);
    if (missed.norm() > kOffRange * (1 + length * qr.maxPivot())) return 0;
  }
  return 1 / length;
}

double force_manipulability(const JointGroup& group, const Eigen::VectorXd& q, const Eigen::VectorXd& direction) {
  const SmallVector z = unit(direction);
  const Transposed Jt = jacobian_rows(group, q, z.size());
  const double torque = (Jt * z).norm();
  return torque > kRankTolerance * Jt.norm() ? 1 / torque : detail::kInfinity;
}

}  // namespace mmgrasp
