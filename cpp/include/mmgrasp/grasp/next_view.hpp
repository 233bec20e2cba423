#pragma once

#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/grasp/synthesize_grasps.hpp"
#include "mmgrasp/mapping/depth_camera.hpp"

namespace mmgrasp {

/// Which camera poses next_view() compares, and how.
struct MMGRASP_EXPORT NextViewOptions {
  int candidates = 24;           ///< Poses on the sphere around the object; > 0.
  double distance = 0.35;        ///< Way from the camera to the middle of the object [m]; > 0.
  double min_elevation = 0.35;   ///< Lowest camera above the horizontal through the middle, in [-pi/2, pi/2) [rad].
  double max_elevation = 1.35;   ///< Highest; above min_elevation, at most pi/2 [rad].
  int draws = 2;                 ///< Frames imagined of each pose, each with noise of its own; > 0.
  int max_width = 160;           ///< Imagined frames have no more columns [pixels]; > 0.
  FrameUncertainty uncertainty;  ///< That of the frame's pose; an image of sigmas is not taken.
  int threads = 0;               ///< 0: all. The answer does not depend on it.
  unsigned seed = 1;             ///< Same seed, same view.
  SynthesisOptions synthesis;    ///< How grasps are searched for in what would be known.
  void check() const;
};

/// A camera pose and what is expected of it.
struct MMGRASP_EXPORT ViewCandidate {
  Pose T_world_camera = Pose::Identity();
  double probability = 0;  ///< Best grasp's, once the frame is in the map, in the mean over the draws.
  double certain = 0;      ///< How much surface would be certain, in shares of the candidate with most.
  double unseen = 0;       ///< Share of the object's pixels that would show what the map does not know.
  Eigen::VectorXd q;       ///< The arm's configuration; empty without an arm.
};

/// Where to look next.
struct MMGRASP_EXPORT NextView {
  Outcome outcome = Outcome::not_found;   ///< solved, not_found (the arm reaches no pose) or stopped.
  double probability_now = 0;             ///< Best grasp's in the map as it is; 0: there is none.
  std::vector<ViewCandidate> candidates;  ///< Those within reach, the best first.
  Rejections arm;                         ///< Why the arm did not reach others.
};

/// The reachable camera pose after which the best grasp is expected to be most probable.
///
/// Candidates lie on a sphere around the object and look at its middle; `arm`, whose tip is the camera, leaves out
/// those it does not reach. From each a frame is imagined: the map's surface where it is known, and where it is not the
/// hull of what was seen, down to the table, since the back of a part is about where its rims are. Its depths get the
/// camera's noise, it is integrated into a copy of the map, and grasps are searched for there. Best is the largest
/// sum of the best grasp's probability (4.9), in the mean over the draws, and of the share of surface that would be
/// certain: until a hand fits, the probability is 0 everywhere and tells no view from another. Throws InvalidInput as
/// synthesize_grasps() does, and on options out of range.
MMGRASP_EXPORT NextView next_view(const ProbabilisticSdf& map, const HandModel& hand, const DepthCamera& camera,
                                  const NextViewOptions& options = {}, const Monitor& monitor = {},
                                  const ArmReach& arm = {});
MMGRASP_EXPORT NextView next_view(const ProbabilisticSdf& map, const Hand& hand, const DepthCamera& camera,
                                  const NextViewOptions& options = {}, const Monitor& monitor = {},
                                  const ArmReach& arm = {});

}  // namespace mmgrasp
