#include "plan/manipulation/common/informed_union.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/ball_volume.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kTries = 10000;       // Draws before a union is called too thin.
constexpr double kAround = 0.1;     // [rad or m]
constexpr double kThin = 1e-9;      // Ellipsoids longer than their axis by less than this share have no inside.
constexpr int kGuesses = 64;        // Random ellipsoids asked before all of them are.
constexpr double kScanShare = 0.1;  // Time to ask one grasp, by that of one draw.

}  // namespace

InformedUnion::InformedUnion(const GraspEnds& ends, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper)
    : ends_(ends),
      lower_(lower),
      upper_(upper),
      ball_volume_(unit_ball_volume(ends.dimension())),
      box_volume_((upper - lower).prod()),
      cost_(kInfinity),
      grasps_(ends.size()),
      ball_(ends.dimension() + 1) {
  for (int g = 0; g < ends.size(); ++g) {
    first_of_.push_back(all_.size());
    for (int s = 0; s < ends.count(g, GraspEnds::kStart); ++s)
      for (int k = 0; k < ends.count(g, GraspEnds::kGoal); ++k) {
        const double squared =
            squared_distance(ends.end(g, GraspEnds::kStart, s), ends.end(g, GraspEnds::kGoal, k), ends.dimension());
        all_.push_back({g, s, k, std::sqrt(squared), 0});
      }
  }
  first_of_.push_back(all_.size());
  pairs_.reserve(all_.size());
  first_pair_.reserve(static_cast<std::size_t>(ends.size()) + 1);
}

void InformedUnion::set_cost(double cost) {
  cost_ = cost;
  grasps_ = ends_.below(cost / (1 + kThin));
  prepared_ = false;
}

double InformedUnion::ellipsoid_volume(const Pair& pair) const {
  const double c = cost_ - ends_.cost(pair.grasp);
  if (!(c > pair.c_min * (1 + kThin))) return 0;
  const double across = 0.25 * (c * c - pair.c_min * pair.c_min);
  return ball_volume_ * 0.5 * c * std::pow(across, 0.5 * (ends_.dimension() - 1));
}

void InformedUnion::prepare() {
  prepared_ = true;
  pairs_.clear();
  first_pair_.clear();
  volumes_.assign(static_cast<std::size_t>(grasps_), 0);
  double sum = 0;
  for (const Pair& pair : all_) {
    if (pair.grasp >= grasps_) break;
    while (static_cast<int>(first_pair_.size()) <= pair.grasp) first_pair_.push_back(pairs_.size());
    const double own = ellipsoid_volume(pair);
    if (!(own > 0)) continue;
    volumes_[pair.grasp] += own;
    pairs_.push_back(pair);
    pairs_.back().volume = sum += own;
  }
}

double InformedUnion::volume(int grasp) {
  if (std::isinf(cost_)) return box_volume_;
  if (!prepared_) prepare();
  return grasp < grasps_ ? std::min(volumes_[grasp], box_volume_) : 0;
}

double InformedUnion::volume() {
  if (std::isinf(cost_)) return box_volume_;
  if (!prepared_) prepare();
  return pairs_.empty() ? 0 : std::min(pairs_.back().volume, box_volume_);
}

void InformedUnion::draw_ellipsoid(Rng& rng, const Pair& pair, double c, double* q) {
  const int d = ends_.dimension();
  // A direction from normal numbers, two at a time, and a radius.
  double squared = 0;
  for (int i = 0; i < d; i += 2) {
    const double radius = std::sqrt(-2 * std::log(1 - rng.uniform())), angle = kTwoPi * rng.uniform();
    ball_[i] = radius * std::cos(angle);
    ball_[i + 1 < d ? i + 1 : d] = radius * std::sin(angle);
  }
  for (int i = 0; i < d; ++i) squared += ball_[i] * ball_[i];
  const double length = std::pow(rng.uniform(), 1.0 / d) / std::sqrt(squared);
  const double along = 0.5 * c * length, across = 0.5 * std::sqrt(c * c - pair.c_min * pair.c_min) * length;
  const double* start = ends_.end(pair.grasp, GraspEnds::kStart, pair.start);
  const double* goal = ends_.end(pair.grasp, GraspEnds::kGoal, pair.goal);
  for (int i = 0; i < d; ++i) q[i] = (i == 0 ? along : across) * ball_[i];
  if (pair.c_min > 0) {
    // Any orthogonal map of the first axis onto the long one serves; the reflection is the cheapest. It takes u, the
    // long axis minus the first one, to -u.
    const double inverse = 1 / pair.c_min;
    double product = 0, norm = 0;
    for (int i = 0; i < d; ++i) {
      const double u = (goal[i] - start[i]) * inverse - (i == 0 ? 1 : 0);
      product += u * q[i];
      norm += u * u;
    }
    if (norm > 0) {
      const double factor = 2 * product / norm;
      for (int i = 0; i < d; ++i) q[i] -= factor * ((goal[i] - start[i]) * inverse - (i == 0 ? 1 : 0));
    }
  }
  for (int i = 0; i < d; ++i) q[i] += 0.5 * (start[i] + goal[i]);
}

