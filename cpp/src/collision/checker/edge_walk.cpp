#include "collision/checker/edge_walk.hpp"

#include <algorithm>
#include <cmath>

namespace mmgrasp {

using detail::SceneShape;
using detail::ShapePair;
using detail::Snapshot;

namespace {

// Single precision of gaps and rates; the balls' radii carry the slack of their own coordinates.
double surely(double motion) {
  return motion * (1 + 1e-5) + 1e-7;
}

// Far checks first finds collisions early; once this many intervals wait, one is finished after the other, which keeps
// memory independent of the number of pieces.
constexpr std::size_t kBroad = 256;

// From below.
double gap_to(const SceneShape& other, const Eigen::Vector3d& centre, double radius) {
  const Eigen::Vector3d in_other = other.T_world.R.transpose() * (centre - other.T_world.t);
  if (other.solid->kind == detail::SolidKind::voxels) return other.solid->field->distance(in_other) - radius;
  return other.solid->normal.dot(in_other) - other.solid->offset - radius;
}

}  // namespace

CollisionChecker::Impl::EdgeWalk::EdgeWalk(Impl& checker, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1,
                                           long pieces)
    : checker_(checker), q0_(q0), delta_(q1 - q0), q_(q0.size()), pieces_(pieces) {
  if (pieces < 2) return;
  const Eigen::VectorXd step = delta_.cwiseAbs() / static_cast<double>(pieces);
  const detail::MotionRates own = checker.plan->rates_along(q0, q1);
  const detail::MotionRates& rates = checker.plan->rates.finite ? checker.plan->rates : own;
  body_motion_ = rates.shapes.transpose() * step;
  pair_motion_ = rates.pairs.transpose() * step;
  hulls_meet_.assign(checker.plan->varying.size(), 0);
}

bool CollisionChecker::Impl::EdgeWalk::all_free() {
  if (pieces_ < 2) return true;
  const CheckerOptions& options = checker_.snapshot->options;
  open_.clear();
  if (options.check_scene && !checker_.snapshot->scene.empty()) {
    for (int i = 0; i < checker_.plan->moving_in_scene; ++i) open_.push_back(i);
  }
  const std::size_t bodies = open_.size();
  if (options.check_self) {
    for (int i = 0; i < static_cast<int>(checker_.plan->varying.size()); ++i) open_.push_back(i);
  }
  std::size_t looked_at = 0;
  std::vector<Interval> queue{{0, pieces_, 0, bodies, open_.size()}};
  bool deep = false;
  for (std::size_t next = 0; next < queue.size();) {
    deep = deep || queue.size() - next > kBroad;
    const Interval interval = deep ? queue.back() : queue[next];
    if (deep) {
      // All that wait were put there before: their lists lie within this one's end.
      queue.pop_back();
      open_.resize(interval.end);
    } else {
      ++next;
    }
    const long middle = (interval.low + interval.high) / 2;
    const long reach = std::max(middle - interval.low, interval.high - middle) - 1;
    Interval rest = interval;
    ++looked_at;
    if (!look(interval, middle, static_cast<double>(reach), rest)) return false;
    if (rest.end == rest.bodies) continue;
    rest.high = middle;
    if (rest.high - rest.low > 1) queue.push_back(rest);
    rest.low = middle;
    rest.high = interval.high;
    if (rest.high - rest.low > 1) queue.push_back(rest);
  }
  // What was proven counts as checked.
  checker_.queries += static_cast<std::size_t>(pieces_ - 1) - looked_at;
  return true;
}

bool CollisionChecker::Impl::EdgeWalk::look(const Interval& interval, long at, double reach, Interval& rest) {
  q_ = q0_ + delta_ * (static_cast<double>(at) / static_cast<double>(pieces_));
  ++checker_.queries;
  checker_.place_balls(q_.data());
  rest.bodies = open_.size();
  if (!bodies_free(interval, reach)) return false;
  rest.pairs = open_.size();
  if (!pairs_free(interval, reach)) return false;
  rest.end = open_.size();
  return true;
}

bool CollisionChecker::Impl::EdgeWalk::bodies_free(const Interval& interval, double reach) {
  const Snapshot& snapshot = *checker_.snapshot;
  for (std::size_t n = interval.bodies; n < interval.pairs; ++n) {
    const int body = open_[n];
    const double motion = surely(body_motion_[body] * reach);
    bool proven = true;
    if (!checker_.body_is_free(body, motion, proven)) return false;
    for (int i = snapshot.packed; i < static_cast<int>(snapshot.scene.size()); ++i) {
      const double gap = gap_to(snapshot.scene[i], checker_.ball_centre(body), checker_.placed_balls().radius[body]);
      if (gap > motion) continue;
      proven = false;
      if (checker_.hits_scene(checker_.plan->moving[body], i)) return false;
    }
    if (!proven) open_.push_back(body);
  }
  return true;
}

bool CollisionChecker::Impl::EdgeWalk::pairs_free(const Interval& interval, double reach) {
  for (std::size_t n = interval.pairs; n < interval.end; ++n) {
    const int index = open_[n];
    const ShapePair& pair = checker_.plan->varying[index];
    const float* radius = checker_.placed_balls().radius;
    const double gap = (checker_.ball_centre(pair.ball_a) - checker_.ball_centre(pair.ball_b)).norm() -
                       radius[pair.ball_a] - radius[pair.ball_b];
    const double motion = surely(pair_motion_[index] * reach);
    if (gap > motion) continue;
    if (pair.gaps) {
      const double wanted = reach > 0 ? motion : 0;
      const double apart = pair.gaps->at_least(q_[pair.columns[0]], q_[pair.columns[1]], wanted);
      if (apart > wanted) continue;
      if (apart > 0) {
        open_.push_back(index);
        continue;
      }
    }
    // The last look within an interval proves nothing about others.
    const detail::CoverAnswer answer = checker_.pair_within(pair, reach > 0 ? motion : 0, hulls_meet_[index]);
    if (answer == detail::kApart) continue;
    if (answer == detail::kOverlap) {
      checker_.last_pair = index;
      return false;
    }
    open_.push_back(index);
  }
  return true;
}

}  // namespace mmgrasp
