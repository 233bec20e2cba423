#pragma once

#include <vector>

#include "mmgrasp/trajopt/optimize_whole_body.hpp"

namespace mmgrasp::detail {

/// Seconds that each way between successive configurations takes, resting at the first and the last.
std::vector<double> segment_times(const JointGroup& group, const std::vector<Eigen::VectorXd>& knots);

/// `intervals` shared out in proportion to times, at least three each.
std::vector<int> share_intervals(int intervals, const std::vector<double>& times);

/// A drive of the base that the arm's part of a way has to wait for.
struct GuidedBase {
  std::vector<Eigen::Vector3d> poses;  ///< Straight drives and turns; empty: the base is not guided.
  bool arm_waits = true;               ///< The arm moves at the end of the way; else at its beginning.
};

/// Seconds it takes without stopping at corners.
double drive_time(const JointGroup& group, const std::vector<Eigen::Vector3d>& poses);

/// Through the knots: the arm straight, the base along a smooth curve that looks where it drives, or turning, driving
/// and turning where it would have to turn back. `guides` is empty or holds one per way.
WholeBodyGuess guess_through(const JointGroup& group, const std::vector<Eigen::VectorXd>& knots,
                             const std::vector<int>& intervals, const std::vector<double>& times,
                             const std::vector<GuidedBase>& guides = {});

/// The same motion with other numbers of intervals per segment.
WholeBodyGuess resampled(const WholeBodyTrajectory& trajectory, const std::vector<double>& segment_ends,
                         const std::vector<int>& intervals);

}  // namespace mmgrasp::detail
