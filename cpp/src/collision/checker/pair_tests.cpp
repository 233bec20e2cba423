#include "collision/checker/pair_tests.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "collision/narrow/narrow.hpp"
#include "collision/narrow/stages.hpp"

namespace mmgrasp::detail {
namespace {

FloatRigid to_float(const Rigid& T) {
  FloatRigid out;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) out.R[3 * r + c] = static_cast<float>(T.R(r, c));
    out.t[r] = static_cast<float>(T.t[r]);
  }
  return out;
}

// Spheres grown by more than this meet cells of a grid everywhere [m].
constexpr double kMaxGridMotion = 0.02;

// The exact shapes are only tested for clearances up to this [m]: spheres and hulls have proven most wider ones.
constexpr double kMaxExactMotion = 0.005;

// Hulls this close are left to the exact answer [m].
constexpr double kHullTouch = 1e-7;

// Single precision rounds sums of these magnitudes a few times: far below 2e-6 of them.
float slack_of(const FloatRigid& T, float extent_a, float extent_b) {
  return 2e-6f * (std::abs(T.t[0]) + std::abs(T.t[1]) + std::abs(T.t[2]) + 3 * (extent_a + extent_b));
}

// The bounding box of a body in the frame of another one, single precision.
struct FloatBox {
  FloatBox(const Rigid& T_from, const Solid& solid, const Rigid& T_solid) {
    Rigid box = T_from.to(T_solid);
    box.t += box.R * solid.box_centre;
    T = to_float(box);
    for (int k = 0; k < 3; ++k) half[k] = static_cast<float>(solid.box_half[k]);
  }
  float slack(const SphereCover& cover) const {
    return slack_of(T, cover.extent(), std::max({half[0], half[1], half[2]}));
  }
  FloatRigid T;
  float half[3];
};

// The arrays of all levels of a cover.
std::array<CoverView, BoundingVolumes::kLevels> views(const CoverLevels& covers) {
  std::array<CoverView, BoundingVolumes::kLevels> out;
  for (std::size_t i = 0; i < covers.size(); ++i) out[i] = covers[i].view();
  return out;
}

// A body's cover, placed at T_a, against the bounding box of the other one.
CoverAnswer cover_against_box(const SphereCover& cover, const Rigid& T_a, const Solid& other, const Rigid& T_b,
                              double grow) {
  const FloatBox box(T_a, other, T_b);
  return kernels().cover_meets_box(cover.view(), box.T, box.half, static_cast<float>(grow), box.slack(cover), true);
}

// A lower bound of their clearance; not above 0 where there is none.
double cover_clearance(const SphereCover& cover, const Rigid& T_a, const Solid& other, const Rigid& T_b) {
  const FloatBox box(T_a, other, T_b);
  return kernels().cover_to_box(cover.view(), box.T, box.half, box.slack(cover));
}

// The same for its cover in all levels.
CoverAnswer cover_tree_against_box(const CoverLevels& covers, const Rigid& T_a, const Solid& other, const Rigid& T_b,
                                   double grow, bool seek_overlap) {
  const FloatBox box(T_a, other, T_b);
  return kernels().cover_tree_meets_box(views(covers).data(), static_cast<int>(covers.size()), box.T, box.half,
                                        static_cast<float>(grow), box.slack(covers[0]), seek_overlap);
}

// A body's spheres, placed at T_cover, in the grid of a body at T_grid.
CoverAnswer cover_in_grid(const DistanceGrid& grid, const Rigid& T_grid, const CoverLevels& spheres,
                          const Rigid& T_cover, double grow, bool seek_overlap) {
  const FloatRigid T = to_float(T_grid.to(T_cover));
  return kernels().cover_tree_meets_grid(grid.view(), views(spheres).data(), static_cast<int>(spheres.size()), T,
                                         static_cast<float>(grow), slack_of(T, grid.extent(), spheres[0].extent()),
                                         seek_overlap);
}

// How near two solids, or the hulls around them, come to each other; `touching` also where there is no such hull.
Nearness hull_nearness(const Solid& a, const Rigid& T_a, const Solid& b, const Rigid& T_b, const Closing& closing,
                       Eigen::Vector3d& axis, double& share) {
  const auto bounded = [](const Solid& s) { return s.kind == SolidKind::convex || s.has_hull; };
  if (!bounded(a) || !bounded(b)) return Nearness::touching;
  const double margin = a.margin + b.margin;
  return convex_nearness(a.core, b.core, T_a.to(T_b), closing.seen_from(T_a), margin + kHullTouch, axis, share);
}

