#include "collision/edge/attached_checker.hpp"

#include <algorithm>
#include <cmath>

#include "collision/checker/checker_access.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {

AttachedChecker::AttachedChecker(const CollisionChecker& checker)
    : checker_(checker.clone()),
      largest_(checker.group().lower().cwiseAbs().cwiseMax(checker.group().upper().cwiseAbs()) +
               Eigen::VectorXd::Constant(checker.group().size(), 1e-6)),
      column_(checker.group().size()) {
  const auto& attached = checker.world().attached();
  if (attached.size() != 1) throw InvalidInput("checker: must hold exactly one object");
  CheckerAccess::Impl& impl = CheckerAccess::of(checker_);
  snapshot_ = std::make_shared<Snapshot>(*impl.snapshot);
  plan_ = std::make_shared<PairPlan>(*impl.plan);
  impl.snapshot = snapshot_;
  impl.plan = plan_;
  std::size_t next = 0;
  for (std::size_t s = 0; s < snapshot_->shapes.size(); ++s) {
    if (!snapshot_->bodies[snapshot_->shapes[s].body].held) continue;
    parts_.push_back({static_cast<int>(s), Rigid(attached.begin()->second.shapes[next++].T_link_shape)});
  }
}

void AttachedChecker::hold(const Pose& T_link_object) {
  CheckerAccess::Impl& impl = CheckerAccess::of(checker_);
  const Rigid T(T_link_object);
  for (const Part& part : parts_) {
    const auto s = static_cast<std::size_t>(part.shape);
    BodyShape& shape = snapshot_->shapes[s];
    shape.in_link = T * part.in_object;
    shape.ball = shape.in_link * shape.solid->ball_centre;
    PlacedShape& placed = plan_->placed[s];
    placed.in_frame = plan_->frames.link_in_frame(shape.link) * shape.in_link;
    const int ball = plan_->ball_of[s];
    if (ball >= 0) {
      const Eigen::Vector3d centre = placed.in_frame * shape.padded->ball_centre;
      std::copy_n(centre.data(), 3, plan_->balls[ball].p);
    }
    if (!impl.moves[s]) impl.forget();
  }
  // What does not depend on the configuration may depend on the pose in the hand.
  impl.constant_self.reset();
  impl.nearest_still.reset();
  bounded_ = false;
}

// As PairPlan does, for what the object has a part in.
void AttachedChecker::bound_motion() {
  bounded_ = true;
  const auto held = [&](int ball) {
    return std::any_of(parts_.begin(), parts_.end(),
                       [&](const Part& part) { return plan_->ball_of[part.shape] == ball; });
  };
  const auto radius = [&](int ball) {
    const FrameSphere& own = plan_->balls[ball];
    return Eigen::Vector3d(own.p[0], own.p[1], own.p[2]).norm() + own.radius;
  };
  const MovingFrames& frames = plan_->frames;
  const auto frame = [&](int ball) { return plan_->balls[ball].frame; };
  MotionRates& rates = plan_->rates;
  motion_.setZero(largest_.size());
  const Eigen::Index checked = snapshot_->options.held_only ? plan_->moving_in_scene : rates.shapes.cols();
  for (Eigen::Index i = 0; i < rates.shapes.cols(); ++i) {
    const int ball = static_cast<int>(i);
    if (held(ball)) {
      column_.setZero();
      frames.add_rates(frame(ball), radius(ball), -1, largest_, column_);
      rates.shapes.col(i) = column_;
    }
    if (i < checked) motion_ = motion_.cwiseMax(rates.shapes.col(i));
  }
  for (Eigen::Index i = 0; i < rates.pairs.cols(); ++i) {
    const ShapePair& pair = plan_->varying[i];
    if (!held(pair.ball_a) && !held(pair.ball_b)) continue;
    column_.setZero();
    frames.add_closing_rates(plan_->balls[pair.ball_a], plan_->balls[pair.ball_b], largest_, column_);
    rates.pairs.col(i) = column_;
  }
}

bool AttachedChecker::edge_is_free(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, const EdgeOptions& options) {
  if (!bounded_) bound_motion();
  if (options.continuous) return check_edge(checker_, q0, q1, options).free;
  return stepped_edge_is_free(checker_, motion_, q0, q1, options);
}

bool stepped_edge_is_free(CollisionChecker& checker, const Eigen::VectorXd& motion_bounds, const Eigen::VectorXd& q0,
                          const Eigen::VectorXd& q1, const EdgeOptions& options) {
  const double farthest = (q1 - q0).cwiseAbs().maxCoeff();
  if (!(farthest > 0)) return checker.is_free(q0);
  double pieces = std::max(1.0, std::ceil(farthest / options.joint_step - 1e-9));
  if (std::isfinite(options.workspace_step)) {
    const double motion = (q1 - q0).cwiseAbs().dot(motion_bounds);
    pieces = std::max(pieces, std::ceil(motion / options.workspace_step - 1e-9));
  }
  return checker.edge_is_free(q0, q1, farthest / pieces);
}

}  // namespace mmgrasp::detail
