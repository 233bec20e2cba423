// Two shapes, or one and a shape of the scene: covers of balls first, hulls, and only then the exact narrow phase.

#include <algorithm>
#include <array>
#include <cmath>

#include "collision/checker/checker_impl.hpp"
#include "collision/narrow/convex_clearance.hpp"

namespace mmgrasp {

using detail::CoverAnswer;
using detail::FloatRigid;
using detail::Nearness;
using detail::Rigid;

namespace {

FloatRigid to_float(const Rigid& T) {
  FloatRigid out;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) out.R[3 * r + c] = static_cast<float>(T.R(r, c));
    out.t[r] = static_cast<float>(T.t[r]);
  }
  return out;
}

// Balls grown by more than this meet cells of a field everywhere [m].
constexpr double kFieldReach = 0.02;

// The bodies themselves are only asked for gaps up to this [m]: wider ones are rarely left once balls and hulls were.
constexpr double kExactReach = 0.01;

// Hulls this close are left to the exact answer [m].
constexpr double kTouch = 1e-7;

// Single precision rounds sums of these magnitudes a few times: far below 2e-6 of them.
float slack_of(const FloatRigid& T, float extent_a, float extent_b) {
  return 2e-6f * (std::abs(T.t[0]) + std::abs(T.t[1]) + std::abs(T.t[2]) + 3 * (extent_a + extent_b));
}

// The bounding box of a body, in the frame of another one.
struct SeenBox {
  SeenBox(const Rigid& T_from, const detail::Solid& solid, const Rigid& T_solid) {
    Rigid box = T_from.to(T_solid);
    box.t += box.R * solid.box_centre;
    T = to_float(box);
    for (int k = 0; k < 3; ++k) half[k] = static_cast<float>(solid.box_half[k]);
  }
  float slack(const detail::SphereCover& cover) const {
    return slack_of(T, cover.extent(), std::max({half[0], half[1], half[2]}));
  }
  FloatRigid T;
  float half[3];
};

// Of all levels.
std::array<detail::CoverView, detail::BoundingVolumes::kLevels> views(const detail::CoverLevels& covers) {
  std::array<detail::CoverView, detail::BoundingVolumes::kLevels> out;
  for (std::size_t i = 0; i < covers.size(); ++i) out[i] = covers[i].view();
  return out;
}

// A body's cover, placed at T_a, against the bounding box of the other one.
CoverAnswer cover_against_box(const detail::SphereCover& cover, const Rigid& T_a, const detail::Solid& other,
                              const Rigid& T_b, double grow, bool seek_overlap) {
  const SeenBox box(T_a, other, T_b);
  return detail::kernels().cover_box(cover.view(), box.T, box.half, static_cast<float>(grow), box.slack(cover),
                                     seek_overlap);
}

// The same for its cover in all levels.
CoverAnswer balls_against_box(const detail::CoverLevels& covers, const Rigid& T_a, const detail::Solid& other,
                              const Rigid& T_b, double grow, bool seek_overlap) {
  const SeenBox box(T_a, other, T_b);
  return detail::kernels().box_cover(views(covers).data(), static_cast<int>(covers.size()), box.T, box.half,
                                     static_cast<float>(grow), box.slack(covers[0]), seek_overlap);
}

// A body's balls, placed at T_balls, in the field of a body at T_field.
CoverAnswer balls_in_field(const detail::DistanceField& field, const Rigid& T_field, const detail::CoverLevels& balls,
                           const Rigid& T_balls, double grow, bool seek_overlap) {
  const FloatRigid T = to_float(T_field.to(T_balls));
  return detail::kernels().field_cover(field.view(), views(balls).data(), static_cast<int>(balls.size()), T,
                                       static_cast<float>(grow), slack_of(T, field.extent(), balls[0].extent()),
                                       seek_overlap);
}

