#include "collision/checker/edge_motion.hpp"

#include <algorithm>

namespace mmgrasp::detail {

void EdgeMotion::start(const Placement& placement, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1,
                       const Eigen::VectorXd& step) {
  placement_ = &placement;
  velocities_valid_ = false;
  step_ = step;
  magnitude_ = step.cwiseAbs();
  const PairPlan& plan = placement.plan();
  if (!plan.rates.finite) along_edge_ = plan.rates_along(q0, q1);
  rates_ = plan.rates.finite ? &plan.rates : &along_edge_;
  body_rates_.noalias() = rates_->shapes.transpose() * magnitude_;
  pair_rates_.noalias() = rates_->pairs.transpose() * magnitude_;
  const MotionBounds& bounds = plan.frame_bounds;
  if (!bounds.bends()) {
    half_squares_.resize(0);
    return;
  }
  MotionBounds::squares(magnitude_, half_squares_);
  half_squares_ *= 0.5;
  velocities_.resize(bounds.tree().frames);
}

Closing EdgeMotion::of_body(int body, double reach) {
  Closing out;
  out.most = out.by_rates = of_body_anywhere(body, reach);
  if (half_squares_.size() == 0 || reach == 0) return out;
  const Velocity& v = velocity(body);
  out.centre = placement_->sphere_centre(body);
  add_velocity(v.at(out.centre), v.angular, placement_->spheres().radius[body],
               rates_->shape_bends.col(body).dot(half_squares_), reach, out);
  return out;
}

Closing EdgeMotion::of_pair(int pair, double reach) {
  Closing out;
  out.most = out.by_rates = of_pair_anywhere(pair, reach);
  if (half_squares_.size() == 0 || reach == 0) return out;
  const ShapePair& shapes = placement_->plan().varying[pair];
  const int sphere = rates_->b_moves[pair] ? shapes.sphere_b : shapes.sphere_a;
  const int other = rates_->b_moves[pair] ? shapes.sphere_a : shapes.sphere_b;
  const Velocity &v = velocity(sphere), &w = velocity(other);
  out.first_moves = !rates_->b_moves[pair];
  out.centre = placement_->sphere_centre(sphere);
  add_velocity(v.at(out.centre) - w.at(out.centre), v.angular - w.angular, placement_->spheres().radius[sphere],
               rates_->pair_bends.col(pair).dot(half_squares_), reach, out);
  return out;
}

void EdgeMotion::add_velocity(const Eigen::Vector3d& linear, const Eigen::Vector3d& angular, double radius, double bend,
                              double reach, Closing& out) {
  out.directed = true;
  out.radius = radius;
  out.shift = with_slack(1) * reach * linear;
  out.turn = with_slack(1) * reach * angular;
  out.bend = with_slack(bend * reach * reach);
  out.speed = out.shift.norm() + out.turn.norm() * radius;
  out.most = std::min(out.most, out.speed + out.bend);
}

void EdgeMotion::find_velocities() {
  velocities_valid_ = true;
  const MotionBounds& bounds = placement_->plan().frame_bounds;
  Velocity& root = velocities_[0];
  root.origin = placement_->frame(0).t;
  root.linear.setZero();
  root.angular.setZero();
  if (bounds.has_base()) {
    root.linear.head<2>() = step_.head<2>();
    root.angular[2] = step_[2];
  }
  for (const ElementaryMotion& motion : bounds.tree().motions) {
    const Velocity& parent = velocities_[motion.parent];
    Velocity& own = velocities_[motion.frame];
    const Rigid frame = placement_->frame(motion.frame);
    own.origin = frame.t;
    own.linear = parent.at(own.origin);
    own.angular = parent.angular;
    (motion.motion == Motion::prismatic ? own.linear : own.angular) +=
        motion.drive.multiplier * step_[motion.drive.column] * (frame.R * motion.axis);
  }
}

}  // namespace mmgrasp::detail
