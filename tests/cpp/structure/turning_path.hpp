#pragma once

#include <cmath>

#include "beam_frames.hpp"
#include "mmgrasp/structure/optimize_grasp.hpp"
#include "support/puma_arm.hpp"

namespace mmgrasp {

/// P2's pipe of figure 3.4, carried by a Puma along an arc on which it turns, past a post.
inline ObjectPathProblem turning_path(int poses) {
  static const test::PumaArm arm;
  ObjectPathProblem problem{arm.group(), {}, figure_3_4().shapes(), {}, {}, {"l5", "l6"}, figure_3_4_frame(), "pipe"};
  for (int i = 0; i < poses; ++i) {
    const double turn = -0.3 + 0.12 * i;
    problem.T_world_object.push_back(
        pose_from_xyz_rpy({0.5 * std::cos(turn), 0.5 * std::sin(turn), 0.45 + 0.01 * i}, {0, 0.05 * i, turn}));
  }
  problem.world.add("post", Cylinder{0.05, 0.6}, pose_from_xyz_rpy({0.25, 0.22, 0.3}, {0, 0, 0}));
  return problem;
}

/// The Puma's hand: approach along z, closing along x.
inline PipeGraspOptions pipe_tool() {
  PipeGraspOptions options;
  options.approach = Eigen::Vector3d::UnitZ();
  options.closing = Eigen::Vector3d::UnitX();
  return options;
}

}  // namespace mmgrasp
