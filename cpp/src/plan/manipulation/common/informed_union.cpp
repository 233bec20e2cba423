#include "plan/manipulation/common/informed_union.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/ball_volume.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kMaxTries = 10000;           // Draws before the union counts as too thin.
constexpr double kLeastDetour = 0.1;       // What draw_around() adds to the factor at least [rad or m].
constexpr double kThin = 1e-9;             // Ellipsoids whose c exceeds c_min by less than this share have no inside.
constexpr int kRandomGuesses = 64;         // Random ellipsoids tested before all of them are.
constexpr double kRelativeScanCost = 0.1;  // Time to test one grasp, by that of one draw.

double weighted_volume(const JointMetric& metric, const Eigen::VectorXd& sides) {
  return metric.weighted() ? sides.cwiseProduct(metric.weights()).prod() : sides.prod();
}

}  // namespace

InformedUnion::InformedUnion(const GraspEnds& ends, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper)
    : ends_(ends),
      lower_(lower),
      upper_(upper),
      unit_ball_volume_(unit_ball_volume(ends.dimension())),
      box_volume_(weighted_volume(ends.metric(), upper - lower)),
      cost_(kInfinity),
      grasps_(ends.size()),
      direction_(ends.dimension() + 1),
      goal_(ends.dimension()) {
  for (int g = 0; g < ends.size(); ++g) {
    first_of_.push_back(all_.size());
    for (int s = 0; s < ends.count(g, GraspEnds::kStart); ++s)
      for (int k = 0; k < ends.count(g, GraspEnds::kGoal); ++k) {
        const double squared = ends.metric().squared_distance(ends.end(g, GraspEnds::kStart, s),
                                                              ends.end(g, GraspEnds::kGoal, k), ends.dimension());
        all_.push_back({g, s, k, std::sqrt(squared), 0});
      }
  }
  first_of_.push_back(all_.size());
  pairs_.reserve(all_.size());
  first_pair_.reserve(ends.size() + 1);
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
  return unit_ball_volume_ * 0.5 * c * std::pow(across, 0.5 * (ends_.dimension() - 1));
}

void InformedUnion::prepare() {
  prepared_ = true;
  pairs_.clear();
  first_pair_.clear();
  volumes_.assign(grasps_, 0);
  double sum = 0;
  for (const Pair& pair : all_) {
    if (pair.grasp >= grasps_) break;
    while (static_cast<int>(first_pair_.size()) <= pair.grasp) first_pair_.push_back(pairs_.size());
    if (!(ellipsoid_volume(pair) > 0)) continue;
    const std::size_t first = pairs_.size();
    append_images(pair);
    for (std::size_t i = first; i < pairs_.size(); ++i) {
      const double own = ellipsoid_volume(pairs_[i]);
      volumes_[pair.grasp] += own;
      pairs_[i].volume = sum += own;
    }
  }
}

void InformedUnion::append_images(const Pair& nearest) {
  const std::size_t first = pairs_.size();
  pairs_.push_back(nearest);
  const double* start = ends_.end(nearest.grasp, GraspEnds::kStart, nearest.start);
  const double* goal = ends_.end(nearest.grasp, GraspEnds::kGoal, nearest.goal);
  const std::vector<int>& wrapping = ends_.metric().wrapping();
  for (std::size_t k = 0; k < wrapping.size(); ++k) {
    const int i = wrapping[k];
    const double short_way =
        ends_.metric().weight(i) * std::abs(JointMetric::nearest_angle(start[i], goal[i]) - start[i]);
    const double long_way = ends_.metric().turn(i) - short_way;
    const std::size_t count = pairs_.size();
    for (std::size_t p = first; p < count; ++p) {
      Pair image = pairs_[p];
      image.long_ways |= std::uint64_t{1} << k;
      image.c_min = std::sqrt(image.c_min * image.c_min + long_way * long_way - short_way * short_way);
      if (ellipsoid_volume(image) > 0) pairs_.push_back(image);
    }
  }
}

const double* InformedUnion::goal_of(const Pair& pair) {
  const double* goal = ends_.end(pair.grasp, GraspEnds::kGoal, pair.goal);
  if (!ends_.metric().any()) return goal;
  const double* start = ends_.end(pair.grasp, GraspEnds::kStart, pair.start);
  goal_ = Eigen::Map<const Eigen::VectorXd>(goal, ends_.dimension());
  const std::vector<int>& wrapping = ends_.metric().wrapping();
  for (std::size_t k = 0; k < wrapping.size(); ++k) {
    double& value = goal_[wrapping[k]];
    value = JointMetric::nearest_angle(start[wrapping[k]], value);
    if (pair.long_ways >> k & 1) value += value > start[wrapping[k]] ? -kTwoPi : kTwoPi;
  }
  return goal_.data();
}

