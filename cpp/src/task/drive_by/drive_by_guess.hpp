#pragma once

#include <vector>

#include "mmgrasp/trajopt/optimize_whole_body.hpp"

namespace mmgrasp::detail {

/// Time of each way between successive via points [s], resting at the first and the last.
std::vector<double> segment_times(const JointGroup& group, const std::vector<Eigen::VectorXd>& via_points);

/// `intervals` shared out in proportion to times, at least three each.
std::vector<int> share_intervals(int intervals, const std::vector<double>& times);

/// A way that is known to be free of collisions: straight between its points.
struct GuidedWay {
  std::vector<Eigen::VectorXd> points;  ///< Empty: the way is not guided.
  std::vector<double> times;            ///< When each point is reached, from 0 [s].
  Eigen::VectorXd at(double time) const;
};

/// A guess through the via points: the arm straight, the base along a smooth curve that looks where it drives, or
/// turning, driving and turning where it would have to turn back; or along `ways`, empty or one between each two.
WholeBodyGuess guess_through(const JointGroup& group, const std::vector<Eigen::VectorXd>& via_points,
                             const std::vector<int>& intervals, const std::vector<double>& times,
                             const std::vector<GuidedWay>& ways = {});

/// The same motion with other numbers of intervals per segment.
WholeBodyGuess resampled(const WholeBodyTrajectory& trajectory, const std::vector<double>& segment_ends,
                         const std::vector<int>& intervals);

}  // namespace mmgrasp::detail
