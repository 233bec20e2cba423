#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/grasp/grasp.hpp"
#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/structure/pipe.hpp"

namespace mmgrasp {

/// The hand's axes and opening, and how densely grasps are drawn along and around a pipe.
struct MMGRASP_EXPORT PipeGraspOptions {
  Eigen::Vector3d approach = Eigen::Vector3d::UnitX();  ///< Unit axis of the tool frame along which the hand moves in.
  Eigen::Vector3d closing = Eigen::Vector3d::UnitY();   ///< Unit axis of the tool frame along which the pads close.
  double max_opening = 0.1;  ///< Sections thicker than this get no grasps (they are counted) [m]; > 0.
  double end_margin = 0.02;  ///< Kept from either node of a section, for the fingers' width [m]; >= 0.
  /// Any two grasps of a section and flip are this far apart along it or in angle [m], [rad]; > 0.
  double length_spacing = 0.01, angle_spacing = 5 * 3.14159265358979323846 / 180;
  double cost_per_metre = 0;  ///< Cost of a grasp for its distance from the centre of mass [1/m]; >= 0.
  int draws = 200;            ///< Fruitless draws in a row after which no more grasps are looked for; > 0.
  unsigned seed = 1;          ///< Same seed, same grasps; a longer list begins with the shorter one.
  void check() const;
};

/// Options for a hand: its axes and widest opening, half its fingers' width kept from the nodes.
MMGRASP_EXPORT PipeGraspOptions pipe_grasp_options(const Hand& hand);

/// One grasp by P2's four variables (3.2.3.1, figure 3.5), which become its provenance: T_object_hand turns the hand's
/// approach axis to `angle` across the section and its closing axis across both (P2's B_e^P); the opening is the
/// section's diameter. Throws InvalidInput unless the section exists and 0 <= length <= its length.
MMGRASP_EXPORT Grasp place_pipe_grasp(const Pipe& pipe, int section, double length, double angle, bool flipped,
                                      const PipeGraspOptions& options = {});

/// Grasps drawn over the whole pipe: sections by their length without margins, length and angle uniform, either flip
/// alike. Returns at most `count`: fewer when no more fit (see `draws`); `too_wide` counts sections left out. Neither
/// the hand's nor the arm's collisions are checked here.
MMGRASP_EXPORT SampledGrasps sample_pipe_grasps(const Pipe& pipe, int count, const PipeGraspOptions& options = {});

}  // namespace mmgrasp
