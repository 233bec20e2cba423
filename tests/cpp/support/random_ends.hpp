#pragma once

#include <vector>

#include "mmgrasp/core/random.hpp"
#include "plan/manipulation/common/grasp_ends.hpp"

namespace mmgrasp::test {

/// Ends of grasps drawn from a box: one to three starts, one or two goals each.
inline detail::GraspEnds random_ends(int grasps, int dimension, Rng& rng, const std::vector<bool>& wraps = {}) {
  const Eigen::VectorXd lower = Eigen::VectorXd::Constant(dimension, -3),
                        upper = Eigen::VectorXd::Constant(dimension, 3);
  std::vector<detail::GraspCandidate> candidates;
  for (int g = 0; g < grasps; ++g) {
    detail::GraspCandidate candidate;
    candidate.grasp = g;
    candidate.metric = detail::JointMetric(wraps);
    for (int k = 0; k < 1 + g % 3; ++k) candidate.starts.push_back(rng.uniform(lower, upper));
    for (int k = 0; k < 1 + g % 2; ++k) candidate.goals.push_back(rng.uniform(lower, upper));
    candidates.push_back(candidate);
  }
  return detail::GraspEnds(candidates);
}

}  // namespace mmgrasp::test