bool InformedUnion::is_representative(const Pair& pair, const double* q) {
  if (!ends_.metric().any()) return true;
  const double* start = ends_.end(pair.grasp, GraspEnds::kStart, pair.start);
  const double* goal = goal_of(pair);
  for (const int i : ends_.metric().wrapping())
    if (std::abs(q[i] - start[i]) > kPi || std::abs(goal[i] - q[i]) > kPi) return false;
  return true;
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
  const JointMetric& metric = ends_.metric();
  // A direction, in the metric's coordinates, from normal numbers, two at a time, and a radius.
  double squared = 0;
  for (int i = 0; i < d; i += 2) {
    const double radius = std::sqrt(-2 * std::log(1 - rng.uniform())), angle = kTwoPi * rng.uniform();
    direction_[i] = radius * std::cos(angle);
    direction_[i + 1 < d ? i + 1 : d] = radius * std::sin(angle);
  }
  for (int i = 0; i < d; ++i) squared += direction_[i] * direction_[i];
  const double length = std::pow(rng.uniform(), 1.0 / d) / std::sqrt(squared);
  const double along = 0.5 * c * length, across = 0.5 * std::sqrt(c * c - pair.c_min * pair.c_min) * length;
  const double* start = ends_.end(pair.grasp, GraspEnds::kStart, pair.start);
  const double* goal = goal_of(pair);
  for (int i = 0; i < d; ++i) q[i] = (i == 0 ? along : across) * direction_[i];
  if (pair.c_min > 0) {
    // Any orthogonal map of the first axis onto the long one serves; the reflection is the cheapest. It takes u, the
    // long axis minus the first one, to -u.
    const double inverse = 1 / pair.c_min;
    double product = 0, norm = 0;
    for (int i = 0; i < d; ++i) {
      const double u = metric.weight(i) * (goal[i] - start[i]) * inverse - (i == 0 ? 1 : 0);
      product += u * q[i];
      norm += u * u;
    }
    if (norm > 0) {
      const double factor = 2 * product / norm;
      for (int i = 0; i < d; ++i)
        q[i] -= factor * (metric.weight(i) * (goal[i] - start[i]) * inverse - (i == 0 ? 1 : 0));
    }
  }
  metric.from_coordinates(q, q, d);
  for (int i = 0; i < d; ++i) q[i] += 0.5 * (start[i] + goal[i]);
}

bool InformedUnion::in_box(const double* q) const {
  for (Eigen::Index i = 0; i < lower_.size(); ++i)
    if (q[i] < lower_[i] || q[i] > upper_[i]) return false;
  return true;
}

bool InformedUnion::in_pair(const Pair& pair, const double* q) const {
  const int d = ends_.dimension();
  const JointMetric& metric = ends_.metric();
  return ends_.cost(pair.grasp) +
             std::sqrt(metric.squared_distance(ends_.end(pair.grasp, GraspEnds::kStart, pair.start), q, d)) +
             std::sqrt(metric.squared_distance(ends_.end(pair.grasp, GraspEnds::kGoal, pair.goal), q, d)) <
         cost_;
}

bool InformedUnion::first_to_contain(std::size_t pair, const double* q) const {
  const int grasp = pairs_[pair].grasp;
  for (int g = 0; g < grasp; ++g)
    if (contains(g, q)) return false;
  for (std::size_t p = first_pair_[grasp]; p < pair && !same_ends(pairs_[p], pairs_[pair]); ++p)
    if (in_pair(pairs_[p], q)) return false;
  return true;
}

int InformedUnion::any_containing(Rng& rng, const double* q) const {
  for (int i = 0; i < kRandomGuesses; ++i) {
    const Pair& pair = pairs_[rng.index(pairs_.size())];
    if (pair.long_ways == 0 && in_pair(pair, q)) return pair.grasp;
  }
  int found = -1;
  std::size_t count = 0;
  for (const Pair& pair : pairs_)
    if (pair.long_ways == 0 && in_pair(pair, q) && rng.index(++count) == 0) found = pair.grasp;
  return found;
}

int InformedUnion::draw_box(Rng& rng, double* q) {
  for (Eigen::Index i = 0; i < lower_.size(); ++i) q[i] = rng.uniform(lower_[i], upper_[i]);
  return grasps_ > 0 ? static_cast<int>(rng.index(grasps_)) : -1;
}

void InformedUnion::draw_around(Rng& rng, int grasp, double factor, double* q) {
  const std::size_t first = first_of_[grasp];
  const Pair& pair = all_[first + rng.index(first_of_[grasp + 1] - first)];
  draw_ellipsoid(rng, pair, pair.c_min * factor + kLeastDetour * ends_.metric().unit(), q);
  ends_.metric().wrap(q);
  for (Eigen::Index i = 0; i < lower_.size(); ++i) q[i] = std::clamp(q[i], lower_[i], upper_[i]);
}

int InformedUnion::draw(Rng& rng, double* q) {
  if (std::isinf(cost_)) return draw_box(rng, q);
  if (!prepared_) prepare();
  if (pairs_.empty()) return -1;
  const double sum = pairs_.back().volume;
  // Both draw uniformly; drawing from the ellipsoids loses time by their overlaps, from the bounds by testing grasps.
  const bool whole_box = sum > box_volume_ * (1 + kRelativeScanCost * grasps_);
  for (int i = 0; i < kMaxTries; ++i) {
    if (whole_box) {
      for (Eigen::Index k = 0; k < lower_.size(); ++k) q[k] = rng.uniform(lower_[k], upper_[k]);
      const int grasp = any_containing(rng, q);
      if (grasp >= 0) return grasp;
      continue;
    }
    const double at = rng.uniform() * sum;
    const auto pair = std::upper_bound(pairs_.begin(), pairs_.end(), at,
                                       [](double value, const Pair& entry) { return value < entry.volume; });
    const std::size_t index = std::min(pair - pairs_.begin(), std::ptrdiff_t(pairs_.size()) - 1);
    draw_ellipsoid(rng, pairs_[index], cost_ - ends_.cost(pairs_[index].grasp), q);
    if (!is_representative(pairs_[index], q)) continue;
    ends_.metric().wrap(q);
    if (in_box(q) && first_to_contain(index, q)) {
      const int grasp = any_containing(rng, q);
      // Rounding can leave a draw on the very edge outside of its own ellipsoid.
      if (grasp >= 0) return grasp;
    }
  }
  return -1;
}

}  // namespace mmgrasp::detail
