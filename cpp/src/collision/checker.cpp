#include "mmgrasp/collision/checker.hpp"

#include <cmath>

#include "collision/checker_impl.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp {

namespace {

// Solvers and interpolation leave rounding at the limits.
constexpr double kLimitSlack = 1e-9;

// The group's own check builds its message's words first: too slow for the hot path, so only when something is wrong.
void check_configuration(const JointGroup& group, const Eigen::VectorXd& q, const char* field) {
  if (q.size() != group.lower().size() || !q.allFinite()) group.check_configuration(q, field);
}

}  // namespace

void CheckerOptions::check() const {
  require(std::isfinite(padding) && padding >= 0, "padding", padding, "must be finite and >= 0 [m]");
}

CollisionChecker::Impl::Impl(std::shared_ptr<const detail::Snapshot> snapshot_in, const JointGroup& group_in)
    : snapshot(std::move(snapshot_in)),
      plan(std::make_shared<detail::PairPlan>(*snapshot, group_in)),
      group(group_in),
      balls(snapshot->shapes.size(), Eigen::Vector3d::Zero()),
      poses(snapshot->shapes.size()),
      pose_stamp(snapshot->shapes.size(), 0),
      moves(snapshot->shapes.size(), 0) {
  for (const int s : plan->moving) moves[s] = 1;
}

void CollisionChecker::Impl::forget() {
  links_valid = false;
  constant_self.reset();
  fixed_scene.reset();
}

void CollisionChecker::Impl::place(const Eigen::VectorXd& q) {
  const bool first = !links_valid;
  group.link_poses(q, links, links_valid);
  links_valid = true;
  ++stamp;
  const auto place_ball = [&](int s) {
    const detail::BodyShape& shape = snapshot->shapes[s];
    const Pose& T = links[shape.link];
    balls[s].noalias() = T.linear() * shape.ball + T.translation();
  };
  for (const int s : plan->moving) place_ball(s);
  if (!first) return;
  fixed_stamp = stamp;
  for (const int s : plan->fixed) place_ball(s);
}

const detail::Rigid& CollisionChecker::Impl::pose(int s) {
  const std::uint64_t current = moves[s] ? stamp : fixed_stamp;
  if (pose_stamp[s] != current) {
    const detail::BodyShape& shape = snapshot->shapes[s];
    const Pose& T = links[shape.link];
    poses[s].R.noalias() = T.linear() * shape.in_link.R;
    poses[s].t.noalias() = T.linear() * shape.in_link.t + T.translation();
    pose_stamp[s] = current;
  }
  return poses[s];
}

bool CollisionChecker::Impl::pair_collides(const detail::ShapePair& pair) {
  if ((balls[pair.a] - balls[pair.b]).squaredNorm() > pair.reach * pair.reach) return false;
  const auto& shapes = snapshot->shapes;
  return detail::solids_collide(*shapes[pair.a].solid, pose(pair.a), *shapes[pair.b].solid, pose(pair.b));
}

bool CollisionChecker::Impl::hits_scene(int s, int scene_shape) {
  const detail::SceneShape& other = snapshot->scene[scene_shape];
  const detail::Solid& solid = *snapshot->shapes[s].padded;
  const double reach = solid.ball_radius + other.solid->ball_radius;
  if ((balls[s] - other.ball).squaredNorm() > reach * reach) return false;
  return detail::solids_collide(solid, pose(s), *other.solid, other.T_world);
}

int CollisionChecker::Impl::find_scene_hit(int s) {
  int hit = -1;
  const auto visit = [&](int item) {
    if (!hits_scene(s, item)) return false;
    hit = item;
    return true;
  };
  const double radius = snapshot->shapes[s].padded->ball_radius;
  snapshot->scene_tree.any_in(balls[s], Eigen::Vector3d::Constant(radius), visit);
  for (int i = snapshot->bounded; hit < 0 && i < static_cast<int>(snapshot->scene.size()); ++i) visit(i);
  return hit;
}

bool CollisionChecker::Impl::self_collides() {
  if (!constant_self) {
    constant_self = false;
    for (const detail::ShapePair& pair : plan->constant) {
      if (pair_collides(pair)) constant_self = true;
    }
  }
  if (*constant_self) return true;
  if (last_pair >= 0 && pair_collides(plan->varying[last_pair])) return true;
  for (std::size_t i = 0; i < plan->varying.size(); ++i) {
    if (!pair_collides(plan->varying[i])) continue;
    last_pair = static_cast<int>(i);
    return true;
  }
  return false;
}

bool CollisionChecker::Impl::scene_collides() {
  if (!fixed_scene) {
    fixed_scene = false;
    for (const int s : plan->fixed) {
      if (find_scene_hit(s) >= 0) fixed_scene = true;
    }
  }
  if (*fixed_scene) return true;
  if (last_shape >= 0 && hits_scene(last_shape, last_scene)) return true;
  for (const int s : plan->moving) {
    const int hit = find_scene_hit(s);
    if (hit < 0) continue;
    last_shape = s;
    last_scene = hit;
    return true;
  }
  return false;
}

Rejection CollisionChecker::Impl::rejection(const Eigen::VectorXd& q) {
  ++queries;
  if (!group.within_limits(q, kLimitSlack)) return Rejection::limits;
  place(q);
  if (snapshot->options.check_self && self_collides()) return Rejection::self_collision;
  if (snapshot->options.check_scene && scene_collides()) return Rejection::scene;
  return Rejection::none;
}

bool CollisionChecker::Impl::is_free(const Eigen::VectorXd& q) {
  ++queries;
  if (!group.within_limits(q, kLimitSlack)) return false;
  place(q);
  if (snapshot->options.check_scene && last_shape >= 0 && hits_scene(last_shape, last_scene)) return false;
  if (snapshot->options.check_self && self_collides()) return false;
  return !(snapshot->options.check_scene && scene_collides());
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

bool CollisionChecker::edge_is_free(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, double step) {
  check_configuration(impl_->group, q0, "q0");
  check_configuration(impl_->group, q1, "q1");
  require(std::isfinite(step) && step > 0, "step", step, "must be finite and > 0 [rad or m]");
  if (!impl_->is_free(q0) || !impl_->is_free(q1)) return false;
  const double pieces = std::ceil((q1 - q0).cwiseAbs().maxCoeff() / step - 1e-9);
  require(pieces < 1e9, "step", step, "must not cut the edge into more than 1e9 pieces");
  const long count = static_cast<long>(pieces);
  long stride = 1;
  while (stride < count) stride *= 2;
  // Halving: a collision in the middle of the edge is found after a few looks, not after half of them.
  Eigen::VectorXd q(q0.size());
  for (stride /= 2; stride >= 1; stride /= 2) {
    for (long i = stride; i < count; i += 2 * stride) {
      q = q0 + (q1 - q0) * (static_cast<double>(i) / static_cast<double>(count));
      if (!impl_->is_free(q)) return false;
    }
  }
  return true;
}

}  // namespace mmgrasp
