#include "mmgrasp/collision/detail/attached_checker.hpp"

#include "collision/checker/engine.hpp"
#include "collision/edge/edge_continuous.hpp"
#include "mmgrasp/collision/detail/edge_steps.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {

/// Snapshot and plan belong to this checker alone: no other checker sees the object move.
struct AttachedChecker::Impl {
  Impl(const JointGroup& group, const World& world, const CheckerOptions& options)
      : snapshot(std::make_shared<Snapshot>(group.robot(), world, options)),
        plan(std::make_shared<PairPlan>(*snapshot, group)),
        engine(snapshot, plan, group),
        motion_bounds(plan->motion_bounds(true)) {}

  /// Only edges need the motion bounds, so they follow a new pose when the first edge is checked.
  void update_bounds() {
    if (bounded) return;
    plan->bound_attached(*snapshot);
    motion_bounds = plan->motion_bounds(true);
    bounded = true;
  }

  std::shared_ptr<Snapshot> snapshot;
  std::shared_ptr<PairPlan> plan;
  CheckerEngine engine;
  Eigen::VectorXd motion_bounds;  ///< Bounds over what is checked against the scene; see mmgrasp::motion_bounds().
  bool bounded = true;            ///< Plan and `motion_bounds` belong to the object's pose.
};

AttachedChecker::AttachedChecker(const JointGroup& group, const World& world, const CheckerOptions& options) {
  options.check();
  require(world.attached().size() == 1, "world attached objects", std::to_string(world.attached().size()),
          "must be exactly one");
  impl_ = std::make_unique<Impl>(group, world, options);
}

AttachedChecker::AttachedChecker(AttachedChecker&&) noexcept = default;
AttachedChecker& AttachedChecker::operator=(AttachedChecker&&) noexcept = default;
AttachedChecker::~AttachedChecker() = default;

void AttachedChecker::place_attached(const Pose& T_link_object) {
  impl_->snapshot->place_attached(T_link_object);
  impl_->plan->place_attached(*impl_->snapshot);
  impl_->engine.attached_moved();
  impl_->bounded = false;
}

bool AttachedChecker::is_free(const Eigen::VectorXd& q) {
  check_configuration(impl_->engine.group(), q, "q");
  return impl_->engine.is_free(q);
}

Rejection AttachedChecker::rejection(const Eigen::VectorXd& q) {
  check_configuration(impl_->engine.group(), q, "q");
  return impl_->engine.rejection(q);
}

bool AttachedChecker::edge_is_free(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, const EdgeOptions& options) {
  check_configuration(impl_->engine.group(), q0, "q0");
  check_configuration(impl_->engine.group(), q1, "q1");
  impl_->update_bounds();
  if (options.continuous) return advance_edge(impl_->engine, q0, q1, options.tolerance).free;
  const double step = edge_step(q1 - q0, impl_->motion_bounds, options.joint_step, options.workspace_step);
  return impl_->engine.is_free(q0) && impl_->engine.edge_stays_free(q0, q1, step);
}

bool AttachedChecker::edge_stays_free(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1,
                                      const EdgeOptions& options) {
  impl_->update_bounds();
  if (options.continuous) return advance_edge(impl_->engine, q0, q1, options.tolerance).free;
  const double step = edge_step(q1 - q0, impl_->motion_bounds, options.joint_step, options.workspace_step);
  return impl_->engine.edge_stays_free(q0, q1, step, true);
}

DistanceResult AttachedChecker::distance(const Eigen::VectorXd& q) {
  check_configuration(impl_->engine.group(), q, "q");
  return impl_->engine.distance(q, false);
}

const Eigen::VectorXd& AttachedChecker::motion_bounds() {
  impl_->update_bounds();
  return impl_->motion_bounds;
}

}  // namespace mmgrasp::detail
