// The hot query: frames, balls against boxes eight by eight, and the pairs they leave.

#include <cmath>
#include <limits>

#include "collision/checker/checker_impl.hpp"

namespace mmgrasp {

using detail::CoverAnswer;
using detail::Rigid;

CollisionChecker::Impl::Impl(std::shared_ptr<const detail::Snapshot> snapshot_in, const JointGroup& group_in)
    : snapshot(std::move(snapshot_in)),
      plan(std::make_shared<detail::PairPlan>(*snapshot, group_in)),
      group(group_in),
      frames(16 * static_cast<std::size_t>(plan->frames.count())),
      ball_row(static_cast<int>((plan->balls.size() + detail::kLanes - 1) / detail::kLanes * detail::kLanes)),
      balls(snapshot->shapes.size(), Eigen::Vector3d::Zero()),
      poses(snapshot->shapes.size()),
      pose_stamp(snapshot->shapes.size(), 0),
      moves(snapshot->shapes.size(), 0),
      pair_masks(plan->blocks.size()) {
  ball_numbers.resize(4 * static_cast<std::size_t>(ball_row));
  for (const int s : plan->moving) moves[s] = 1;
}

void CollisionChecker::Impl::forget() {
  frames_valid = links_valid = false;
  constant_self.reset();
  fixed_scene.reset();
  nearest_still.reset();
}

void CollisionChecker::Impl::place_balls(const double* q) {
  ++stamp;
  const bool first = !frames_valid;
  if (first) {
    detail::MovingFrames::set(Rigid(group.T_world_root()), frames.data());
    fixed_stamp = stamp;
    frames_valid = true;
  }
  plan->frames.place(q, frames.data());
  const std::size_t count = first ? plan->balls.size() : plan->moving.size();
  detail::kernels().place_balls(plan->balls.data(), static_cast<int>(count), frames.data(), ball_numbers.data(),
                                ball_row);
}

void CollisionChecker::Impl::place(const Eigen::VectorXd& q) {
  place_balls(q.data());
  const bool first = !links_valid;
  group.link_poses(q, links, links_valid);
  links_valid = true;
  const auto place_ball = [&](int s) {
    const detail::BodyShape& shape = snapshot->shapes[s];
    const Pose& T = links[shape.link];
    balls[s].noalias() = T.linear() * shape.ball + T.translation();
  };
  for (const int s : plan->moving) place_ball(s);
  if (!first) return;
  for (const int s : plan->fixed) place_ball(s);
}

const Rigid& CollisionChecker::Impl::pose(int s) {
  const std::uint64_t current = moves[s] ? stamp : fixed_stamp;
  if (pose_stamp[s] != current) {
    const detail::PlacedShape& shape = plan->placed[s];
    const Rigid T = detail::MovingFrames::get(frames.data() + 16 * shape.frame);
    poses[s].R.noalias() = T.R * shape.in_frame.R;
    poses[s].t.noalias() = T.R * shape.in_frame.t + T.t;
    pose_stamp[s] = current;
  }
  return poses[s];
}

void CollisionChecker::Impl::gather_near(int first, int last) {
  const detail::ScenePacks& packs = snapshot->packs;
  near.clear();
  const auto add = [&](int ball, int pack, unsigned mask) {
    for (; mask != 0; mask &= mask - 1) near.push_back({ball, packs.item(pack, __builtin_ctz(mask))});
  };
  if (packs.flat()) {
    const int count = packs.count();
    masks.resize(count * (last - first));
    detail::kernels().balls_meet(packs.data(), count, placed_balls().from(first), last - first, masks.data(), nullptr);
    for (int b = first; b < last; ++b) {
      for (int k = 0; k < count; ++k) add(b, k, masks[(b - first) * count + k]);
    }
    return;
  }
  for (int b = first; b < last; ++b) {
    const detail::BallRows ball = placed_balls().from(b);
    const float at[4] = {*ball.x, *ball.y, *ball.z, *ball.radius};
    packs.packs_near(at, [&](int pack) {
      std::uint8_t mask = 0;
      detail::kernels().balls_meet(packs.data() + pack, 1, ball, 1, &mask, nullptr);
      add(b, pack, mask);
      return false;
    });
  }
}

bool CollisionChecker::Impl::body_is_free(int body, double motion, bool& proven) {
  const detail::ScenePacks& packs = snapshot->packs;
  const detail::BallRows ball = placed_balls().from(body);
  const int s = plan->moving[body];
  // A body that moves far is only looked at where it is: what its ball, grown by the motion, meets would hardly ever
  // turn out to stay clear.
  const bool far = motion > kGapReach;
  float grown_radius = static_cast<float>(*ball.radius + (far ? 0 : motion));
  const detail::BallRows grown{ball.x, ball.y, ball.z, &grown_radius};
  const auto hits_any = [&](int pack, unsigned mask) {
    for (; mask != 0; mask &= mask - 1) {
      const int other = packs.item(pack, __builtin_ctz(mask));
      if (far) {
        if (!hits_scene(s, other)) continue;
      } else {
        const CoverAnswer answer = scene_within(s, other, motion);
        if (answer == CoverAnswer::kApart) continue;
        proven = false;
        if (answer == CoverAnswer::kMaybe) continue;
      }
      last_shape = s;
      last_scene = other;
      return true;
    }
    return false;
  };
  const auto stays_far = [&](float nearest) { return std::sqrt(nearest) - *ball.radius > motion; };
  if (packs.flat()) {
    std::uint8_t flat_masks[detail::ScenePacks::kFlat];
    float nearest = std::numeric_limits<float>::infinity();
    detail::kernels().balls_meet(packs.data(), packs.count(), grown, 1, flat_masks, &nearest);
    if (stays_far(nearest)) return true;
    if (far) proven = false;
    for (int k = 0; k < packs.count(); ++k) {
      if (hits_any(k, flat_masks[k])) return false;
    }
    return true;
  }
  const float reach[4] = {*ball.x, *ball.y, *ball.z, static_cast<float>(*ball.radius + motion)};
  return !packs.packs_near(reach, [&](int pack) {
    std::uint8_t mask = 0;
    float nearest = 0;
    detail::kernels().balls_meet(packs.data() + pack, 1, grown, 1, &mask, &nearest);
    if (stays_far(nearest)) return false;
    if (far) proven = false;
    return hits_any(pack, mask);
  });
}

bool CollisionChecker::Impl::find_scene_hit(const std::vector<int>& shapes, int count, int first_ball) {
  const auto found = [&](int s, int other) {
    last_shape = s;
    last_scene = other;
    return true;
  };
  gather_near(first_ball, first_ball + count);
  unsure.clear();
  for (const Near& pair : near) {
    const int s = shapes[pair.shape - first_ball];
    const CoverAnswer answer = scene_balls(s, pair.other);
    if (answer == detail::kOverlap) return found(s, pair.other);
    if (answer == detail::kMaybe) unsure.push_back({s, pair.other});
  }
  for (const Near& pair : unsure) {
    if (hits_scene_exactly(pair.shape, pair.other)) return found(pair.shape, pair.other);
  }
  for (int i = snapshot->packed; i < static_cast<int>(snapshot->scene.size()); ++i) {
    for (int k = 0; k < count; ++k) {
      const int s = shapes[k];
      if (hits_scene(s, i)) return found(s, i);
    }
  }
  return false;
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
  unsure.clear();
  detail::kernels().pairs_meet(plan->blocks.data(), static_cast<int>(plan->blocks.size()), placed_balls(),
                               pair_masks.data());
  for (std::size_t block = 0; block < plan->blocks.size(); ++block) {
    for (unsigned mask = pair_masks[block]; mask != 0; mask &= mask - 1) {
      const int i = plan->pair_of[block * detail::kLanes + static_cast<std::size_t>(__builtin_ctz(mask))];
      const CoverAnswer answer = pair_balls(plan->varying[i]);
      if (answer == detail::kApart) continue;
      if (answer == detail::kMaybe) {
        unsure.push_back({0, i});
        continue;
      }
      last_pair = i;
      return true;
    }
  }
  for (const Near& entry : unsure) {
    if (!pair_collides_exactly(plan->varying[entry.other])) continue;
    last_pair = entry.other;
    return true;
  }
  return false;
}

bool CollisionChecker::Impl::scene_collides() {
  if (!fixed_scene) fixed_scene = fixed_hit_scene();
  return *fixed_scene || moving_hit_scene();
}

std::optional<Contact> CollisionChecker::Impl::placed_contact() {
  const auto body = [&](int s) { return snapshot->bodies[snapshot->shapes[s].body].name; };
  if (snapshot->options.check_self) {
    for (const auto* pairs : {&plan->constant, &plan->varying}) {
      for (const detail::ShapePair& pair : *pairs) {
        if (pair_collides(pair)) return Contact{body(pair.a), body(pair.b), false};
      }
    }
  }
  if (!snapshot->options.check_scene) return std::nullopt;
  if (!fixed_hit_scene() && !moving_hit_scene()) return std::nullopt;
  return Contact{body(last_shape), snapshot->object_names[snapshot->scene[last_scene].object], true};
}

Rejection CollisionChecker::Impl::rejection(const Eigen::VectorXd& q) {
  ++queries;
  if (!group.within_limits(q, kLimitSlack)) return Rejection::limits;
  place_balls(q.data());
  if (snapshot->options.check_self && self_collides()) return Rejection::self_collision;
  if (snapshot->options.check_scene && scene_collides()) return Rejection::scene;
  return Rejection::none;
}

bool CollisionChecker::Impl::placed_is_free() {
  if (snapshot->options.check_scene && last_shape >= 0 && hits_scene(last_shape, last_scene)) return false;
  if (snapshot->options.check_self && self_collides()) return false;
  return !(snapshot->options.check_scene && scene_collides());
}

bool CollisionChecker::Impl::is_free(const Eigen::VectorXd& q) {
  ++queries;
  if (!group.within_limits(q, kLimitSlack)) return false;
  place_balls(q.data());
  return placed_is_free();
}

}  // namespace mmgrasp