// Whether both have covers at all.
bool have_covers(const BodyShape& a, const BodyShape& b) {
  return !a.bounds->cover().empty() && !b.bounds->cover().empty();
}

// The finer covers in the other body's box or grid. With `motion` > 0 [m] kApart means that the two stay apart while
// they come no more than that closer, and kMaybe proves nothing.
CoverAnswer pair_by_fine_covers(Placement& placement, const ShapePair& pair, double motion) {
  const Snapshot& snapshot = placement.snapshot();
  const BodyShape &a = snapshot.shapes[pair.a], &b = snapshot.shapes[pair.b];
  const Rigid &T_a = placement.pose(pair.a), &T_b = placement.pose(pair.b);
  const bool seek_overlap = motion == 0;
  if (!runs(kFineStage) || motion > kMaxGridMotion) return kMaybe;
  // Where their table proves nothing these come too close for covers to tell.
  if (runs(kTableStage) && pair.clearances) return kMaybe;
  // A box needs no grid.
  if (a.solid->is_box != b.solid->is_box) {
    const BodyShape &box = a.solid->is_box ? a : b, &other = a.solid->is_box ? b : a;
    const Rigid &T_box = a.solid->is_box ? T_a : T_b, &T_other = a.solid->is_box ? T_b : T_a;
    return cover_tree_against_box(other.bounds->levels(*other.solid), T_other, *box.solid, T_box, motion, seek_overlap);
  }
  // The grid of the larger body, if it has one: the smaller one has the smaller spheres.
  const bool a_larger = a.solid->sphere_radius > b.solid->sphere_radius;
  const auto by_grid = [&](const BodyShape& body, const Rigid& T_body, const BodyShape& covered,
                           const Rigid& T_covered) {
    return cover_in_grid(*body.bounds->grid(*body.solid), T_body, covered.bounds->levels(*covered.solid), T_covered,
                         motion, seek_overlap);
  };
  const auto is_mesh = [](const BodyShape& shape) { return shape.solid->kind == SolidKind::mesh; };
  if (is_mesh(a) && (a_larger || !is_mesh(b))) return by_grid(a, T_a, b, T_b);
  return is_mesh(b) ? by_grid(b, T_b, a, T_a) : kMaybe;
}

// Lower bounds of the clearance by the first covers; not above 0 where they prove none. Of a pair, the second cover is
// only asked where the first does not prove `wanted` [m].
double pair_cover_clearance(Placement& placement, const ShapePair& pair, double wanted) {
  const Snapshot& snapshot = placement.snapshot();
  const BodyShape &a = snapshot.shapes[pair.a], &b = snapshot.shapes[pair.b];
  if (!runs(kCoverStage) || !have_covers(a, b)) return 0;
  const Rigid &T_a = placement.pose(pair.a), &T_b = placement.pose(pair.b);
  const double first = cover_clearance(a.bounds->cover(), T_a, *b.solid, T_b);
  return first > wanted ? first : std::max(first, cover_clearance(b.bounds->cover(), T_b, *a.solid, T_a));
}

double scene_cover_clearance(Placement& placement, int s, int scene_shape) {
  const BodyShape& shape = placement.snapshot().shapes[s];
  const SceneShape& other = placement.snapshot().scene[scene_shape];
  if (!runs(kCoverStage) || shape.bounds->cover().empty()) return 0;
  return cover_clearance(shape.bounds->cover(), placement.pose(s), *other.solid, other.T_world) - shape.growth -
         other.solid->margin;
}

bool spheres_apart(const SphereRows& spheres, int a, int b) {
  const auto [x, y, z, radius] = spheres;
  const float dx = x[a] - x[b], dy = y[a] - y[b], dz = z[a] - z[b], reach = radius[a] + radius[b];
  return dx * dx + dy * dy + dz * dz > reach * reach;
}

