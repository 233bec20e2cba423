#include "collision/checker/edge_walk.hpp"

#include <algorithm>
#include <cmath>

#include "collision/narrow/field_query.hpp"
#include "collision/narrow/stages.hpp"

namespace mmgrasp::detail {

namespace {

// Far checks first finds collisions early; once this many intervals wait, one is finished after the other, which keeps
// memory independent of the number of pieces.
constexpr std::size_t kMaxWaitingIntervals = 256;

// A lower bound of the clearance of a sphere and an unbounded shape.
double clearance_to(const SceneShape& other, const Eigen::Vector3d& centre, double radius) {
  const Eigen::Vector3d in_other = other.T_world.R.transpose() * (centre - other.T_world.t);
  if (other.solid->kind == SolidKind::voxels)
    return other.solid->grid->distance(in_other) - other.solid->margin - radius;
  if (other.solid->kind == SolidKind::field)
    return field_clearance(*other.solid->field, in_other, radius) - other.solid->margin;
  return other.solid->normal.dot(in_other) - other.solid->offset - radius;
}

}  // namespace

void EdgeWalk::place(long at) {
  if (at == placed_) return;
  placed_ = at;
  q_ = q0_ + delta_ * (static_cast<double>(at) / static_cast<double>(pieces_));
  placement_->place(q_.data());
}

bool EdgeWalk::all_free(Placement& placement, CollisionSearch& search, const Eigen::VectorXd& q0,
                        const Eigen::VectorXd& q1, long pieces) {
  checks_ = 0;
  if (pieces < 2) return true;
  placement_ = &placement;
  search_ = &search;
  q0_ = q0;
  delta_ = q1 - q0;
  pieces_ = pieces;
  placed_ = 0;
  if constexpr (!runs(kIntervalStage)) return each_is_free();
  // Most blocked edges hit the scene in the middle, deep enough for covers to tell: that is asked before anything is
  // proven about the edge.
  place(pieces / 2);
  if (search.surely_hits_scene(placement)) {
    checks_ = 1;
    return false;
  }
  piece_ = delta_ / static_cast<double>(pieces);
  motion_.start(placement, q0, q1, piece_);
  memory_.assign(placement.plan().varying.size(), {});
  return intervals_free();
}

bool EdgeWalk::intervals_free() {
  const Snapshot& snapshot = placement_->snapshot();
  const PairPlan& plan = placement_->plan();
  open_.clear();
  if (snapshot.options.check_scene && !snapshot.scene.empty()) {
    // The outer links are the ones that hit something.
    for (int i = plan.moving_in_scene; i-- > 0;) open_.push_back(i);
  }
  const std::size_t bodies = open_.size();
  if (snapshot.options.check_self) {
    for (int i = 0; i < static_cast<int>(plan.varying.size()); ++i) open_.push_back(i);
  }
  queue_.assign(1, {0, pieces_, 0, bodies, open_.size()});
  bool depth_first = false;
  for (std::size_t next = 0; next < queue_.size();) {
    depth_first = depth_first || queue_.size() - next > kMaxWaitingIntervals;
    const Interval interval = depth_first ? queue_.back() : queue_[next];
    if (depth_first) {
      // All that wait were put there before: their lists lie within this one's end.
      queue_.pop_back();
      open_.resize(interval.end);
    } else {
      ++next;
    }
    const long middle = (interval.low + interval.high) / 2;
    const long reach = std::max(middle - interval.low, interval.high - middle) - 1;
    Interval rest = interval;
    if (!check(interval, middle, static_cast<double>(reach), rest)) return false;
    if (rest.end == rest.bodies || tables_clear(rest)) continue;
    rest.high = middle;
    if (rest.high - rest.low > 1) queue_.push_back(rest);
    rest.low = middle;
    rest.high = interval.high;
    if (rest.high - rest.low > 1) queue_.push_back(rest);
  }
  // What was proven counts as checked.
  checks_ = pieces_ - 1;
  return true;
}

bool EdgeWalk::each_is_free() {
  for (long at = 1; at < pieces_; ++at) {
    ++checks_;
    place(at);
    if (!search_->is_free(*placement_)) return false;
  }
  return true;
}

bool EdgeWalk::check(const Interval& interval, long at, double reach, Interval& rest) {
  ++checks_;
  place(at);
  motion_.placed();
  rest.bodies = open_.size();
  if (!bodies_free(interval, reach)) return false;
  rest.pairs = open_.size();
  if (!pairs_free(interval, reach)) return false;
  rest.end = open_.size();
  return true;
}

bool EdgeWalk::bodies_free(const Interval& interval, double reach) {
  const Snapshot& snapshot = placement_->snapshot();
  for (std::size_t n = interval.bodies; n < interval.pairs; ++n) {
    const int body = open_[n];
    bool proven = true;
    if (!search_->body_is_free(*placement_, body, motion_, reach, proven)) return false;
    for (int i = snapshot.packed; i < static_cast<int>(snapshot.scene.size()); ++i) {
      if (snapshot.allowed(placement_->plan().moving[body], i)) continue;
      const double radius = placement_->spheres().radius[body];
      if (clearance_to(snapshot.scene[i], placement_->sphere_centre(body), radius) > motion_.of_body(body, reach).most)
        continue;
      proven = false;
      if (scene_collides(*placement_, placement_->plan().moving[body], i)) return false;
    }
    if (!proven) open_.push_back(body);
  }
  return true;
}

bool EdgeWalk::tables_clear(const Interval& interval) const {
  if (!runs(kTableStage) || interval.pairs > interval.bodies) return false;
  const auto clears = [&](int index) {
    const ShapePair& pair = placement_->plan().varying[index];
    const auto [i, j] = pair.columns;
    const double share = 1 / static_cast<double>(pieces_);
    return pair.clearances && pair.clearances->stays_apart({q0_[i], q0_[j]}, {delta_[i] * share, delta_[j] * share},
                                                           interval.low + 1, interval.high - 1);
  };
  return std::all_of(open_.begin() + static_cast<long>(interval.pairs), open_.begin() + static_cast<long>(interval.end),
                     clears);
}

bool EdgeWalk::pairs_free(const Interval& interval, double reach) {
  for (std::size_t n = interval.pairs; n < interval.end; ++n) {
    const int index = open_[n];
    const ShapePair& pair = placement_->plan().varying[index];
    const float* radius = placement_->spheres().radius;
    const double clearance =
        (placement_->sphere_centre(pair.sphere_a) - placement_->sphere_centre(pair.sphere_b)).norm() -
        radius[pair.sphere_a] - radius[pair.sphere_b];
    if (runs(kSphereStage) && clearance > motion_.of_pair_anywhere(index, reach)) continue;
    // The last check within an interval proves nothing about others.
    Closing motion;
    if (reach > 0) motion = motion_.of_pair(index, reach);
    if (runs(kSphereStage) && clearance > motion.most) continue;
    if (runs(kTableStage) && pair.clearances) {
      const double apart = pair.clearances->at_least(q_[pair.columns[0]], q_[pair.columns[1]], motion.most);
      if (apart > motion.most) continue;
      if (apart > 0) {
        open_.push_back(index);
        continue;
      }
    }
    const CoverAnswer answer = pair_within(*placement_, pair, motion, memory_[index]);
    if (answer == kApart) continue;
    if (answer == kOverlap) {
      search_->remember_pair(index);
      return false;
    }
    open_.push_back(index);
  }
  return true;
}

}  // namespace mmgrasp::detail
