#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp {

/// Forward kinematics of many configurations, a column of Q (size() x m) each. The same values as JointGroup::fk to
/// 1e-12, several configurations at a time. Throws InvalidInput when Q has not size() rows.
MMGRASP_EXPORT void fk_batch(const JointGroup& group, const Eigen::Ref<const Eigen::MatrixXd>& Q, Poses& T_world_tip);

/// fk_batch() with the world-aligned Jacobians at the tip, stored next to each other: 6 x (m size()).
MMGRASP_EXPORT void fk_jacobian_batch(const JointGroup& group, const Eigen::Ref<const Eigen::MatrixXd>& Q,
                                      Poses& T_world_tip, Matrix6Xd& J);

/// JointGroup::manipulability of each.
MMGRASP_EXPORT Eigen::VectorXd manipulability_batch(const JointGroup& group,
                                                    const Eigen::Ref<const Eigen::MatrixXd>& Q);

}  // namespace mmgrasp