// Where one of them moves, false proves that they stay apart, and true nothing. `hulls_meet`: their hulls are known to.
bool pair_meets_exactly(Placement& placement, const ShapePair& pair, const Closing& closing, bool hulls_meet) {
  const Snapshot& snapshot = placement.snapshot();
  const BodyShape &a = snapshot.shapes[pair.a], &b = snapshot.shapes[pair.b];
  if (runs(kFineStage) && a.solid->kind == SolidKind::mesh && b.solid->kind == SolidKind::mesh) {
    // Few large triangles look for their like in a grid around the smaller body.
    const bool grid_of_a = a.solid->sphere_radius < b.solid->sphere_radius;
    const BodyShape &first = grid_of_a ? a : b, &second = grid_of_a ? b : a;
    return meshes_collide(*first.solid, placement.pose(grid_of_a ? pair.a : pair.b), *first.bounds->grid(*first.solid),
                          *second.solid, placement.pose(grid_of_a ? pair.b : pair.a),
                          grid_of_a ? closing : closing.swapped(), hulls_meet);
  }
  return solids_collide(*a.solid, placement.pose(pair.a), *b.solid, placement.pose(pair.b), closing.most);
}

// Their hulls are known to meet.
bool scene_meets_exactly(Placement& placement, int shape, int scene_shape, double motion) {
  const Snapshot& snapshot = placement.snapshot();
  const SceneShape& other = snapshot.scene[scene_shape];
  return solids_collide(*snapshot.shapes[shape].padded, placement.pose(shape), *other.solid, other.T_world, motion,
                        true, motion > 0 ? nullptr : &placement.memory(shape, scene_shape).piece);
}

// Whether the triangle that hit last hits again: quicker to find out than anything about the hulls.
bool last_piece_hits(Placement& placement, int shape, int scene_shape) {
  const int piece = placement.memory(shape, scene_shape).piece;
  if (piece < 0 || !runs(kLastCollisionStage)) return false;
  const Snapshot& snapshot = placement.snapshot();
  const SceneShape& other = snapshot.scene[scene_shape];
  return piece_collides(*snapshot.shapes[shape].padded, placement.pose(shape), *other.solid, other.T_world, piece);
}

// Seen from the scene's shape, which stands still, the direction between them lasts longest.
Nearness hulls_in_scene(Placement& placement, int shape, int scene_shape, const Closing& closing, double& share) {
  const Snapshot& snapshot = placement.snapshot();
  const SceneShape& other = snapshot.scene[scene_shape];
  return hull_nearness(*other.solid, other.T_world, *snapshot.shapes[shape].padded, placement.pose(shape), closing,
                       placement.memory(shape, scene_shape).axis, share);
}

}  // namespace

CoverAnswer pair_by_covers(Placement& placement, const ShapePair& pair) {
  const Snapshot& snapshot = placement.snapshot();
  const BodyShape &a = snapshot.shapes[pair.a], &b = snapshot.shapes[pair.b];
  if (!have_covers(a, b)) return kMaybe;
  if constexpr (runs(kCoverStage)) {
    const Rigid &T_a = placement.pose(pair.a), &T_b = placement.pose(pair.b);
    const CoverAnswer first = cover_against_box(a.bounds->cover(), T_a, *b.solid, T_b, 0);
    if (first == kApart || (first == kOverlap && b.solid->is_box)) return first;
    const CoverAnswer second = cover_against_box(b.bounds->cover(), T_b, *a.solid, T_a, 0);
    if (second == kApart || (second == kOverlap && a.solid->is_box)) return second;
  }
  return pair_by_fine_covers(placement, pair, 0);
}

CoverAnswer scene_by_covers(Placement& placement, int s, int scene_shape) {
  const Snapshot& snapshot = placement.snapshot();
  const BodyShape& shape = snapshot.shapes[s];
  const SceneShape& other = snapshot.scene[scene_shape];
  if (snapshot.allowed(s, scene_shape)) return kApart;
  const bool unbounded = other.solid->kind == SolidKind::plane || other.solid->kind == SolidKind::field;
  if (shape.bounds->cover().empty() || unbounded) return kMaybe;
  const double grow = shape.growth + other.solid->margin;
  if (other.solid->kind == SolidKind::voxels) {
    const int sphere = placement.plan().sphere_of[s];
    const Eigen::Vector3d centre = other.T_world.R.transpose() * (placement.sphere_centre(sphere) - other.T_world.t);
    if (other.solid->grid->distance(centre) > placement.spheres().radius[sphere] + other.solid->margin) return kApart;
    return cover_in_grid(*other.solid->grid, other.T_world, shape.bounds->levels(*shape.solid), placement.pose(s), grow,
                         true);
  }
  if constexpr (!runs(kCoverStage)) return kMaybe;
  const CoverAnswer answer =
      cover_against_box(shape.bounds->cover(), placement.pose(s), *other.solid, other.T_world, grow);
  return answer == kOverlap && !other.solid->is_box ? kMaybe : answer;
}

