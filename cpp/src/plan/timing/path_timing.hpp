#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/monitor.hpp"
#include "plan/timing/blended_path.hpp"

namespace mmgrasp::detail {

/// The fastest motion along a path that starts, ends and passes sharp corners at rest. On a grid of arc lengths the
/// squared path speed x = (ds/dt)^2 is linear between neighbours, so that the path acceleration u is constant there.
/// Joint velocity f' sqrt(x) and joint acceleration f' u + f'' x are bounded at both ends of every interval. A backward
/// pass finds the largest x at each grid point from which the rest can be driven, a forward pass the largest x that can
/// be reached.
class PathTiming {
 public:
  struct State {
    Eigen::VectorXd position, velocity, acceleration;
    double s = 0;
  };

  /// Throws TimingStopped, as jumps() does.
  PathTiming(const BlendedPath& path, const Eigen::VectorXd& velocity_limits,
             const Eigen::VectorXd& acceleration_limits, const CancelToken& stop);

  double duration() const { return times_.back(); }
  const CancelToken& stop() const { return stop_; }
  State at(double time) const;
  /// Times of grid points at which some joint's acceleration jumps by more than `relative` of its limit.
  std::vector<double> jumps(double relative) const;

 private:
  struct Interval {
    std::size_t segment = 0;
    double s0 = 0, s1 = 0;  // Arc lengths from the segment's start.
  };
  struct Bounds;  // The allowed (x, u) of one interval.

  void make_grid();
  Bounds bounds(std::size_t interval, double next_limit) const;
  void integrate();
  State state(std::size_t interval, double time_in_interval) const;

  const BlendedPath& path_;
  Eigen::VectorXd velocity_limits_, acceleration_limits_;
  const CancelToken stop_;
  std::vector<Interval> intervals_;
  std::vector<double> speed_limits_;  // Largest x by joint velocities alone, per grid point; 0 where the path rests.
  std::vector<double> x_;             // One per grid point.
  std::vector<double> times_;         // One per grid point.
};

}  // namespace mmgrasp::detail
