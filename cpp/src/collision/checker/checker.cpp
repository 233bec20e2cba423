#include "mmgrasp/collision/checker.hpp"

#include <cmath>

#include "collision/checker/checker_impl.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {

using detail::check_configuration;

namespace {

void check_edge_input(const JointGroup& group, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, double step) {
  check_configuration(group, q0, "q0");
  check_configuration(group, q1, "q1");
  require_within(step, 1e-9, kLargestLength, "step", "rad or m");
}

}  // namespace

void CheckerOptions::check() const {
  require_not_negative(padding, "padding", "m");
}

std::string describe(const Contact& contact) {
  const std::string a = "'" + contact.a + "'", b = "'" + contact.b + "'";
  return contact.by_padding ? a + " comes closer to " + b + " than their padding" : a + " touches " + b;
}

CollisionChecker::CollisionChecker(const JointGroup& group, const World& world, const CheckerOptions& options) {
  options.check();
  const auto snapshot = std::make_shared<const detail::Snapshot>(group.robot(), world, options);
  impl_ = std::make_unique<Impl>(Impl{detail::CheckerEngine(snapshot, group)});
}

CollisionChecker::CollisionChecker(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CollisionChecker::CollisionChecker(CollisionChecker&&) noexcept = default;
CollisionChecker& CollisionChecker::operator=(CollisionChecker&&) noexcept = default;
CollisionChecker::~CollisionChecker() = default;

CollisionChecker CollisionChecker::clone() const {
  return CollisionChecker(std::make_unique<Impl>(*impl_));
}

const JointGroup& CollisionChecker::group() const {
  return impl_->engine.group();
}
const World& CollisionChecker::world() const {
  return impl_->engine.placement().snapshot().world;
}
const CheckerOptions& CollisionChecker::options() const {
  return impl_->engine.options();
}
std::size_t CollisionChecker::queries() const {
  return impl_->engine.queries();
}

CollisionChecker CollisionChecker::with_group(const JointGroup& group) const {
  const std::shared_ptr<const detail::Snapshot>& snapshot = impl_->engine.placement().shared_snapshot();
  if (&group.robot().data() != &snapshot->robot.data()) {
    throw InvalidInput("group = " + group.name() + ": belongs to another robot than the checker's; make a new checker");
  }
  return CollisionChecker(std::make_unique<Impl>(Impl{detail::CheckerEngine(snapshot, group)}));
}

void CollisionChecker::set_root(const Pose& T_world_root) {
  impl_->engine.set_root(T_world_root);
}

Rejection CollisionChecker::rejection(const Eigen::VectorXd& q) {
  check_configuration(group(), q, "q");
  return impl_->engine.rejection(q);
}

bool CollisionChecker::is_free(const Eigen::VectorXd& q) {
  check_configuration(group(), q, "q");
  return impl_->engine.is_free(q);
}

std::vector<Contact> CollisionChecker::contacts(const Eigen::VectorXd& q) {
  check_configuration(group(), q, "q");
  return impl_->engine.contacts(q);
}

std::optional<Contact> CollisionChecker::first_contact(const Eigen::VectorXd& q) {
  check_configuration(group(), q, "q");
  return impl_->engine.first_contact(q);
}

DistanceResult CollisionChecker::distance(const Eigen::VectorXd& q) {
  check_configuration(group(), q, "q");
  return impl_->engine.distance(q, false);
}

DistanceResult CollisionChecker::distance_and_gradient(const Eigen::VectorXd& q) {
  check_configuration(group(), q, "q");
  return impl_->engine.distance(q, true);
}

std::vector<DistanceResult> CollisionChecker::distances(const Eigen::VectorXd& q, double within) {
  check_configuration(group(), q, "q");
  require_positive(within, "within", "m");
  return impl_->engine.distances(q, within);
}

bool CollisionChecker::edge_is_free(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, double step) {
  check_edge_input(group(), q0, q1, step);
  return impl_->engine.is_free(q0) && impl_->engine.edge_stays_free(q0, q1, step);
}

bool CollisionChecker::edge_stays_free(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, double step,
                                       bool end_is_free) {
  check_edge_input(group(), q0, q1, step);
  return impl_->engine.edge_stays_free(q0, q1, step, end_is_free);
}

}  // namespace mmgrasp
