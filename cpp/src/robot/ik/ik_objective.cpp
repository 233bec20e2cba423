#include "mmgrasp/robot/ik_objective.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/robot/detail/ik_closed_form.hpp"
#include "mmgrasp/robot/detail/manipulability_measure.hpp"

namespace mmgrasp {
namespace {

void check_weight(double weight) {
  require_not_negative(weight, "objective weight");
}

/// (5.10) with its mirror: as printed it has no bound on where it is active and leaves out the lower limit.
class JointLimits final : public IkObjective {
 public:
  JointLimits(const JointGroup& group, double soft_fraction, double weight)
      : IkObjective(group.size()), weight_(weight) {
    lower_ = group.lower();
    upper_ = group.upper();
    for (Eigen::Index i = 0; i < lower_.size(); ++i) {
      const double range = upper_[i] - lower_[i];
      // Base columns have a workspace, no limits that could harm them.
      const bool limited = std::isfinite(range) && !(group.has_base() && i < 3);
      lower_[i] = limited ? lower_[i] + soft_fraction * range : -detail::kInfinity;
      upper_[i] = limited ? upper_[i] - soft_fraction * range : detail::kInfinity;
    }
  }

  std::string name() const override { return "joint limits"; }

  double evaluate(const Eigen::VectorXd& q, Eigen::VectorXd& gradient) const override {
    const Eigen::VectorXd above = (q - upper_).cwiseMax(0), below = (lower_ - q).cwiseMax(0);
    gradient = 2 * weight_ * (above - below);
    return weight_ * (above.squaredNorm() + below.squaredNorm());
  }

 private:
  Eigen::VectorXd lower_, upper_;  // where the soft zones begin
  double weight_;
};

/// sqrt(det(J J^T)) of the arm's columns and its gradient.
class Singularity final : public IkObjective {
 public:
  Singularity(const JointGroup& group, double threshold, double weight)
      : IkObjective(group.size()),
        group_(group),
        first_(group.has_base() ? 3 : 0),
        plain_(detail::one_joint_a_column(group)),
        threshold_(threshold),
        weight_(weight) {}

  std::string name() const override { return "singularity"; }

  double evaluate(const Eigen::VectorXd& q, Eigen::VectorXd& gradient) const override {
    gradient.setZero(q.size());
    const Matrix6Xd J = group_.jacobian(q).rightCols(q.size() - first_);
    const double M = detail::volume(J);
    if (M >= threshold_) return 0;
    const double lack = 1 - M / threshold_;
    const double slope = -2 * weight_ * lack / threshold_;
    if (plain_)
      analytic(J, M, slope, gradient);
    else
      numeric(q, slope, gradient);
    return weight_ * lack * lack;
  }

 private:
  /// dM/dq_i = M tr((J J^T)^-1 dJ/dq_i J^T). A column of the Jacobian turns with the joints before it; joints from it
  /// on move the tip under it.
  void analytic(const Matrix6Xd& J, double M, double slope, Eigen::VectorXd& gradient) const {
    if (M < 1e-12) return;  // no direction is better than another there
    const Matrix6Xd B = (J * J.transpose()).ldlt().solve(J);
    for (Eigen::Index i = 0; i < J.cols(); ++i) {
      const Eigen::Vector3d v = J.col(i).head<3>(), w = J.col(i).tail<3>();
      double trace = 0;
      for (Eigen::Index j = 0; j < J.cols(); ++j) {
        const Eigen::Vector3d vj = J.col(j).head<3>(), wj = J.col(j).tail<3>();
        trace += B.col(j).head<3>().dot(i < j ? w.cross(vj) : wj.cross(v));
        if (i < j) trace += B.col(j).tail<3>().dot(w.cross(wj));
      }
      gradient[first_ + i] = slope * M * trace;
    }
  }

  /// Mimic joints share columns: central differences.
  void numeric(const Eigen::VectorXd& q, double slope, Eigen::VectorXd& gradient) const {
    constexpr double kStep = 1e-6;
    Eigen::VectorXd moved = q;
    const auto at = [&](Eigen::Index i, double value) {
      moved[i] = value;
      return detail::volume(group_.jacobian(moved).rightCols(q.size() - first_));
    };
    for (Eigen::Index i = first_; i < q.size(); ++i) {
      gradient[i] = slope * (at(i, q[i] + kStep) - at(i, q[i] - kStep)) / (2 * kStep);
      moved[i] = q[i];
    }
  }

  JointGroup group_;
  Eigen::Index first_;
  bool plain_;  // one column a joint
  double threshold_, weight_;
};

class CameraView final : public IkObjective {
 public:
  CameraView(const JointGroup& group, int link, const Pose& T_link_camera, const Eigen::Vector3d& point, double weight)
      : IkObjective(group.size()),
        group_(group),
        link_(link),
        T_link_camera_(T_link_camera),
        point_(point),
        weight_(weight) {}

  std::string name() const override { return "camera view"; }

  double evaluate(const Eigen::VectorXd& q, Eigen::VectorXd& gradient) const override {
    Poses T_world_link;
    group_.link_poses(q, T_world_link);
    const Pose T_world_camera = T_world_link[link_] * T_link_camera_;
    const Eigen::Vector3d p = T_world_camera.inverse() * point_;
    const double behind = std::min(0.0, p[2]);
    // The point stands still while the camera moves: it is seen to move against what is fixed to the link there.
    Matrix6Xd J(6, q.size());
    group_.point_jacobian(T_world_link, q, link_, point_, J);
    const Eigen::Vector3d slope = T_world_camera.linear() * Eigen::Vector3d(p[0], p[1], behind);
    gradient = -2 * weight_ * (J.topRows<3>().transpose() * slope);
    return weight_ * (p[0] * p[0] + p[1] * p[1] + behind * behind);
  }

 private:
  JointGroup group_;
  int link_;
  Pose T_link_camera_;
  Eigen::Vector3d point_;
  double weight_;
};

}  // namespace

IkObjective::~IkObjective() = default;

std::shared_ptr<const IkObjective> make_joint_limit_objective(const JointGroup& group, double soft_fraction,
                                                              double weight) {
  require(soft_fraction > 0 && soft_fraction <= 0.5, "soft_fraction", soft_fraction, "must be in (0, 0.5]");
  check_weight(weight);
  return std::make_shared<JointLimits>(group, soft_fraction, weight);
}

std::shared_ptr<const IkObjective> make_singularity_objective(const JointGroup& group, double threshold,
                                                              double weight) {
  require_positive(threshold, "threshold");
  check_weight(weight);
  const int arm = group.size() - (group.has_base() ? 3 : 0);
  require(arm >= 6, "joints of the arm", arm, "must be at least 6: with fewer, sqrt(det(J J^T)) is always 0");
  return std::make_shared<Singularity>(group, threshold, weight);
}

std::shared_ptr<const IkObjective> make_camera_view_objective(const JointGroup& group, int camera_link,
                                                              const Pose& T_link_camera,
                                                              const Eigen::Vector3d& p_world_point, double weight) {
  const int links = static_cast<int>(group.robot().links().size());
  require(camera_link >= 0 && camera_link < links, "camera_link", camera_link,
          "must be the index of a link, below " + std::to_string(links));
  checked_pose(T_link_camera.matrix(), "T_link_camera");
  for (int i = 0; i < 3; ++i) require_number(p_world_point[i], "p_world_point[" + std::to_string(i) + "]");
  check_weight(weight);
  return std::make_shared<CameraView>(group, camera_link, T_link_camera, p_world_point, weight);
}

}  // namespace mmgrasp