// Of two solids or the hulls around them; `touching` also where there is no such hull.
Nearness hull_nearness(const detail::Solid& a, const Rigid& T_a, const detail::Solid& b, const Rigid& T_b,
                       double motion) {
  const auto bounded = [](const detail::Solid& s) { return s.kind == detail::SolidKind::convex || s.has_hull; };
  if (!bounded(a) || !bounded(b)) return Nearness::touching;
  const double margin = a.margin + b.margin;
  return detail::convex_nearness(a.core, b.core, T_a.to(T_b), motion + margin + kTouch, margin + kTouch);
}

}  // namespace

bool CollisionChecker::Impl::balls_apart(const detail::ShapePair& pair) const {
  const auto [x, y, z, radius] = placed_balls();
  const int a = pair.ball_a, b = pair.ball_b;
  const float dx = x[a] - x[b], dy = y[a] - y[b], dz = z[a] - z[b], reach = radius[a] + radius[b];
  return dx * dx + dy * dy + dz * dz > reach * reach;
}

CoverAnswer CollisionChecker::Impl::pair_balls(const detail::ShapePair& pair, double more) {
  const detail::BodyShape &a = snapshot->shapes[pair.a], &b = snapshot->shapes[pair.b];
  if (a.bounds->balls().empty() || b.bounds->balls().empty()) return detail::kMaybe;
  const Rigid &T_a = pose(pair.a), &T_b = pose(pair.b);
  const bool seek_overlap = more == 0;
  const CoverAnswer first = cover_against_box(a.bounds->balls(), T_a, *b.solid, T_b, more, seek_overlap);
  if (first == detail::kApart || (first == detail::kOverlap && b.solid->is_box)) return first;
  const CoverAnswer second = cover_against_box(b.bounds->balls(), T_b, *a.solid, T_a, more, seek_overlap);
  if (second == detail::kApart || (second == detail::kOverlap && a.solid->is_box)) return second;
  if (more > kFieldReach) return detail::kMaybe;
  // A box needs no field.
  if (a.solid->is_box != b.solid->is_box) {
    const detail::BodyShape &box = a.solid->is_box ? a : b, &other = a.solid->is_box ? b : a;
    const Rigid &T_box = a.solid->is_box ? T_a : T_b, &T_other = a.solid->is_box ? T_b : T_a;
    return balls_against_box(other.bounds->detail(*other.solid).covers, T_other, *box.solid, T_box, more, seek_overlap);
  }
  // The larger body as the field: the smaller one has the smaller balls.
  const bool a_larger = a.solid->ball_radius > b.solid->ball_radius;
  const auto by_field = [&](const detail::BodyShape& body, const Rigid& T_body, const detail::BodyShape& balls,
                            const Rigid& T_balls) {
    const auto& field = body.bounds->detail(*body.solid).field;
    if (field == nullptr) return detail::kMaybe;
    return balls_in_field(*field, T_body, balls.bounds->detail(*balls.solid).covers, T_balls, more, seek_overlap);
  };
  const CoverAnswer answer = a_larger ? by_field(a, T_a, b, T_b) : by_field(b, T_b, a, T_a);
  if (answer != detail::kMaybe) return answer;
  return a_larger ? by_field(b, T_b, a, T_a) : by_field(a, T_a, b, T_b);
}

bool CollisionChecker::Impl::pair_collides_exactly(const detail::ShapePair& pair, double more, bool hulls_meet) {
  const detail::BodyShape &a = snapshot->shapes[pair.a], &b = snapshot->shapes[pair.b];
  if (a.solid->kind == detail::SolidKind::mesh && b.solid->kind == detail::SolidKind::mesh) {
    // Few large triangles look for their like in a field around the smaller body.
    const bool field_of_a = a.solid->ball_radius < b.solid->ball_radius;
    const detail::BodyShape &first = field_of_a ? a : b, &second = field_of_a ? b : a;
    return detail::meshes_collide(*first.solid, pose(field_of_a ? pair.a : pair.b),
                                  *first.bounds->detail(*first.solid).field, *second.solid,
                                  pose(field_of_a ? pair.b : pair.a), more, hulls_meet);
  }
  return detail::solids_collide(*a.solid, pose(pair.a), *b.solid, pose(pair.b), more);
}

