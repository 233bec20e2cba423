#include "structure/object_path/path_configurations.hpp"

#include <cmath>
#include <string>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/detail/ik_descent.hpp"
#include "mmgrasp/robot/detail/ik_starts.hpp"
#include "mmgrasp/robot/ik_branches.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;

constexpr int kRedundantValues = 24;
constexpr double kOutside = 0.1;  // [rad] Polishing moves a branch by less
constexpr std::size_t kMostBases = 20000;
constexpr double kStandsStill = 1e-12;

/// The group's joints but the base's, the robot's root standing in the origin.
JointGroup without_base(const JointGroup& group) {
  const Robot& robot = group.robot();
  const Joint& first = robot.joints()[group.joints()[3]];
  return robot.chain(robot.links()[first.parent_link].name, robot.links()[group.tip_link()].name)
      .with_reference(group.reference())
      .at(Pose::Identity());
}

}  // namespace

PathConfigurations::PathConfigurations(const JointGroup& group, const ObjectPathOptions& options)
    : group_(group), options_(options), J_(6, group.size()) {
  if (group.has_base() && group.size() > 3) {
    arm_group_ = without_base(group);
    const std::vector<std::string> names(group.names().begin() + 3, group.names().end());
    if (arm_group_->names() != names) arm_group_ = group;  // no chain: no closed form
  } else {
    arm_group_ = group;
  }
  arm_.emplace(*arm_group_, options.redundant_values > 0 ? options.redundant_values : kRedundantValues);
  turns_.emplace(*arm_group_);
  middle_ = 0.5 * (arm_group_->sample_lower() + arm_group_->sample_upper());
  q_.resize(group.size());
}

void PathConfigurations::place_bases(const Poses& T_world_hand) {
  bases_.clear();
  if (!group_.has_base() || !arm_->known_form()) return;
  const double spacing = options_.base_spacing;
  Eigen::Vector2d lower = Eigen::Vector2d::Constant(kInfinity), upper = -lower;
  for (const Pose& T : T_world_hand) {
    VectorXd from = group_.sample_lower(), to = group_.sample_upper();
    keep_base_near(group_, T, from, to);
    lower = lower.cwiseMin(from.head<2>());
    upper = upper.cwiseMax(to.head<2>());
  }
  const Eigen::Array2d first = (lower.array() / spacing - 1e-9).ceil(), last = (upper.array() / spacing + 1e-9).floor();
  const double count = std::max(0.0, last[0] - first[0] + 1) * std::max(0.0, last[1] - first[1] + 1);
  require(count * options_.base_headings <= kMostBases, "base_spacing", spacing,
          "makes more than " + std::to_string(kMostBases) + " base poses on this path; must be larger");
  for (double x = first[0]; x <= last[0]; ++x) {
    for (double y = first[1]; y <= last[1]; ++y) {
      for (int k = 0; k < options_.base_headings; ++k) {
        bases_.emplace_back(x * spacing, y * spacing, wrap_angle(k * kTwoPi / options_.base_headings));
      }
    }
  }
}

double PathConfigurations::force(const Matrix6Xd& J, const Vector6d& motion) const {
  if (options_.manipulability_weight == 0) return 0;
  const double length = motion.norm();
  return length < kStandsStill ? 0 : length / (J.transpose() * motion).norm();  // P2's direction is undefined then
}

void PathConfigurations::add(const VectorXd& q, const Matrix6Xd& J) {
  values_.insert(values_.end(), q.data(), q.data() + q.size());
  forces_.push_back(force(J, motion_));
}

