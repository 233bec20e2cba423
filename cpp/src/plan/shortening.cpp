#include "plan/shortening.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mmgrasp::detail {
namespace {

constexpr int kPatience = 60;           // Attempts without a gain after which a path counts as short.
constexpr double kSmallestGain = 1e-3;  // Relative to the path's length; less is not worth another corner.

using Waypoints = std::vector<Eigen::VectorXd>;

struct PathPoint {
  std::size_t edge = 0;  // Between waypoints edge and edge + 1.
  Eigen::VectorXd q;
};

class Shortener {
 public:
  Shortener(CollisionChecker& checker, Waypoints& waypoints, Rng& rng, const ShorteningOptions& options)
      : checker_(checker), waypoints_(waypoints), rng_(rng), options_(options) {}

  void run() {
    remove_repeats();
    skip_waypoints();
    int without_gain = 0;
    for (int i = 0; i < options_.iterations && without_gain < kPatience && waypoints_.size() > 2; ++i) {
      if (options_.stopped()) return;
      const bool gained = i % 3 == 2 ? shortcut_one_joint() : shortcut();
      without_gain = gained ? 0 : without_gain + 1;
    }
    skip_waypoints();
  }

 private:
  bool free(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return checker_.edge_is_free(a, b, options_.edge_step);
  }

  static double length(const Waypoints& points) {
    double sum = 0;
    for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
    return sum;
  }

  void remove_repeats() {
    Waypoints kept{waypoints_.front()};
    for (std::size_t i = 1; i < waypoints_.size(); ++i) {
      const bool last = i + 1 == waypoints_.size();
      if ((waypoints_[i] - kept.back()).norm() > 1e-9) {
        kept.push_back(waypoints_[i]);
      } else if (last && kept.size() > 1) {
        kept.back() = waypoints_[i];
      } else if (last) {
        kept.push_back(waypoints_[i]);
      }
    }
    waypoints_ = std::move(kept);
  }

  /// From each waypoint straight to the farthest later one in sight.
  void skip_waypoints() {
    for (std::size_t i = 0; i + 2 < waypoints_.size(); ++i) {
      for (std::size_t j = waypoints_.size() - 1; j > i + 1; --j) {
        if (options_.stopped()) return;
        if (!free(waypoints_[i], waypoints_[j])) continue;
        waypoints_.erase(waypoints_.begin() + i + 1, waypoints_.begin() + j);
        break;
      }
    }
  }

  PathPoint point_at(double s) const {
    for (std::size_t i = 0; i + 1 < waypoints_.size(); ++i) {
      const double edge = (waypoints_[i + 1] - waypoints_[i]).norm();
      if (s <= edge && edge > 0) return {i, waypoints_[i] + (s / edge) * (waypoints_[i + 1] - waypoints_[i])};
      s -= edge;
    }
    return {waypoints_.size() - 2, waypoints_.back()};
  }

  std::pair<PathPoint, PathPoint> random_points() {
    const double total = length(waypoints_);
    double s0 = rng_.uniform(0.0, total), s1 = rng_.uniform(0.0, total);
    if (s0 > s1) std::swap(s0, s1);
    return {point_at(s0), point_at(s1)};
  }

  /// The stretch between two points, corners included.
  Waypoints stretch(const PathPoint& a, const PathPoint& b) const {
    Waypoints points{a.q};
    points.insert(points.end(), waypoints_.begin() + a.edge + 1, waypoints_.begin() + b.edge + 1);
    points.push_back(b.q);
    return points;
  }

  bool replace_if_better(const PathPoint& a, const PathPoint& b, const Waypoints& old_stretch, Waypoints new_stretch) {
    if (length(old_stretch) - length(new_stretch) < kSmallestGain * length(waypoints_)) return false;
    for (std::size_t i = 0; i + 1 < new_stretch.size(); ++i) {
      if (!free(new_stretch[i], new_stretch[i + 1])) return false;
    }
    Waypoints result(waypoints_.begin(), waypoints_.begin() + a.edge + 1);
    result.insert(result.end(), new_stretch.begin(), new_stretch.end());
    result.insert(result.end(), waypoints_.begin() + b.edge + 1, waypoints_.end());
    waypoints_ = std::move(result);
    remove_repeats();
    return true;
  }

  bool shortcut() {
    const auto [a, b] = random_points();
    if (a.edge == b.edge) return false;
    return replace_if_better(a, b, stretch(a, b), {a.q, b.q});
  }

  bool shortcut_one_joint() {
    const auto [a, b] = random_points();
    const auto joint = static_cast<Eigen::Index>(rng_.index(static_cast<std::size_t>(a.q.size())));
    if (a.edge == b.edge) return false;
    const Waypoints old_stretch = stretch(a, b);
    Waypoints new_stretch = old_stretch;
    const double total = length(old_stretch);
    double s = 0;
    for (std::size_t i = 1; i + 1 < new_stretch.size(); ++i) {
      s += (old_stretch[i] - old_stretch[i - 1]).norm();
      new_stretch[i][joint] = a.q[joint] + (s / total) * (b.q[joint] - a.q[joint]);
    }
    return replace_if_better(a, b, old_stretch, std::move(new_stretch));
  }

  CollisionChecker& checker_;
  Waypoints& waypoints_;
  Rng& rng_;
  const ShorteningOptions& options_;
};

}  // namespace

void shorten_path(CollisionChecker& checker, JointPath& path, Rng& rng, const ShorteningOptions& options) {
  if (path.waypoints.size() > 2) Shortener(checker, path.waypoints, rng, options).run();
}

}  // namespace mmgrasp::detail
