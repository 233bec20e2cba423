#pragma once

#include <cmath>
#include <vector>

#include "beam_frames.hpp"
#include "mmgrasp/structure/object_path.hpp"
#include "mmgrasp/structure/pipe_grasps.hpp"
#include "support/puma_arm.hpp"

namespace mmgrasp {

/// Pipe1 of P2 along an arc around the arm that also rises and turns; nothing else in the world.
inline ObjectPathProblem free_arc(int poses) {
  static const test::PumaArm arm;
  ObjectPathProblem problem{arm.group(), {}, figure_3_4().shapes(), {}, {}, {"l5", "l6"}, figure_3_4_frame(), "pipe"};
  for (int i = 0; i < poses; ++i) {
    const double turn = -0.3 + 0.12 * i;
    problem.T_world_object.push_back(
        pose_from_xyz_rpy({0.5 * std::cos(turn), 0.5 * std::sin(turn), 0.45 + 0.01 * i}, {0, 0.05 * i, turn}));
  }
  return problem;
}

/// With a post that some arm configurations hit.
inline ObjectPathProblem arc_past_post(int poses) {
  ObjectPathProblem problem = free_arc(poses);
  problem.world.add("post", Cylinder{0.05, 0.6}, pose_from_xyz_rpy({0.25, 0.22, 0.3}, {0, 0, 0}));
  return problem;
}

/// The arm's tool: z goes in, x closes.
inline PipeGraspOptions puma_tool() {
  PipeGraspOptions options;
  options.approach = Eigen::Vector3d::UnitZ();
  options.closing = Eigen::Vector3d::UnitX();
  return options;
}

/// Of Pipe1, for that tool.
inline std::vector<Grasp> some_grasps(int count, unsigned seed) {
  PipeGraspOptions options = puma_tool();
  options.seed = seed;
  return sample_pipe_grasps(figure_3_4(), count, options).grasps;
}

}  // namespace mmgrasp