/// `q_` has the base's values in it.
void PathConfigurations::add_arm(const Pose& T_root_hand) {
  const Eigen::Index n = arm_group_->size();
  const bool based = group_.size() > n;
  if (!maybe_in_reach(*arm_group_, T_root_hand.translation(), 1e-5)) {
    rejections_.add(Rejection::unreachable);
    return;
  }
  const auto use = [&](const VectorXd& q, const Matrix6Xd& J) {
    if (!arm_group_->within_limits(q)) {
      rejections_.add(Rejection::limits);
      return;
    }
    const auto one = [&](const VectorXd& turned) {
      if (!based) {
        add(turned, J);
        return;
      }
      q_.tail(n) = turned;
      Pose T;
      if (motion_.norm() >= kStandsStill) group_.fk_jacobian(q_, T, J_);
      add(q_, J_);
    };
    if (!options_.all_turns || !turns_->any()) {
      one(q);
    } else {
      for (const VectorXd& turned : turns_->of(q, middle_)) one(turned);
    }
  };
  const ClosedFormSolver::Counts counts = arm_->solve(T_root_hand, kOutside, use);
  partial_ = counts.free || arm_->redundant_joint() >= 0;
  rejections_.add(Rejection::limits, counts.far);
  rejections_.add(Rejection::unreachable, counts.without);
}

PathConfigurations::Layer PathConfigurations::take(Eigen::Index count) {
  Layer layer;
  layer.q = Eigen::Map<const Eigen::MatrixXd>(values_.data(), group_.size(), count);
  layer.manipulability = Eigen::Map<const VectorXd>(forces_.data(), count);
  layer.rejections = rejections_;
  return layer;
}

PathConfigurations::Layer PathConfigurations::at(const Pose& T_world_hand, const Vector6d& motion) {
  motion_ = motion;
  values_.clear();
  forces_.clear();
  rejections_ = {};
  partial_ = false;
  if (arm_->known_form()) {
    if (group_.has_base()) {
      for (const Eigen::Vector3d& base : bases_) {
        q_.head<3>() = base;
        add_arm(group_.root_pose(q_).inverse() * T_world_hand);
      }
    } else {
      add_arm(T_world_hand);
    }
  }
  // No closed form, or a singularity or sampled values that missed what little room the limits leave.
  if (forces_.empty() && (!arm_->known_form() || (!group_.has_base() && partial_))) {
    const IkBranches found =
        solve_ik_branches(group_, T_world_hand, {}, {}, options_.redundant_values, {}, options_.all_turns);
    rejections_ = found.rejections;
    Pose T;
    for (const VectorXd& q : found.solutions) {
      group_.fk_jacobian(q, T, J_);
      add(q, J_);
    }
  }
  return take(static_cast<Eigen::Index>(forces_.size()));
}

PathConfigurations::Layer PathConfigurations::single(const Pose& T_world_hand, const Vector6d& motion,
                                                     const VectorXd& seed) {
  if (arm_->known_form() && !group_.has_base()) {
    Layer all = at(T_world_hand, motion);
    if (all.q.cols() < 2) return all;
    Eigen::Index nearest = 0;
    double least = kInfinity;
    for (Eigen::Index i = 0; i < all.q.cols(); ++i) {
      double squared = 0;
      for (Eigen::Index j = 0; j < seed.size(); ++j) {
        const double move = all.q(j, i) - seed[j];
        squared += std::pow(group_.wraps()[j] ? shortest_turn(move) : move, 2);
      }
      if (squared >= least) continue;
      least = squared;
      nearest = i;
    }
    all.q = all.q.col(nearest).eval();
    all.manipulability = all.manipulability.segment<1>(nearest).eval();
    return all;
  }
  motion_ = motion;
  values_.clear();
  forces_.clear();
  rejections_ = {};
  IkOptions options;
  options.position_tolerance = options.rotation_tolerance = 1e-13;  // as exact as branches are
  IkWorkspace workspace;
  IkStarts starts(group_, T_world_hand, options.seed);
  VectorXd q = seed;
  for (int i = 0; i <= options.restarts && maybe_in_reach(group_, T_world_hand.translation(), 1e-5); ++i) {
    if (i > 0) q = starts.next();
    if (!descend(group_, T_world_hand, q, options, workspace, true).converged) continue;
    add(q, workspace.J);
    return take(1);
  }
  rejections_.add(Rejection::unreachable);
  return take(0);
}

}  // namespace mmgrasp::detail
