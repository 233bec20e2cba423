#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"

namespace mmgrasp {

/// One factor of a grasp's quality, 1 - weight + weight * value: one of weight 0.5 halves the quality at worst.
struct MMGRASP_EXPORT QualityFactor {
  std::string name;
  double value = 1;   ///< From 0 to 1, the best.
  double weight = 1;  ///< From 0 (counts nothing) to 1.

  double factor() const { return 1 - weight + weight * value; }
};

/// Provenance of sample_grasps: two opposed contacts and a direction of approach.
struct MMGRASP_EXPORT ContactPairProvenance {
  int pair = 0;             ///< Index among the object's contact pairs, those that are too wide included.
  int approach = 0;         ///< Index among GraspSamplerOptions::approaches.
  bool flipped = false;     ///< The hand is turned by half a turn about the approach.
  bool tips_flush = false;  ///< The tips of the pads are flush with the object's far face.
};

/// Provenance of sample_pipe_grasps: P2's four variables (3.2.3.1, figure 3.5).
struct MMGRASP_EXPORT PipeProvenance {
  int section = 0;
  double length = 0;     ///< From the section's first node to the tool frame [m].
  double angle = 0;      ///< From the section's y axis to the approach direction about its x axis, in [-pi, pi) [rad].
  bool flipped = false;  ///< The hand is turned by half a turn about the approach.
};

/// Provenance of evaluate_graspability: a place of a height map and, if a depth image was given, of the image.
struct MMGRASP_EXPORT HeightMapProvenance {
  double angle = 0;    ///< Direction of the closing axis in the map's frame, in [0, pi) [rad].
  double height = 0;   ///< Height of the finger tips above the map's frame [m].
  int ix = 0, iy = 0;  ///< Cell of the map.
  Eigen::Vector2d pixel = Eigen::Vector2d::Constant(-1);  ///< (u, v); (-1, -1): no image, or outside of it.
};

/// Which sampler a grasp came from, and with which numbers; monostate: it was given.
using GraspProvenance = std::variant<std::monostate, ContactPairProvenance, PipeProvenance, HeightMapProvenance>;

/// One way to hold an object: where the hand stands, how far it is open, what it costs and how good it is.
///
/// Samplers, planners, trays and plans all speak of this one record. The hand's frame is its tool frame
/// (Hand::tool_link); a robot holds the object when T_world_hand = T_world_object * T_object_hand.
///
///     Grasp grasp;
///     grasp.T_object_hand = pose_from_xyz_rpy({0, 0, 0.01}, {0, 1.5708, 0});  // from above, approaching along x
///     grasp.opening = 0.04;
///     problem.grasps = {grasp};
struct MMGRASP_EXPORT Grasp {
  /// Pose of the hand's tool frame in the object's frame. Where no object is known (evaluate_graspability) the object's
  /// frame is the world's.
  Pose T_object_hand = Pose::Identity();
  double opening = 0;  ///< Distance between the fingers while holding [m]: the object's width between them; >= 0.
  double cost = 0;     ///< Added by planners to their path's length; >= 0.
  double quality = 1;  ///< Larger is better, in [0, 1].
  std::vector<QualityFactor> quality_factors{};  ///< `quality` is their product; empty when it was given as a number.
  /// Posture of a hand with several joint groups: for each of Hand::groups() how far it is open, in [0, 1]. Empty: the
  /// posture that belongs to `opening`.
  std::vector<double> posture{};
  GraspProvenance provenance{};

  /// Sets `quality_factors`, and `quality` to their product.
  void set_quality(std::vector<QualityFactor> factors);
};

/// What a sampler found, and what it left out because the hand does not open so far.
struct MMGRASP_EXPORT SampledGrasps {
  std::vector<Grasp> grasps;
  int too_wide = 0;  ///< Contact pairs (sample_grasps) or sections of a pipe (sample_pipe_grasps) wider than the hand.
  int tips_flush = 0;  ///< How many of `grasps` have the tips of the pads flush with the far face (sample_grasps).
};

}  // namespace mmgrasp