bool CollisionChecker::Impl::pair_collides(const detail::ShapePair& pair) {
  if (balls_apart(pair)) return false;
  const CoverAnswer answer = pair_balls(pair);
  return answer == detail::kMaybe ? pair_collides_exactly(pair) : answer == detail::kOverlap;
}

CoverAnswer CollisionChecker::Impl::scene_balls(int s, int scene_shape, double more) {
  const detail::BodyShape& shape = snapshot->shapes[s];
  const detail::SceneShape& other = snapshot->scene[scene_shape];
  if (shape.bounds->balls().empty() || other.solid->kind == detail::SolidKind::plane) return detail::kMaybe;
  // Padding pushes out the corners of a box by up to sqrt(3) of it.
  const double grow = (shape.padded != shape.solid ? 1.75 * snapshot->options.padding : 0) + more;
  if (other.solid->kind == detail::SolidKind::voxels) {
    const int ball = plan->ball_of[s];
    if (other.solid->field->distance(other.T_world.R.transpose() * (ball_centre(ball) - other.T_world.t)) >
        placed_balls().radius[ball] + more)
      return detail::kApart;
    const auto& covers = shape.bounds->detail(*shape.solid).covers;
    return balls_in_field(*other.solid->field, other.T_world, covers, pose(s), grow, more == 0);
  }
  const CoverAnswer answer =
      cover_against_box(shape.bounds->balls(), pose(s), *other.solid, other.T_world, grow, more == 0);
  return answer == detail::kOverlap && !other.solid->is_box ? detail::kMaybe : answer;
}

CoverAnswer CollisionChecker::Impl::pair_within(const detail::ShapePair& pair, double motion, char& hulls_meet) {
  if (motion > 0 && motion <= kGapReach) {
    const CoverAnswer balls = pair_balls(pair, motion);
    if (balls != CoverAnswer::kMaybe) return balls;
    if (!hulls_meet) {
      const detail::Solid &a = *snapshot->shapes[pair.a].solid, &b = *snapshot->shapes[pair.b].solid;
      const Nearness hulls = hull_nearness(a, pose(pair.a), b, pose(pair.b), motion);
      if (hulls == Nearness::beyond) return CoverAnswer::kApart;
      if (hulls == Nearness::near) return CoverAnswer::kMaybe;
      hulls_meet = 1;
    }
    if (motion <= kExactReach && !pair_collides_exactly(pair, motion, true)) return CoverAnswer::kApart;
  }
  return pair_collides(pair) ? CoverAnswer::kOverlap : CoverAnswer::kMaybe;
}

CoverAnswer CollisionChecker::Impl::scene_within(int s, int scene_shape, double motion) {
  const CoverAnswer balls = scene_balls(s, scene_shape, motion);
  if (balls != CoverAnswer::kMaybe) return balls;
  const detail::SceneShape& other = snapshot->scene[scene_shape];
  switch (hull_nearness(*snapshot->shapes[s].padded, pose(s), *other.solid, other.T_world, motion)) {
    case Nearness::beyond:
      return CoverAnswer::kApart;
    case Nearness::near:
      return CoverAnswer::kMaybe;
    case Nearness::touching:
      break;
  }
  if (motion <= kExactReach && !hits_scene_exactly(s, scene_shape, motion)) return CoverAnswer::kApart;
  return hits_scene(s, scene_shape) ? CoverAnswer::kOverlap : CoverAnswer::kMaybe;
}

bool CollisionChecker::Impl::hits_scene_exactly(int s, int scene_shape, double more) {
  const detail::SceneShape& other = snapshot->scene[scene_shape];
  return detail::solids_collide(*snapshot->shapes[s].padded, pose(s), *other.solid, other.T_world, more);
}

bool CollisionChecker::Impl::hits_scene(int s, int scene_shape) {
  const CoverAnswer answer = scene_balls(s, scene_shape);
  return answer == detail::kMaybe ? hits_scene_exactly(s, scene_shape) : answer == detail::kOverlap;
}

}  // namespace mmgrasp
