#include "mmgrasp/robot/kinematics_batch.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/detail/joint_group_data.hpp"
#include "mmgrasp/robot/detail/manipulability_measure.hpp"

namespace mmgrasp {
namespace {

using detail::KinematicsKernels;

using Columns = Eigen::Ref<const Eigen::MatrixXd>;

void check_rows(const JointGroup& group, const Columns& Q) {
  require(Q.rows() == group.size(), "Q rows", static_cast<double>(Q.rows()),
          "must be " + std::to_string(group.size()) + " (group \"" + group.name() + "\")");
}

/// J may be null.
void run(const JointGroup& group, const Columns& Q, Pose* T, double* J) {
  static_assert(sizeof(Pose) == 16 * sizeof(double), "poses must lie next to each other");
  const detail::GroupKinematics& kinematics = *group.data().kinematics;
  const Eigen::Index m = Q.cols(), per_configuration = 6 * static_cast<Eigen::Index>(group.size());
  if (!kinematics.spherical.empty()) {
    for (Eigen::Index i = 0; i < m; ++i) {
      if (J)
        group.fk_jacobian(Q.col(i), T[i], Eigen::Map<Matrix6Xd>(J + i * per_configuration, 6, group.size()));
      else
        T[i] = group.fk(Q.col(i));
    }
    return;
  }
  const KinematicsKernels& kernels = detail::kinematics_kernels();
  const detail::RootPose& root = group.data().root;
  const Eigen::Index whole = m / kernels.lanes * kernels.lanes, rest = m - whole;
  if (whole > 0)
    kernels.batch(kinematics.chain, root, Q.data(), Q.outerStride(), whole / kernels.lanes, T[0].data(), J);
  if (rest == 0) return;
  // The rest is filled up with its last configuration, so that an answer does not depend on where in Q it stands.
  constexpr int kMaxLanes = 8;
  double q[kMaxLanes * detail::kMaxColumns], poses[kMaxLanes * 16], jacobians[kMaxLanes * 6 * detail::kMaxColumns];
  for (int i = 0; i < kernels.lanes; ++i) {
    const auto from = Q.col(whole + std::min<Eigen::Index>(i, rest - 1));
    std::copy(from.data(), from.data() + from.size(), q + i * Q.rows());
  }
  kernels.batch(kinematics.chain, root, q, Q.rows(), 1, poses, J ? jacobians : nullptr);
  std::copy(poses, poses + 16 * rest, T[whole].data());
  if (J) std::copy(jacobians, jacobians + per_configuration * rest, J + whole * per_configuration);
}

}  // namespace

void fk_batch(const JointGroup& group, const Columns& Q, Poses& T_world_tip) {
  check_rows(group, Q);
  T_world_tip.resize(Q.cols());
  if (Q.cols() > 0) run(group, Q, T_world_tip.data(), nullptr);
}

void fk_jacobian_batch(const JointGroup& group, const Columns& Q, Poses& T_world_tip, Matrix6Xd& J) {
  check_rows(group, Q);
  T_world_tip.resize(Q.cols());
  J.resize(6, Q.cols() * group.size());
  if (Q.cols() > 0) run(group, Q, T_world_tip.data(), J.data());
}

Eigen::VectorXd manipulability_batch(const JointGroup& group, const Columns& Q) {
  check_rows(group, Q);
  constexpr Eigen::Index kBlock = 64;  // what stays in the first-level cache
  const Eigen::Index n = group.size(), m = Q.cols();
  Eigen::VectorXd values(m);
  Poses poses(std::min(m, kBlock));
  Matrix6Xd J(6, n * std::min(m, kBlock));
  for (Eigen::Index first = 0; first < m; first += kBlock) {
    const Eigen::Index count = std::min(kBlock, m - first);
    run(group, Q.middleCols(first, count), poses.data(), J.data());
    for (Eigen::Index i = 0; i < count; ++i)
      values[first + i] = detail::volume(Eigen::Map<const Matrix6Xd>(J.data() + 6 * n * i, 6, n));
  }
  return values;
}

}  // namespace mmgrasp
