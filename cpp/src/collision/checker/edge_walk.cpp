#include "collision/checker/edge_walk.hpp"

#include <algorithm>
#include <cmath>

#include "collision/narrow/field_query.hpp"
#include "collision/narrow/stages.hpp"
#include "mmgrasp/core/detail/interruption.hpp"

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

void EdgeWalk::place(int at) {
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
  pieces_ = static_cast<int>(pieces);
  placed_ = 0;
  if constexpr (!runs(kIntervalStage)) return each_is_free();
  // Most blocked edges hit the scene in the middle, deep enough for covers to tell: that is asked before anything is
  // proven about the edge.
  place(pieces_ / 2);
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
    for (int i = plan.moving_in_scene; i-- > 0;) open_.push_back({i, 0, pieces_});
  }
  const std::size_t bodies = open_.size();
  if (snapshot.options.check_self) {
    for (int i = 0; i < static_cast<int>(plan.varying.size()); ++i) open_.push_back({i, 0, pieces_});
  }
  queue_.assign(1, {pieces_ / 2, 0, bodies, open_.size()});
  bool depth_first = false;
  for (std::size_t next = 0; next < queue_.size();) {
    depth_first = depth_first || queue_.size() - next > kMaxWaitingIntervals;
    throw_if_interrupted();
    const Interval interval = depth_first ? queue_.back() : queue_[next];
    if (depth_first) {
      // All that wait were put there before: their lists lie within this one's end.
      queue_.pop_back();
      open_.resize(interval.end);
    } else {
      ++next;
    }
    if (!check(interval)) return false;
  }
  // What was proven counts as checked.
  checks_ = pieces_ - 1;
  return true;
}

void EdgeWalk::keep(const Open& entry, int at, int proven) {
  const Open left{entry.index, entry.low, std::min(entry.high, at - proven)};
  const Open right{entry.index, std::max(entry.low, at + proven), entry.high};
  if (left.any()) left_.push_back(left);
  if (right.any()) right_.push_back(right);
}

void EdgeWalk::queue(const std::vector<Open>& side, std::size_t bodies) {
  if (side.empty()) return;
  if (bodies == 0 && std::all_of(side.begin(), side.end(), [&](const Open& pair) { return table_clears(pair); }))
    return;
  const Open widest = *std::max_element(side.begin(), side.end(),
                                        [](const Open& a, const Open& b) { return a.high - a.low < b.high - b.low; });
  const std::size_t begin = open_.size();
  open_.insert(open_.end(), side.begin(), side.end());
  queue_.push_back({widest.low + (widest.high - widest.low) / 2, begin, begin + bodies, open_.size()});
}

bool EdgeWalk::each_is_free() {
  for (int at = 1; at < pieces_; ++at) {
    throw_if_interrupted();
    ++checks_;
    place(at);
    if (!search_->is_free(*placement_)) return false;
  }
  return true;
}

bool EdgeWalk::check(const Interval& interval) {
  ++checks_;
  place(interval.at);
  motion_.placed();
  left_.clear();
  right_.clear();
  if (!bodies_free(interval)) return false;
  const std::size_t left = left_.size(), right = right_.size();
  if (!pairs_free(interval)) return false;
  queue(left_, left);
  queue(right_, right);
  return true;
}

bool EdgeWalk::bodies_free(const Interval& interval) {
  const Snapshot& snapshot = placement_->snapshot();
  const int at = interval.at;
  for (std::size_t n = interval.bodies; n < interval.pairs; ++n) {
    const Open entry = open_[n];
    const int body = entry.index;
    const double reach = std::max(at - entry.low, entry.high - at) - 1;
    double share = 1;
    if (!search_->body_is_free(*placement_, body, motion_, reach, share)) return false;
    for (int i = snapshot.packed; i < static_cast<int>(snapshot.scene.size()); ++i) {
      if (snapshot.allowed(placement_->plan().moving[body], i)) continue;
      const double radius = placement_->spheres().radius[body];
      const double clearance = clearance_to(snapshot.scene[i], placement_->sphere_centre(body), radius);
      const double lasts = motion_.of_body(body, reach).share(clearance);
      share = std::min(share, lasts);
      if (lasts < 1 && scene_collides(*placement_, placement_->plan().moving[body], i)) return false;
    }
    if (share < 1) keep(entry, at, static_cast<int>(share * reach));
  }
  return true;
}

bool EdgeWalk::table_clears(const Open& entry) const {
  const ShapePair& pair = placement_->plan().varying[entry.index];
  const auto [i, j] = pair.columns;
  const double share = 1 / static_cast<double>(pieces_);
  return runs(kTableStage) && pair.clearances &&
         pair.clearances->stays_apart({q0_[i], q0_[j]}, {delta_[i] * share, delta_[j] * share}, entry.low + 1,
                                      entry.high - 1);
}

bool EdgeWalk::pairs_free(const Interval& interval) {
  const SphereRows spheres = placement_->spheres();
  const int at = interval.at;
  for (std::size_t n = interval.pairs; n < interval.end; ++n) {
    const Open entry = open_[n];
    const int index = entry.index;
    const ShapePair& pair = placement_->plan().varying[index];
    const double reach = std::max(at - entry.low, entry.high - at) - 1;
    const double clearance =
        (placement_->sphere_centre(pair.sphere_a) - placement_->sphere_centre(pair.sphere_b)).norm() -
        spheres.radius[pair.sphere_a] - spheres.radius[pair.sphere_b];
    if (runs(kSphereStage) && clearance > motion_.of_pair_anywhere(index, reach)) continue;
    // The last check of an entry proves nothing about others.
    Closing motion;
    if (reach > 0) motion = motion_.of_pair(index, reach);
    double share = 0;
    if (runs(kSphereStage) && clearance > 0) {
      share = motion.share(clearance);
      if (share == 1) continue;
    }
    if (runs(kTableStage) && pair.clearances) {
      const double apart = pair.clearances->at_least(q_[pair.columns[0]], q_[pair.columns[1]], motion.most);
      if (apart > motion.most) continue;
      if (apart > 0) {
        keep(entry, at, static_cast<int>(std::max(share, motion.share(apart)) * reach));
        continue;
      }
    }
    // Spheres apart: the rest could only prove more of a way on which hardly any pair stays clear.
    if (share == 0 || motion.most <= kMaxProvenMotion) {
      const Within within = pair_within(*placement_, pair, motion, memory_[index]);
      if (within.touch) {
        search_->remember_pair(index);
        return false;
      }
      share = std::max(share, within.share);
      if (share == 1) continue;
    }
    keep(entry, at, static_cast<int>(share * reach));
  }
  return true;
}

}  // namespace mmgrasp::detail