bool InformedUnion::in_box(const double* q) const {
  for (Eigen::Index i = 0; i < lower_.size(); ++i)
    if (q[i] < lower_[i] || q[i] > upper_[i]) return false;
  return true;
}

bool InformedUnion::in_pair(const Pair& pair, const double* q) const {
  const int d = ends_.dimension();
  return ends_.cost(pair.grasp) +
             std::sqrt(squared_distance(ends_.end(pair.grasp, GraspEnds::kStart, pair.start), q, d)) +
             std::sqrt(squared_distance(ends_.end(pair.grasp, GraspEnds::kGoal, pair.goal), q, d)) <
         cost_;
}

bool InformedUnion::first_to_contain(std::size_t pair, const double* q) const {
  const int grasp = pairs_[pair].grasp;
  for (int g = 0; g < grasp; ++g)
    if (contains(g, q)) return false;
  for (std::size_t p = first_pair_[grasp]; p < pair; ++p)
    if (in_pair(pairs_[p], q)) return false;
  return true;
}

int InformedUnion::any_containing(Rng& rng, const double* q) const {
  for (int i = 0; i < kGuesses; ++i) {
    const Pair& pair = pairs_[rng.index(pairs_.size())];
    if (in_pair(pair, q)) return pair.grasp;
  }
  int found = -1;
  std::size_t count = 0;
  for (const Pair& pair : pairs_)
    if (in_pair(pair, q) && rng.index(++count) == 0) found = pair.grasp;
  return found;
}

int InformedUnion::draw_box(Rng& rng, double* q) {
  for (Eigen::Index i = 0; i < lower_.size(); ++i) q[i] = rng.uniform(lower_[i], upper_[i]);
  return grasps_ > 0 ? static_cast<int>(rng.index(static_cast<std::size_t>(grasps_))) : -1;
}

void InformedUnion::draw_around(Rng& rng, int grasp, double factor, double* q) {
  const std::size_t first = first_of_[grasp];
  const Pair& pair = all_[first + rng.index(first_of_[static_cast<std::size_t>(grasp) + 1] - first)];
  draw_ellipsoid(rng, pair, pair.c_min * factor + kAround, q);
  for (Eigen::Index i = 0; i < lower_.size(); ++i) q[i] = std::clamp(q[i], lower_[i], upper_[i]);
}

int InformedUnion::draw(Rng& rng, double* q) {
  if (std::isinf(cost_)) return draw_box(rng, q);
  if (!prepared_) prepare();
  if (pairs_.empty()) return -1;
  const double sum = pairs_.back().volume;
  // Both ways draw uniformly; the ellipsoids pay for their overlaps, the box for asking every grasp.
  const bool whole_box = sum > box_volume_ * (1 + kScanShare * grasps_);
  for (int i = 0; i < kTries; ++i) {
    if (whole_box) {
      for (Eigen::Index k = 0; k < lower_.size(); ++k) q[k] = rng.uniform(lower_[k], upper_[k]);
      const int grasp = any_containing(rng, q);
      if (grasp >= 0) return grasp;
      continue;
    }
    const double at = rng.uniform() * sum;
    const auto pair = std::upper_bound(pairs_.begin(), pairs_.end(), at,
                                       [](double value, const Pair& entry) { return value < entry.volume; });
    const auto index = static_cast<std::size_t>(std::min(pair - pairs_.begin(), std::ptrdiff_t(pairs_.size()) - 1));
    draw_ellipsoid(rng, pairs_[index], cost_ - ends_.cost(pairs_[index].grasp), q);
    if (in_box(q) && first_to_contain(index, q)) {
      const int grasp = any_containing(rng, q);
      // Rounding can leave a draw on the very edge outside of its own ellipsoid.
      if (grasp >= 0) return grasp;
    }
  }
  return -1;
}

}  // namespace mmgrasp::detail
