#include "plan/timing/path_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "plan/timing/timing_stop.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kRounding = 5e-7;        // Less beyond what is allowed is rounding [rad or m].
constexpr double kLeastShare = 1.0 / 16;  // Corners are rounded by no smaller share of what is allowed: they are stops.
constexpr std::size_t kNeighbours = 2;    // Edges on either side that are looked at for a nearer one.

/// The distance to a polyline of points that follow it: the nearest edge is sought from the last point's.
class Follower {
 public:
  explicit Follower(const std::vector<Eigen::VectorXd>& waypoints) : waypoints_(waypoints) {
    for (std::size_t i = 0; i + 1 < waypoints.size(); ++i) edges_.emplace_back(waypoints[i + 1] - waypoints[i]);
  }

  double distance(const Eigen::VectorXd& q) {
    double nearest = edge_distance(edge_, q);
    for (std::size_t from = waypoints_.size(); from != edge_;) {
      from = edge_;
      const std::size_t begin = from - std::min(from, kNeighbours);
      const std::size_t end = std::min(from + kNeighbours + 1, waypoints_.size() - 1);
      for (std::size_t i = begin; i < end; ++i) {
        const double d = edge_distance(i, q);
        if (d >= nearest) continue;
        nearest = d;
        edge_ = i;
      }
    }
    return nearest;
  }

  /// The inner waypoint next to the last point (one of the ends of its edge).
  std::size_t corner(const Eigen::VectorXd& q) const {
    const std::size_t last = waypoints_.size() - 3;
    if (edge_ == 0) return 0;
    if (edge_ > last) return last;
    const bool at_begin = (waypoints_[edge_] - q).squaredNorm() <= (waypoints_[edge_ + 1] - q).squaredNorm();
    return at_begin ? edge_ - 1 : edge_;
  }

 private:
  double edge_distance(std::size_t i, const Eigen::VectorXd& q) const {
    const Eigen::VectorXd& edge = edges_[i];
    const double along = (q - waypoints_[i]).dot(edge) / edge.squaredNorm();
    return (q - waypoints_[i] - std::clamp(along, 0.0, 1.0) * edge).norm();
  }

  const std::vector<Eigen::VectorXd>& waypoints_;
  std::vector<Eigen::VectorXd> edges_;
  std::size_t edge_ = 0;
};

/// Points of one interval so close that the motion bends by less than the rounding between them.
int point_count(const JointTrajectory& motion, std::size_t i) {
  const double h = motion.times[i + 1] - motion.times[i];
  const double bend = std::max(motion.accelerations[i].norm(), motion.accelerations[i + 1].norm());
  return static_cast<int>(std::clamp(std::ceil(h * std::sqrt(bend / (8 * kRounding))), 2.0, 64.0));
}

/// The corner nearest to `corner` along the path that is no stop; the number of corners when all are.
std::size_t rounded_corner(const std::vector<double>& deviations, std::size_t corner) {
  for (std::size_t away = 0; away < deviations.size(); ++away) {
    if (corner >= away && deviations[corner - away] > 0) return corner - away;
    if (corner + away < deviations.size() && deviations[corner + away] > 0) return corner + away;
  }
  return deviations.size();
}

}  // namespace

bool keeps_deviation(const JointTrajectory& motion, const std::vector<Eigen::VectorXd>& waypoints,
                     const std::vector<double>& allowed, std::vector<double>& deviations, const CancelToken& stop) {
  if (deviations.empty()) return true;
  std::vector<bool> beyond(deviations.size(), false);
  bool kept = true;
  Follower follower(waypoints);
  for (std::size_t i = 0; i + 1 < motion.times.size(); ++i) {
    end_if_stopped(stop);
    const double h = motion.times[i + 1] - motion.times[i];
    const int count = point_count(motion, i);
    for (int k = 0; k < count; ++k) {
      const Eigen::VectorXd q = motion.at(motion.times[i] + h * k / count);
      const double distance = follower.distance(q);
      const std::size_t corner = follower.corner(q);
      if (distance <= allowed[corner] + kRounding) continue;
      const std::size_t rounded = rounded_corner(deviations, corner);
      if (rounded == deviations.size()) return true;
      beyond[rounded] = true;
      kept = false;
    }
  }
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    if (!beyond[i]) continue;
    deviations[i] /= 2;
    if (deviations[i] < kLeastShare * allowed[i]) deviations[i] = 0;
  }
  return kept;
}

}  // namespace mmgrasp::detail
