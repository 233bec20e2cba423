#include "plan/motion/shortening.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kMaxFailures = 30;        // Shortcuts in a row without a gain after which a path counts as short.
constexpr double kSmallestGain = 4e-3;  // Relative to the path's length; shortcuts that gain less are not checked.

using Waypoints = std::vector<Eigen::VectorXd>;

struct PathPoint {
  std::size_t edge = 0;  // Lies between waypoints `edge` and `edge + 1`.
  Eigen::VectorXd q;
};

/// Shortens a path in place by shortcuts that are free, of all joints and of one, at random places.
class Shortener {
 public:
  Shortener(MotionEdges& edges, Waypoints& waypoints, Rng& rng, const ShorteningOptions& options)
      : edges_(edges), waypoints_(waypoints), rng_(rng), options_(options) {}

  void run() {
    remove_repeats();
    skip_waypoints();
    int without_gain = 0;
    for (int i = 0; i < options_.iterations && without_gain < kMaxFailures && waypoints_.size() > 2; ++i) {
      if (options_.stopped()) return;
      // A steered base cannot move one value alone.
      const bool gained = i % 3 == 2 && !edges_.steered() ? shortcut_one_joint() : shortcut();
      without_gain = gained ? 0 : without_gain + 1;
    }
    if (options_.skips_at_end) skip_waypoints();
  }

 private:
  double length(const Waypoints& points) const { return edges_.metric().length(points); }

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

  /// Goes from each waypoint straight to the farthest later one with a free edge.
  void skip_waypoints() {
    for (std::size_t i = 0; i + 2 < waypoints_.size(); ++i) {
      for (std::size_t j = waypoints_.size() - 1; j > i + 1; --j) {
        if (options_.stopped()) return;
        const PathPoint a{i, waypoints_[i]}, b{j - 1, waypoints_[j]};
        // A straight edge is never longer; turning and driving may be.
        const double least_gain = edges_.steered() ? kSmallestGain * length(waypoints_) : -1e-9;
        if (replace_if_better(a, b, stretch(a, b), joined(a.q, b.q), least_gain)) break;
      }
    }
  }

  PathPoint point_at(double s) const {
    for (std::size_t i = 0; i + 1 < waypoints_.size(); ++i) {
      const double edge = edges_.metric().norm(waypoints_[i + 1] - waypoints_[i]);
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

  Waypoints joined(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    Waypoints points{a};
    edges_.connect(a, b, points);
    return points;
  }

  bool replace_if_better(const PathPoint& a, const PathPoint& b, const Waypoints& old_stretch, Waypoints new_stretch,
                         double least_gain) {
    if (length(old_stretch) - length(new_stretch) < least_gain) return false;
    // Most shortcuts are blocked between their ends: those are checked last. Waypoints are free; a point within an
    // edge lies between its checks.
    const std::size_t last = new_stretch.size() - 2;
    for (std::size_t i = 0; i <= last; ++i) {
      if (!edges_.straight_stays_free(new_stretch[i], new_stretch[i + 1], options_.resolution, i == last)) return false;
    }
    if (a.q != waypoints_[a.edge] && !edges_.is_free(a.q)) return false;
    if (new_stretch.back() != waypoints_[b.edge + 1] && !edges_.is_free(new_stretch.back())) return false;
    Waypoints result(waypoints_.begin(), waypoints_.begin() + a.edge + 1);
    result.insert(result.end(), new_stretch.begin(), new_stretch.end());
    // The new stretch may end whole turns away from where the old one did.
    Eigen::VectorXd turns = new_stretch.back() - b.q;
    for (double& turn : turns) turn = whole_turns(turn);
    for (auto w = waypoints_.begin() + b.edge + 1; w != waypoints_.end(); ++w) result.push_back(*w + turns);
    waypoints_ = std::move(result);
    remove_repeats();
    return true;
  }

  bool shortcut() {
    const auto [a, b] = random_points();
    if (a.edge == b.edge) return false;
    return replace_if_better(a, b, stretch(a, b), joined(a.q, b.q), kSmallestGain * length(waypoints_));
  }

  bool shortcut_one_joint() {
    const auto [a, b] = random_points();
    const auto joint = static_cast<Eigen::Index>(rng_.index(a.q.size()));
    if (a.edge == b.edge) return false;
    const Waypoints old_stretch = stretch(a, b);
    Waypoints new_stretch = old_stretch;
    const double total = length(old_stretch);
    double s = 0;
    for (std::size_t i = 1; i + 1 < new_stretch.size(); ++i) {
      s += edges_.metric().norm(old_stretch[i] - old_stretch[i - 1]);
      new_stretch[i][joint] = a.q[joint] + (s / total) * (b.q[joint] - a.q[joint]);
    }
    return replace_if_better(a, b, old_stretch, std::move(new_stretch), kSmallestGain * length(waypoints_));
  }

  MotionEdges& edges_;
  Waypoints& waypoints_;
  Rng& rng_;
  const ShorteningOptions& options_;
};

}  // namespace

void shorten_path(MotionEdges& edges, JointPath& path, Rng& rng, const ShorteningOptions& options) {
  if (path.waypoints.size() > 2) Shortener(edges, path.waypoints, rng, options).run();
}

}  // namespace mmgrasp::detail