bool pair_collides_exactly(Placement& placement, const ShapePair& pair) {
  return pair_meets_exactly(placement, pair, {}, false);
}

bool scene_collides_exactly(Placement& placement, int shape, int scene_shape) {
  double share = 0;
  if (last_piece_hits(placement, shape, scene_shape)) return true;
  return hulls_in_scene(placement, shape, scene_shape, {}, share) == Nearness::touching &&
         scene_meets_exactly(placement, shape, scene_shape, 0);
}

bool pair_collides(Placement& placement, const ShapePair& pair) {
  if (spheres_apart(placement.spheres(), pair.sphere_a, pair.sphere_b)) return false;
  const CoverAnswer answer = pair_by_covers(placement, pair);
  return answer == kMaybe ? pair_collides_exactly(placement, pair) : answer == kOverlap;
}

bool scene_collides(Placement& placement, int shape, int scene_shape) {
  const CoverAnswer answer = scene_by_covers(placement, shape, scene_shape);
  return answer == kMaybe ? scene_collides_exactly(placement, shape, scene_shape) : answer == kOverlap;
}

bool only_padding_meets(Placement& placement, int shape, int scene_shape) {
  const BodyShape& a = placement.snapshot().shapes[shape];
  const SceneShape& b = placement.snapshot().scene[scene_shape];
  if (a.padded == a.solid && b.solid == b.bare) return false;
  return !solids_collide(*a.solid, placement.pose(shape), *b.bare, b.T_world);
}

Within pair_within(Placement& placement, const ShapePair& pair, const Closing& closing, PairMemory& memory) {
  if (closing.most == 0) return {pair_collides(placement, pair), 0};
  const Snapshot& snapshot = placement.snapshot();
  const Solid &a = *snapshot.shapes[pair.a].solid, &b = *snapshot.shapes[pair.b].solid;
  const double clearance = pair_cover_clearance(placement, pair, std::min(closing.most, kMaxProvenMotion));
  Within out{false, closing.share(clearance)};
  if (out.share == 1) return out;
  if (closing.most > kMaxProvenMotion) {
    if (clearance <= 0) out.touch = pair_collides(placement, pair);
    return out;
  }
  if (have_covers(snapshot.shapes[pair.a], snapshot.shapes[pair.b]) &&
      pair_by_fine_covers(placement, pair, closing.most) == kApart)
    return {false, 1};
  if (!memory.hulls_meet) {
    double share = 0;
    if (hull_nearness(a, placement.pose(pair.a), b, placement.pose(pair.b), closing, memory.axis, share) !=
        Nearness::touching)
      return {false, std::max(share, out.share)};
    memory.hulls_meet = true;
  }
  if (closing.most <= kMaxExactMotion && !pair_meets_exactly(placement, pair, closing, true)) return {false, 1};
  if (clearance <= 0) out.touch = pair_collides(placement, pair);
  return out;
}

Within scene_within(Placement& placement, int s, int scene_shape, const Closing& closing) {
  if (placement.snapshot().allowed(s, scene_shape)) return {false, 1};
  const double clearance = scene_cover_clearance(placement, s, scene_shape);
  Within out{false, closing.share(clearance)};
  if (out.share == 1) return out;
  // What moves far hardly ever turns out to stay clear: first whether it hits where it is.
  const bool far = closing.most > kMaxProvenMotion;
  if (far && clearance > 0) return out;
  const auto surely_hits = [&] {
    return scene_by_covers(placement, s, scene_shape) == kOverlap || last_piece_hits(placement, s, scene_shape);
  };
  if (far && surely_hits()) return {true, 0};
  double share = 0;
  if (hulls_in_scene(placement, s, scene_shape, closing, share) != Nearness::touching)
    return {false, std::max(share, out.share)};
  if (closing.most <= kMaxExactMotion && !scene_meets_exactly(placement, s, scene_shape, closing.most))
    return {false, 1};
  if (clearance <= 0) out.touch = (!far && surely_hits()) || scene_meets_exactly(placement, s, scene_shape, 0);
  return out;
}

}  // namespace mmgrasp::detail
