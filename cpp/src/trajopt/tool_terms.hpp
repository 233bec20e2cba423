#pragma once

#include <memory>

#include "mmgrasp/trajopt/whole_body_problem.hpp"
#include "trajopt/terms.hpp"
#include "trajopt/tool_chain.hpp"

namespace mmgrasp::detail {

/// Some of the six errors of a ToolConstraint (P1 4.4). Variables: the chain's steps.
class ToolPoseTerm : public CurvedTerm {
 public:
  /// Rows with infinite bounds are left out.
  ToolPoseTerm(std::shared_ptr<const ToolChain> chain, const ToolConstraint& constraint);
  void value(const double* x, double* out) const override;
  void jacobian(const double* x, double* out) const override;
  void hessian(const double* x, const double* multipliers, double* out) const override;

 private:
  std::shared_ptr<const ToolChain> chain_;
  Eigen::Matrix3d R_target_world_;
  Eigen::Vector3d p_target_;
  Eigen::Quaterniond target_world_;
  std::vector<int> axes_;
};

/// Velocity of the tool along given directions, and the square of its speed. Variables: the configuration's steps, then
/// drive velocities in the same order; a diff-drive base has v and omega instead of its three.
class ToolVelocityTerm : public CurvedTerm {
 public:
  /// One row per direction (world); an empty matrix: one row, the squared speed.
  ToolVelocityTerm(std::shared_ptr<const ToolChain> chain, bool diff_drive, const Eigen::Matrix3Xd& directions);
  void value(const double* x, double* out) const override;
  void jacobian(const double* x, double* out) const override;
  void hessian(const double* x, const double* multipliers, double* out) const override;

 private:
  struct Motion;
  /// Velocity, its Jacobian (3 x variables) and the Hessian of d^T velocity.
  Motion motion(const double* x) const;
  Eigen::MatrixXd curvature(const double* x, const Motion& m, const Eigen::Vector3d& d) const;
  std::shared_ptr<const ToolChain> chain_;
  bool diff_drive_;
  Eigen::Matrix3Xd directions_;
};

}  // namespace mmgrasp::detail
