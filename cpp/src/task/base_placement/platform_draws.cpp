#include "task/base_placement/platform_draws.hpp"

#include <Eigen/SVD>
#include <cmath>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/detail/ik_starts.hpp"
#include "mmgrasp/robot/detail/manipulability_measure.hpp"
#include "mmgrasp/robot/ik_objective.hpp"

namespace mmgrasp::detail {
namespace {

/// Half the squared distance of the base from a pose: what draws two ends together.
class BaseDistance final : public IkObjective {
 public:
  BaseDistance(int size, const Eigen::Vector3d& base, double turn_weight)
      : IkObjective(size), base_(base), turn_weight_(turn_weight) {}
  std::string name() const override { return "base distance"; }
  double evaluate(const Eigen::VectorXd& q, Eigen::VectorXd& gradient) const override {
    const double turn = turn_weight_ * wrap_angle(q[2] - base_[2]);
    const Eigen::Vector2d way = q.head<2>() - base_.head<2>();
    gradient.setZero(q.size());
    gradient.head<2>() = way;
    gradient[2] = turn_weight_ * turn;
    return 0.5 * (way.squaredNorm() + turn * turn);
  }

 private:
  Eigen::Vector3d base_;
  double turn_weight_;
};

Matrix6Xd arm_jacobian(const JointGroup& group, const Eigen::VectorXd& q) {
  return group.jacobian(q).rightCols(q.size() - 3);
}

}  // namespace

PlatformEnd::PlatformEnd(CollisionChecker& checker, const Pose& T_world_tip, const Eigen::Vector3d& point,
                         const std::optional<MountedCamera>& camera, const PlatformLocationsOptions& options,
                         std::uint64_t stream)
    : checker_(checker),
      group_(checker.group()),
      T_world_tip_(T_world_tip),
      point_(point),
      camera_(camera),
      least_manipulability_(options.least_manipulability),
      lower_(group_.sample_lower()),
      upper_(group_.sample_upper()),
      seed_(options.seed),
      stream_(stream) {
  descent_.restarts = 0;
  slide_ = descent_;
  slide_.objective_iterations = 20;
  // Half as much again as required, so that the search does not end right at the bound.
  if (least_manipulability_ > 0)
    slide_.objectives.push_back(make_singularity_objective(group_, 1.5 * least_manipulability_));
  if (camera_)
    slide_.objectives.push_back(make_camera_view_objective(group_, camera_->link, camera_->T_link_camera, point));
  keep_base_near(group_, T_world_tip, lower_, upper_);
}

bool PlatformEnd::in_view(const Pose& T_world_link) const {
  if (!camera_) return true;
  return camera_->camera.project((T_world_link * camera_->T_link_camera).inverse() * point_).has_value();
}

PlatformEnd::Fault PlatformEnd::fault_of(const Eigen::VectorXd& q, Rejection& cause) {
  if (volume(arm_jacobian(group_, q)) < least_manipulability_) return Fault::singular;
  if (camera_) {
    Poses poses;
    group_.link_poses(q, poses);
    if (!in_view(poses[camera_->link])) return Fault::view;
  }
  cause = checker_.rejection(q);
  return cause == Rejection::none ? Fault::none : Fault::other;
}

bool PlatformEnd::count(Fault fault, Rejection cause) {
  if (fault == Fault::view) ++counts.view;
  if (fault == Fault::singular) ++counts.singular;
  if (fault == Fault::other) counts.rejections.add(cause);
  return fault == Fault::none;
}

std::optional<Eigen::VectorXd> PlatformEnd::solve(const Eigen::VectorXd& start, bool fixed_base) {
  ++counts.draws;
  IkOptions options = descent_;
  if (fixed_base) {
    options.joint_weights.assign(group_.size(), 1.0);
    for (std::size_t i = 0; i < 3; ++i) options.joint_weights[i] = 1e12;
    options.position_tolerance *= 0.01;  // putting the base back costs next to nothing of the rest
    options.rotation_tolerance *= 0.01;
  }
  IkResult result = solve_ik(group_, T_world_tip_, start, options);
  counts.iterations += result.iterations;
  if (result.outcome != Outcome::solved) {
    counts.rejections += result.rejections;
    return std::nullopt;
  }
  if (fixed_base) {
    result.q.head<3>() = start.head<3>();
    const Vector6d error = pose_difference(group_.fk(result.q), T_world_tip_);
    if (error.head<3>().norm() > descent_.position_tolerance || error.tail<3>().norm() > descent_.rotation_tolerance) {
      counts.rejections.add(Rejection::unreachable);
      return std::nullopt;
    }
  }
  Rejection cause = Rejection::none;
  Fault fault = fault_of(result.q, cause);
  if (!fixed_base && (fault == Fault::view || fault == Fault::singular) && !slide_.objectives.empty()) {
    const IkResult better = solve_ik(group_, T_world_tip_, result.q, slide_);
    counts.iterations += better.iterations;
    if (better.outcome == Outcome::solved) {
      result.q = better.q;
      fault = fault_of(result.q, cause);
    }
  }
  if (!count(fault, cause)) return std::nullopt;
  return result.q;
}

bool PlatformEnd::draw(const IkSeedDatabase* database) {
  constexpr int kRemembered = 64;
  if (!queried_ && database) remembered_ = database->seeds(T_world_tip_, kRemembered);
  queried_ = true;
  Rng rng(seed_, 2 * counts.draws + stream_);
  Eigen::VectorXd start;
  // Every fourth start is new, so that the database keeps learning.
  if (next_remembered_ < remembered_.size() && counts.draws % 4 != 3) {
    start = remembered_[next_remembered_++];
  } else {
    start = rng.uniform(lower_, upper_);
  }
  const std::optional<Eigen::VectorXd> q = solve(start, false);
  if (q) found.push_back(*q);
  return q.has_value();
}

Eigen::VectorXd PlatformEnd::drawn_towards(const Eigen::VectorXd& q, const Eigen::Vector3d& base, double turn_weight) {
  IkOptions options = descent_;
  options.objectives = {std::make_shared<BaseDistance>(static_cast<int>(q.size()), base, std::max(turn_weight, 0.05))};
  const auto valid = [this](const Eigen::VectorXd& candidate) {
    Rejection cause = Rejection::none;
    const Fault fault = fault_of(candidate, cause);
    if (fault == Fault::none || fault == Fault::other) return cause;
    return Rejection::grasp_filter;
  };
  const IkResult result = solve_ik(group_, T_world_tip_, q, options, valid);
  counts.iterations += result.iterations;
  return result.outcome == Outcome::solved ? result.q : q;
}

bool PlatformEnd::confirmed(const Eigen::VectorXd& q) const {
  if (!group_.within_limits(q)) return false;
  const Poses poses = group_.robot().link_poses(group_.full_values(q), group_.root_pose(q));
  const Vector6d error = pose_difference(poses[group_.tip_link()], T_world_tip_);
  constexpr double kRounding = 1 + 1e-6;
  if (error.head<3>().norm() > kRounding * descent_.position_tolerance ||
      error.tail<3>().norm() > kRounding * descent_.rotation_tolerance)
    return false;
  if (camera_ && !in_view(poses[camera_->link])) return false;
  const Eigen::MatrixXd J = arm_jacobian(group_, q);
  if (J.jacobiSvd().singularValues().prod() < least_manipulability_ * (1 - 1e-9)) return false;
  return checker_.clone().contacts(q).empty();
}

}  // namespace mmgrasp::detail
