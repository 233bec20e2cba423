#pragma once

#include <Eigen/Core>
#include <cmath>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/ik.hpp"

namespace mmgrasp::detail {

/// Narrows the box [lower, upper] of a group with base: x and y no farther from the pose than the tip gets with every
/// link stretched and every slide out.
void keep_base_near(const JointGroup& group, const Pose& T_world_tip, Eigen::VectorXd& lower, Eigen::VectorXd& upper);

/// Start configurations that spread over the limits without clusters: an additive sequence with irrational steps
/// (powers of the root of x^(n+1) = x + 1), shifted at random by the seed. A base starts no farther
/// from the pose than the arm could reach.
class IkStarts {
 public:
  IkStarts(const JointGroup& group, const Pose& T_world_tip, unsigned seed);
  Eigen::VectorXd next();

 private:
  Eigen::VectorXd lower_, upper_, position_, step_;
};

/// Angles without limits are taken the way that is nearest to the seed.
void unwind(const JointGroup& group, const Eigen::VectorXd& seed, Eigen::VectorXd& q);

}  // namespace mmgrasp::detail
