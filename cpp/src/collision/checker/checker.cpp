#include "mmgrasp/collision/checker.hpp"

#include <cmath>

#include "collision/checker/checker_impl.hpp"
#include "collision/checker/edge_walk.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp {

namespace {

// The group's own check builds its message's words first: too slow for the hot path, so only when something is wrong.
void check_configuration(const JointGroup& group, const Eigen::VectorXd& q, const char* field) {
  if (q.size() != group.lower().size() || !q.allFinite()) group.check_configuration(q, field);
}

}  // namespace

void CheckerOptions::check() const {
  require(std::isfinite(padding) && padding >= 0, "padding", padding, "must be finite and >= 0 [m]");
}

CollisionChecker::CollisionChecker(const JointGroup& group, const World& world, const CheckerOptions& options) {
  options.check();
  impl_ = std::make_unique<Impl>(std::make_shared<detail::Snapshot>(group.robot(), world, options), group);
}

CollisionChecker::CollisionChecker(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CollisionChecker::CollisionChecker(CollisionChecker&&) noexcept = default;
CollisionChecker& CollisionChecker::operator=(CollisionChecker&&) noexcept = default;
CollisionChecker::~CollisionChecker() = default;

CollisionChecker CollisionChecker::clone() const {
  return CollisionChecker(std::make_unique<Impl>(*impl_));
}

const JointGroup& CollisionChecker::group() const {
  return impl_->group;
}
const World& CollisionChecker::world() const {
  return impl_->snapshot->world;
}
std::size_t CollisionChecker::queries() const {
  return impl_->queries;
}

CollisionChecker CollisionChecker::with_group(const JointGroup& group) const {
  if (&group.robot().data() != &impl_->snapshot->robot.data()) {
    throw InvalidInput("group = " + group.name() + ": belongs to another robot than the checker's; make a new checker");
  }
  return CollisionChecker(std::make_unique<Impl>(impl_->snapshot, group));
}

void CollisionChecker::set_root(const Pose& T_world_root) {
  impl_->group = impl_->group.at(T_world_root);
  // Constant self pairs do not depend on where the robot stands.
  const std::optional<bool> constant_self = impl_->constant_self;
  impl_->forget();
  impl_->constant_self = constant_self;
}

Rejection CollisionChecker::rejection(const Eigen::VectorXd& q) {
  check_configuration(impl_->group, q, "q");
  return impl_->rejection(q);
}

bool CollisionChecker::is_free(const Eigen::VectorXd& q) {
  check_configuration(impl_->group, q, "q");
  return impl_->is_free(q);
}

std::optional<Contact> CollisionChecker::first_contact(const Eigen::VectorXd& q) {
  check_configuration(impl_->group, q, "q");
  ++impl_->queries;
  impl_->place_balls(q.data());
  return impl_->placed_contact();
}

bool CollisionChecker::edge_is_free(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, double step) {
  check_configuration(impl_->group, q0, "q0");
  check_configuration(impl_->group, q1, "q1");
  require(std::isfinite(step) && step > 0, "step", step, "must be finite and > 0 [rad or m]");
  if (!impl_->is_free(q0) || !impl_->is_free(q1)) return false;
  const double pieces = std::ceil((q1 - q0).cwiseAbs().maxCoeff() / step - 1e-9);
  require(pieces < detail::kMaxPieces, "step", step, "must not cut the edge into more than 1e9 pieces");
  return Impl::EdgeWalk(*impl_, q0, q1, static_cast<long>(pieces)).all_free();
}

}  // namespace mmgrasp
