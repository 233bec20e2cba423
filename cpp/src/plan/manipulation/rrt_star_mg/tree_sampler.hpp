#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/plan/rrt_star_mg.hpp"
#include "plan/manipulation/common/informed_union.hpp"
#include "plan/manipulation/rrt_star_mg/grasp_trees.hpp"
#include "plan/manipulation/rrt_star_mg/tuning.hpp"

namespace mmgrasp::detail {

/// Decides where the trees of RRT*-MG grow next: configurations drawn at random, and those that a tree gave up but
/// another grasp's may use (X_reassign, P2 5.3.3).
class MMGRASP_EXPORT TreeSampler {
 public:
  /// x_rand and j of P2's Algorithm 5.13; both -1: nothing was drawn.
  struct Sample {
    int configuration = -1;
    int grasp = -1;
  };

  TreeSampler(GraspTrees& trees, InformedUnion& informed, const RrtStarMgOptions& options,
              const RrtStarMgTuning& tuning);

  /// Sample (Algorithm 5.10), once a path is known: uniform where a better one can pass, with one of the grasps that
  /// can have it.
  Sample draw(Rng& rng);
  /// Draws a configuration before there is a path: mostly near a straight line of the grasp, for the space within the
  /// joint limits is large and few paths leave that neighbourhood.
  int draw_near_straight_line(Rng& rng, int grasp);
  /// The grasp whose trees grow next before there is a path: that of the k-th cheapest straight line with a chance that
  /// falls as 1 / k. However many must be tried, none waits much longer than its place in that order.
  int pick_grasp(Rng& rng) const;

  /// SampleRandom(X_reassign) (Algorithm 5.13, line 19): takes random ones out of the list until one may improve a
  /// grasp whose tree on this side does not have it.
  Sample draw_reassigned(Rng& rng, int side);
  /// Adds to X_reassign.
  void reassign(int configuration) { reassigned_.push_back(configuration); }

 private:
  GraspTrees& trees_;
  InformedUnion& informed_;
  const RrtStarMgOptions& options_;
  const RrtStarMgTuning& tuning_;
  std::vector<int> reassigned_;
  Eigen::VectorXd q_;  ///< Scratch.
};

}  // namespace mmgrasp::detail
